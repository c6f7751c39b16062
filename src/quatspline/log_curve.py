"""The log-curve ln q(t) of a curve, carried past pi where the curve runs straight through -1."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from quatspline import quaternion
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray

ONE_AXIS = 1e-12
"""Vector parts that leave one line by less than this make a spin about one axis."""

STEPS = np.arange(16) / 16
"""Shares of a segment at which the angle is followed: less than half a turn of S^3 between two."""


def log_curve(
    evaluate: Callable[[FloatArray], FloatArray], keyframes: Keyframes, t: FloatArray, q: FloatArray
) -> FloatArray:
    """ln q(t), shape S + (*K, 3); see `Curve.log`.

    Parameters
    ----------
    evaluate : orientations (m, K, 4) at times since the first keyframe (m,)
    keyframes : of the curve
    t, q : times since the first keyframe, S, and the orientations there, S + (*K, 4)
    """
    principal = quaternion.log(q)
    tracks = q.reshape(*t.shape, -1, 4)
    result = principal.reshape(*t.shape, -1, 3)
    axes = [_common_axis(track) for track in keyframes.tracks]
    if any(axis is not None for axis in axes):
        grid = np.append(keyframes.inside(STEPS), keyframes.knots[-1])
        along = evaluate(grid)
    for k, axis in enumerate(axes):
        if axis is not None:
            turning = np.unwrap(_angle(along[:, k], axis))
            rough = _followed(t, grid, turning, keyframes.closed)
            angle = _angle(tracks[..., k, :], axis)
            angle = angle + 2.0 * np.pi * np.rint((rough - angle) / (2.0 * np.pi))
            result[..., k, :] = angle[..., None] * axis
    return result.reshape(principal.shape)


def _common_axis(q: FloatArray) -> FloatArray | None:
    """The axis that all orientations (n, 4) turn about, signed by the first that has one."""
    v = q[:, 1:]
    longest = np.argmax(np.linalg.norm(v, axis=1))
    length = np.linalg.norm(v[longest])
    if length < ONE_AXIS:
        return None
    axis = v[longest] / length
    if np.linalg.norm(np.cross(v, axis), axis=1).max() > ONE_AXIS:
        return None
    along = v @ axis
    first = along[np.argmax(np.abs(along) > ONE_AXIS)]
    return axis if first > 0 else -axis


def _followed(t: FloatArray, grid: FloatArray, turning: FloatArray, closed: bool) -> FloatArray:
    """The angle at t, roughly, on the branch on which the curve arrives from its start."""
    periods = np.floor(t / grid[-1]) if closed else np.zeros_like(t)
    rough = np.interp(t - periods * grid[-1], grid, turning)
    return np.asarray(rough + periods * (turning[-1] - turning[0]))


def _angle(q: FloatArray, axis: FloatArray) -> FloatArray:
    """theta of exp(theta axis), -pi < theta <= pi."""
    return np.arctan2(q[..., 1:] @ axis, q[..., 0])
