"""Analytic motions: the dense truth that accuracy is measured against."""

from __future__ import annotations

import numpy as np

from quatspline import quaternion
from quatspline.quaternion import FloatArray

SPAN = 10.0
"""The tumble is used on [0, SPAN]; orders are read on the inner part [3, 7]."""
INNER = (3.0, 7.0)


def tumble(t: FloatArray) -> FloatArray:
    """Q(t) = exp(a(t)) exp(b(t)), (..., 4): a smooth motion about changing axes.

    a = (0.8 sin 1.1t, 0.6 cos(0.7t + 0.3), 0.5 sin(1.7t + 1)), b = (0.3t, 0, 0.2 cos t), half angles.
    """
    return quaternion.mul(quaternion.exp(_parts(t)[0]), quaternion.exp(_parts(t)[1]))


def tumble_rates(t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Body angular velocity and acceleration (..., 3) of `tumble`, exact.

    omega = 2 (R_b^T Jr(2a) a' + Jr(2b) b'), by the product rule; alpha by differentiating once
    more in closed form would need Jr', so it is taken from a nine-point stencil of omega (1e-11).
    """
    t = np.asarray(t, dtype=float)
    nodes = np.arange(-4, 5) * STENCIL
    weights = np.array([3, -32, 168, -672, 0, 672, -168, 32, -3]) / (840.0 * STENCIL)
    alpha = np.einsum("j,...ji->...i", weights, _omega(t[..., None] + nodes))
    return _omega(t), alpha


STENCIL = 0.01


def _parts(t: FloatArray) -> tuple[FloatArray, FloatArray]:
    t = np.asarray(t, dtype=float)
    a = [0.8 * np.sin(1.1 * t), 0.6 * np.cos(0.7 * t + 0.3), 0.5 * np.sin(1.7 * t + 1.0)]
    b = [0.3 * t, np.zeros_like(t), 0.2 * np.cos(t)]
    return np.stack(a, axis=-1), np.stack(b, axis=-1)


def _slopes(t: FloatArray) -> tuple[FloatArray, FloatArray]:
    a = [0.88 * np.cos(1.1 * t), -0.42 * np.sin(0.7 * t + 0.3), 0.85 * np.cos(1.7 * t + 1.0)]
    b = [np.full_like(t, 0.3), np.zeros_like(t), -0.2 * np.sin(t)]
    return np.stack(a, axis=-1), np.stack(b, axis=-1)


def _omega(t: FloatArray) -> FloatArray:
    (a, b), (da, db) = _parts(t), _slopes(t)
    wa = np.einsum("...ij,...j->...i", quaternion.right_jacobian(2.0 * a), 2.0 * da)
    wb = np.einsum("...ij,...j->...i", quaternion.right_jacobian(2.0 * b), 2.0 * db)
    return quaternion.rotate(quaternion.conj(quaternion.exp(b)), wa) + wb
