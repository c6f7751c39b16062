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
from quatspline.kernels.jacobians import inverse_right_jacobian
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.quick import exp, log
from quatspline.kernels.values import keyframe, put_vec_column, quat_column, vec, vec_column

WINDOW = 4
"""Keyframes in the chart estimate of an end velocity: one more than the curve's order."""

ROUNDING = 1e-14
"""Half angles below this are rounding."""

TIES, QUADRATIC = 3, 1e-8
"""Corrections by `tie` at most; each squares the gap, and after one of 1e-8 nothing is left."""


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


@compiled
def set_segment(c, base, x, y, z, m0, coefficients, p1):
    """Constants of (1): base d_{i-1}, increments x, y, z; returns the reach."""
    set_base(c, base)
    first = set_factor(c, 0, x, (1.0 - m0, 3.0 * m0, -3.0 * m0, m0, 0.0, 0.0))
    second = set_factor(c, 1, y, (*coefficients, 0.0, 0.0))
    third = set_factor(c, 2, z, (0.0, 0.0, 0.0, p1, 0.0, 0.0))
    return max(first, second, third)


@compiled
def set_phantoms(w, closed, clamped):
    """w_0 and w_{N+1} from the others: wrapped, or repeated; a clamped curve's are given."""
    n = w.shape[1] - 2
    if closed or not clamped:
        put_vec_column(w, 0, vec_column(w, n if closed else 1))
        put_vec_column(w, n + 1, vec_column(w, 1 if closed else n))


@compiled
def increments(d, w):
    """w_j = ln(d_{j-1}^-1 d_j), j = 1 ... N."""
    for j in range(1, d.shape[1]):
        put_vec_column(w, j, log(~quat_column(d, j - 1) * quat_column(d, j)))


@compiled
def tie(d, w):
    """Bring free increments back onto the controls, d_j = d_{j-1} exp(w_j), to first order.

    An unfinished solve leaves gaps that would be jumps of the curve; tied, it is C^2 and misses
    keyframes instead.  Lengths may exceed pi, where the logarithm is on another branch, hence
    a correction.  Returns the largest gap met.
    """
    worst = 0.0
    for j in range(1, d.shape[1]):
        step = vec_column(w, j)
        gap = log(~exp(step) * (~quat_column(d, j - 1) * quat_column(d, j)))
        worst = max(worst, gap @ gap)
        if gap @ gap > ROUNDING * ROUNDING:
            put_vec_column(w, j, step + inverse_right_jacobian(step, gap))
    return math.sqrt(worst)


@compiled
def settle(d, w, met):
    """Increments that lead exactly from control to control, d_{k+1} = d_k exp(w_{k+1})."""
    if not met:
        increments(d, w)
    else:
        for _ in range(TIES):
            if tie(d, w) <= QUADRATIC:
                break


@inlined
def _miss(p, q):
    """|vec| squared of ~p q; 1 where they are more than half a turn apart."""
    miss = ~p * q
    return vec(miss) @ vec(miss) if miss.w > 0.0 else 1.0


@compiled
def write_segments(q, h, closed, clamped, sign, d, w, segments):
    """Constants of (1) from controls d and the increments w between them, phantoms included.

    Returns (reach, residual): the largest half angle that a sample meets, and the largest miss
    at a keyframe in rad, taken on both of its sides with the constants that were written.
    """
    reach = worst = 0.0
    set_phantoms(w, closed, clamped)
    x, y = vec_column(w, 0), vec_column(w, 1)
    base = quat_column(d, 0) * exp(-x)
    h1, h2, h3 = spacing(h, -1, closed, clamped), h[0], spacing(h, 1, closed, clamped)
    m0 = weight_before(spacing(h, -2, closed, clamped), h1, h2)
    turn = exp((1.0 - m0) * x) * exp(weight_after(h1, h2, h3) * y)
    for i in range(h.size):
        h4 = spacing(h, i + 2, closed, clamped)
        m1, p1 = weight_before(h1, h2, h3), weight_after(h2, h3, h4)
        z = vec_column(w, i + 2)
        reach = max(reach, set_segment(segments[i], base, x, y, z, m0, middle(h1, h2, h3, m1), p1))
        start = base * turn
        turn = exp((1.0 - m1) * y) * exp(p1 * z)
        end = base * exp(x) * turn
        worst = max(worst, _miss(start, keyframe(q, i, sign)))
        worst = max(worst, _miss(end, keyframe(q, i + 1, sign)))
        base = quat_column(d, i)
        h1, h2, h3, m0, x, y = h2, h3, h4, m1, y, z
    return reach, 2.0 * math.asin(min(1.0, math.sqrt(worst)))


@inlined
def end_velocity(q, h, at_end):
    """Chart estimate of q^-1 q' at an end of an open curve, from the last WINDOW keyframes."""
    i = q.shape[0] - 1 if at_end else 0
    return chart_velocity(q, h, False, 1.0, i, WINDOW, np.empty((5, 4)))
