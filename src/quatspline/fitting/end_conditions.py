"""Interpolating B-splines of odd degree: their ends, and the derivatives that complete ones take there.

A spline of degree k through n points has k - 1 conditions too few, half of them at either end:

    natural       derivatives (k + 1)/2 ... k - 1 vanish
    not-a-knot    (k - 1)/2 inner knots at either end are none
    complete      derivatives 1 ... (k - 1)/2 are given

Derivatives that nobody gives are those of a polynomial through the points beside the end,

    x(s) = sum_{m=1}^{p} a_m s^m,    x(s_j) = x_j,    s_j = t_j - t_0                               (1)

of degree p <= k.  With a_1 ... a_g known, the y_j = (x_j - sum_{m<=g} a_m s_j^m) / s_j^{g+1} are points of the
polynomial with coefficients a_{g+1} ... a_p, which is expanded at 0 from its divided differences.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from quatspline.quaternion import FloatArray
from quatspline.system.quiet import quiet

ENDS = ("natural", "not-a-knot", "complete")


ILL = 7
"""Degrees from which a solve is refined once: the condition of the equations grows with the degree, to a miss of
1e-10 for degree 9."""


def fewest(degree: int, ends: str) -> int:
    """Points that an open spline needs."""
    return {"natural": (degree + 1) // 2, "not-a-knot": degree + 1, "complete": 2}[ends]


def interpolated(t: FloatArray, x: FloatArray, degree: int, conditions: Any) -> Any:
    """scipy's spline through x (n, ...); refused where its linear system is singular.

    An ill-conditioned one, of very uneven spacings, is no matter: a spline is smooth whatever its
    coefficients are, and segments may take their ends from the points themselves.
    """
    from scipy.interpolate import make_interp_spline

    spline = None
    with quiet(), suppress(np.linalg.LinAlgError):
        spline = make_interp_spline(t, x, degree, bc_type=conditions)
        if degree >= ILL:
            left = _left_over(spline, t, conditions)
            spline.c += make_interp_spline(t, x - spline(t), degree, bc_type=left).c
    if spline is None or not np.isfinite(spline.c).all():
        h = np.diff(t)
        raise ValueError(
            f"times: spacings in the ratio {h.max() / h.min():.3g} are too uneven for degree={degree}: "
            "the spline's linear system is singular"
        )
    return spline


def _left_over(spline: Any, t: FloatArray, conditions: Any) -> Any:
    """What a solved spline lacks of its end conditions: those of the step that refines it."""
    if conditions is None or isinstance(conditions, str):
        return conditions
    return tuple(
        [(m, value - spline(end, m)) for m, value in side]
        for end, side in zip((t[0], t[-1]), conditions, strict=True)
    )


def natural(degree: int, shape: tuple[int, ...]) -> Any:
    """Conditions of scipy's for points of a shape, at both ends."""
    flat = [(m, np.zeros(shape)) for m in range((degree + 1) // 2, degree)]
    return flat, flat


def expanded(
    s: FloatArray, x: FloatArray, known: Sequence[FloatArray], count: int
) -> list[FloatArray]:
    """a_1 ... a_count of (1) from points x (p, ...) at s (p,), the first of them known; zero beyond p.

    s rises from 0 or falls from it, 0 itself left out.
    """
    column = s.reshape(-1, *[1] * (x.ndim - 1))
    for a in known:
        x = (x - a * column) / column
    missing = count - len(known)
    series = np.zeros((missing + 1, *x.shape[1:]))
    differences = _divided(s, x / column)
    for node, c in zip(s[::-1], differences[::-1], strict=True):
        shifted = np.concatenate([np.zeros_like(series[:1]), series[:-1]])
        series = shifted - node * series
        series[0] += c
    return [*known, *series[:missing]]


def _divided(s: FloatArray, y: FloatArray) -> FloatArray:
    """The divided differences of y (p, ...) at s (p,): coefficients of Newton's polynomial."""
    table = y.copy()
    for j in range(1, len(s)):
        gap = (s[j:] - s[:-j]).reshape(-1, *[1] * (y.ndim - 1))
        table[j:] = (table[j:] - table[j - 1 : -1]) / gap
    return table


def derivatives(t: FloatArray, x: FloatArray, degree: int) -> list[tuple[int, FloatArray]]:
    """(m, derivative m) for m = 1 ... (k - 1)/2 at the first of points x (n, ...), from k + 1 of them."""
    s = t[1 : degree + 1] - t[0]
    series = expanded(s, x[1 : degree + 1] - x[0], [], (degree - 1) // 2)
    factorial = np.cumprod(np.arange(1.0, degree))
    return [(m + 1, factorial[m] * a) for m, a in enumerate(series)]
