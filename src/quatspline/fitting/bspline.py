"""The cubic B-spline on the knots of an interpolant: weights, ends, and its cumulative segments.

A knot t_i carries the control quaternion d_i and the basis function B_i on t_{i-2} ... t_{i+2}.
With w_j = ln(d_{j-1}^-1 d_j) and C_j = sum of B_k over k >= j, the curve on [t_i, t_{i+1}] is

    Q = d_{i-1} exp(C_i w_i) exp(C_{i+1} w_{i+1}) exp(C_{i+2} w_{i+2})     [kim1995general]     (1)

At the knot itself only three functions remain,

    m_i = B_{i-1}(t_i) = h_i^2 / ((h_{i-1} + h_i)(h_{i-2} + h_{i-1} + h_i)),               (2)
    p_i = B_{i+1}(t_i) = h_{i-1}^2 / ((h_{i-1} + h_i)(h_{i-1} + h_i + h_{i+1})),           (3)

and B_i(t_i) = 1 - m_i - p_i.  Beyond the ends of an open curve lie phantom knots: reflected
(natural), or repeated (clamped: zero spacings).

With N segments the knots are 0 ... N, of which a closed curve's last is its first.  Controls d are
held as (4, N + 1) and increments w as (3, N + 2), component first so that loops vectorise: column j
is w_j, and w_0 and w_{N+1} lead to the controls beyond the ends.
"""

from __future__ import annotations

import math

import numpy as np

from quatspline.families.cumulative import set_base, set_factor
from quatspline.fitting.tangents import chart_velocity
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.scalars import NEAR, between, cross, log, log_between, mul, sinc, sinc_near

WINDOW = 4
"""Keyframes in the chart estimate of an end velocity: one more than the curve's order."""

ROUNDING = 1e-14
"""Half angles below this are rounding."""


@inlined
def increment(w, j):
    """Column j of increments (3, N + 2)."""
    return w[0, j], w[1, j], w[2, j]


@inlined
def control(d, k):
    """Column k of quaternions (4, N + 1)."""
    return d[0, k], d[1, k], d[2, k], d[3, k]


@inlined
def set_control(d, k, w, x, y, z):
    """Write column k of quaternions (4, N + 1)."""
    d[0, k], d[1, k], d[2, k], d[3, k] = w, x, y, z


@inlined
def keyframe(q, i):
    """Keyframe i of (n, 4)."""
    return q[i, 0], q[i, 1], q[i, 2], q[i, 3]


@compiled
def turned(f, w):
    """exp(f w)."""
    x, y, z = f * w[0], f * w[1], f * w[2]
    n = x * x + y * y + z * z
    if n < NEAR * NEAR:
        s, c = sinc_near(n)
    else:
        s, c = sinc(n)
    return c, s * x, s * y, s * z


@compiled
def _far_log(w, x, y, z):
    return log(w, x, y, z)


@inlined
def small_log(w, x, y, z):
    """The logarithm, by its series where that is exact to rounding."""
    n = x * x + y * y + z * z
    if w > 0.0 and n < 1e-3:
        f = 1.0 + n * (1 / 6 + n * (3 / 40 + n * (15 / 336 + n * (105 / 3456))))
        return f * x, f * y, f * z
    return _far_log(w, x, y, z)


@inlined
def squared(v):
    """|v|^2."""
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]


@inlined
def spacing(h, i, closed, clamped):
    """h_i = t_{i+1} - t_i for any i, phantoms included."""
    n = h.size
    if i >= 0 and i < n:
        return h[i]
    if closed:
        return h[i % n]
    if clamped:
        return 0.0
    i %= 2 * n  # reflected at both ends
    return h[min(i, 2 * n - 1 - i)]


@inlined
def weight_before(h0, h1, h2):
    """(2): m_i of h_{i-2}, h_{i-1}, h_i."""
    return h2 * h2 / ((h1 + h2) * (h0 + h1 + h2))


@inlined
def weight_after(h1, h2, h3):
    """(3): p_i of h_{i-1}, h_i, h_{i+1}."""
    return h1 * h1 / ((h1 + h2) * (h1 + h2 + h3))


@compiled
def knot_weights(h, closed, clamped, m, p):
    """Fill m and p (N + 1,) with (2) and (3) at every knot."""
    for i in range(h.size + 1):
        h1, h2 = spacing(h, i - 1, closed, clamped), spacing(h, i, closed, clamped)
        m[i] = weight_before(spacing(h, i - 2, closed, clamped), h1, h2)
        p[i] = weight_after(h1, h2, spacing(h, i + 1, closed, clamped))


@inlined
def middle(h1, h2, h3, after):
    """Coefficients in u of C_{i+1} on [t_i, t_{i+1}] for h_{i-1}, h_i, h_{i+1}; after = m_{i+1}.

    C_i = 1 - m_i (1 - u)^3 and C_{i+2} = p_{i+1} u^3; this one rises from p_i to 1 - m_{i+1}.
    """
    g = 1.0 / ((h1 + h2) * (h1 + h2 + h3))
    c0, c1, c2 = g * h1 * h1, 3.0 * g * h1 * h2, 3.0 * g * h2 * h2
    return c0, c1, c2, 1.0 - after - c0 - c1 - c2


@inlined
def blending(h0, h1, h2, h3, h4, u):
    """B_{i-1} ... B_{i+2} at u on [t_i, t_{i+1}], from h_{i-2} ... h_{i+2}."""
    c0, c1, c2, c3 = middle(h1, h2, h3, weight_before(h1, h2, h3))
    v = 1.0 - u
    first = weight_before(h0, h1, h2) * v * v * v
    last = weight_after(h2, h3, h4) * u * u * u
    inner = ((c3 * u + c2) * u + c1) * u + c0
    return first, 1.0 - first - inner, inner - last, last


@compiled
def set_segment(segments, i, base, x, y, z, m0, coefficients, p1):
    """Constants of (1) for segment i: base d_{i-1}, increments x, y, z; returns the reach."""
    c0, c1, c2, c3 = coefficients
    set_base(segments, i, base[0], base[1], base[2], base[3])
    first = set_factor(
        segments, i, 0, x[0], x[1], x[2], 1.0 - m0, 3.0 * m0, -3.0 * m0, m0, 0.0, 0.0
    )
    second = set_factor(segments, i, 1, y[0], y[1], y[2], c0, c1, c2, c3, 0.0, 0.0)
    third = set_factor(segments, i, 2, z[0], z[1], z[2], 0.0, 0.0, 0.0, p1, 0.0, 0.0)
    return max(first, second, third)


@compiled
def set_phantoms(w, closed, clamped):
    """w_0 and w_{N+1} from the others: wrapped, or repeated; a clamped curve's are given."""
    n = w.shape[1] - 2
    for c in range(3):
        if closed:
            w[c, 0], w[c, n + 1] = w[c, n], w[c, 1]
        elif not clamped:
            w[c, 0], w[c, n + 1] = w[c, 1], w[c, n]


@compiled
def increments(d, w):
    """w_j = ln(d_{j-1}^-1 d_j), j = 1 ... N."""
    for j in range(1, d.shape[1]):
        w[0, j], w[1, j], w[2, j] = log_between(*control(d, j - 1), *control(d, j))


@inlined
def _following(whole, w, gap):
    """Jr(2 w)^-1 gap: what w gains when whole = exp(w) is followed by a small turn."""
    n = squared(w)
    side = cross(*w, *gap)
    bend = cross(*w, *side)
    f = 1.0 / 3.0 + n / 45.0
    if n > 1e-4:
        length = math.sqrt(n)
        f = (1.0 - length * whole[0] / math.sin(length)) / n
    return (
        gap[0] + side[0] + f * bend[0],
        gap[1] + side[1] + f * bend[1],
        gap[2] + side[2] + f * bend[2],
    )


@compiled
def tie(d, w):
    """Bring free increments back onto the controls, d_j = d_{j-1} exp(w_j), to first order.

    An unfinished solve leaves gaps that would be jumps of the curve; tied, it is C^2 and misses
    keyframes instead.  Lengths may exceed pi, where the logarithm is on another branch, hence
    a correction.  Returns the largest gap met.
    """
    worst = 0.0
    for j in range(1, d.shape[1]):
        whole = turned(1.0, increment(w, j))
        gap = small_log(*between(*whole, *between(*control(d, j - 1), *control(d, j))))
        worst = max(worst, squared(gap))
        if squared(gap) > ROUNDING * ROUNDING:
            x, y, z = _following(whole, increment(w, j), gap)
            w[0, j] += x
            w[1, j] += y
            w[2, j] += z
    return math.sqrt(worst)


@inlined
def _miss(base, turn, q, i, sign):
    """|vec| squared of (base turn)^-1 q_i; 1 where they are more than half a turn apart."""
    w, x, y, z = mul(*base, *turn)
    w, x, y, z = between(w, x, y, z, sign * q[i, 0], sign * q[i, 1], sign * q[i, 2], sign * q[i, 3])
    return x * x + y * y + z * z if w > 0.0 else 1.0


@compiled
def write_segments(q, h, closed, clamped, sign, d, w, segments):
    """Constants of (1) from controls d and the increments w between them, phantoms included.

    Returns (reach, residual): the largest half angle that a sample meets, and the largest miss
    at a keyframe in rad, taken on both of its sides with the constants that were written.
    """
    n = h.size
    reach = worst = 0.0
    set_phantoms(w, closed, clamped)
    x, y = increment(w, 0), increment(w, 1)
    base = mul(*control(d, 0), *turned(-1.0, x))
    h1, h2, h3 = spacing(h, -1, closed, clamped), h[0], spacing(h, 1, closed, clamped)
    m0 = weight_before(spacing(h, -2, closed, clamped), h1, h2)
    turn = mul(*turned(1.0 - m0, x), *turned(weight_after(h1, h2, h3), y))
    for i in range(n):
        h4 = spacing(h, i + 2, closed, clamped)
        m1, p1 = weight_before(h1, h2, h3), weight_after(h2, h3, h4)
        z = increment(w, i + 2)
        reach = max(reach, set_segment(segments, i, base, x, y, z, m0, middle(h1, h2, h3, m1), p1))
        worst = max(worst, _miss(base, turn, q, i, 1.0))
        whole = mul(*base, *turned(1.0, x))
        turn = mul(*turned(1.0 - m1, y), *turned(p1, z))
        last = closed and i == n - 1
        worst = max(worst, _miss(whole, turn, q, 0 if last else i + 1, sign if last else 1.0))
        base = control(d, i)
        h1, h2, h3, m0, x, y = h2, h3, h4, m1, y, z
    return reach, 2.0 * math.asin(min(1.0, math.sqrt(worst)))


@inlined
def end_velocity(q, h, at_end):
    """Chart estimate of q^-1 q' at an end of an open curve, from the last WINDOW keyframes."""
    time, x = np.empty(5), np.empty((5, 3))
    return chart_velocity(q, h, False, 1.0, q.shape[0] - 1 if at_end else 0, WINDOW, time, x)
