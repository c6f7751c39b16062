"""Timing without wishful thinking: calibrated loops, contenders interleaved round by round.

A contender is a function of a repeat count, so that what is timed can loop in compiled code.  Every
contender runs once unmeasured (compilation, caches), is calibrated until a measurement lasts
long enough, and is then measured once a round, in an order drawn anew for each round.
"""

from __future__ import annotations

import gc
import math
import time
from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from quatspline.timing.budget import Call

K = TypeVar("K", bound=Hashable)
"""What a contender is known by."""

LEAST = 0.02
"""Seconds that a measurement should last: far above the clock's resolution and jitter."""

Contender = Callable[[int], object]


@dataclass(frozen=True)
class Timing:
    """Seconds of one call: median and interquartile range (NaN for a single one) over rounds."""

    median: float
    iqr: float
    rounds: int
    loops: int


def repeated(call: Call) -> Contender:
    """A contender that repeats a call."""

    def contender(loops: int) -> None:
        for _ in range(loops):
            call()

    return contender


def elapsed(call: Call) -> float:
    """Seconds of a call, by the clock."""
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def calibrated(contender: Contender, least: float = LEAST) -> int:
    """The repeat count at which a measurement lasts about ``least`` seconds."""
    contender(1)
    loops = 1
    while (lasts := elapsed(partial(contender, loops))) < least / 4:
        loops *= 4
    return max(1, int(np.ceil(loops * least / lasts)))


def timed(
    calls: Iterable[tuple[K, Call]], *, slow: float, rounds: int, least: float, seed: int = 0
) -> dict[K, Timing]:
    """Time calls by name: those that last longer than ``slow`` once, all others interleaved.

    Slow ones are let go as soon as they are timed: what was prepared for them may be large.
    """
    once: dict[K, Timing] = {}
    quick: dict[K, Contender] = {}
    for name, call in calls:
        lasts = elapsed(call)
        if lasts > slow:
            once[name] = Timing(lasts, math.nan, 1, 1)
        else:
            quick[name] = repeated(call)
    return once | interleaved(quick, rounds, seed, least)


def interleaved(
    contenders: Mapping[K, Contender], rounds: int, seed: int = 0, least: float = LEAST
) -> dict[K, Timing]:
    """Time all contenders in one run, interleaved; compare the results only with one another."""
    rng = np.random.default_rng(seed)
    loops = {name: calibrated(contender, least) for name, contender in contenders.items()}
    names = list(contenders)
    spent: dict[K, list[float]] = {name: [] for name in names}
    enabled = gc.isenabled()
    gc.disable()
    try:
        for _ in range(rounds):
            for name in (names[i] for i in rng.permutation(len(names))):
                measurement = partial(contenders[name], loops[name])
                spent[name].append(elapsed(measurement) / loops[name])
    finally:
        if enabled:
            gc.enable()
    return {name: _summary(np.array(s), rounds, loops[name]) for name, s in spent.items()}


def _summary(seconds: NDArray[np.float64], rounds: int, loops: int) -> Timing:
    low, median, high = np.percentile(seconds, [25, 50, 75])
    return Timing(float(median), float(high - low), rounds, loops)
