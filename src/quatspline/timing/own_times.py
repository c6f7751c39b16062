"""Seconds of set-up and of a sample of curves on somebody's own keyframes."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np

from quatspline.curve import Curve
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.timing.interleaved import interleaved, repeated

ROUNDS, LEAST, SLOW = 5, 2e-3, 0.02
"""Of the timings: rounds, seconds a measurement, and the seconds from which one call is enough."""


def timed(keyframes: Keyframes, curves: dict[str, Curve]) -> dict[str, dict[str, float]]:
    """Seconds of set-up and of a sample, interleaved; slow calls are timed once.

    Set-up includes a sample every thousand segments: long curves are fitted where they are called.
    """
    first, last = float(keyframes.times[0]), float(keyframes.times[-1])
    t, sparse = np.linspace(first, last, 1000), keyframes.times[:-1:1000].copy()
    calls: dict[tuple[str, str], Callable[[], object]] = {}
    for name, curve in curves.items():
        calls[name, "seconds_set_up"] = partial(_ready, curve, keyframes, sparse)
        calls[name, "seconds_per_sample"] = partial(curve, t)
    once = {key: _elapsed(call) for key, call in calls.items()}
    quick = {"\t".join(key): repeated(calls[key]) for key, s in once.items() if s < SLOW}
    for joined, timing in interleaved(quick, ROUNDS, least=LEAST).items():
        name, column = joined.split("\t")
        once[name, column] = timing.median
    scale = {"seconds_set_up": 1.0, "seconds_per_sample": max(t.size, 1)}
    return {
        name: {column: once[name, column] / size for column, size in scale.items()}
        for name in curves
    }


def _ready(curve: Curve, keyframes: Keyframes, t: FloatArray) -> None:
    type(curve).from_keyframes(keyframes, **curve._options)(t)


def _elapsed(call: Callable[[], object]) -> float:
    call()
    start = time.perf_counter()
    call()
    return time.perf_counter() - start
