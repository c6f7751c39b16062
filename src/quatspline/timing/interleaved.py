"""Timing without wishful thinking: calibrated loops, contenders interleaved round by round.

A contender is a function of a repeat count, so that what is timed can loop in compiled code.  Every
contender runs once unmeasured (compilation, caches), is calibrated until a measurement lasts
long enough, and is then measured once a round, in an order drawn anew for each round.
"""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LEAST = 0.02
"""Seconds that a measurement should last: far above the clock's resolution and jitter."""

Contender = Callable[[int], object]


@dataclass(frozen=True)
class Timing:
    """Seconds of one call: median and interquartile range over rounds."""

    median: float
    iqr: float
    rounds: int
    loops: int


class OverBudget(Exception):
    """A call that would take longer than its budget; the message carries no seconds, so that tables of
    two runs can be told apart by their timing columns alone."""

    def __init__(self, message: str = "over budget") -> None:
        super().__init__(message)


def repeated(call: Callable[[], object]) -> Contender:
    """A contender that repeats a call."""

    def contender(loops: int) -> None:
        for _ in range(loops):
            call()

    return contender


def elapsed(contender: Contender, loops: int) -> float:
    """Seconds of one measurement."""
    start = time.perf_counter()
    contender(loops)
    return time.perf_counter() - start


def calibrated(contender: Contender, least: float = LEAST) -> int:
    """The repeat count at which a measurement lasts about ``least`` seconds."""
    contender(1)
    loops = 1
    while (seconds := elapsed(contender, loops)) < least / 4:
        loops *= 4
    return max(1, int(np.ceil(loops * least / seconds)))


def interleaved(
    contenders: Mapping[str, Contender], rounds: int, seed: int = 0, least: float = LEAST
) -> dict[str, Timing]:
    """Time all contenders in one run, interleaved; compare the results only with one another."""
    rng = np.random.default_rng(seed)
    loops = {name: calibrated(contender, least) for name, contender in contenders.items()}
    seconds: dict[str, list[float]] = {name: [] for name in contenders}
    enabled = gc.isenabled()
    gc.disable()
    try:
        for _ in range(rounds):
            for name in rng.permutation(list(contenders)):
                seconds[name].append(elapsed(contenders[name], loops[name]) / loops[name])
    finally:
        if enabled:
            gc.enable()
    return {name: _summary(np.array(s), rounds, loops[name]) for name, s in seconds.items()}


def _summary(seconds: NDArray[np.float64], rounds: int, loops: int) -> Timing:
    low, median, high = np.percentile(seconds, [25, 50, 75])
    return Timing(float(median), float(high - low), rounds, loops)
