"""Whether keyframes are noisy recordings, and how noisy."""

from __future__ import annotations

import numpy as np

from quatspline import keyframes as kf
from quatspline.fitting.noise_level import noise_level
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray

LEAST = 40
"""Keyframes from which on noise is told from motion: a third of them must do."""

THINNED, GROWS = 3, 1.3
"""White noise has the same level in every third keyframe as in all.  What a smooth motion leaves in third
differences is 27 times as large there, and the steps of a random walk seem 1.73 times as noisy."""

NOTICED = 1e-4
"""In rad: what is below is the rounding of a file with few digits."""


def told_noise(keyframes: Keyframes) -> FloatArray:
    """The `noise_level` of every track, rad an axis, (*K,), where it is white noise; 0 where it is motion.

    Few keyframes, or a motion so lively that every third one does not follow it, are given the benefit of
    the doubt.
    """
    if keyframes.count < LEAST:
        return np.zeros(keyframes.track_shape)
    level = _level(keyframes, 0, 1)
    thinned = [_level(keyframes, first, THINNED) for first in range(THINNED)]
    white = (level > NOTICED) & (np.mean(thinned, axis=0) <= GROWS * level)
    return np.where(white, level, 0.0)


def _level(keyframes: Keyframes, first: int, step: int) -> FloatArray:
    """Of every ``step``-th keyframe, as an open curve."""
    q = keyframes.tracks[:, first::step].swapaxes(0, 1).reshape(-1, *keyframes.track_shape, 4)
    return noise_level(kf.prepare(keyframes.knots[: keyframes.count][first::step], q))
