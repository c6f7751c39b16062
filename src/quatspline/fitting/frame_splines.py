"""Splines through the axes of frames: end conditions in terms of body rates, constants of segments.

In the chart at an end, x_j = ln(q_0^-1 q_j), half rotation vectors, the motion is

    R(s) = R_0 exp [2 x(s)],    x(s) = sum_m a_m s^m,    2 a_1 = omega,    4 a_2 = alpha            (1)

and derivative m of the matrices is m! times the coefficient of s^m of this series:
R_0 [omega], R_0 ([omega]^2 + [alpha]), ...  Coefficients that are not given are estimated from the polynomial
through the keyframes beside the end (`end_conditions`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.fitting.end_conditions import expanded
from quatspline.quaternion import FloatArray

CHUNK = 4096
"""Segments whose constants are made at once: what they are made of takes several times their memory."""

Rates = tuple[FloatArray | None, FloatArray | None]
"""Body velocity and acceleration (K, 3) at an end, where they are given."""


def axes_of(q: FloatArray) -> FloatArray:
    """Columns of the matrices of q (n, K, 4): (n, K, column, component)."""
    return quaternion.rotate(q[..., None, :], np.eye(3))


def complete(
    t: FloatArray, q: FloatArray, degree: int, rates: Rates
) -> list[tuple[int, FloatArray]]:
    """(m, derivative m of the axes), m = 1 ... (k - 1)/2, at the first of keyframes q (n, K, 4)."""
    count, (velocity, acceleration) = (degree - 1) // 2, rates
    known = None if velocity is None else 0.5 * velocity
    a = _coefficients(t, q, degree, [] if known is None else [known])
    if acceleration is not None:
        a = _coefficients(t, q, degree, [a[0], 0.25 * acceleration])
    series = _exponential([_crossing(2.0 * x) for x in a], count)
    factorial = [math.factorial(m) for m in range(1, count + 1)]
    start = axes_of(q[:1])[0]
    return [
        (m + 1, f * (e @ start)) for m, (f, e) in enumerate(zip(factorial, series, strict=True))
    ]


def _coefficients(
    t: FloatArray, q: FloatArray, degree: int, known: list[FloatArray]
) -> list[FloatArray]:
    """a_1 ... of (1): with those known, the polynomial is of degree k still, through fewer keyframes."""
    reach = degree + 1 - len(known)
    return expanded(t[1:reach] - t[0], quaternion.chart(q[:reach]), known, (degree - 1) // 2)


def _crossing(v: FloatArray) -> FloatArray:
    """[v]^T of v (K, 3): its rows are v x e_j."""
    return -np.cross(np.eye(3), v[:, None])


def _exponential(x: list[FloatArray], count: int) -> list[FloatArray]:
    """Coefficients 1 ... count of the exponential of a series of matrices without a constant term.

    Of E = sum X^p / p! in powers of s; the sum is over all orders of factors, so that transposes will do.
    """
    total = [np.zeros_like(x[0]) for _ in range(count)]
    power = x[:count]  # coefficients 1 ... count of X^p / p!
    for p in range(1, count + 1):
        total = [a + b for a, b in zip(total, power, strict=True)]
        power = [
            sum((power[i] @ x[m - i - 1] for i in range(m)), np.zeros_like(x[0])) / (p + 1)
            for m in range(count)
        ]
    return total


def constants(spline: Any, t: FloatArray, q: FloatArray, axes: FloatArray) -> FloatArray:
    """Constants (K, segments, ...) of `families.frames`: the middle of each arc, and B seen from there."""
    made = np.empty((q.shape[1], len(t) - 1, 4 + 9 * (spline.k + 1)))
    for start in range(0, len(t) - 1, CHUNK):
        part = slice(start, start + CHUNK + 1)
        made[:, start : start + CHUNK] = _constants(spline, t[part], q[part], axes[part])
    return made


def _constants(spline: Any, t: FloatArray, q: FloatArray, axes: FloatArray) -> FloatArray:
    h = np.diff(t)[:, None, None, None]
    middle = quaternion.normalise(q[:-1] + q[1:])
    powers = [spline(t[:-1], m) * h**m / math.factorial(m) for m in range(2, spline.k + 1)]
    bends = -np.cumsum(powers[::-1], axis=0)[::-1]  # u^k - u = -u (1 - u) (1 + ... + u^(k - 2))
    rows = np.stack([axes[:-1], axes[1:] - axes[:-1], *bends], axis=2)
    seen = quaternion.rotate(quaternion.conj(middle)[:, :, None, None], rows)
    flat = seen.reshape(*seen.shape[:2], -1)
    return np.moveaxis(np.concatenate([middle, flat], axis=-1), 1, 0)
