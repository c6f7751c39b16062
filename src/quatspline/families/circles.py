"""Circles on S^3: pairs of arcs, met one after the other (biarcs) or blended by slerp.

A circle that leaves P with unit tangent T and curvature vector c in R^4 (|c| = 1/r, r <= 1) is

    p(phi) = P + X sin(phi) + Y (1 - cos(phi)),    X = r T,  Y = r^2 c,                            (1)

and every segment holds two of them, each with its angle phi = phi_0 + r u + g u (1 - u), exact at both
ends.  Great circles have r = 1; an arc that nears a point keeps its position to rounding, whatever
happens to its plane.
"""

from __future__ import annotations

from quatspline.families.nested import slerp_jet
from quatspline.kernels.family import family
from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import sincos_any
from quatspline.kernels.values import put_quat, quat_at, restored, slerp, unit

# notation: the constants of a circle are P, X, Y (12) and the angle's phi_0, r, g.
P, X, Y, PHI, SIZE = 0, 4, 8, 12, 15
FIRST, SECOND, SPLIT = 0, SIZE, 2 * SIZE
"""Two circles, then a biarc's u where its second arc begins; a blend's three coefficients from u^1 to u^3."""


@inlined
def set_circle(c, k, p, x, y, angle):
    """The circle (1) at places k ..., and its angle a0 + a1 u + a2 u (1 - u)."""
    put_quat(c, k + P, p)
    put_quat(c, k + X, x)
    put_quat(c, k + Y, y)
    c[k + PHI], c[k + PHI + 1], c[k + PHI + 2] = angle


@inlined
def _angle(c, k, u):
    """The angle at u, and its slope."""
    bend, rate = c[k + PHI + 2], c[k + PHI + 1]
    return bend * (u - u * u) + (rate * u + c[k + PHI]), bend * (1.0 - 2.0 * u) + rate


@inlined
def _point(c, k, u):
    angle, _ = _angle(c, k, u)
    sine, cosine = sincos_any(angle)
    return quat_at(c, k + P) + sine * quat_at(c, k + X) + (1.0 - cosine) * quat_at(c, k + Y)


@inlined
def _jet(c, k, u):
    """p, p', p'' of (1) with respect to u."""
    angle, rate = _angle(c, k, u)
    sine, cosine = sincos_any(angle)
    x, y = quat_at(c, k + X), quat_at(c, k + Y)
    along, across = cosine * x + sine * y, cosine * y - sine * x
    p = quat_at(c, k + P) + sine * x + (1.0 - cosine) * y
    return p, rate * along, (-2.0 * c[k + PHI + 2]) * along + (rate * rate) * across


@inlined
def biarc(c, u):
    """The first arc before the split, the second from there on."""
    return unit(_point(c, FIRST if u < c[SPLIT] else SECOND, u))


@inlined
def biarc_jet(c, u):
    """From the right at the joint."""
    return _jet(c, FIRST if u < c[SPLIT] else SECOND, u)


@inlined
def blend(c, u):
    """slerp(p_0(u), p_1(u), f(u))."""
    p, q = _point(c, FIRST, u), _point(c, SECOND, u)
    f = ((c[SPLIT + 2] * u + c[SPLIT + 1]) * u + c[SPLIT]) * u
    return restored(slerp(p, q, f), p)


@inlined
def blend_jet(c, u):
    """The same with its derivatives."""
    c1, c2, c3 = c[SPLIT], c[SPLIT + 1], c[SPLIT + 2]
    f, f1 = ((c3 * u + c2) * u + c1) * u, (3.0 * c3 * u + 2.0 * c2) * u + c1
    f2 = 6.0 * c3 * u + 2.0 * c2
    return slerp_jet(_jet(c, FIRST, u), _jet(c, SECOND, u), (f, f1, f2))


BIARC = family(SPLIT + 1, biarc, jet=biarc_jet)
BLEND = family(SPLIT + 3, blend, jet=blend_jet)
