"""Velocity and acceleration at every keyframe from its neighbours: local splines in local charts.

In the chart x_j = ln(q_i^-1 q_j) centred at a keyframe, derivatives are body rates (in log units).
A cubic spline through the points within m keyframes gives both; nothing global is solved.  Two
facts make this cheap.  ln(q_i^-1 q_{i+k}) = -ln(q_{i+k}^-1 q_i), so that m logarithms per keyframe
serve both sides; and each side of a spline, eliminated from its far end, acts on the centre by one
relation v = r - p a only, so that two sides give v and a by one division.
"""

from __future__ import annotations

import math

import numpy as np

from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import TINY, arctan_series
from quatspline.kernels.values import Vec, keyframe, put_quat, quat_at, vec_at

# notation: log units throughout (half rotation vectors), h_j spacings, m the window, v and a the
# velocity and the acceleration at a keyframe

START, STOP = math.radians(240) / 2, math.radians(340) / 2
"""Half angles away from a keyframe between which a window gives way to the next smaller one: the
chart folds at a full turn, and a window cut off at once would make the curve jump with its data."""


@inlined
def log_scale(w, l2):
    """theta / l and theta = atan2(l, w), l^2 = l2: turns a vector part into a logarithm.

    Of -1, whose logarithm has a length but no direction, theta = pi and theta / l is finite.
    Two halvings of the angle bring it below pi/8, without a branch, so that loops vectorise.
    """
    length = math.sqrt(l2)
    g = 1.0 / (math.sqrt(w * w + l2) + abs(w))  # tan(theta/2) / l
    t = length * g
    g = g / (1.0 + math.sqrt(1.0 + t * t))  # tan(theta/4) / l
    scale = 4.0 * (g * arctan_series(l2 * g * g) + g)
    theta = length * scale
    if w < 0.0:
        return math.pi / (length + TINY) - scale, math.pi - theta
    return scale, theta


@inlined
def continued(q, h, closed, sign, m):
    """Keyframes and spacings with, closed, m more on either side, so that no index wraps."""
    pad = m if closed else 0
    points, gaps = np.empty((q.shape[0] + 2 * pad, 4)), np.empty(h.size + 2 * pad)
    for i in range(gaps.size):
        gaps[i] = h[(i - pad) % h.size]
    for i in range(points.shape[0]):
        put_quat(points[i], 0, keyframe(q, i - pad, sign))
    return points, gaps


@inlined
def chords(q, result):
    """ln(q_i^-1 q_{i+k}) into result (m, 4, n): x, y, z and the length, k = 1 ... m."""
    for k in range(1, min(result.shape[0] + 1, q.shape[0])):
        x, y, z, length = result[k - 1, 0], result[k - 1, 1], result[k - 1, 2], result[k - 1, 3]
        inside = q.shape[0] - k
        for i in range(inside):
            length[i], x[i], y[i], z[i] = ~quat_at(q[i], 0) * quat_at(q[i + k], 0)
        _logs(length[:inside], x, y, z)


@inlined
def _logs(w, x, y, z):
    """The logarithms of (w, x, y, z) in place, their lengths for w; the loop vectorises."""
    for i in range(w.size):
        v = Vec(x[i], y[i], z[i])
        scale, w[i] = log_scale(w[i], v @ v)
        x[i], y[i], z[i] = scale * v


@inlined
def _point(chords, i, j, side):
    """x_j of the chart at keyframe i, j >= 1 keyframes after it (side 1) or before it (-1)."""
    return side * vec_at(chords[j - 1, :, i if side > 0 else i - j], 0)


@inlined
def _gap(h, i, j, side):
    """The spacing between the keyframes j and j + 1 after keyframe i, or before it."""
    return h[i + j if side > 0 else i - 1 - j]


@inlined
def _half(chords, h, i, k, side, natural):
    """The k keyframes on one side of keyframe i as a relation v = r - p a: (p, r).

    Elimination of the spline's second derivatives M_j from the far end towards M_0 = a.  On the
    side before i, time runs backwards: v is to be negated.
    """
    zero = Vec(0.0, 0.0, 0.0)
    e, g = 0.0, zero  # M_{j+1} = g + e M_j; natural: M_k = 0
    outer, beyond = _gap(h, i, k - 1, side), _point(chords, i, k, side)
    for j in range(k - 1, 0, -1):
        inner, x = _gap(h, i, j - 1, side), _point(chords, i, j, side)
        before = _point(chords, i, j - 1, side) if j > 1 else zero
        below = inner
        if j == k - 1 and not natural:
            # not-a-knot: M_k = (1 + ratio) M_{k-1} - ratio M_{k-2}
            ratio = outer / inner
            e = 1.0 + ratio
            below -= ratio * outer
        pivot = 1.0 / (2.0 * (inner + outer) + outer * e)
        rise, fall = (6.0 / outer) * (beyond - x), (6.0 / inner) * (x - before)
        g = pivot * (rise - fall - outer * g)
        e = -below * pivot
        outer, beyond = inner, x
    return (outer / 6.0) * (2.0 + e), (1.0 / outer) * beyond - (outer / 6.0) * g


@inlined
def _window(chords, h, closed, i, k):
    """v and a at keyframe i by the spline through k keyframes on either side."""
    before, after, start, stop = _extent(h, closed, i, k)
    zero = Vec(0.0, 0.0, 0.0)
    p, x, r, y = 0.0, zero, 0.0, zero
    if after > 0:
        p, x = _half(chords, h, i, after, 1, stop or after < 2)
    if before > 0:
        r, y = _half(chords, h, i, before, -1, start or before < 2)
    if before == 0 or after == 0:
        return x - y, zero
    f = 1.0 / (p + r)
    return f * (r * x - p * y), f * (x + y)


@inlined
def _extent(h, closed, i, k):
    """Keyframes before and after keyframe i in its window k; whether it meets a curve's ends."""
    if closed:
        return k, k, False, False
    left, right = i, h.size - i
    return min(k, left), min(k, right), k >= left, k >= right


@inlined
def _turned(chords, h, closed, i, k):
    """A bound of the half angle from keyframe i to any point on the arcs joining its window.

    On an arc of length s with ends at distances a and b none is farther than (a + b + s) / 2.
    """
    before, after, _, _ = _extent(h, closed, i, k)
    bound, near = 0.0, 0.0
    for j in range(after):
        far = chords[j, 3, i]
        bound = max(bound, near + far + chords[0, 3, i + j])
        near = far
    near = 0.0
    for j in range(before):
        far = chords[j, 3, i - 1 - j]
        bound = max(bound, near + far + chords[0, 3, i - 1 - j])
        near = far
    return 0.5 * bound


@inlined
def local_rates(chords, h, closed, i):
    """v and a at keyframe i: the nested windows, each with its share of what wider ones left.

    Chords and h as `continued` and `chords` leave them, i counted there.
    """
    left, v, a = 1.0, Vec(0.0, 0.0, 0.0), Vec(0.0, 0.0, 0.0)
    for k in range(chords.shape[0], 0, -1):
        passed = 0.0
        if k > 1:
            xi = (_turned(chords, h, closed, i, k) - START) / (STOP - START)
            xi = min(max(xi, 0.0), 1.0)
            passed = xi * xi * xi * (10.0 - xi * (15.0 - 6.0 * xi))
        if passed < 1.0:
            share = left * (1.0 - passed)
            own_v, own_a = _window(chords, h, closed, i, k)
            v, a = v + share * own_v, a + share * own_a
        left *= passed
        if left == 0.0:
            break
    return v, a
