"""Euler angles as files have them: turns about axes of the body, one after the other.

An order names the axes, the first first: "ZXY" is Rz Rx Ry, each about an axis as the turns before left
it.  Turns about fixed axes are the same in the opposite order.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import ArrayLike

from quatspline.quaternion import FloatArray

AXES = "XYZ"

ORDERS = tuple(map("".join, itertools.permutations(AXES)))
"""Orders by which every orientation can be told."""

LOCKED = 1e-14
"""Below this (rad) from the lock one of two angles is nothing but rounding: it keeps its last value."""

TIE = 1e-9
"""How much nearer (rad) the other branch must be: at half way between both, rounding must not decide."""


def from_angles(angles: ArrayLike, order: str) -> FloatArray:
    """Quaternions (..., 4) of angles (..., k) in rad about the k axes of an order, repeated or not."""
    half = 0.5 * np.asarray(angles, dtype=float)
    q = np.zeros((*half.shape[:-1], 4))
    q[..., 0] = 1.0
    for k, axis in enumerate(order):
        q = _turned(q, AXES.index(axis), np.cos(half[..., k]), np.sin(half[..., k]))
    return q


def _turned(q: FloatArray, axis: int, c: FloatArray, s: FloatArray) -> FloatArray:
    """Quaternions times cos + sin e, e being the unit vector of an axis."""
    i, j, k = (1 + (axis + step) % 3 for step in range(3))
    out = np.empty_like(q)
    out[..., 0] = c * q[..., 0] - s * q[..., i]
    out[..., i] = c * q[..., i] + s * q[..., 0]
    out[..., j] = c * q[..., j] + s * q[..., k]
    out[..., k] = c * q[..., k] - s * q[..., j]
    return out


def continuous_angles(q: FloatArray, order: str) -> FloatArray:
    """Angles (n, 3) in rad of orientations q (n, 4) about the three axes of an order, without leaps.

    The first lies in the principal branch, the middle angle within a quarter turn.  Of every other the
    branch and the multiples of a turn are those nearest the frame before; at the lock, where only the
    sum or the difference of the outer angles is determined, the other keeps its last value.
    """
    angles = _principal(q, order)
    steps = wrapped(angles[1:] - angles[:-1])
    across = wrapped(mirrored(angles[1:]) - angles[:-1])
    # Branch to branch costs the same from either: only changes of branch are to be found.
    change = np.abs(across).sum(axis=1) < np.abs(steps).sum(axis=1) - TIE
    other = np.concatenate([[False], np.logical_xor.accumulate(change)])
    return np.unwrap(np.where(other[:, np.newaxis], mirrored(angles), angles), axis=0)


def mirrored(angles: FloatArray) -> FloatArray:
    """The same orientations by the other angles (n, 3) of an order of three different axes."""
    return np.stack([angles[:, 0] + np.pi, np.pi - angles[:, 1], angles[:, 2] + np.pi], axis=1)


def wrapped(angles: FloatArray) -> FloatArray:
    """Angles less the nearest multiple of a turn."""
    return angles - 2.0 * np.pi * np.round(angles / (2.0 * np.pi))


def _principal(q: FloatArray, order: str) -> FloatArray:
    """Angles of orders of three different axes, the middle one within a quarter turn.

    With half angles h and e_1 e_2 = s e_3, multiplying out (cos h_1 + e_1 sin h_1) ... gives

        (w - s q_2, q_1 - q_3) = (cos h_2 - s sin h_2) (cos, sin)(h_1 - h_3)                      (1)
        (w + s q_2, q_1 + q_3) = (cos h_2 + s sin h_2) (cos, sin)(h_1 + h_3)                      (2)

    One of the factors vanishes at the lock.
    """
    first, second, third = (q[:, 1 + AXES.index(axis)] for axis in order)
    s = 1.0 if order in ("XYZ", "YZX", "ZXY") else -1.0
    minus = q[:, 0] - s * second, first - third
    plus = q[:, 0] + s * second, first + third
    middle = s * (2.0 * np.arctan2(np.hypot(*plus), np.hypot(*minus)) - 0.5 * np.pi)
    difference, total = _held(*minus), _held(*plus)
    return np.stack([total + difference, middle, total - difference], axis=1)


def _held(a: FloatArray, b: FloatArray) -> FloatArray:
    """atan2(b, a), the last value that is determined where both vanish."""
    angle = np.arctan2(b, a)
    fine = np.hypot(a, b) > LOCKED
    if fine.all() or not fine.any():
        return np.where(fine, angle, 0.0)
    last = np.maximum.accumulate(np.where(fine, np.arange(len(fine)), np.argmax(fine)))
    return np.asarray(angle[last])
