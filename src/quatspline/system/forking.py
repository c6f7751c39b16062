"""Work that a fork waits for: imports, compilations and what else one thread must end for all.

A forked child has the thread that forked and no other.  A module that another thread was importing,
or a lock that it held, would stay so in the child, which would wait for it forever.
"""

from __future__ import annotations

# What takes locks of its own before a fork has to be there first: hooks run from the last to the first, and while
# ours waits, imports of other threads may need those locks.
import concurrent.futures.thread  # noqa: F401
import logging  # noqa: F401
import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

PATIENCE = 30.0
"""Seconds that a fork waits for other threads: one of them may be waiting for what the forking thread
is importing, and then waiting longer would be a deadlock."""

_free = threading.Condition()
_at_work: set[int] = set()
"""The threads in work that a fork waits for."""
_held: list[Any] = []


@contextmanager
def undivided() -> Iterator[None]:
    """Within it, other threads' forks wait; it may be nested, and excludes no other thread."""
    me = threading.get_ident()
    if me in _at_work:
        yield
        return
    with _free:
        _at_work.add(me)
    try:
        yield
    finally:
        with _free:
            _at_work.discard(me)
            _free.notify_all()


def hold(lock: Any) -> None:
    """Have forks take a re-entrant lock of another library first, so that no child inherits it taken.

    Nothing may enter `undivided` while it holds the lock and has not entered before.
    """
    _held.append(lock)


def _before() -> None:
    _free.acquire()
    _free.wait_for(lambda: not _at_work - {threading.get_ident()}, PATIENCE)
    for lock in _held:
        lock.acquire()


def _after() -> None:
    for lock in reversed(_held):
        lock.release()
    _free.release()


def _after_in_child() -> None:
    _at_work.intersection_update({threading.get_ident()})
    _after()


if hasattr(os, "register_at_fork"):  # not on Windows, which does not fork
    os.register_at_fork(before=_before, after_in_parent=_after, after_in_child=_after_in_child)
