"""Probes of the 2017 paper's own sentences: its derivatives at knots, and what its protocol costs."""

from __future__ import annotations

import numpy as np

from quatspline import quaternion
from quatspline.catalogue import scheme
from quatspline.claims.probes import walked
from quatspline.options import among
from quatspline.quaternion import FloatArray
from quatspline.timing.operations import executed
from quatspline.timing.protocols import Protocol
from quatspline.trajectories.paper import CASES, SOLVE
from quatspline.trajectories.walks import directions

DEGREE = 16
"""Of the polynomial fitted to a segment: the curve is analytic there, so this leaves rounding."""

KNOT = 2
"""The knot looked at, of five keyframes: its two segments have no ghost."""

SLERP = 2.0
"""A slerp is one logarithm and one exponential."""


def derivative_error(order: int = 2, one_axis: bool = False, product_rule: bool = False) -> float:
    """How far the printed Q' or Q'' at a knot is off the quartic's, as a share of its size.

    Orientations alone decide: a polynomial through those of the segment is differentiated.

    Parameters
    ----------
    order : 1 or 2
    one_axis : whether all steps are about one axis, so that they commute; else about random ones
    product_rule : whether the product rule replaces the printed square (a + b)^2 of Q''
    """
    keyframes = _turned() if one_axis else walked(5, 60.0)[1]
    curve = scheme("quartic")(None, keyframes)
    t = KNOT + np.polynomial.chebyshev.chebpts1(2 * DEGREE) / 2.0 + 0.5
    fitted = np.polynomial.chebyshev.chebfit(2.0 * (t - KNOT) - 1.0, curve(t), DEGREE)
    slope = np.polynomial.chebyshev.chebder(fitted, order, scl=2.0)
    measured = np.asarray(np.polynomial.chebyshev.chebval(-1.0, slope))
    return _relative(_formula(curve.quaternions, order, product_rule), measured)


def _turned() -> FloatArray:
    """Five keyframes, steps of 20 to 80 degrees about one axis."""
    half = np.radians([0.0, 20.0, 90.0, 130.0, 210.0]) / 2.0
    return quaternion.exp(half[:, None] * directions(np.random.default_rng(0), (1,)))


def _formula(keyframes: FloatArray, order: int, product_rule: bool) -> FloatArray:
    """Theorem 1 as printed, or with the product rule, at the knot: (4,)."""
    # notation: a, b are the logarithms of the steps before and after the knot
    before, here, after = keyframes[KNOT - 1 : KNOT + 2]
    a, b = (_step(p, q) for p, q in ((before, here), (here, after)))
    if order == 1:
        return 0.5 * quaternion.mul(here, a + b)
    squared = quaternion.mul(a + b, a + b)
    if product_rule:
        squared = squared + quaternion.mul(a, b) - quaternion.mul(b, a)
    return quaternion.mul(here, 0.25 * squared + 3.0 * (b - a))


def _step(p: FloatArray, q: FloatArray) -> FloatArray:
    return np.concatenate([[0.0], quaternion.log(quaternion.mul(quaternion.conj(p), q))])


def _relative(x: FloatArray, y: FloatArray) -> float:
    return float(np.linalg.norm(x - y) / np.linalg.norm(y))


def operations_over_quartic(
    name: str = "nielson",
    protocol: Protocol = "per-frame",
    case: str = "key",
    frames: int = 101,
) -> float:
    """Exponentials and logarithms (two a slerp) for the frames of Table 1, over the quartic's."""
    return _operations(name, protocol, case, frames) / _operations(
        "quartic", protocol, case, frames
    )


def _operations(name: str, protocol: Protocol, case: str, frames: int) -> float:
    keyframes = CASES[case].keyframes()
    cls = scheme(name)
    curve = cls.from_keyframes(keyframes, **among(cls, SOLVE))
    counts = executed(curve, frames, frames if protocol == "per-frame" else 1).total
    return counts["exps"] + counts["logs"] + SLERP * counts["slerps"]


def iterations(case: str = "key") -> int:
    """Updates of Nielson's iteration for a reconstructed case, by the published stop rule."""
    report = scheme("nielson").from_keyframes(CASES[case].keyframes(), **SOLVE).solve_report
    assert report is not None
    return int(report.iterations)
