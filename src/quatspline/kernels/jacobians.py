"""Jacobians of the exponential, by which rates follow from a logarithm that moves.

For q = exp(v) in log units, z = |v|^2, s = sin|v| / |v|, c = cos|v|,

    vec(~q q') = Jr(v) v',    Jr(v) w = w - a v x w + b v x (v x w),                             (1)
    Jr(v)^-1 w = w + v x w + k v x (v x w),                                                      (2)
    a = s^2,    b = (1 - s c) / z,    k = (1 - |v| cot|v|) / z.

Left Jacobians, vec(q' ~q) = Jl(v) v', have the other sign before the simple products: Jl(v) = Jr(-v).
In rotation vectors r = 2 v these are the Jacobians of SO(3) at r [barr1992; park1997].  All coefficients
are entire in z: with s = 1 + z S and c = 1 + z C they are polynomials in z, S and C, so that no
angle, however small, loses digits.
"""

from __future__ import annotations

from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import FITTED, series, series_slopes, sinc
from quatspline.kernels.values import Mat, Vec, cross

SERIES = 1.0
"""Below this z the polynomials serve any curve; above it (1 - s c) / z is accurate."""


@inlined
def coefficients_near(z):
    """a, b and 2 da/dz, 2 db/dz for z <= NEAR^2: no root, no division."""
    s, c = series(z)
    ds, dc = series_slopes(z)
    sine = 1.0 + z * s
    b1 = -2.0 * (ds + dc + s * c + z * (ds * c + s * dc))
    return sine * sine, -(s + c + z * s * c), 2.0 * sine * (c - s), b1


@inlined
def coefficients(z):
    """a, b and 2 da/dz, 2 db/dz for any angle."""
    s, c = sinc(z)
    na, nb, na1, nb1 = coefficients_near(min(z, SERIES))
    d = 1.0 / max(z, SERIES)
    b = (1.0 - s * c) * d
    e = (c - s) * d
    b1 = (s * s - e * c - 2.0 * b) * d
    if z < SERIES:
        return na, nb, na1, nb1
    return s * s, b, 2.0 * s * e, b1


@inlined
def inverse_coefficient(z):
    """k and dk/dz for any angle; singular where |v| is a multiple of pi but 0."""
    if z < FITTED:
        s, c = series(z)
        ds, dc = series_slopes(z)
        d = 1.0 / (1.0 + z * s)
        k = (s - c) * d
        return k, (ds - dc - k * (s + z * ds)) * d
    s, c = sinc(z)
    k = (1.0 - c / s) / z
    return k, (1.0 / (s * s) - 1.0 - k * z) / (2.0 * z * z)


@inlined
def right_jacobian(v, w):
    """(1): Jr(v) w."""
    a, b, _, _ = coefficients(v @ v)
    t = cross(v, w)
    return w - a * t + b * cross(v, t)


@inlined
def inverse_right_jacobian(v, w):
    """(2): Jr(v)^-1 w."""
    k, _ = inverse_coefficient(v @ v)
    t = cross(v, w)
    return w + t + k * cross(v, t)


@inlined
def spun(f, a, b, v):
    """The matrix f (I + a [v] + b [v]^2), [v] w = v x w."""
    n = v @ v
    x, y, z = f * b * v.x, f * b * v.y, f * b * v.z
    t, g = (f * a) * v, f * (1.0 - b * n)
    return Mat(
        Vec(g + x * v.x, x * v.y + t.z, x * v.z - t.y),
        Vec(y * v.x - t.z, g + y * v.y, y * v.z + t.x),
        Vec(z * v.x + t.y, z * v.y - t.x, g + z * v.z),
    )


@inlined
def jacobian_matrix(v):
    """Jr(v)."""
    a, b, _, _ = coefficients(v @ v)
    return spun(1.0, -a, b, v)


@inlined
def inverse_jacobian_matrix(v):
    """Jr(v)^-1."""
    k, _ = inverse_coefficient(v @ v)
    return spun(1.0, 1.0, k, v)


@inlined
def turn_matrix(v):
    """R(exp(v))."""
    s, c = sinc(v @ v)
    return spun(1.0, 2.0 * s * c, 2.0 * s * s, v)
