"""What a call costs: seconds within a budget, memory, and operations that no machine changes.

A task is a function of a size that prepares a call.  Before a call of some size is made it is made at
sizes ten times smaller, smallest first, so that one that would take too long is known before it
starts: its cost is said to be over budget instead of waited for.
"""

from __future__ import annotations

import ctypes
import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from quatspline.curve import Curve
from quatspline.instruments.trials import reason
from quatspline.kernels.operations import UNSTATED
from quatspline.timing.interleaved import Contender, OverBudget, interleaved, repeated
from quatspline.timing.operations import OPERATIONS, per_keyframe, per_sample

Call = Callable[[], object]
Task = Callable[[int], Call]

FACTOR = 10
"""Between the rungs of a ladder of sizes."""

SLOW = 0.05
"""Calls that take this share of the budget are timed once: rounds of them would exceed it."""


@dataclass(frozen=True)
class Cost:
    """Seconds of a call: median and interquartile range over rounds (NaN for a single one), or why
    there are none."""

    seconds: float = math.nan
    iqr: float = math.nan
    rounds: int = 0
    failure: str | None = None


def costs(
    tasks: Mapping[str, Task],
    size: int,
    *,
    least: int = 1,
    budget: float,
    rounds: int,
    duration: float,
    seed: int = 0,
) -> dict[str, Cost]:
    """Time the calls of one size against one another, each within a budget in seconds.

    Fast ones are interleaved over rounds, measurements of about ``duration`` seconds; slow ones are
    timed once.  ``least`` is the smallest size that a task accepts.
    """
    found: dict[str, Cost] = {}
    fast: dict[str, Contender] = {}
    for name, task in tasks.items():
        try:
            expected = predicted(task, size, least, budget)
            call = task(size)
        except OverBudget as error:
            found[name] = Cost(failure=str(error))
        except Exception as error:  # a scheme that does not apply or fails is a row with its reason
            found[name] = Cost(failure=reason(error))
        else:
            if expected > SLOW * budget:
                found[name] = Cost(_seconds(call), rounds=1)
            else:
                fast[name] = repeated(call)
    for name, timing in interleaved(fast, rounds, seed, duration).items():
        found[name] = Cost(timing.median, timing.iqr, timing.rounds)
    return found


def predicted(task: Task, size: int, least: int, budget: float) -> float:
    """Seconds that a call of a size should take, from smaller ones.

    From one rung to the next the time grows as over the last two, and at least by FACTOR.  Raises
    OverBudget where the call or its preparation would exceed the budget.
    """
    sizes = rungs(size, least)
    task(sizes[0])()  # whatever is compiled or imported at first use
    expected = 0.0
    before = (math.inf, math.inf)
    for rung in sizes:
        start = time.perf_counter()
        call = task(rung)
        preparing = time.perf_counter() - start
        calling = _seconds(call)
        if calling < budget / FACTOR and _grown(calling, before[1]) > budget:
            calling = min(calling, _seconds(call))  # a hiccup is no growth
        expected = _grown(calling, before[1])
        if max(_grown(preparing, before[0]), expected) > budget:
            raise OverBudget
        before = preparing, calling
    return expected


def _grown(seconds: float, before: float) -> float:
    return seconds * max(FACTOR, seconds / before if before > 0.0 else 0.0)


def rungs(size: int, least: int) -> list[int]:
    """Sizes below ``size``, a power of FACTOR apart, not less than ``least``, ascending.

    The size itself where none is smaller: the first call has nothing to go by.
    """
    powers = range(int(math.log(size / least, FACTOR) + 1e-9), 0, -1)
    return [size // FACTOR**k for k in powers] or [size]


def peak_bytes(call: Call) -> float:
    """Growth of the resident memory during a call at its highest, its result included; NaN where
    the system does not tell (it is read from Linux's /proc).

    Counts what compiled code allocates too, which tracemalloc does not see.
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


def _seconds(call: Call) -> float:
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def _status(field: str) -> float:
    """A field of /proc/self/status, in bytes."""
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith(f"{field}:"):
            return 1024.0 * float(line.split()[1])
    return math.nan
