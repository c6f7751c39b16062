"""Budgets: what a call would cost at some size, foretold from two small ones, against what it may cost.

Two meters exist.  `seconds` is the clock, whose forecasts differ from run to run by what else the machine
does.  `calls` counts the calls that Python makes, which is what a library that loops in Python spends
its time on: the same number in every run and on every machine.  A choice that a table rests on asks the
second; what compiled code does inside one call, neither foretells: a scheme whose solve grows faster than
its keyframes says how many are practical (`Curve.practical_keyframes`).
"""

from __future__ import annotations

import gc
import math
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

Meter = Callable[[Callable[[], object]], float]
"""What a call costs."""

Job = Callable[[int], Callable[[], object]]
"""Prepares a call of some size, so that its preparation costs nothing."""

SIZES = (64, 128)
"""From these a cost is foretold: large enough that what a call costs whatever its size does not hide growth."""


def seconds(call: Callable[[], object]) -> float:
    """Seconds of a call, by the clock."""
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def calls(call: Callable[[], object]) -> float:
    """Calls of functions, written in Python or not, that a call makes."""
    count = 0

    def counted(frame: Any, event: str, argument: Any) -> None:
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


@dataclass(frozen=True)
class Budget:
    """What may be spent, and a forecast of what would be.

    Attributes
    ----------
    limit : the most that may be spent, in the meter's unit
    meter : `seconds` or `calls`
    sizes : the two sizes that a forecast is made from

    Examples
    --------
    >>> budget = Budget(limit=1e4, meter=calls)
    >>> budget.forecast(lambda size: lambda: [abs(-1) for _ in range(size)], 1000, linear=True) > 1000
    True
    >>> budget.affords(2e4)
    False
    """

    limit: float
    meter: Meter = seconds
    sizes: tuple[int, int] = SIZES

    def affords(self, cost: float) -> bool:
        """Whether so much may be spent."""
        return cost <= self.limit

    def forecast(self, job: Job, size: int, *, linear: bool = False) -> float:
        """The cost of a job at a size: a line through two costs, or without ``linear`` a power of the size.

        Every call is made once unmeasured, for the first one compiles, imports and fills caches.
        """
        few, many = self.sizes
        low, high = (self._warm(job(n)) for n in self.sizes)
        if linear or low <= 0.0 or high <= low:
            return low + (high - low) * (size - few) / (many - few)
        power = math.log(high / low) / math.log(many / few)
        return low * (size / few) ** power

    def _warm(self, call: Callable[[], object]) -> float:
        call()
        return self.meter(call)
