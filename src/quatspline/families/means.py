"""Spherical averages: curves whose points are weighted means on S^3 of four control quaternions.

The mean of p_j with weights w_j (sum 1) is the Q that solves [buss2001]

    sum_j w_j l_j = 0,    l_j = ln(Q^-1 p_j),                                                       (1)

by Newton: Q <- Q exp(H^-1 g), g the left side of (1), H = sum_j w_j Jl^-1(2 l_j).  At the mean H is
symmetric (its other part is [g]) and positive definite while all p_j lie within a quarter turn of Q.
With weights B_j(t), v = omega/2 and K_j = Jl^-1(2 l_j), derivatives of (1) give

    H v = sum_j B_j' l_j,                                                                           (2)
    H v' = sum_j B_j'' l_j - 2 B_j' K_j v - B_j dK_j v,    l_j' = -K_j v.                            (3)

Here B_j are the four basis functions of a cubic B-spline on a segment (`bspline`).
"""

from __future__ import annotations

import math

from numba import carray

from quatspline.kernels.jit import BLOCK, CONSTANTS, RESULT, ROWS, compiled, inlined, sample_kernel
from quatspline.kernels.scalars import cross, exp, log_between, mul
from quatspline.segments import Family

# notation: the constants of a segment are d_{i-1} ... d_{i+2} (16), m_i, the coefficients from u^0 to
# u^3 of B_{i+1} + B_{i+2} (4), and p_{i+1}: B_{i-1} = m_i (1 - u)^3, B_{i+2} = p_{i+1} u^3.
WEIGHTS = 16
SIZE = 22
_D, _W = CONSTANTS, CONSTANTS + WEIGHTS

SERIES = 0.25
"""Below this |l|^2 the ten Taylor terms reach rounding."""

STEPS = 50
"""Steps for one mean: Newton takes 2 or 3; points beyond a quarter turn need more."""
CLOSE = 1e-8
"""A Newton step this short squares to less than rounding: it is the last."""


@inlined
def curvature(r):
    """k = (1 - x cot x)/x^2 of r = x^2, of which Jl^-1(2 l) = I - [l] + k [l]^2 is made, x = |l|."""
    if r < SERIES:
        return 1 / 3 + r * (
            1 / 45
            + r
            * (
                2 / 945
                + r
                * (
                    1 / 4725
                    + r
                    * (
                        2 / 93555
                        + r
                        * (
                            1382 / 638512875
                            + r
                            * (
                                4 / 18243225
                                + r
                                * (
                                    3617 / 162820783125
                                    + r * (87734 / 38979295480125 + r * (349222 / 1531329465290625))
                                )
                            )
                        )
                    )
                )
            )
        )
    x = math.sqrt(r)
    return (1.0 - x / math.tan(x)) / r


@inlined
def _slope(r, k):
    """dk/dr, given k = `curvature` of r."""
    if r < SERIES:
        return 1 / 45 + r * (
            4 / 945
            + r
            * (
                1 / 1575
                + r
                * (
                    8 / 93555
                    + r
                    * (
                        1382 / 127702575
                        + r
                        * (
                            8 / 6081075
                            + r
                            * (
                                3617 / 23260111875
                                + r * (701872 / 38979295480125 + r * (349222 / 170147718365625))
                            )
                        )
                    )
                )
            )
        )
    sine = math.sin(math.sqrt(r))
    # x cot x = 1 - k r
    return (r / (sine * sine) - 1.0 - k * r) / (2.0 * r * r)


@inlined
def _mixed(w, a, b, c, d):
    """The weighted sum of four tuples of three."""
    return (
        w[0] * a[0] + w[1] * b[0] + w[2] * c[0] + w[3] * d[0],
        w[0] * a[1] + w[1] * b[1] + w[2] * c[1] + w[3] * d[1],
        w[0] * a[2] + w[1] * b[2] + w[2] * c[2] + w[3] * d[2],
    )


@inlined
def _symmetric(l):
    """The symmetric part of Jl^-1(2 l), (xx, xy, xz, yy, yz, zz): I + k [l]^2."""
    x, y, z = l
    r = x * x + y * y + z * z
    k = curvature(r)
    return (
        1.0 + k * (x * x - r),
        k * x * y,
        k * x * z,
        1.0 + k * (y * y - r),
        k * y * z,
        1.0 + k * (z * z - r),
    )


@inlined
def _solved(a, b, c, d, w, g):
    """H^-1 g, or g itself (the gradient step) where H, of four points' logs, is not definite."""
    a, b, c, d = _symmetric(a), _symmetric(b), _symmetric(c), _symmetric(d)
    h00, h01, h02 = _mixed(w, a[:3], b[:3], c[:3], d[:3])
    h11, h12, h22 = _mixed(w, a[3:], b[3:], c[3:], d[3:])
    c00, c01, c02 = h11 * h22 - h12 * h12, h02 * h12 - h01 * h22, h01 * h12 - h02 * h11
    c11, c12, c22 = h00 * h22 - h02 * h02, h01 * h02 - h00 * h12, h00 * h11 - h01 * h01
    det = h00 * c00 + h01 * c01 + h02 * c02
    if not (h00 > 0.0 and c22 > 0.0 and det > 0.0):
        return g
    k = 1.0 / det
    return (
        k * (c00 * g[0] + c01 * g[1] + c02 * g[2]),
        k * (c01 * g[0] + c11 * g[1] + c12 * g[2]),
        k * (c02 * g[0] + c12 * g[1] + c22 * g[2]),
    )


@inlined
def _log(q, p):
    return log_between(q[0], q[1], q[2], q[3], p[0], p[1], p[2], p[3])


@inlined
def logs(q, a, b, c, d):
    """l_j of (1) for four points."""
    return _log(q, a), _log(q, b), _log(q, c), _log(q, d)


@compiled
def newton_step(q, a, b, c, d, w):
    """H^-1 g of (1) at q."""
    la, lb, lc, ld = logs(q, a, b, c, d)
    return _solved(la, lb, lc, ld, w, _mixed(w, la, lb, lc, ld))


@compiled
def mean(a, b, c, d, w):
    """(1) from the normalised sum of w_j p_j; any weights that sum to one, some may be zero."""
    s, x, y, z = (
        w[0] * a[0] + w[1] * b[0] + w[2] * c[0] + w[3] * d[0],
        w[0] * a[1] + w[1] * b[1] + w[2] * c[1] + w[3] * d[1],
        w[0] * a[2] + w[1] * b[2] + w[2] * c[2] + w[3] * d[2],
        w[0] * a[3] + w[1] * b[3] + w[2] * c[3] + w[3] * d[3],
    )
    length = math.sqrt(s * s + x * x + y * y + z * z)
    k = 1.0 / length if length > 0.0 else 0.0
    q = (k * s, k * x, k * y, k * z) if length > 0.0 else b
    for _ in range(STEPS):
        x, y, z = newton_step(q, a, b, c, d, w)
        step = x * x + y * y + z * z
        q = mul(q[0], q[1], q[2], q[3], *exp(x, y, z))
        if step < CLOSE * CLOSE:
            break
    k = 1.0 / math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return k * q[0], k * q[1], k * q[2], k * q[3]


@inlined
def _weights(s, j, u):
    """B_{i-1} ... B_{i+2} and their first and second derivatives by u."""
    c = _W
    m, p, v = s[c, j], s[c + 5, j], 1.0 - u
    c1, c2, c3 = s[c + 2, j], s[c + 3, j], s[c + 4, j]
    inner = ((c3 * u + c2) * u + c1) * u + s[c + 1, j]
    inner1 = (3.0 * c3 * u + 2.0 * c2) * u + c1
    inner2 = 6.0 * c3 * u + 2.0 * c2
    f, f1, f2 = m * v * v * v, -3.0 * m * v * v, 6.0 * m * v
    g, g1, g2 = p * u * u * u, 3.0 * p * u * u, 6.0 * p * u
    return (
        (f, 1.0 - f - inner, inner - g, g),
        (f1, -f1 - inner1, inner1 - g1, g1),
        (f2, -f2 - inner2, inner2 - g2, g2),
    )


@inlined
def _control(s, k, j):
    c = _D + 4 * k
    return s[c, j], s[c + 1, j], s[c + 2, j], s[c + 3, j]


@inlined
def _controls(s, j):
    return _control(s, 0, j), _control(s, 1, j), _control(s, 2, j), _control(s, 3, j)


@sample_kernel
def ORIENTATION(sheet, n):
    """The mean of the segment's controls."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        a, b, c, d = _controls(s, j)
        q = mean(a, b, c, d, _weights(s, j, s[0, j])[0])
        s[RESULT, j] = q[0]
        s[RESULT + 1, j] = q[1]
        s[RESULT + 2, j] = q[2]
        s[RESULT + 3, j] = q[3]


@sample_kernel
def VELOCITY(sheet, n):
    """(2)."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        a, b, c, d = _controls(s, j)
        w, w1, _ = _weights(s, j, s[0, j])
        la, lb, lc, ld = logs(mean(a, b, c, d, w), a, b, c, d)
        x, y, z = _solved(la, lb, lc, ld, w, _mixed(w1, la, lb, lc, ld))
        k = 2.0 * s[1, j]
        s[RESULT, j] = k * x
        s[RESULT + 1, j] = k * y
        s[RESULT + 2, j] = k * z


@inlined
def _bent(l, v):
    """K v and dK v of (3) for one point, K = I - [l] + k [l]^2 and l' = -K v."""
    x, y, z = l
    r = x * x + y * y + z * z
    k = curvature(r)
    tx, ty, tz = cross(x, y, z, v[0], v[1], v[2])
    ux, uy, uz = cross(x, y, z, tx, ty, tz)
    kx, ky, kz = v[0] - tx + k * ux, v[1] - ty + k * uy, v[2] - tz + k * uz
    # dK v = -l' x v + k (l' x t + l x (l' x v)) + 2 k' (l . l') u,  t = l x v,  u = l x t
    ax, ay, az = cross(kx, ky, kz, v[0], v[1], v[2])
    bx, by, bz = cross(kx, ky, kz, tx, ty, tz)
    cx, cy, cz = cross(x, y, z, ax, ay, az)
    f = -2.0 * _slope(r, k) * (x * kx + y * ky + z * kz)
    return (kx, ky, kz), (
        ax - k * (bx + cx) + f * ux,
        ay - k * (by + cy) + f * uy,
        az - k * (bz + cz) + f * uz,
    )


@sample_kernel
def ACCELERATION(sheet, n):
    """(3)."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        a, b, c, d = _controls(s, j)
        w, w1, w2 = _weights(s, j, s[0, j])
        la, lb, lc, ld = logs(mean(a, b, c, d, w), a, b, c, d)
        v = _solved(la, lb, lc, ld, w, _mixed(w1, la, lb, lc, ld))
        ka, ea = _bent(la, v)
        kb, eb = _bent(lb, v)
        kc, ec = _bent(lc, v)
        kd, ed = _bent(ld, v)
        x, y, z = _mixed(w2, la, lb, lc, ld)
        kx, ky, kz = _mixed(w1, ka, kb, kc, kd)
        ex, ey, ez = _mixed(w, ea, eb, ec, ed)
        right = (x - 2.0 * kx - ex, y - 2.0 * ky - ey, z - 2.0 * kz - ez)
        x, y, z = _solved(la, lb, lc, ld, w, right)
        k = 2.0 * s[1, j] * s[1, j]
        s[RESULT, j] = k * x
        s[RESULT + 1, j] = k * y
        s[RESULT + 2, j] = k * z


_KERNELS = (ORIENTATION, VELOCITY, ACCELERATION)

SPHERICAL_MEAN = Family(SIZE, near=_KERNELS, far=_KERNELS)
"""Evaluates means with the weights of a cubic B-spline."""
