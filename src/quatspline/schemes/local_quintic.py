"""Fair without equations: rates of a local cubic spline at every keyframe, joined by quintics."""

from __future__ import annotations

import math

import numpy as np

from quatspline._jit import fit_kernel, inlined
from quatspline.families.rotation_vector import (
    ROTATION_VECTOR,
    coefficients,
    half_acceleration,
    set_base,
    set_hermite,
)
from quatspline.families.segments import SegmentCurve
from quatspline.keyframes import Keyframes
from quatspline.options import Count
from quatspline.primitives import cross, log_between, sinc

# notation: log units throughout (half rotation vectors), h_j spacings, m the window

START, STOP = math.radians(240) / 2, math.radians(340) / 2
"""Half angles, accumulated from a keyframe to its window's end, between which the window gives way
to the next smaller one: the chart folds at a full turn."""


class LocalQuinticSpline(SegmentCurve):
    """Local quintic spline: C^2, interpolating, order 4, nearly of least torque, nothing solved.

    At every keyframe, velocity v_i and acceleration a_i are the derivatives at t_i of a cubic spline
    through the points x_j = ln(q_i^-1 q_j), |j - i| <= m, of the chart centred there, in which
    derivatives are body rates.  Its ends are not-a-knot where the window is cut, natural where it
    meets the curve's end.  One exponential a segment, Q = q_i exp(phi(u)), matches the rates of
    both ends (docs: local-quintic.md, LQ.1-LQ.6):

        phi(0) = 0,    phi'(0) = h v_i,                     phi''(0) = h^2 a_i                   (1)
        phi(1) = L_i,  phi'(1) = Jr^-1(2 L_i) h v_{i+1},
        phi''(1) = Jr^-1(2 L_i) (h^2 a_{i+1} - (d/du Jr(2 phi)) phi')                            (2)

    Every keyframe's rates are the same from both sides, so that the curve is C^2 whatever they are.

    Options
    -------
    window
        m, keyframes on either side; a segment is shaped by 2 m + 2 keyframes.  1 has order 2.
    """

    title = "Local quintic C2 spline"
    reference = "park1997"
    continuity = 2
    order = 4
    support = 8
    constant_rate = "everywhere"
    family = ROTATION_VECTOR
    operations = {"exps per sample": 1, "logs per keyframe": 3}

    def _fit(self, keyframes: Keyframes, *, window: Count = 3) -> None:
        self.order = 4 if window > 1 else 2
        self.support = 2 * window + 2
        self.operations = {"exps per sample": 1, "logs per keyframe": window}
        self._solve(FIT, np.array([float(window)]))


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):  # noqa: N802 - a constant
    """Constants of every segment; parameters[0] is the window m."""
    n, m = q.shape[0], int(parameters[0])
    chords = np.empty((m, n, 3))
    rates = np.empty((n, 6))
    for k in range(m):
        for i in range(n if closed else n - 1 - k):
            _chord(q, i, k + 1, sign, chords)
    for i in range(n):
        _rates(chords, h, closed, i, rates)
    reach = 0.0
    for i in range(h.size):
        set_base(segments, i, q[i, 0], q[i, 1], q[i, 2], q[i, 3])
        reach = max(reach, _join(chords[0, i], h[i], rates[i], rates[(i + 1) % n], segments, i))
    report[3] = reach


@inlined
def _chord(q, i, k, sign, chords):
    """ln(q_i^-1 q_{i+k}), q continued around a closed curve with its sign."""
    n = q.shape[0]
    s = sign if ((i + k) // n) % 2 == 1 else 1.0
    j = (i + k) % n
    x, y, z = log_between(
        q[i, 0], q[i, 1], q[i, 2], q[i, 3], s * q[j, 0], s * q[j, 1], s * q[j, 2], s * q[j, 3]
    )
    chords[k - 1, i, 0] = x
    chords[k - 1, i, 1] = y
    chords[k - 1, i, 2] = z


@inlined
def _point(chords, i, j, side):
    """x_j of the chart at keyframe i, j >= 1 keyframes after it (side 1) or before it (-1)."""
    k = i if side > 0 else (i - j) % chords.shape[1]
    x = chords[j - 1, k]
    return side * x[0], side * x[1], side * x[2]


@inlined
def _gap(h, i, j, side):
    """The spacing between the keyframes j and j + 1 after keyframe i, or before it."""
    return h[(i + j if side > 0 else i - 1 - j) % h.size]


@inlined
def _half(chords, h, i, k, side, natural):
    """The k keyframes on one side of keyframe i as a relation v = r - p a: (p, r).

    Elimination of the spline's second derivatives M_j from the far end towards M_0 = a.  On the side
    before i, time runs backwards: v is to be negated.
    """
    e, gx, gy, gz = 0.0, 0.0, 0.0, 0.0  # M_{j+1} = g + e M_j; natural: M_k = 0
    outer = _gap(h, i, k - 1, side)
    sx, sy, sz = _point(chords, i, k, side)
    for j in range(k - 1, 0, -1):
        inner = _gap(h, i, j - 1, side)
        x, y, z = _point(chords, i, j, side)
        wx, wy, wz = 0.0, 0.0, 0.0
        if j > 1:
            wx, wy, wz = _point(chords, i, j - 1, side)
        below = inner
        if j == k - 1 and not natural:
            # not-a-knot: M_k = (1 + ratio) M_{k-1} - ratio M_{k-2}
            ratio = outer / inner
            e = 1.0 + ratio
            below -= ratio * outer
        f, g = 6.0 / outer, 6.0 / inner
        pivot = 1.0 / (2.0 * (inner + outer) + outer * e)
        gx = (f * (sx - x) - g * (x - wx) - outer * gx) * pivot
        gy = (f * (sy - y) - g * (y - wy) - outer * gy) * pivot
        gz = (f * (sz - z) - g * (z - wz) - outer * gz) * pivot
        e = -below * pivot
        outer, sx, sy, sz = inner, x, y, z
    c, d = 1.0 / outer, outer / 6.0
    return d * (2.0 + e), c * sx - d * gx, c * sy - d * gy, c * sz - d * gz


@inlined
def _window(chords, h, closed, i, k):
    """v and a at keyframe i by the spline through k keyframes on either side."""
    n = chords.shape[1]
    before, after = k, k
    if not closed:
        before, after = min(k, i), min(k, n - 1 - i)
    ends = not closed
    if before > 0 and after > 0:
        p, x, y, z = _half(chords, h, i, after, 1, after < 2 or (ends and i + k >= n - 1))
        r, a, b, c = _half(chords, h, i, before, -1, before < 2 or (ends and i - k <= 0))
        f = 1.0 / (p + r)
        return (
            f * (r * x - p * a),
            f * (r * y - p * b),
            f * (r * z - p * c),
            f * (x + a),
            f * (y + b),
            f * (z + c),
        )
    if after > 0:
        _, x, y, z = _half(chords, h, i, after, 1, after < 2 or i + k >= n - 1)
        return x, y, z, 0.0, 0.0, 0.0
    _, x, y, z = _half(chords, h, i, before, -1, before < 2 or i - k <= 0)
    return -x, -y, -z, 0.0, 0.0, 0.0


@inlined
def _turned(chords, closed, i, k):
    """The half angle accumulated from keyframe i to the farther end of its window k."""
    n = chords.shape[1]
    before, after = 0.0, 0.0
    for j in range(k):
        if closed or i + j < n - 1:
            x = chords[0, (i + j) % n]
            after += math.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])
        if closed or i - j > 0:
            x = chords[0, (i - 1 - j) % n]
            before += math.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])
    return max(before, after)


@inlined
def _rates(chords, h, closed, i, rates):
    """v and a at keyframe i: the nested windows, each with its share of what wider ones left."""
    left = 1.0
    for c in range(6):
        rates[i, c] = 0.0
    for k in range(chords.shape[0], 0, -1):
        passed = 0.0
        if k > 1:
            xi = (_turned(chords, closed, i, k) - START) / (STOP - START)
            xi = min(max(xi, 0.0), 1.0)
            passed = xi * xi * xi * (10.0 - xi * (15.0 - 6.0 * xi))
        if passed < 1.0:
            share = left * (1.0 - passed)
            w = _window(chords, h, closed, i, k)
            for c in range(6):
                rates[i, c] += share * w[c]
        left *= passed
        if left == 0.0:
            break


@inlined
def _inverse(d, x, y, z, vx, vy, vz):
    """Jr^-1(2 L) v with L = (x, y, z): v + L x v + d L x (L x v)."""
    tx, ty, tz = cross(x, y, z, vx, vy, vz)
    ux, uy, uz = cross(x, y, z, tx, ty, tz)
    return vx + tx + d * ux, vy + ty + d * uy, vz + tz + d * uz


@inlined
def _join(chord, h, start, stop, segments, i):
    """phi of segment i by (1) and (2); returns its bound."""
    x, y, z = chord[0], chord[1], chord[2]
    k, r = h * h, x * x + y * y + z * z
    s, c = sinc(r)
    a, b, a1, b1 = coefficients(r, s, c)
    d = -0.5 * a1 / a  # (s - c) / (z s): the inverse's (1 - r cot r) / r^2
    gx, gy, gz = _inverse(d, x, y, z, h * stop[0], h * stop[1], h * stop[2])
    fx, fy, fz = half_acceleration(a, b, a1, b1, x, y, z, gx, gy, gz, 0.0, 0.0, 0.0)
    ex, ey, ez = _inverse(d, x, y, z, k * stop[3] - fx, k * stop[4] - fy, k * stop[5] - fz)
    return set_hermite(
        segments,
        i,
        (h * start[0], h * start[1], h * start[2]),
        (k * start[3], k * start[4], k * start[5]),
        (x, y, z),
        (gx, gy, gz),
        (ex, ey, ez),
    )
