"""Lookahead: how many keyframes after a segment's own two shape it, which data that still arrive must wait for.

Every keyframe is turned in turn, those behind a segment and those ahead of it.
"""

from __future__ import annotations

import numpy as np

from quatspline import quaternion
from quatspline.instruments.locality import FELT, SAMPLES, SIZE
from quatspline.instruments.trials import Build
from quatspline.quaternion import FloatArray

COUNT = 12
"""Keyframes: a decay of 0.27 a segment is followed to the end, and local schemes end before."""

TURN = SIZE * np.array([2.0, -1.0, 2.0]) / 3.0
"""Rotation vector of a keyframe's turn: oblique, so that no axis of a scheme's is spared."""


def moved(build: Build, times: FloatArray, keyframes: FloatArray) -> FloatArray:
    """The largest movement of every segment over the turn of every keyframe: (n, segments)."""
    curve = build(times, keyframes)
    t = times[0] + curve.keyframes.inside(SAMPLES).reshape(-1, SAMPLES)
    before = curve(t)
    responses = np.empty((len(keyframes), len(t)))
    for k, response in enumerate(responses):
        turned = keyframes.copy()
        turned[k] = quaternion.mul(turned[k], quaternion.exp(0.5 * TURN))
        response[:] = quaternion.distance(build(times, turned)(t), before).max(axis=1)
    return responses / SIZE


def lookahead(responses: FloatArray) -> int | None:
    """Keyframes after a segment's own two that it feels, at most; None where it is all that there are.

    Parameters
    ----------
    responses : (n, segments) as `moved` gives them, of an open curve
    """
    keyframe, segment = np.nonzero(~(responses <= FELT))  # NaN is felt
    ahead = int(np.max(keyframe - segment - 1, initial=0))
    return None if ahead == len(responses) - 2 else ahead
