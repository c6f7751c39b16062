"""Committed, seeded sets of keyframes."""

from __future__ import annotations

import numpy as np

from quatspline.quaternion import FloatArray
from quatspline.trajectories.walks import walk

SEED = 2004
COUNT = 200


def torque_sets(count: int = COUNT) -> list[tuple[FloatArray, FloatArray, float]]:
    """Open sets (times (n,), keyframes (n, 4), step in degrees) that fairness is measured on.

    4 to 9 keyframes, one step angle per set from 20 to 110 degrees, random axes, spacings uniform in
    [0.5, 1.5].  The first sets are the same whatever the count.
    """
    sets = []
    for index in range(count):
        rng = np.random.default_rng([SEED, index])
        n = int(rng.integers(4, 10))
        degrees = float(rng.uniform(20.0, 110.0))
        sets.append((*_uneven(rng, n, degrees), degrees))
    return sets


def step_sets(degrees: int, count: int) -> list[tuple[FloatArray, FloatArray]]:
    """Open sets (times (n,), keyframes (n, 4)) of one step angle, otherwise as `torque_sets`."""
    sets = []
    for index in range(count):
        rng = np.random.default_rng([SEED, degrees, index])
        sets.append(_uneven(rng, int(rng.integers(4, 10)), float(degrees)))
    return sets


def _uneven(rng: np.random.Generator, n: int, degrees: float) -> tuple[FloatArray, FloatArray]:
    times = np.concatenate([[0.0], np.cumsum(rng.uniform(0.5, 1.5, n - 1))])
    return times, walk(rng, n, degrees)[:, 0]
