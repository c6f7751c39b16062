"""Nested slerps: triangles of three arcs (de Casteljau, Barry & Goldman) and squads of two.

Triangle: three arcs p_k at x_k(u), then slerp(p_0, p_1, y_0(u)) and slerp(p_1, p_2, y_1(u)), then
slerp of those two at z(u), all parameters affine in u.  De Casteljau's algorithm has x = y = z = u.

Squad: slerp(p_0(u), p_1(u), 2u(1 - u)).

Rates propagate 2-jets (p, p', p'') in R^4 through slerp(a, b, u) = f(1 - u) a + f(u) b.  With
delta = |a - b|^2 / 2 = 1 - cos(theta), the weight f(v, delta) = sin(v theta)/sin(theta) is analytic
at delta = 0: v 2F1(1 + v, 1 - v; 3/2; delta/2).  Small arcs take the series, others closed forms.
"""

from __future__ import annotations

import math

from quatspline._jit import BLOCK, CONSTANTS, RESULT, ROWS, compiled, inlined, sample_kernel
from quatspline.families.arcs import SIZE as ARC_SIZE
from quatspline.families.arcs import along
from quatspline.families.segments import Family, carray
from quatspline.primitives import between, sincos, slerp

PARAMETERS = 3 * ARC_SIZE
"""First of the six pairs (value at u = 0, slope) of x_0, x_1, x_2, y_0, y_1, z."""

TRIANGLE_SIZE = PARAMETERS + 12
SQUAD_SIZE = 2 * ARC_SIZE

SMALL = 0.03
"""delta below which the series is used: twelve terms reach rounding."""
TERMS = 12


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


@sample_kernel
def TRIANGLE_ORIENTATION(sheet, n):
    """The triangle of slerps at u."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        u = s[0, j]
        a0, a1, a2, a3 = _arc(s, 0, j, _parameter(s, 0, j, u))
        b0, b1, b2, b3 = _arc(s, 1, j, _parameter(s, 1, j, u))
        c0, c1, c2, c3 = _arc(s, 2, j, _parameter(s, 2, j, u))
        a0, a1, a2, a3 = slerp(a0, a1, a2, a3, b0, b1, b2, b3, _parameter(s, 3, j, u))
        b0, b1, b2, b3 = slerp(b0, b1, b2, b3, c0, c1, c2, c3, _parameter(s, 4, j, u))
        a0, a1, a2, a3 = slerp(a0, a1, a2, a3, b0, b1, b2, b3, _parameter(s, 5, j, u))
        s[RESULT, j] = a0
        s[RESULT + 1, j] = a1
        s[RESULT + 2, j] = a2
        s[RESULT + 3, j] = a3


@sample_kernel
def SQUAD_ORIENTATION(sheet, n):
    """The squad at u."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        u = s[0, j]
        a0, a1, a2, a3 = _arc(s, 0, j, u)
        b0, b1, b2, b3 = _arc(s, 1, j, u)
        a0, a1, a2, a3 = slerp(a0, a1, a2, a3, b0, b1, b2, b3, 2.0 * u * (1.0 - u))
        s[RESULT, j] = a0
        s[RESULT + 1, j] = a1
        s[RESULT + 2, j] = a2
        s[RESULT + 3, j] = a3


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


@compiled
def _weight(v, delta, theta, sine, cosine):
    """f(v, delta) and its derivatives f_v, f_d, f_vv, f_vd, f_dd."""
    if delta < SMALL:
        p0, p1, p2 = 1.0, 0.0, 0.0  # prod (k^2 - v^2) and its derivatives by v
        scale, before, last = 1.0, 0.0, 0.0  # c_k delta^k, delta^(k-1), delta^(k-2)
        f = fv = fd = fvv = fvd = fdd = 0.0
        for k in range(TERMS):
            g0, g1, g2 = v * p0, p0 + v * p1, 2.0 * p1 + v * p2
            f += scale * g0
            fv += scale * g1
            fvv += scale * g2
            fd += k * before * g0
            fvd += k * before * g1
            fdd += k * (k - 1) * last * g0
            m = (k + 1.0) * (k + 1.0)
            p0, p1, p2 = (
                p0 * (m - v * v),
                p1 * (m - v * v) - 2.0 * v * p0,
                p2 * (m - v * v) - 4.0 * v * p1 - 2.0 * p0,
            )
            step = 0.5 / ((k + 1.5) * (k + 1.0))
            scale, before, last = scale * step * delta, scale * step, before * step
        return f, fv, fd, fvv, fvd, fdd
    s, c = math.sin(v * theta), math.cos(v * theta)
    f = s / sine
    fv = theta * c / sine
    fvv = -theta * theta * f
    fd = (v * c - cosine * f) / (sine * sine)
    # (1 - c^2) f_cc - 3 c f_c + (v^2 - 1) f = 0 with c = 1 - delta, f_c = -f_d
    fdd = ((1.0 - v * v) * f - 3.0 * cosine * fd) / (sine * sine)
    fvd = ((c - v * theta * s) / sine - theta * c * cosine / (sine * sine)) / sine
    return f, fv, fd, fvv, fvd, fdd


@inlined
def _weight_jet(v, v1, delta, d1, d2, theta, sine, cosine):
    """f, f', f'' along v(u), affine or with v'' folded in by the caller, and delta(u)."""
    f, fv, fd, fvv, fvd, fdd = _weight(v, delta, theta, sine, cosine)
    return (
        f,
        fv * v1 + fd * d1,
        fvv * v1 * v1 + 2.0 * fvd * v1 * d1 + fdd * d1 * d1 + fd * d2,
        fv,
    )


@compiled
def slerp_jet(a, a1, a2, b, b1, b2, u, u1, u2):
    """The 2-jet of slerp(a(x), b(x), u(x)) from the 2-jets of its arguments."""
    e, e1, e2 = _combine(1.0, a, -1.0, b), _combine(1.0, a1, -1.0, b1), _combine(1.0, a2, -1.0, b2)
    m = _combine(1.0, a, 1.0, b)
    minus = _dot(e, e)
    delta, d1, d2 = 0.5 * minus, _dot(e, e1), _dot(e1, e1) + _dot(e, e2)
    theta = 2.0 * math.atan2(math.sqrt(minus), math.sqrt(_dot(m, m)))
    sine, cosine = math.sin(theta), 1.0 - delta
    f, f1, f2, fv = _weight_jet(1.0 - u, -u1, delta, d1, d2, theta, sine, cosine)
    g, g1, g2, gv = _weight_jet(u, u1, delta, d1, d2, theta, sine, cosine)
    f2 -= fv * u2
    g2 += gv * u2
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
    sine, cosine = math.sin(x * theta), math.cos(x * theta)
    rate = theta * slope
    p = along(s, c, j, sine, cosine)
    p1 = along(s, c, j, rate * cosine, -rate * sine)
    return p, p1, _combine(-rate * rate, p, 0.0, p)


@inlined
def _slope(s, k, j):
    return s[CONSTANTS + PARAMETERS + 2 * k + 1, j]


@compiled
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


@compiled
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
    for j in range(n):
        q, q1, _ = _triangle_jet(s, j)
        set_rate(s, j, q, q1, s[1, j])


@sample_kernel
def TRIANGLE_ACCELERATION(sheet, n):
    """alpha of the triangle."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        q, _, q2 = _triangle_jet(s, j)
        set_rate(s, j, q, q2, s[1, j] * s[1, j])


@sample_kernel
def SQUAD_VELOCITY(sheet, n):
    """omega of the squad."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        q, q1, _ = _squad_jet(s, j)
        set_rate(s, j, q, q1, s[1, j])


@sample_kernel
def SQUAD_ACCELERATION(sheet, n):
    """alpha of the squad."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        q, _, q2 = _squad_jet(s, j)
        set_rate(s, j, q, q2, s[1, j] * s[1, j])


_TRIANGLE = (TRIANGLE_ORIENTATION, TRIANGLE_VELOCITY, TRIANGLE_ACCELERATION)
_SQUAD = (SQUAD_ORIENTATION, SQUAD_VELOCITY, SQUAD_ACCELERATION)

TRIANGLE = Family(TRIANGLE_SIZE, near=_TRIANGLE, far=_TRIANGLE)
SQUAD = Family(SQUAD_SIZE, near=_SQUAD, far=_SQUAD)
