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
    """The continuous angle about the axis: the branch nearest to the keyframes' own turning."""
    keyframes = curve.keyframes
    angle = np.arctan2(q[..., 1:] @ axis, q[..., 0])
    at_keys = np.arctan2(keyframes.tracks[k][:, 1:] @ axis, keyframes.tracks[k][:, 0])
    if keyframes.closed:
        closing = at_keys[0] + (0.0 if keyframes.signs[k] > 0 else np.pi)
        at_keys = np.append(at_keys, closing)
    turning = np.unwrap(at_keys)
    since = t - curve.domain[0]
    period = keyframes.knots[-1]
    periods = np.floor(since / period) if keyframes.closed else np.zeros_like(since)
    rough = np.interp(since - periods * period, keyframes.knots, turning)
    rough = rough + periods * (turning[-1] - turning[0])
    return angle + 2.0 * np.pi * np.rint((rough - angle) / (2.0 * np.pi))
