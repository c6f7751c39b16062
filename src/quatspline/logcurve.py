"""The log-curve ln q(t) of a curve, carried past pi where the curve runs straight through -1."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from quatspline import quaternion
from quatspline.quaternion import FloatArray

if TYPE_CHECKING:
    from quatspline.curve import Curve

ONE_AXIS = 1e-12
"""Vector parts that leave one line by less than this make a spin about one axis."""

STEPS = np.arange(16) / 16
"""Shares of a segment at which the angle is followed: less than half a turn of S^3 between two."""


def log_curve(curve: Curve, t: ArrayLike) -> FloatArray:
    """ln q(t), shape S + (*K, 3); see `Curve.log`."""
    q = curve(t)
    principal = quaternion.log(q)
    samples = np.asarray(t, dtype=float)
    keyframes = curve.keyframes
    tracks = q.reshape(*samples.shape, -1, 4)
    result = principal.reshape(*samples.shape, -1, 3)
    for k in range(keyframes.tracks.shape[0]):
        axis = _common_axis(keyframes.tracks[k])
        if axis is not None:
            angle = _lifted(curve, k, axis, samples, tracks[..., k, :])
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


def _lifted(curve: Curve, k: int, axis: FloatArray, t: FloatArray, q: FloatArray) -> FloatArray:
    """The continuous angle about the axis: the branch on which the curve arrives from its start."""
    knots = curve.keyframes.knots
    grid = np.append(knots[:-1, None] + np.diff(knots)[:, None] * STEPS, knots[-1])
    along = curve(np.clip(curve.domain[0] + grid, *curve.domain)).reshape(grid.size, -1, 4)[:, k]
    turning = np.unwrap(_angle(along, axis))
    since = t - curve.domain[0]
    periods = np.floor(since / knots[-1]) if curve.closed else np.zeros_like(since)
    rough = np.interp(since - periods * knots[-1], grid, turning)
    rough = rough + periods * (turning[-1] - turning[0])
    angle = _angle(q, axis)
    return angle + 2.0 * np.pi * np.rint((rough - angle) / (2.0 * np.pi))


def _angle(q: FloatArray, axis: FloatArray) -> FloatArray:
    """theta of exp(theta axis), -pi < theta <= pi."""
    return np.arctan2(q[..., 1:] @ axis, q[..., 0])
