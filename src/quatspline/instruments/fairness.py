"""Fairness: torque energy, jerk energy, arc length and peak acceleration of a curve."""

from __future__ import annotations

import numpy as np

from quatspline.curve import Curve
from quatspline.instruments.derivatives import derivative, rates
from quatspline.quaternion import FloatArray

PANELS, POINTS = 4, 5
"""Gauss-Legendre panels a segment and points a panel: exact to rounding for smooth segments."""

DIFFERENCE = 1e-3
"""Step of the jerk's central difference as a share of a panel."""


def _nodes(curve: Curve) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times (m,), weights (m,) and panel widths (m,) of the quadrature over the domain."""
    times = curve.times
    u, w = np.polynomial.legendre.leggauss(POINTS)
    edges = np.linspace(times[:-1], times[1:], PANELS + 1, axis=1)
    left, width = edges[:, :-1].reshape(-1), np.diff(edges, axis=1).reshape(-1)
    t = left[:, None] + width[:, None] * (0.5 + 0.5 * u)
    weights = 0.5 * width[:, None] * w
    return t.reshape(-1), weights.reshape(-1), np.repeat(width, POINTS)


def fairness(curve: Curve) -> dict[str, float]:
    """Integrals and peaks of a single-track curve; lower is fairer.

    torque: integral of |alpha|^2 (rad^2/t^3), infinite in truth where the velocity jumps; jerk:
    integral of |alpha'|^2 (rad^2/t^5); length: integral of |omega| (rad); peak: max |alpha| (rad/t^2).
    """
    t, weight, width = _nodes(curve)
    omega, alpha = rates(curve, t)
    h = DIFFERENCE * width
    jerk = (derivative(curve, t + h, 2) - derivative(curve, t - h, 2)) / (2.0 * h[:, None])
    speed = np.linalg.norm(omega, axis=-1)
    return {
        "torque": float(weight @ np.einsum("mi,mi->m", alpha, alpha)),
        "jerk": float(weight @ np.einsum("mi,mi->m", jerk, jerk)),
        "length": float(weight @ speed),
        "peak": float(np.linalg.norm(alpha, axis=-1).max()),
    }
