"""Derivatives of any curve, peers included: its own where it has them, otherwise the numerical ones."""

from __future__ import annotations

from quatspline import stencil
from quatspline.curve import Curve
from quatspline.quaternion import FloatArray


def derivative(curve: Curve, t: FloatArray, order: int) -> FloatArray:
    """Orders 0, 1, 2 of a single-track curve at t (m,) in its domain: (m, 4) or (m, 3)."""
    if order in curve.orders:
        return curve(t, order)
    return rates(curve, t)[order - 1]


def rates(curve: Curve, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angular velocity and acceleration (m, 3) at once: half the work where they are numerical."""
    if 1 in curve.orders and 2 in curve.orders:
        return curve(t, 1), curve(t, 2)
    return stencil.rates(curve.orientations, curve.since(t), curve.keyframes.knots)


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
    return stencil.rates(curve.orientations, since, curve.keyframes.knots)
