"""Which schemes a comparison of all leaves out on many keyframes: the same ones in every run, on every machine."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from quatspline import keyframes as kf
from quatspline import quaternion
from quatspline.catalogue import scheme
from quatspline.curve import Curve
from quatspline.keyframes import Keyframes
from quatspline.timing.budget import Budget, calls

SAMPLES = (400, 20, 20)
"""That instruments take of a scheme for a segment: of orientations, and of the rates that it offers."""
VECTORISED = 3
"""Calls that a sample counts as besides those that it makes: array code was seen to take 0.6 us for one,
a loop in Python 0.2 to 0.3 us a call."""
BUDGET = Budget(limit=2e7, meter=calls)
"""Of a library's scheme, about five seconds, unless it is asked for by name."""


def left_out(name: str, count: int) -> str | None:
    """Why a comparison of all schemes leaves one out; None where it is measured.

    By counts alone, so that every run decides alike.  Only a library's scheme is held against the budget:
    those of this package are measured up to the keyframes that they say are practical.
    """
    cls = scheme(name)
    if reason := cls.impractical(count):
        return f"{reason}; ask for it by name"
    if cls.peer is None or BUDGET.affords(_work(cls, count)):
        return None
    return "over budget on so many keyframes; ask for it by name"


def _work(cls: type[Curve], count: int) -> float:
    """Calls that a library's scheme makes in a comparison; 0 where its trial fails, as it will in earnest."""

    def set_up(size: int) -> Callable[[], object]:
        return partial(cls.from_keyframes, _trial(size))

    def samples(size: int, order: int) -> Callable[[], object]:
        return partial(cls.from_keyframes(_trial(size)), np.arange(size - 1.0) + 0.5, order)

    foretold = partial(BUDGET.forecast, size=count, linear=cls.support is not None)
    try:
        spent = foretold(set_up)
        for order in cls.orders:
            each = foretold(partial(samples, order=order)) + VECTORISED * count
            spent += SAMPLES[order] * each
    except Exception:  # whatever a scheme raises is told by the measurement itself
        return 0.0
    return spent


def _trial(count: int) -> Keyframes:
    """Keyframes of a smooth motion with even times, which every scheme takes."""
    turn = np.arange(count)[:, None] * (0.03, 0.02, 0.05)
    return kf.prepare(None, quaternion.exp(np.sin(turn)))
