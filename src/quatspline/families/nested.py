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

from quatspline.families.arcs import ANGLE, along
from quatspline.families.arcs import SIZE as ARC
from quatspline.kernels.family import family
from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import series, series_bend, series_slopes, sincos
from quatspline.kernels.values import arc, slerp

PARAMETERS = 3 * ARC
"""First of the six pairs (value at u = 0, slope) of x_0, x_1, x_2, y_0, y_1, z."""

FAR = 2.25
"""z = theta^2 up to which the polynomial of sin(theta)/theta serves (to 2e-14 for its second
derivative); beyond it closed forms."""


@inlined
def set_parameter(c, k, value, slope):
    """Parameter k of x_0, x_1, x_2, y_0, y_1, z."""
    c[PARAMETERS + 2 * k], c[PARAMETERS + 2 * k + 1] = value, slope


@inlined
def _parameter(c, k, u):
    """Parameter k at u, with its derivatives."""
    slope = c[PARAMETERS + 2 * k + 1]
    return c[PARAMETERS + 2 * k] + slope * u, slope, 0.0


@inlined
def _arc(c, k, x):
    """The point of arc k at x."""
    sine, cosine = sincos(x * c[ARC * k + ANGLE])
    return along(c, ARC * k, sine, cosine)


@inlined
def _inner_arc(c, k, u):
    """Arc k of a triangle at u."""
    x, _, _ = _parameter(c, k, u)
    return _arc(c, k, x)


@inlined
def triangle(c, u):
    """The triangle of slerps at u."""
    y0, _, _ = _parameter(c, 3, u)
    y1, _, _ = _parameter(c, 4, u)
    z, _, _ = _parameter(c, 5, u)
    p = _inner_arc(c, 1, u)
    return slerp(slerp(_inner_arc(c, 0, u), p, y0), slerp(p, _inner_arc(c, 2, u), y1), z)


@inlined
def _middle_arc(c, u):
    return _inner_arc(c, 1, u)


@inlined
def squad(c, u):
    """The squad at u."""
    return slerp(_arc(c, 0, u), _arc(c, 1, u), 2.0 * u * (1.0 - u))


@inlined
def _first_arc(c, u):
    return _arc(c, 0, u)


# Rates.  A 2-jet is a tuple (p, p', p'').


@inlined
def sinc_jet(z):
    """sigma(z) = sin(sqrt z)/sqrt z and its first two derivatives: entire in z, branch-free.

    Beyond FAR by 4 z sigma'' + 6 sigma' + sigma = 0.
    """
    n = min(z, FAR)
    s0, _ = series(n)
    s1, _ = series_slopes(n)
    s2 = series_bend(n)
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
def slerp_jet(p, q, u):
    """The 2-jet of slerp(p(x), q(x), u(x)) from the 2-jets of its arguments."""
    (a, a1, a2), (b, b1, b2), (v, v1, v2) = p, q, u
    e, e1, e2 = a - b, a1 - b1, a2 - b2
    theta, _, _ = arc(a, b)
    # z = theta^2 from |a - b|^2 = 2 (1 - cos(theta)): z' = (|a - b|^2)' / sigma(z)
    z = theta * theta
    d, dz, dzz = sinc_jet(z)
    z1 = 2.0 * (e @ e1) / d
    z2 = (2.0 * (e1 @ e1 + e @ e2) - z1 * dz * z1) / d
    d1, d2 = dz * z1, dzz * z1 * z1 + dz * z2
    f, f1, f2 = _weight_jet(1.0 - v, -v1, -v2, z, z1, z2, d, d1, d2)
    g, g1, g2 = _weight_jet(v, v1, v2, z, z1, z2, d, d1, d2)
    return (
        f * a + g * b,
        (f1 * a + g1 * b) + (f * a1 + g * b1),
        (f2 * a + g2 * b) + 2.0 * (f1 * a1 + g1 * b1) + (f * a2 + g * b2),
    )


@inlined
def _arc_jet(c, k, x, slope):
    """The 2-jet of arc k at x, whose slope in u is given."""
    theta = c[ARC * k + ANGLE]
    sine, cosine = sincos(x * theta)
    rate = theta * slope
    p = along(c, ARC * k, sine, cosine)
    return p, along(c, ARC * k, rate * cosine, -rate * sine), (-rate * rate) * p


@inlined
def _inner_arc_jet(c, k, u):
    x, slope, _ = _parameter(c, k, u)
    return _arc_jet(c, k, x, slope)


@inlined
def triangle_jet(c, u):
    """The triangle with its derivatives."""
    p = _inner_arc_jet(c, 1, u)
    left = slerp_jet(_inner_arc_jet(c, 0, u), p, _parameter(c, 3, u))
    right = slerp_jet(p, _inner_arc_jet(c, 2, u), _parameter(c, 4, u))
    return slerp_jet(left, right, _parameter(c, 5, u))


@inlined
def squad_jet(c, u):
    """The squad with its derivatives."""
    parameter = (2.0 * u * (1.0 - u), 2.0 - 4.0 * u, -4.0)
    return slerp_jet(_arc_jet(c, 0, u, 1.0), _arc_jet(c, 1, u, 1.0), parameter)


TRIANGLE = family(PARAMETERS + 12, triangle, jet=triangle_jet, spare=_middle_arc)
SQUAD = family(2 * ARC, squad, jet=squad_jet, spare=_first_arc)
