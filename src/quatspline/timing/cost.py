"""What a call costs: seconds within a budget, memory, and operations that no machine changes.

Before a call of some size is made it is made at sizes ten times smaller, smallest first, so that one that
would take too long is known before it starts: its cost is said to be over budget instead of waited for.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quatspline.curve import Curve
from quatspline.instruments.trials import reason
from quatspline.operations import UNSTATED
from quatspline.segments import CHUNK
from quatspline.timing.budget import OVER, Budget, Call, Job, rungs
from quatspline.timing.interleaved import timed
from quatspline.timing.operations import OPERATIONS, per_keyframe, per_sample

SLOW = 0.05
"""Calls that take this share of the budget are timed once: rounds of them would exceed it."""

SPREAD = CHUNK
"""Segments between samples in a set-up: as many as are fitted where one is asked for, so that all are."""


@dataclass(frozen=True)
class Task:
    """A call that can be made at any size; ``linear``: its cost and its preparation's grow with the size."""

    prepare: Job
    linear: bool = True


@dataclass(frozen=True)
class Cost:
    """Seconds of a call, or why there are none.

    Median and interquartile range over rounds (NaN for a single one).
    """

    seconds: float = math.nan
    iqr: float = math.nan
    rounds: int = 0
    failure: str | None = None


def fitted_whole(make: Callable[[], Curve], times: NDArray[Any]) -> Call:
    """The call that makes a curve through keyframes at times (n,), all of it.

    Where there are many it takes samples, too: a long curve of a local scheme is fitted only where it is
    called, and its constructor alone times nothing.
    """
    if len(times) <= SPREAD:
        return make
    at = np.append(times[::SPREAD], times[-1:])
    return lambda: make()(at)


def costs(
    tasks: Mapping[str, Task],
    size: int,
    *,
    least: int = 1,
    budget: Budget,
    rounds: int,
    duration: float,
    seed: int = 0,
) -> dict[str, Cost]:
    """Time the calls of one size against one another, each within a budget in seconds.

    Fast ones are interleaved over rounds, measurements of about ``duration`` seconds; slow ones are
    timed once.  ``least`` is the smallest size that a task accepts.
    """
    failures: dict[str, str] = {}
    calls = _affordable(tasks, size, least, budget, failures)
    timings = timed(calls, slow=SLOW * budget.limit, rounds=rounds, least=duration, seed=seed)
    found = {name: Cost(t.median, t.iqr, t.rounds) for name, t in timings.items()}
    return found | {name: Cost(failure=failure) for name, failure in failures.items()}


def _affordable(
    tasks: Mapping[str, Task], size: int, least: int, budget: Budget, failures: dict[str, str]
) -> Iterator[tuple[str, Call]]:
    """Calls of a size by name, prepared; why there is none goes among the failures."""
    for name, task in tasks.items():
        whole = partial(_whole, task)
        try:
            cost = budget.forecast(whole, size, linear=task.linear, sizes=rungs(size, least))
            if budget.affords(cost):
                yield name, _telling(task.prepare(size), partial(failures.__setitem__, name))
            else:
                failures[name] = OVER
        except Exception as error:  # a scheme that does not apply or fails is a row with its reason
            failures[name] = reason(error)


def _telling(call: Call, tell: Callable[[str], object]) -> Call:
    """The call, which tells of a size that fails though smaller ones did not, and goes on."""

    def made() -> None:
        try:
            call()
        except Exception as error:
            tell(reason(error))

    return made


def _whole(task: Task, size: int) -> Call:
    """A call with its preparation, which may take longer."""
    return lambda: task.prepare(size)()


def peak_bytes(call: Call) -> float:
    """Growth of the resident memory during a call at its highest, its result included.

    NaN where the system does not tell: it is read from Linux's /proc.  Counts
    what compiled code allocates too, which tracemalloc does not see.
    """
    call()  # pages of code and caches are in
    try:
        ctypes.CDLL(None).malloc_trim(0)  # what earlier calls left free must not serve this one
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")  # resets the highest
    except (OSError, AttributeError):
        return math.nan
    before = _status("VmRSS")
    call()
    return max(0.0, _status("VmHWM") - before)


def operations(curve: Curve, unit: str) -> dict[str, float]:
    """Counts of exps, logs and slerps per "sample" or per "keyframe", those of all iterations included.

    NaN for a scheme that states none.
    """
    if curve.operations == UNSTATED:
        return dict.fromkeys(OPERATIONS, math.nan)
    return per_sample(curve) if unit == "sample" else per_keyframe(curve)


def _status(field: str) -> float:
    """A field of /proc/self/status, in bytes."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(f"{field}:"):
            return 1024.0 * float(line.split()[1])
    return math.nan
