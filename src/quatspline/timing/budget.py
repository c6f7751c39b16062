"""The forecast of cost: what a call would cost at some size, foretold from smaller ones, against what it may cost.

One class, `Budget`, decides everywhere what would take too long.  It has two meters.  `calls` counts the
calls that Python makes, which is what a library that loops in Python spends its time on: the same number in
every run and on every machine.  It decides which schemes a table holds (`Budget.refusal`).  `seconds` are those
that the processor spends on this process, whose forecasts differ from machine to machine and, less than a
clock's, from run to run.  They decide whether a cell of a table of seconds is waited for.  What compiled code
does inside one call, calls do not foretell: a scheme whose solve grows faster than its keyframes says how many
are practical (`Curve.practical_keyframes`).
"""

from __future__ import annotations

import gc
import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from quatspline import keyframes as kf
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.keyframes import Keyframes

Call = Callable[[], object]

Meter = Callable[[Call], float]
"""What a call costs."""

Job = Callable[[int], Call]
"""Prepares a call of some size, so that its preparation costs nothing."""

SIZES = (64, 128)
"""From these a cost is foretold: large enough that what a call costs whatever its size does not hide growth."""

FACTOR = 10
"""Between the rungs of a ladder of sizes."""

VECTORISED = 3
"""Calls that a sample counts as besides those that it makes: array code was seen to take 0.6 us for one,
a loop in Python 0.2 to 0.3 us a call."""

OVER = "over budget"
"""Why something is not measured.  No costs stand in it, so that tables of two runs can be told apart by their
timing columns alone."""


class OverBudget(Exception):
    """Something is not measured because it would cost too much; the message is the reason."""


def seconds(call: Call) -> float:
    """Seconds that the processor spends on a call: others may share it, and would stretch those of a clock."""
    start = time.process_time()
    call()
    return time.process_time() - start


def calls(call: Call) -> float:
    """Calls of functions, written in Python or not, that a call makes."""
    count = 0

    def counted(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    before, collecting = sys.getprofile(), gc.isenabled()
    gc.disable()  # finalizers run when the collector likes, and would be counted
    sys.setprofile(counted)
    try:
        call()
    finally:
        sys.setprofile(before)
        if collecting:
            gc.enable()
    return float(count)


def rungs(size: int, least: int) -> list[int]:
    """Sizes below ``size``, a power of FACTOR apart, not less than ``least``, ascending.

    The size itself where none is smaller: the first call has nothing to go by.
    """
    powers = range(int(math.log(size / least, FACTOR) + 1e-9), 0, -1)
    return [size // FACTOR**k for k in powers] or [size]


def too_many(scheme: type[Curve], count: int) -> str | None:
    """Why so many keyframes are more than a scheme says are practical; None where they are not."""
    limit = scheme.practical_keyframes
    return f"{OVER} beyond {limit} keyframes" if limit and count > limit else None


@dataclass(frozen=True)
class Budget:
    """What may be spent, and a forecast of what would be.

    Attributes
    ----------
    limit : the most that may be spent, in the meter's unit
    meter : `seconds` or `calls`

    Examples
    --------
    >>> budget = Budget(limit=1e4, meter=calls)
    >>> budget.forecast(lambda size: lambda: [abs(-1) for _ in range(size)], 1000, linear=True) > 1000
    True
    >>> budget.affords(2e4)
    False
    """

    limit: float
    meter: Meter

    def affords(self, cost: float) -> bool:
        """Whether so much may be spent."""
        return cost <= self.limit

    def forecast(
        self, job: Job, size: int, *, linear: bool = False, sizes: Sequence[int] = SIZES
    ) -> float:
        """The cost of a job at a size, from its costs at other, ascending ones.

        The last two are extrapolated, by a line or, without ``linear``, by a power of the size.  Those
        before keep a meter that waits for the call from waiting too long: a size that is itself foretold to
        exceed the limit is not tried, and the cost is infinite.
        """
        job(sizes[0])()  # compiles, imports and fills caches, at no cost
        known: list[tuple[int, float]] = []
        for tried in sizes:
            if tried < size and not self.affords(_extrapolated(known, tried, linear)):
                return math.inf
            known.append((tried, self._cost(job(tried))))
        return _extrapolated(known, size, linear)

    def largest(self, job: Job, most: int, start: int) -> int:
        """The size, up to ``most``, of which a call just keeps within the limit.

        By ever larger calls: what a call costs whatever its size must not count for every item of it.
        """
        size = min(start, most)
        while True:
            call = job(size)
            call()
            cost = self.meter(call)
            if size == most or cost > self.limit / 2:
                return size
            size = min(most, int(size * self.limit / max(cost, self.limit / FACTOR)))

    def refusal(
        self, scheme: type[Curve], count: int, samples: Sequence[int] = (0, 0, 0)
    ) -> str | None:
        """Why a scheme is not measured on so many keyframes; None where it is.

        A scheme of this package is measured up to the keyframes that it says are practical.  A library's is
        also held against the budget, for its `work`.
        """
        if reason := too_many(scheme, count):
            return reason
        if scheme.peer is None or self.affords(self.work(scheme, count, samples)):
            return None
        return OVER

    def work(self, scheme: type[Curve], count: int, samples: Sequence[int]) -> float:
        """What it costs to set a curve up and to take samples of every segment, so many of each order.

        Counted in calls; 0 where a trial of the scheme fails, as it will in earnest.
        """
        foretold = partial(self.forecast, size=count, linear=scheme.support is not None)
        try:
            spent = foretold(lambda size: partial(scheme.from_keyframes, _trial(size)))
            for order in scheme.orders:
                if samples[order]:
                    each = foretold(partial(_sampling, scheme, order)) + VECTORISED * count
                    spent += samples[order] * each
        except Exception:  # whatever a scheme raises is told by the measurement itself
            return 0.0
        return spent

    def _cost(self, call: Call) -> float:
        """The lesser of two measurements: caches of a size are cold at first, and a hiccup is no cost.

        A dear call is not repeated.
        """
        cost = self.meter(call)
        return min(cost, self.meter(call)) if cost < self.limit / FACTOR else cost


def _extrapolated(known: Sequence[tuple[int, float]], size: int, linear: bool) -> float:
    """The cost at a size from those at the last two that are known; from one in proportion, from none 0."""
    if len(known) < 2:
        return known[0][1] * size / known[0][0] if known else 0.0
    (few, low), (many, high) = known[-2:]
    if linear or low <= 0.0 or high <= low:
        return low + max(high - low, 0.0) * (size - few) / (many - few)
    power = math.log(high / low) / math.log(many / few)
    return low * (size / few) ** power


def _sampling(scheme: type[Curve], order: int, size: int) -> Call:
    """One sample of every segment."""
    return partial(scheme.from_keyframes(_trial(size)), np.arange(size - 1.0) + 0.5, order)


def _trial(count: int) -> Keyframes:
    """Keyframes of a smooth motion with even times, which every scheme takes."""
    turn = np.arange(count)[:, None] * (0.03, 0.02, 0.05)
    return kf.prepare(None, quaternion.exp(np.sin(turn)))
