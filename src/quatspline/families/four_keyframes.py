"""The construction of the paper on four keyframes, for any knots and any curvature weight.

On segment i, with steps D_j = ln(q_j^-1 q_{j+1}) and spacings h_j,

    Q(u) = q_i exp(f_1(u) D_{i-1}) exp(f_2(u) D_i) exp(f_3(u) D_{i+1})                            (1)

where f_1 goes from 0 to 0, f_2 from 0 to 1 and f_3 from 0 to 0 (the paper writes q_{i-1} and f_1 + 1).
Each f is the quintic Hermite interpolant of the coefficients that make, at every knot,

    Q' ~ v_i = (h_i s_{i-1} + h_{i-1} s_i) / (h_{i-1} + h_i),      s_j = D_j / h_j                 (2)
    Q'' ~ a_i = 2 kappa (s_i - s_{i-1}) / (h_{i-1} + h_i)                                          (3)

With kappa = 3 the term u^5 vanishes: the paper's quartic [xing2017].  kappa = 1 takes the second
derivative of the parabola through three keyframes.  Ghost keyframes repeat the ends.
"""

from __future__ import annotations

from quatspline._jit import fit_kernel, inlined
from quatspline.families.cumulative import bound, hermite, set_base, set_turn
from quatspline.primitives import log_between, polar


@inlined
def _step(q, i, sign, closed):
    """|D_i| and the axis of D_i, with the wrap of closed curves; 0 beyond the ends of open ones."""
    n = q.shape[0]
    if not closed and (i < 0 or i >= n - 1):
        return 0.0, 0.0, 0.0, 0.0
    if i < 0:
        i += n
    elif i >= n:
        i -= n
    j, s = i + 1, 1.0
    if j == n:
        j, s = 0, sign
    x, y, z = log_between(
        q[i, 0], q[i, 1], q[i, 2], q[i, 3], s * q[j, 0], s * q[j, 1], s * q[j, 2], s * q[j, 3]
    )
    return polar(x, y, z)


@inlined
def _spacing(h, i, closed):
    """h_i, wrapped or, beyond the ends of an open curve, equal to its neighbour."""
    if i < 0:
        return h[h.size - 1] if closed else h[0]
    if i >= h.size:
        return h[0] if closed else h[h.size - 1]
    return h[i]


@inlined
def _exponents(h0, h1, h2, k):
    """Coefficients of f_1, f_2, f_3 in u: (2) and (3) per unit of D, times h_1 and h_1^2."""
    left, right = h1 / (h0 + h1), h1 / (h1 + h2)
    return (
        hermite(0.0, left * h1 / h0, -k * left * h1 / h0, 0.0, 0.0, 0.0),
        hermite(0.0, left * h0 / h1, k * left, 1.0, right * h2 / h1, -k * right),
        hermite(0.0, 0.0, 0.0, 0.0, right * h1 / h2, k * right * h1 / h2),
    )


@inlined
def _bound(c):
    return bound(c[0], c[1], c[2], c[3], c[4], c[5])


@inlined
def _set(segments, i, k, v, c):
    set_turn(segments, i, k, v[0], v[1], v[2], v[3], c[0], c[1], c[2], c[3], c[4], c[5])


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Constants of (1); parameters[0] is kappa."""
    k = 2.0 * parameters[0]
    a, b = _step(q, -1, sign, closed), _step(q, 0, sign, closed)
    h0, h1, h2 = _spacing(h, -1, closed), h[0], _spacing(h, 1, closed)
    f1, f2, f3 = _exponents(h0, h1, h2, k)
    m1, m2, m3 = _bound(f1), _bound(f2), _bound(f3)
    reach = 0.0
    for i in range(h.size):
        c = _step(q, i + 1, sign, closed)
        after = _spacing(h, i + 1, closed)
        if i > 0 and not (h1 == h0 and h[i] == h1 and after == h2):
            h0, h1, h2 = h[i - 1], h[i], after
            f1, f2, f3 = _exponents(h0, h1, h2, k)
            m1, m2, m3 = _bound(f1), _bound(f2), _bound(f3)
        set_base(segments, i, q[i, 0], q[i, 1], q[i, 2], q[i, 3])
        _set(segments, i, 0, a, f1)
        _set(segments, i, 1, b, f2)
        _set(segments, i, 2, c, f3)
        reach = max(reach, a[0] * m1, b[0] * m2, c[0] * m3)
        a, b = b, c
    report[3] = reach
