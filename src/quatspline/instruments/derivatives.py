"""Derivatives of any curve, peers included: its own where it has them, otherwise the numerical ones."""

from __future__ import annotations

import numpy as np

from quatspline import stencil
from quatspline.curve import Curve
from quatspline.quaternion import FloatArray

ONE_SIDED = 4
"""Points of the one-sided extrapolation to a knot: exact for cubics."""

_LIMIT = np.array([4.0, -6.0, 4.0, -1.0])
_SLOPE = np.array([-13.0 / 3.0, 19.0 / 2.0, -7.0, 11.0 / 6.0])
"""Weights of values at h, 2h, 3h, 4h for the value and for h times the slope at 0."""


def derivative(curve: Curve, t: FloatArray, order: int) -> FloatArray:
    """Orders 0, 1, 2 of a single-track curve at t (m,) in its domain: (m, 4) or (m, 3)."""
    if order in curve.orders:
        return curve(t, order)
    return rates(curve, t)[order - 1]


def rates(curve: Curve, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angular velocity and acceleration (m, 3) at once: half the work where they are numerical."""
    if 1 in curve.orders and 2 in curve.orders:
        return curve(t, 1), curve(t, 2)
    return stencil.rates(curve._orientation, curve.since(t), curve.keyframes.knots)


def analytic(curve: Curve) -> bool:
    """Whether both rates are the curve's own, not the numerical fallback's."""
    return {1, 2} <= set(curve.orders) - set(curve.numeric_orders)


def closed_forms(curve: Curve) -> bool:
    """Whether both rates are closed forms of this package, tested against the curve."""
    return analytic(curve) and curve.peer is None


def rates_since(curve: Curve, since: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angular velocity and acceleration (m, 3) of the curve as it runs, whatever a library reports.

    A peer's rates are a claim about its curve, so its orientations are differentiated.  At times since
    the first keyframe (m,): Unix times leave no digits inside a segment.
    """
    if closed_forms(curve):
        return curve.inner(since, 1)[:, 0], curve.inner(since, 2)[:, 0]
    return stencil.rates(curve._orientation, since, curve.keyframes.knots)


def one_sided(
    curve: Curve, at: FloatArray, step: FloatArray, side: int
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Limits at knots ``at`` (m,) from one side (+1 or -1): q (m, 4), then three derivatives (m, 3).

    Knots are times since the first keyframe; beyond a closed curve's seam its first segment goes on.
    Values at 1 to 4 steps (m,) away are extrapolated; the last is the slope of the acceleration.
    """
    nodes = at[:, None] + side * step[:, None] * np.arange(1.0, ONE_SIDED + 1)
    t, period = nodes.reshape(-1), curve.keyframes.knots[-1]
    rates = rates_since(curve, np.where(t > period, t - period, t))
    q, omega, alpha = (
        values.reshape(*nodes.shape, -1) for values in (curve.inner(t)[:, 0], *rates)
    )
    limits = [np.einsum("j,mji->mi", _LIMIT, values) for values in (q, omega, alpha)]
    slope = np.einsum("j,mji->mi", _SLOPE, alpha) / (side * step[:, None])
    return limits[0], limits[1], limits[2], slope
