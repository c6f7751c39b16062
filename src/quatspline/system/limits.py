"""Limits of time and memory for code of other people, each from a variable of the environment."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

GIB = 1 << 30
TRIAL_SECONDS, CELL_SECONDS = "QUATSPLINE_TRIAL_SECONDS", "QUATSPLINE_CELL_SECONDS"
MEMORY_GIB = "QUATSPLINE_MEMORY_GIB"
DEFAULTS = {TRIAL_SECONDS: 60.0, CELL_SECONDS: 3600.0}
TRIAL_MEMORY = 4 * GIB
"""Bytes for a new plug-in: importing it must leave room for the others."""
SHARE = 0.5
"""Of the machine's memory, for one process; the same for any number of them, so that no row depends on it."""


def seconds(variable: str) -> float:
    """The limit of time of that name.

    Raises
    ------
    ValueError
        If the environment says anything but a positive number.
    """
    return _positive(variable, DEFAULTS[variable])


def memory() -> int:
    """Bytes that a process measuring cells may hold."""
    return int(_positive(MEMORY_GIB, SHARE * _installed() / GIB) * GIB)


def _positive(variable: str, default: float) -> float:
    given = os.environ.get(variable, "")
    with suppress(ValueError):
        value = float(given or default)
        if 0.0 < value < 1e9:
            return value
    raise ValueError(f"{variable}={given!r}: expected a positive number")


def _installed() -> int:
    """Bytes of memory of the machine, or of the container where that has fewer."""
    sizes = [64 * GIB]  # where a system tells nothing
    with suppress(AttributeError, ValueError, OSError):
        sizes.append(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    with suppress(ValueError, OSError):  # "max" is no number
        sizes.append(int(Path("/sys/fs/cgroup/memory.max").read_text(encoding="ascii")))
    return min(sizes)


def hold_memory(most: int) -> None:
    """Refuse this process more data than that: Python raises MemoryError; without effect on Windows."""
    try:
        import resource
    except ImportError:
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    least = min(limit for limit in (most, soft, hard) if limit != resource.RLIM_INFINITY)
    with suppress(ValueError, OSError):  # systems differ in what may be set
        resource.setrlimit(resource.RLIMIT_DATA, (least, hard))
