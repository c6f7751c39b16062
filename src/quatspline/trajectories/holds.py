"""Committed, seeded sets of keyframes on which curves overshoot: bodies that hold, and turns about one axis."""

from __future__ import annotations

import numpy as np

from quatspline import quaternion
from quatspline.quaternion import FloatArray
from quatspline.trajectories.sets import SEED
from quatspline.trajectories.walks import directions, walk

MOVE, DEGREES = 10.0, 90.0
"""What a move beside a hold lasts and turns."""

LEAST, LARGEST = 5.0, 110.0
"""Degrees of a step about one axis: shares of far smaller ones would say nothing but how small they are."""


def hold_sets(ratio: int, count: int) -> list[tuple[FloatArray, FloatArray]]:
    """Open sets (times (n,), keyframes (n, 4)): moves about random axes, with one hold between two of them.

    1 to 4 moves on either side; the hold, two equal keyframes, lasts ``ratio`` moves.
    """
    sets = []
    for index in range(count):
        rng = np.random.default_rng([SEED, 1, ratio, index])
        before, after = rng.integers(1, 5, 2)
        stays = np.append(np.arange(before + 1), np.arange(before, before + after + 1))
        spacings = np.full(before + after + 1, MOVE)
        spacings[before] *= ratio
        times = np.concatenate([[0.0], np.cumsum(spacings)])
        sets.append((times, walk(rng, before + after + 1, DEGREES)[stays, 0]))
    return sets


def axis_sets(count: int) -> list[tuple[FloatArray, FloatArray]]:
    """Open sets of 4 to 9 keyframes that turn about one random axis, back and forth.

    Steps are uniform in [5, 110] degrees, either way, spacings in [0.5, 1.5].
    """
    sets = []
    for index in range(count):
        rng = np.random.default_rng([SEED, 2, index])
        n = int(rng.integers(4, 10))
        times = np.concatenate([[0.0], np.cumsum(rng.uniform(0.5, 1.5, n - 1))])
        half = 0.5 * np.radians(rng.uniform(LEAST, LARGEST, n)) * rng.choice((-1.0, 1.0), n)
        turned = quaternion.exp(np.cumsum(half)[:, None] * directions(rng, ()))
        first = quaternion.normalise(rng.normal(size=4))
        sets.append((times, quaternion.align(quaternion.mul(first, turned))))
    return sets
