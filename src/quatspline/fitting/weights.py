"""Weights of keyframes in sums of squares."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from quatspline.options import per_keyframe
from quatspline.quaternion import FloatArray

SPREAD = 1e9
"""Largest ratio of weights: beyond it rounding moves the keyframes that weigh least."""


def positive(weights: ArrayLike | None, count: int) -> FloatArray:
    """Weights (n,), refused where one is not above 0 or next to nothing."""
    if weights is None:
        return np.ones(count)
    w = per_keyframe("weights", weights, count)
    if (w <= 0.0).any():
        i = int(np.argmax(w <= 0.0))
        raise ValueError(f"weights[{i}] = {w[i]:g}: must be above 0")
    if w.min() * SPREAD < w.max():
        i = int(np.argmin(w))
        raise ValueError(
            f"weights[{i}] = {w[i]:g}: less than {1.0 / SPREAD:g} of the largest, {w.max():g}; "
            "leave out what counts for nothing"
        )
    return w
