"""One writer at a time in a folder, held by a lock that dies with its process."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

LOCK = ".quatspline.lock"
PATIENCE = 0.5
"""Seconds to wait for a writer that is about to end."""


@contextmanager
def sole_writer(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder.  A file that a killed process left there locks nothing.

    Raises ValueError naming the folder where another process writes, and where nobody can.
    """
    from filelock import FileLock, Timeout

    path = folder / LOCK
    lock = FileLock(path)
    try:
        lock.acquire(timeout=PATIENCE)
    except Timeout:
        raise ValueError(_refusal(path)) from None
    except (OSError, NotImplementedError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ValueError(f"{folder}: cannot be written: {reason}") from None
    try:
        with suppress(OSError):  # only told to others; a full disk is found out soon enough
            path.write_text(f"{os.getpid()}\n", encoding="ascii")
        yield
    finally:
        with suppress(OSError):  # while it is held: who waits for this file then opens a new one
            path.unlink()
        lock.release()


def _refusal(path: Path) -> str:
    """Why the lock was not to be had."""
    try:
        holder = path.read_text(encoding="ascii", errors="replace").strip()
    except OSError as error:  # it would be there if another process held it
        return f"{path.parent}: cannot be written: {error.strerror}"
    who = f"process {holder}" if holder.isdigit() else "another process"
    return f"{path.parent}: {who} is writing to this folder: wait until it ends, or name another"
