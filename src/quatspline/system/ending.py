"""How a process and its workers end when a signal asks for it: together, soon, without a trace."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from types import FrameType

SIGNALS = [getattr(signal, n) for n in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, n)]

PATIENCE = 1.0
"""Seconds for what runs to unwind: compiled code and libraries do not look up before they return."""

PULSE = 0.25
"""Seconds between two looks of a worker at whether the process that started it is there."""


class Ended(KeyboardInterrupt):
    """A signal asked for the end: ``status`` is what a shell expects of it."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.status = 128 + number


@contextmanager
def ending(tell: Callable[[int], object]) -> Iterator[None]:
    """Within it the signals raise `Ended`, and all workers have ended when it is left by one.

    What has not unwound in time is cut off, once ``tell`` has been called with the status.  Outside
    the main thread, where signals cannot be caught, nothing changes.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def end(number: int, frame: FrameType | None) -> None:
        for other in SIGNALS:
            signal.signal(other, signal.SIG_IGN)  # once is enough
        _cut_off_after(PATIENCE, 128 + number, tell)
        raise Ended(number)

    before = {number: signal.getsignal(number) for number in SIGNALS}
    caught = [n for n, handler in before.items() if handler is not signal.SIG_IGN]  # nohup
    for number in caught:
        signal.signal(number, end)
    try:
        yield
    except Ended:
        end_workers()
        raise
    finally:
        for number in caught:
            signal.signal(number, before[number])


def _cut_off_after(seconds: float, status: int, tell: Callable[[int], object]) -> None:
    def cut() -> None:
        try:
            end_workers()
            tell(status)
            sys.stderr.flush()
        finally:
            os._exit(status)

    timer = threading.Timer(seconds, cut)
    timer.daemon = True
    timer.start()


def end_workers() -> None:
    """Kill this process's workers: each is at a cell that will be measured again."""
    from multiprocessing import active_children

    for worker in active_children():
        if worker.pid is not None:
            with suppress(ProcessLookupError):  # loky's processes have no method for it
                os.kill(worker.pid, getattr(signal, "SIGKILL", signal.SIGTERM))


@contextmanager
def hang_up_ignored() -> Iterator[None]:
    """Within it, processes start that a closed terminal does not end: they inherit it."""
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "SIGHUP"):
        yield
        return
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGHUP, before)


@cache
def bind_to(parent: int) -> None:
    """Have this process, where the one of that number started it, end with it, however that ends.

    A signal from the keyboard reaches a worker, too; what it means is decided by its parent.
    """
    if os.getppid() != parent:
        return

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(PULSE)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)
