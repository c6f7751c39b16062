"""Nested slerps: triangles of three arcs (de Casteljau, Barry & Goldman) and squads of two.

Triangle: three arcs p_k at x_k(u), then slerp(p_0, p_1, y_0(u)) and slerp(p_1, p_2, y_1(u)), then
slerp of those two at z(u), all parameters affine in u.  De Casteljau's algorithm has x = y = z = u.

Squad: slerp(p_0(u), p_1(u), 2u(1 - u)).

Rates propagate 2-jets (p, p', p'') in R^4 through slerp(a, b, u) = f(1 - u) a + f(u) b with

    f(v) = sin(v theta)/sin(theta) = v sigma(v^2 z) / sigma(z),  z = theta^2                     (1)

where sigma(z) = sin(theta)/theta is entire in z, and so is |a - b|^2 as a function of z: no angle,
however small, loses digits.
"""

from __future__ import annotations

import math

from numba import carray

from quatspline.families.arcs import SIZE as ARC_SIZE
from quatspline.families.arcs import along
from quatspline.kernels.jit import BLOCK, CONSTANTS, RESULT, ROWS, inlined, sample_kernel, whole
from quatspline.kernels.scalars import (
    S1,
    S2,
    S3,
    S4,
    S5,
    S6,
    S7,
    S8,
    TINY,
    arc_angle,
    between,
    sincos,
    slerp,
)
from quatspline.segments import Family

PARAMETERS = 3 * ARC_SIZE
"""First of the six pairs (value at u = 0, slope) of x_0, x_1, x_2, y_0, y_1, z."""

TRIANGLE_SIZE = PARAMETERS + 12
SQUAD_SIZE = 2 * ARC_SIZE

ROUGH = 5e-7
"""Squares of lengths off 1 by more than this are restored by a root: to 1e-13 without one."""

FAR = 2.25
"""z = theta^2 up to which the polynomial of sin(theta)/theta serves (to 2e-14 for its second
derivative); beyond it closed forms."""


@inlined
def set_parameter(segments, i, k, value, slope):
    """Parameter k of x_0, x_1, x_2, y_0, y_1, z."""
    segments[i, PARAMETERS + 2 * k] = value
    segments[i, PARAMETERS + 2 * k + 1] = slope


@inlined
def _parameter(s, k, j, u):
    c = CONSTANTS + PARAMETERS + 2 * k
    return s[c, j] + s[c + 1, j] * u


@inlined
def _arc(s, k, j, x):
    c = CONSTANTS + ARC_SIZE * k
    sine, cosine = sincos(x * s[c + 8, j])
    return along(s, c, j, sine, cosine)


@inlined
def restored(p, other):
    """p / |p|: slerp between near-antipodes has digits to lose; the other where it has lost all."""
    size = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]
    if not size > TINY:
        return other
    k = 1.0 / math.sqrt(size)
    return k * p[0], k * p[1], k * p[2], k * p[3]


@inlined
def _set_unit(s, j, p):
    """p, nearly of unit length, into the result rows; 1 where it is off by more than ROUGH.

    Off by e, 1.5 - |p|^2 / 2 restores the length to 3/2 e^2, without a root and a division.
    """
    size = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]
    off = abs(size - 1.0) <= ROUGH
    k = 1.5 - 0.5 * size if off else 1.0
    _set(s, j, (k * p[0], k * p[1], k * p[2], k * p[3]))
    return 0 if off else 1


@inlined
def _restore(s, n, arc):
    """Result rows to unit length; where a slerp has lost all, to the point of an arc."""
    for j in range(n):
        p = (s[RESULT, j], s[RESULT + 1, j], s[RESULT + 2, j], s[RESULT + 3, j])
        _set(s, j, restored(p, _arc(s, arc, j, s[0, j])))


@inlined
def _set(s, j, q):
    s[RESULT, j] = q[0]
    s[RESULT + 1, j] = q[1]
    s[RESULT + 2, j] = q[2]
    s[RESULT + 3, j] = q[3]


@sample_kernel
def TRIANGLE_ORIENTATION(sheet, n):
    """The triangle of slerps at u."""
    s = carray(sheet, (ROWS, BLOCK))
    rough = 0
    for j in range(n):
        u = s[0, j]
        a0, a1, a2, a3 = _arc(s, 0, j, _parameter(s, 0, j, u))
        b0, b1, b2, b3 = _arc(s, 1, j, _parameter(s, 1, j, u))
        c0, c1, c2, c3 = _arc(s, 2, j, _parameter(s, 2, j, u))
        a0, a1, a2, a3 = slerp(a0, a1, a2, a3, b0, b1, b2, b3, _parameter(s, 3, j, u))
        b0, b1, b2, b3 = slerp(b0, b1, b2, b3, c0, c1, c2, c3, _parameter(s, 4, j, u))
        a0, a1, a2, a3 = slerp(a0, a1, a2, a3, b0, b1, b2, b3, _parameter(s, 5, j, u))
        rough += _set_unit(s, j, (a0, a1, a2, a3))
    if rough > 0:
        _restore(s, n, 1)


@sample_kernel
def SQUAD_ORIENTATION(sheet, n):
    """The squad at u."""
    s = carray(sheet, (ROWS, BLOCK))
    rough = 0
    for j in range(n):
        u = s[0, j]
        a0, a1, a2, a3 = _arc(s, 0, j, u)
        b0, b1, b2, b3 = _arc(s, 1, j, u)
        p = slerp(a0, a1, a2, a3, b0, b1, b2, b3, 2.0 * u * (1.0 - u))
        rough += _set_unit(s, j, p)
    if rough > 0:
        _restore(s, n, 0)


@inlined
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]


@inlined
def _combine(f, a, g, b):
    """f a + g b of 4-tuples."""
    return (
        f * a[0] + g * b[0],
        f * a[1] + g * b[1],
        f * a[2] + g * b[2],
        f * a[3] + g * b[3],
    )


@inlined
def sinc_jet(z):
    """sigma(z) = sin(sqrt z)/sqrt z and its first two derivatives: entire in z, branch-free.

    Beyond FAR by 4 z sigma'' + 6 sigma' + sigma = 0.
    """
    n = min(z, FAR)
    s0 = ((((((S8 * n + S7) * n + S6) * n + S5) * n + S4) * n + S3) * n + S2) * n + S1
    s1 = (
        ((((7.0 * S8 * n + 6.0 * S7) * n + 5.0 * S6) * n + 4.0 * S5) * n + 3.0 * S4) * n + 2.0 * S3
    ) * n + S2
    s2 = (
        (((42.0 * S8 * n + 30.0 * S7) * n + 20.0 * S6) * n + 12.0 * S5) * n + 6.0 * S4
    ) * n + 2.0 * S3
    m = max(z, FAR)
    r = math.sqrt(m)
    sine, cosine = sincos(r)
    k = 0.5 / m
    f0 = sine / r
    f1 = k * (cosine - f0)
    f2 = -k * (0.5 * f0 + 3.0 * f1)
    far = z > FAR
    return (
        f0 if far else 1.0 + n * s0,
        f1 if far else s0 + n * s1,
        f2 if far else 2.0 * s1 + n * s2,
    )


@inlined
def _weight_jet(v, v1, v2, z, z1, z2, d, d1, d2):
    """f, f', f'' of (1) along v(x), z(x), given sigma(z) with its derivatives d, d1, d2 by x."""
    s, sw, sww = sinc_jet(v * v * z)
    w1 = 2.0 * v * v1 * z + v * v * z1
    w2 = 2.0 * (v1 * v1 + v * v2) * z + 4.0 * v * v1 * z1 + v * v * z2
    f = v * s / d
    f1 = (v1 * s + v * sw * w1 - f * d1) / d
    f2 = v2 * s + 2.0 * v1 * sw * w1 + v * (sww * w1 * w1 + sw * w2)
    return f, f1, (f2 - 2.0 * f1 * d1 - f * d2) / d


@inlined
def slerp_jet(a, a1, a2, b, b1, b2, u, u1, u2):
    """The 2-jet of slerp(a(x), b(x), u(x)) from the 2-jets of its arguments."""
    e, e1, e2 = _combine(1.0, a, -1.0, b), _combine(1.0, a1, -1.0, b1), _combine(1.0, a2, -1.0, b2)
    theta, _, _ = arc_angle(a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3])
    # z = theta^2 from |a - b|^2 = 2 (1 - cos(theta)): z' = (|a - b|^2)' / sigma(z)
    z = theta * theta
    d, dz, dzz = sinc_jet(z)
    z1 = 2.0 * _dot(e, e1) / d
    z2 = (2.0 * (_dot(e1, e1) + _dot(e, e2)) - z1 * dz * z1) / d
    d1, d2 = dz * z1, dzz * z1 * z1 + dz * z2
    f, f1, f2 = _weight_jet(1.0 - u, -u1, -u2, z, z1, z2, d, d1, d2)
    g, g1, g2 = _weight_jet(u, u1, u2, z, z1, z2, d, d1, d2)
    p = _combine(f, a, g, b)
    p1 = _combine(1.0, _combine(f1, a, g1, b), 1.0, _combine(f, a1, g, b1))
    p2 = _combine(
        1.0,
        _combine(1.0, _combine(f2, a, g2, b), 2.0, _combine(f1, a1, g1, b1)),
        1.0,
        _combine(f, a2, g, b2),
    )
    return p, p1, p2


@inlined
def _arc_jet(s, k, j, x, slope):
    c = CONSTANTS + ARC_SIZE * k
    theta = s[c + 8, j]
    sine, cosine = sincos(x * theta)
    rate = theta * slope
    p = along(s, c, j, sine, cosine)
    p1 = along(s, c, j, rate * cosine, -rate * sine)
    return p, p1, _combine(-rate * rate, p, 0.0, p)


@inlined
def _slope(s, k, j):
    return s[CONSTANTS + PARAMETERS + 2 * k + 1, j]


@inlined
def _triangle_jet(s, j):
    """q, q', q'' of the triangle with respect to u."""
    u = s[0, j]
    a, a1, a2 = _arc_jet(s, 0, j, _parameter(s, 0, j, u), _slope(s, 0, j))
    b, b1, b2 = _arc_jet(s, 1, j, _parameter(s, 1, j, u), _slope(s, 1, j))
    c, c1, c2 = _arc_jet(s, 2, j, _parameter(s, 2, j, u), _slope(s, 2, j))
    y0, y1, z = _parameter(s, 3, j, u), _parameter(s, 4, j, u), _parameter(s, 5, j, u)
    a, a1, a2 = slerp_jet(a, a1, a2, b, b1, b2, y0, _slope(s, 3, j), 0.0)
    b, b1, b2 = slerp_jet(b, b1, b2, c, c1, c2, y1, _slope(s, 4, j), 0.0)
    return slerp_jet(a, a1, a2, b, b1, b2, z, _slope(s, 5, j), 0.0)


@inlined
def _squad_jet(s, j):
    """q, q', q'' of the squad with respect to u."""
    u = s[0, j]
    a, a1, a2 = _arc_jet(s, 0, j, u, 1.0)
    b, b1, b2 = _arc_jet(s, 1, j, u, 1.0)
    return slerp_jet(a, a1, a2, b, b1, b2, 2.0 * u * (1.0 - u), 2.0 - 4.0 * u, -4.0)


@inlined
def set_rate(s, j, q, derivative, scale):
    """2 vec(q^-1 q^(k)) times scale into the result rows: omega for k = 1, alpha for k = 2."""
    d = derivative
    _, x, y, z = between(q[0], q[1], q[2], q[3], d[0], d[1], d[2], d[3])
    s[RESULT, j] = 2.0 * scale * x
    s[RESULT + 1, j] = 2.0 * scale * y
    s[RESULT + 2, j] = 2.0 * scale * z


@sample_kernel
def TRIANGLE_VELOCITY(sheet, n):
    """omega of the triangle."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(whole(n)):
        q, q1, _ = _triangle_jet(s, j)
        set_rate(s, j, q, q1, s[1, j])


@sample_kernel
def TRIANGLE_ACCELERATION(sheet, n):
    """alpha of the triangle."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(whole(n)):
        q, _, q2 = _triangle_jet(s, j)
        set_rate(s, j, q, q2, s[1, j] * s[1, j])


@sample_kernel
def SQUAD_VELOCITY(sheet, n):
    """omega of the squad."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(whole(n)):
        q, q1, _ = _squad_jet(s, j)
        set_rate(s, j, q, q1, s[1, j])


@sample_kernel
def SQUAD_ACCELERATION(sheet, n):
    """alpha of the squad."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(whole(n)):
        q, _, q2 = _squad_jet(s, j)
        set_rate(s, j, q, q2, s[1, j] * s[1, j])


_TRIANGLE = (TRIANGLE_ORIENTATION, TRIANGLE_VELOCITY, TRIANGLE_ACCELERATION)
_SQUAD = (SQUAD_ORIENTATION, SQUAD_VELOCITY, SQUAD_ACCELERATION)

TRIANGLE = Family(TRIANGLE_SIZE, near=_TRIANGLE, far=_TRIANGLE)
SQUAD = Family(SQUAD_SIZE, near=_SQUAD, far=_SQUAD)
