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
from quatspline.fitting.bspline import spacing
from quatspline.kernels.jit import REACH, compiled, fit_kernel, inlined
from quatspline.kernels.values import (
    keyframe,
    put_quat_column,
    quat_at,
    quat_column,
    turn,
    vec_column,
)


@compiled
def _steps(q, sign, closed):
    """The axis of D_j and |D_j| as columns (4, n + 2 or n + 1), column 0 being j = -1.

    Closed curves wrap; beyond the ends of open ones steps are zero.
    """
    n = q.shape[0]
    d, points = np.zeros((4, n + 1 + closed)), np.empty((4, n))
    for j in range(n):  # component first: the loop below vectorises
        put_quat_column(points, j, quat_at(q[j], 0))
    for j in range(n - 1):
        _put(d, j + 1, quat_column(points, j), quat_column(points, j + 1))
    if closed:
        _put(d, n, keyframe(q, n - 1, sign), keyframe(q, n, sign))
        d[:, 0], d[:, n + 1] = d[:, n], d[:, 1]
    return d


@inlined
def _put(d, j, p, q):
    length, n = turn(p, q)
    d[0, j], d[1, j], d[2, j], d[3, j] = n.x, n.y, n.z, length


@inlined
def _exponents(h0, h1, h2, k):
    """f_1, f_2, f_3 with their bounds: (2) and (3) per unit of D, times h_1 and h_1^2."""
    left, right = h1 / (h0 + h1), h1 / (h1 + h2)
    f1 = hermite(0.0, left * h1 / h0, -k * left * h1 / h0, 0.0, 0.0, 0.0)
    f2 = hermite(0.0, left * h0 / h1, k * left, 1.0, right * h2 / h1, -k * right)
    f3 = hermite(0.0, 0.0, 0.0, 0.0, right * h1 / h2, k * right * h1 / h2)
    return (f1, f2, f3), (SIDE * bound(*f1), bound(*f2), SIDE * bound(*f3))


@inlined
def _set(c, k, d, j, f):
    set_turn(c, k, d[3, j], vec_column(d, j), f)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Constants of (1); parameters[0] is kappa."""
    k, d = 2.0 * parameters[0], _steps(q, sign, closed)
    h0, h1, h2 = spacing(h, -1, closed, False), h[0], spacing(h, 1, closed, False)
    f, m = _exponents(h0, h1, h2, k)
    reach = 0.0
    for i in range(h.size):
        after = spacing(h, i + 1, closed, False)
        if i > 0 and not (h1 == h0 and h[i] == h1 and after == h2):
            h0, h1, h2 = h[i - 1], h[i], after
            f, m = _exponents(h0, h1, h2, k)
        c = segments[i]
        set_base(c, quat_at(q[i], 0))
        _set(c, 0, d, i, f[0])
        _set(c, 1, d, i + 1, f[1])
        _set(c, 2, d, i + 2, f[2])
        reach = max(reach, m[0] * d[3, i], m[1] * d[3, i + 1], m[2] * d[3, i + 2])
    report[REACH] = reach
