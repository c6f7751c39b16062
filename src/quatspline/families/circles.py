"""Circles on S^3: pairs of arcs, met one after the other (biarcs) or blended by slerp.

A circle that leaves P with unit tangent T and curvature vector c in R^4 (|c| = 1/r, r <= 1) is

    p(phi) = P + X sin(phi) + Y (1 - cos(phi)),    X = r T,  Y = r^2 c,                            (1)

and every segment holds two of them, each with its angle phi = phi_0 + r u + g u (1 - u), exact at both
ends.  Great circles have r = 1; an arc that nears a point keeps its position to rounding, whatever
happens to its plane.
"""

from __future__ import annotations

import math

from numba import carray

from quatspline.families.nested import restored, set_rate, slerp_jet
from quatspline.kernels.jit import BLOCK, CONSTANTS, RESULT, ROWS, compiled, inlined, sample_kernel
from quatspline.kernels.scalars import sincos_any, slerp
from quatspline.segments import Family

# notation: the constants of a circle are P, X, Y (12) and the angle's phi_0, r, g.
SIZE = 15
SPLIT = 2 * SIZE
"""A biarc's u where its second arc begins; a blend's three coefficients from u^1 to u^3."""

_FIRST, _SECOND, _SPLIT = CONSTANTS, CONSTANTS + SIZE, CONSTANTS + SPLIT


@inlined
def dot(a, b):
    """The inner product in R^4."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]


@inlined
def combine(f, a, g, b):
    """f a + g b in R^4."""
    return f * a[0] + g * b[0], f * a[1] + g * b[1], f * a[2] + g * b[2], f * a[3] + g * b[3]


@inlined
def unit(a):
    """a / |a|; zero stays zero."""
    length = math.sqrt(dot(a, a))
    return combine(1.0 / length if length > 0.0 else 0.0, a, 0.0, a)


@compiled
def set_circle(segments, i, k, p, x, y, a0, a1, a2):
    """Circle k (0, 1) of segment i, (1), and its angle a0 + a1 u + a2 u (1 - u)."""
    c = SIZE * k
    for j in range(4):
        segments[i, c + j] = p[j]
        segments[i, c + 4 + j] = x[j]
        segments[i, c + 8 + j] = y[j]
    segments[i, c + 12] = a0
    segments[i, c + 13] = a1
    segments[i, c + 14] = a2


@inlined
def _on(s, c, j, sine, rise):
    """(1) with rows from c on."""
    return (
        s[c, j] + sine * s[c + 4, j] + rise * s[c + 8, j],
        s[c + 1, j] + sine * s[c + 5, j] + rise * s[c + 9, j],
        s[c + 2, j] + sine * s[c + 6, j] + rise * s[c + 10, j],
        s[c + 3, j] + sine * s[c + 7, j] + rise * s[c + 11, j],
    )


@inlined
def _point(s, c, j, u):
    angle = s[c + 14, j] * (u - u * u) + (s[c + 13, j] * u + s[c + 12, j])
    sine, cosine = sincos_any(angle)
    return _on(s, c, j, sine, 1.0 - cosine)


@inlined
def _jet(s, c, j, u):
    """p, p', p'' of (1) with respect to u."""
    bend = s[c + 14, j]
    angle = bend * (u - u * u) + (s[c + 13, j] * u + s[c + 12, j])
    rate = bend * (1.0 - 2.0 * u) + s[c + 13, j]
    sine, cosine = math.sin(angle), math.cos(angle)
    x = (s[c + 4, j], s[c + 5, j], s[c + 6, j], s[c + 7, j])
    y = (s[c + 8, j], s[c + 9, j], s[c + 10, j], s[c + 11, j])
    along, across = combine(cosine, x, sine, y), combine(-sine, x, cosine, y)
    p1 = combine(rate, along, 0.0, along)
    return _on(s, c, j, sine, 1.0 - cosine), p1, combine(-2.0 * bend, along, rate * rate, across)


@inlined
def _result(s, j, q):
    s[RESULT, j] = q[0]
    s[RESULT + 1, j] = q[1]
    s[RESULT + 2, j] = q[2]
    s[RESULT + 3, j] = q[3]


@sample_kernel
def BIARC_ORIENTATION(sheet, n):
    """The first arc before the split, the second from there on."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        u = s[0, j]
        if u < s[_SPLIT, j]:
            _result(s, j, unit(_point(s, _FIRST, j, u)))
        else:
            _result(s, j, unit(_point(s, _SECOND, j, u)))


@compiled
def _biarc_jet(s, j):
    u = s[0, j]
    if u < s[_SPLIT, j]:
        return _jet(s, _FIRST, j, u)
    return _jet(s, _SECOND, j, u)


@sample_kernel
def BIARC_VELOCITY(sheet, n):
    """omega of the biarc."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        q, q1, _ = _biarc_jet(s, j)
        set_rate(s, j, q, q1, s[1, j])


@sample_kernel
def BIARC_ACCELERATION(sheet, n):
    """alpha of the biarc, from the right at its joint."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        q, _, q2 = _biarc_jet(s, j)
        set_rate(s, j, q, q2, s[1, j] * s[1, j])


@sample_kernel
def BLEND_ORIENTATION(sheet, n):
    """slerp(p_0(u), p_1(u), f(u))."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        u = s[0, j]
        a, b = _point(s, _FIRST, j, u), _point(s, _SECOND, j, u)
        f = ((s[_SPLIT + 2, j] * u + s[_SPLIT + 1, j]) * u + s[_SPLIT, j]) * u
        p = slerp(a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3], f)
        _result(s, j, restored(p, a))


@compiled
def _blend_jet(s, j):
    u = s[0, j]
    a, a1, a2 = _jet(s, _FIRST, j, u)
    b, b1, b2 = _jet(s, _SECOND, j, u)
    c1, c2, c3 = s[_SPLIT, j], s[_SPLIT + 1, j], s[_SPLIT + 2, j]
    f, f1 = ((c3 * u + c2) * u + c1) * u, (3.0 * c3 * u + 2.0 * c2) * u + c1
    return slerp_jet(a, a1, a2, b, b1, b2, f, f1, 6.0 * c3 * u + 2.0 * c2)


@sample_kernel
def BLEND_VELOCITY(sheet, n):
    """omega of the blend."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        q, q1, _ = _blend_jet(s, j)
        set_rate(s, j, q, q1, s[1, j])


@sample_kernel
def BLEND_ACCELERATION(sheet, n):
    """alpha of the blend."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        q, _, q2 = _blend_jet(s, j)
        set_rate(s, j, q, q2, s[1, j] * s[1, j])


_BIARC = (BIARC_ORIENTATION, BIARC_VELOCITY, BIARC_ACCELERATION)
_BLEND = (BLEND_ORIENTATION, BLEND_VELOCITY, BLEND_ACCELERATION)

BIARC = Family(SPLIT + 1, near=_BIARC, far=_BIARC)
BLEND = Family(SPLIT + 3, near=_BLEND, far=_BLEND)
