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

import numpy as np

from quatspline.families.cumulative import SIDE, set_base, set_turn
from quatspline.families.polynomials import bound, hermite
from quatspline.kernels.jit import REACH, compiled, fit_kernel, inlined
from quatspline.kernels.scalars import turn


@compiled
def _steps(q, sign, closed, d):
    """|D_j| and the axis of D_j into the rows of d (4, n + 2 or n + 1), column 0 being j = -1.

    Closed curves wrap; beyond the ends of open ones steps are zero.
    """
    n = q.shape[0]
    length, nx, ny, nz = d[0], d[1], d[2], d[3]
    parts = np.empty((4, n))  # component first: the loop below vectorises
    w, x, y, z = parts[0], parts[1], parts[2], parts[3]
    for j in range(n):
        w[j], x[j], y[j], z[j] = q[j, 0], q[j, 1], q[j, 2], q[j, 3]
    for j in range(n - 1):
        length[j + 1], nx[j + 1], ny[j + 1], nz[j + 1] = turn(
            w[j], x[j], y[j], z[j], w[j + 1], x[j + 1], y[j + 1], z[j + 1]
        )
    last = d.shape[1] - 1
    for c in range(4):
        d[c, 0] = d[c, last] = 0.0
    if closed:
        length[n], nx[n], ny[n], nz[n] = turn(
            q[n - 1, 0], q[n - 1, 1], q[n - 1, 2], q[n - 1, 3],
            sign * q[0, 0], sign * q[0, 1], sign * q[0, 2], sign * q[0, 3],
        )  # fmt: skip
        for c in range(4):
            d[c, 0], d[c, last] = d[c, n], d[c, 1]


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
def _set(segments, i, k, d, j, c):
    set_turn(segments, i, k, d[0, j], d[1, j], d[2, j], d[3, j], c[0], c[1], c[2], c[3], c[4], c[5])


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Constants of (1); parameters[0] is kappa."""
    k = 2.0 * parameters[0]
    d = np.empty((4, h.size + 2))
    _steps(q, sign, closed, d)
    h0, h1, h2 = _spacing(h, -1, closed), h[0], _spacing(h, 1, closed)
    f1, f2, f3 = _exponents(h0, h1, h2, k)
    m1, m2, m3 = _bound(f1), _bound(f2), _bound(f3)
    reach = 0.0
    for i in range(h.size):
        after = _spacing(h, i + 1, closed)
        if i > 0 and not (h1 == h0 and h[i] == h1 and after == h2):
            h0, h1, h2 = h[i - 1], h[i], after
            f1, f2, f3 = _exponents(h0, h1, h2, k)
            m1, m2, m3 = _bound(f1), _bound(f2), _bound(f3)
        set_base(segments, i, q[i, 0], q[i, 1], q[i, 2], q[i, 3])
        _set(segments, i, 0, d, i, f1)
        _set(segments, i, 1, d, i + 1, f2)
        _set(segments, i, 2, d, i + 2, f3)
        reach = max(reach, SIDE * max(d[0, i] * m1, d[0, i + 2] * m3), d[0, i + 1] * m2)
    report[REACH] = reach
