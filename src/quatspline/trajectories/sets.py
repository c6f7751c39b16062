"""Committed, seeded sets of keyframes."""

from __future__ import annotations

import numpy as np

from quatspline.quaternion import FloatArray
from quatspline.trajectories.walks import walk

SEED = 2004
COUNT = 200


def torque_sets(count: int = COUNT) -> list[tuple[FloatArray, FloatArray, float]]:
    """Open sets (times (n,), keyframes (n, 4), step in degrees) that fairness is measured on.

    4 to 9 keyframes, one step angle a set from 20 to 110 degrees, random axes, spacings uniform in
    [0.5, 1.5].  The first sets are the same whatever the count.
    """
    sets = []
    for index in range(count):
        rng = np.random.default_rng([SEED, index])
        n = int(rng.integers(4, 10))
        degrees = float(rng.uniform(20.0, 110.0))
        times = np.concatenate([[0.0], np.cumsum(rng.uniform(0.5, 1.5, n - 1))])
        sets.append((times, walk(rng, n, degrees)[:, 0], degrees))
    return sets
