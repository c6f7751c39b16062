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
from quatspline.families.cumulative import hermite, set_base, set_factor
from quatspline.primitives import log_between


@inlined
def _step(q, i, sign, closed):
    """D_i = ln(q_i^-1 q_{i+1}) with the wrap of closed curves; 0 beyond the ends of open ones."""
    n = q.shape[0]
    if closed:
        i %= n
    elif i < 0 or i >= n - 1:
        return 0.0, 0.0, 0.0
    j, s = i + 1, 1.0
    if j == n:
        j, s = 0, sign
    return log_between(
        q[i, 0], q[i, 1], q[i, 2], q[i, 3], s * q[j, 0], s * q[j, 1], s * q[j, 2], s * q[j, 3]
    )


@inlined
def _spacing(h, i, closed):
    """h_i, wrapped or, beyond the ends of an open curve, equal to its neighbour."""
    if closed:
        return h[i % h.size]
    return h[min(max(i, 0), h.size - 1)]


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):  # noqa: N802 - a constant
    """Constants of (1); parameters[0] is kappa."""
    kappa = parameters[0]
    ax, ay, az = _step(q, -1, sign, closed)
    bx, by, bz = _step(q, 0, sign, closed)
    reach = 0.0
    for i in range(h.size):
        cx, cy, cz = _step(q, i + 1, sign, closed)
        h0, h1, h2 = _spacing(h, i - 1, closed), h[i], _spacing(h, i + 1, closed)
        left, right = h1 / (h0 + h1), h1 / (h1 + h2)
        # (2) and (3) per unit of D, in u: slopes times h_1, second derivatives times h_1^2
        set_base(segments, i, q[i, 0], q[i, 1], q[i, 2], q[i, 3])
        k = 2.0 * kappa
        c = hermite(0.0, left * h1 / h0, -k * left * h1 / h0, 0.0, 0.0, 0.0)
        r1 = set_factor(segments, i, 0, ax, ay, az, c[0], c[1], c[2], c[3], c[4], c[5])
        c = hermite(0.0, left * h0 / h1, k * left, 1.0, right * h2 / h1, -k * right)
        r2 = set_factor(segments, i, 1, bx, by, bz, c[0], c[1], c[2], c[3], c[4], c[5])
        c = hermite(0.0, 0.0, 0.0, 0.0, right * h1 / h2, k * right * h1 / h2)
        r3 = set_factor(segments, i, 2, cx, cy, cz, c[0], c[1], c[2], c[3], c[4], c[5])
        reach = max(reach, r1, r2, r3)
        ax, ay, az, bx, by, bz = bx, by, bz, cx, cy, cz
    report[3] = reach
