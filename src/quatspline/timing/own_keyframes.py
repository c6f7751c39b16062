"""A comparison on a user's own keyframes: which schemes it leaves out on many, and seconds of the others."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from quatspline.catalogue import scheme
from quatspline.curve import Curve
from quatspline.keyframes import Keyframes
from quatspline.timing.budget import Budget, Call, calls
from quatspline.timing.cost import fitted_whole
from quatspline.timing.interleaved import timed

BUDGET = Budget(limit=1e7, meter=calls)
"""Of a library's scheme, two seconds or so, unless it is asked for by name."""
SAMPLES = (400, 20, 20)
"""That instruments take of a scheme for a segment: of orientations, and of the rates that it offers."""

ROUNDS, LEAST, SLOW = 5, 2e-3, 0.02
"""Of the timings: rounds, seconds a measurement, and the seconds from which one call is enough."""
SAMPLED = 1000
"""Samples of the call that a sample's seconds are read from."""


def left_out(name: str, count: int) -> str | None:
    """Why a comparison of all schemes leaves one out on so many keyframes; None where it is measured."""
    reason = BUDGET.refusal(scheme(name), count, SAMPLES)
    return f"{reason}; ask for it by name" if reason else None


def too_dear(name: str, count: int, samples: int) -> bool:
    """Whether so many orientations of every segment are more than is spent on a library's scheme, asked for or not."""
    cls = scheme(name)
    return cls.peer is not None and not BUDGET.affords(BUDGET.work(cls, count, (samples, 0, 0)))


def seconds_of(keyframes: Keyframes, curves: dict[str, Curve]) -> dict[str, dict[str, float]]:
    """Seconds of set-up and of a sample, interleaved; slow calls are timed once."""
    timings = timed(_calls(keyframes, curves), slow=SLOW, rounds=ROUNDS, least=LEAST)
    return {
        name: {
            "seconds_set_up": timings[name, "set-up"].median,
            "seconds_per_sample": timings[name, "samples"].median / SAMPLED,
        }
        for name in curves
    }


def _calls(
    keyframes: Keyframes, curves: dict[str, Curve]
) -> Iterator[tuple[tuple[str, str], Call]]:
    first, last = float(keyframes.times[0]), float(keyframes.times[-1])
    t = np.linspace(first, last, SAMPLED)
    for name, curve in curves.items():
        make = partial(type(curve).from_keyframes, keyframes, **curve.options)
        for key, call in (
            ("set-up", fitted_whole(make, keyframes.times)),
            ("samples", partial(curve, t)),
        ):
            call()  # caches are filled
            yield (name, key), call
