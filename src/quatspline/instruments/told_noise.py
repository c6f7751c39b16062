"""Whether keyframes are noisy recordings, and how noisy."""

from __future__ import annotations

import numpy as np

from quatspline import keyframes as kf
from quatspline.fitting.noise_level import noise_level
from quatspline.keyframes import Keyframes

LEAST = 40
"""Keyframes from which on noise is told from motion: a third of them must do."""

THINNED, GROWS = 3, 1.3
"""White noise has the same level in every third keyframe as in all.  What a smooth motion leaves in third
differences is 27 times as large there, and the steps of a random walk seem 1.73 times as noisy."""

NOTICED = 1e-4
"""In rad: what is below is the rounding of a file with few digits."""


def told_noise(keyframes: Keyframes) -> float:
    """The `noise_level` of a single track, rad an axis, where it is white noise; 0 where it is motion.

    Few keyframes, or a motion so lively that every third one does not follow it, are given the benefit of
    the doubt.
    """
    if keyframes.count < LEAST:
        return 0.0
    level = _level(keyframes, 0, 1)
    thinned = [_level(keyframes, first, THINNED) for first in range(THINNED)]
    return level if level > NOTICED and np.mean(thinned) <= GROWS * level else 0.0


def _level(keyframes: Keyframes, first: int, step: int) -> float:
    """Of every ``step``-th keyframe, as an open curve."""
    q = keyframes.quaternions[first::step]
    return float(noise_level(kf.prepare(keyframes.knots[: keyframes.count][first::step], q)))
