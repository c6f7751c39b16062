"""Fairness: torque energy, jerk energy, arc length and peak acceleration of a curve."""

from __future__ import annotations

from functools import cache

import numpy as np

from quatspline.curve import Curve
from quatspline.instruments.derivatives import rates
from quatspline.quaternion import FloatArray

PANELS, POINTS = 4, 5
"""Gauss-Legendre panels a segment and points a panel: exact to rounding for smooth segments."""


def fairness(curve: Curve) -> dict[str, float]:
    """Integrals and peaks of a single-track curve; lower is fairer.

    torque: integral of |alpha|^2 (rad^2/t^3), infinite in truth where the velocity jumps; jerk:
    integral of |alpha'|^2 (rad^2/t^5); length: integral of |omega| (rad); peak: max |alpha| (rad/t^2).
    """
    t, weight, width = _nodes(curve.times)
    omega, alpha = rates(curve, t)
    panels = alpha.reshape(-1, POINTS, 3)
    jerk = np.einsum("ij,pjk->pik", _slopes(), panels).reshape(-1, 3) / width[:, None]
    return {
        "torque": float(weight @ np.einsum("mi,mi->m", alpha, alpha)),
        "jerk": float(weight @ np.einsum("mi,mi->m", jerk, jerk)),
        "length": float(weight @ np.linalg.norm(omega, axis=-1)),
        "peak": float(np.linalg.norm(alpha, axis=-1).max()),
    }


def _nodes(times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times (m,), weights (m,) and panel widths (m,) of the quadrature over the domain."""
    u, w = np.polynomial.legendre.leggauss(POINTS)
    edges = np.linspace(times[:-1], times[1:], PANELS + 1, axis=1)
    left, width = edges[:, :-1].reshape(-1), np.diff(edges, axis=1).reshape(-1)
    t = left[:, None] + width[:, None] * (0.5 + 0.5 * u)
    weights = 0.5 * width[:, None] * w
    return t.reshape(-1), weights.reshape(-1), np.repeat(width, POINTS)


@cache
def _slopes() -> FloatArray:
    """Slopes (POINTS, POINTS) at a unit panel's nodes of the quartic through values there."""
    u = 0.5 + 0.5 * np.polynomial.legendre.leggauss(POINTS)[0]
    powers = np.arange(POINTS)
    derivatives = powers * u[:, None] ** np.maximum(powers - 1, 0)
    return derivatives @ np.linalg.inv(np.vander(u, increasing=True))
