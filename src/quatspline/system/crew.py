"""Processes that work through tasks, one task at a time each: whatever a task does to its process is its own.

A pool of libraries says that a process died, not at what, and bounds no time.  Here each process has a
pipe of its own; one that ends or takes too long is known with the task that it was at, and replaced.
"""

from __future__ import annotations

import math
import os
import signal
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import connection
from typing import Any, NamedTuple

from joblib.externals.loky.backend.process import LokyProcess

from quatspline.system.ending import bind_to, ended_by, hang_up_ignored, kill
from quatspline.system.limits import hold_memory

LATE = "it did not end within its limit of"
KILLED = -getattr(signal, "SIGKILL", 9)

Task = tuple[Callable[..., Any], tuple[Any, ...]]
"""A function that other processes find by name, and its arguments."""


class Outcome(NamedTuple):
    """What became of a task: its result, or how its process ended.

    ``strange``: somebody killed the process, or memory of the machine ran out, which need not be
    the task's doing.
    """

    place: int
    result: Any = None
    death: str | None = None
    strange: bool = False


@dataclass
class _Worker:
    process: LokyProcess
    pipe: connection.Connection
    place: int = -1
    until: float = math.inf
    ready: bool = False

    def death(self) -> tuple[str, bool]:
        """How the process ended, in words, and whether that says nothing of the task."""
        self.process.join()
        code = self.process.exitcode or 0
        if not self.ready:
            return f"the process did not come to begin it: {ended_by(code)}", True
        return f"it ended its process: {ended_by(code)}", code == KILLED


class Crew:
    """Up to so many processes, started when there is something to do.

    Parameters
    ----------
    count : of processes
    seconds : the limit of time of one task
    memory : bytes that a process may hold
    environment : of the processes, besides this one's
    """

    def __init__(
        self, count: int, seconds: float, memory: int, environment: Mapping[str, str] = {}
    ) -> None:
        self.count, self.seconds, self.memory = count, seconds, memory
        self.environment = dict(environment)
        self._workers: list[_Worker] = []

    def outcomes(self, tasks: Iterable[tuple[int, Task]]) -> Iterator[Outcome]:
        """What becomes of tasks, as they end; one whose process died is tried once more."""
        waiting, again = deque(tasks), set[int]()
        at: dict[int, Task] = {}
        try:
            while waiting or at:
                while waiting and (worker := self._free()) is not None:
                    place, at[place] = waiting[0]
                    self._hand(worker, *waiting.popleft())
                for outcome in self._next():
                    task = at.pop(outcome.place)
                    if outcome.death and outcome.place not in again and not _late(outcome):
                        again.add(outcome.place)
                        waiting.append((outcome.place, task))
                    else:
                        yield outcome
        finally:
            if at:  # given up: nobody waits for what they are at
                self.close()

    def close(self) -> None:
        """End the processes."""
        for worker in self._workers:
            self._end(worker)
        self._workers.clear()

    def _free(self) -> _Worker | None:
        for worker in self._workers:
            if worker.place < 0:
                return worker
        if len(self._workers) == self.count:
            return None
        self._workers.append(self._started())
        return self._workers[-1]

    def _started(self) -> _Worker:
        ours, theirs = connection.Pipe()
        process = LokyProcess(
            target=serve, args=(theirs, os.getpid(), self.memory), env=self.environment
        )
        with hang_up_ignored():
            process.start()
        theirs.close()
        return _Worker(process, ours)

    def _hand(self, worker: _Worker, place: int, task: Task) -> None:
        worker.place = place
        worker.until = time.monotonic() + self.seconds if worker.ready else math.inf
        with suppress(OSError):  # it died idle: its pipe is at its end, which `_next` sees
            worker.pipe.send(task)

    def _next(self) -> Iterator[Outcome]:
        """The outcomes that are there."""
        busy = {worker.pipe: worker for worker in self._workers if worker.place >= 0}
        first = min(worker.until for worker in busy.values())
        patience = None if first == math.inf else max(0.0, first - time.monotonic())
        for pipe in connection.wait(list(busy), patience):
            outcome = self._received(busy[pipe])  # type: ignore[index]
            if outcome is not None:
                yield outcome
        for worker in busy.values():
            if worker.place >= 0 and time.monotonic() > worker.until:
                yield self._lost(worker, f"{LATE} {self.seconds:g} s", strange=False)

    def _received(self, worker: _Worker) -> Outcome | None:
        """The outcome of a task; None where the process has only started, and its time begins."""
        try:
            result = worker.pipe.recv()
        except (EOFError, OSError):
            return self._lost(worker, *worker.death())
        if not worker.ready:
            worker.ready, worker.until = True, time.monotonic() + self.seconds
            return None
        place, worker.place = worker.place, -1
        return Outcome(place, result)

    def _lost(self, worker: _Worker, death: str, strange: bool) -> Outcome:
        place, worker.place = worker.place, -1
        self._workers.remove(worker)
        self._end(worker)
        return Outcome(place, None, death, strange)

    def _end(self, worker: _Worker) -> None:
        kill(worker.process)
        worker.process.join()
        worker.pipe.close()


def _late(outcome: Outcome) -> bool:
    return outcome.death is not None and outcome.death.startswith(LATE)


def serve(pipe: connection.Connection, parent: int, memory: int) -> None:
    """Work through what comes, in a process of a crew."""
    bind_to(parent)
    hold_memory(memory)
    with suppress(OSError):  # standard error is closed
        os.dup2(2, 1)  # standard output is the command's own, whatever libraries print
    sys.stdout = sys.stderr
    told: object = None  # begun: importing all this took no task's time
    while _awaited(pipe, told):
        try:
            function, arguments = pipe.recv()
        except (EOFError, OSError):
            return
        told = function(*arguments)


def _awaited(pipe: connection.Connection, told: object) -> bool:
    """Send what the command waits for; False where it has ended."""
    try:
        pipe.send(told)
    except OSError:
        return False
    return True
