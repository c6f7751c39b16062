"""One exponential a segment: quintic rotation vectors in the chart of a base orientation.

On a segment, with u in [0, 1],

    Q(u) = Q_0 exp(phi(u))                                                                       (1)

with phi a polynomial in R^3 of degree 5 at most, in log units (half rotation vectors).  Rates come
from the right Jacobian [barr1992; park1997]: with z = |phi|^2, s = sin|phi| / |phi|, c = cos|phi|,

    omega/2 = phi' - a phi x phi' + b phi x (phi x phi'),    a = s^2,  b = (1 - s c) / z         (2)
    alpha/2 = phi'' - a phi x phi'' + b phi x (phi x phi'') + b phi' x (phi x phi')
              + k (-a1 phi x phi' + b1 phi x (phi x phi')),  k = phi . phi'                      (3)

where a1 = 2 da/dz and b1 = 2 db/dz.  All four are entire in z: with s = 1 + z S and c = 1 + z C they
are polynomials in z, S and C, so that no angle, however small, loses digits.
"""

from __future__ import annotations

import math

from quatspline._jit import BLOCK, CONSTANTS, RESULT, ROWS, Kernel, inlined, sample_kernel
from quatspline.families.cumulative import hermite
from quatspline.families.segments import Family, carray
from quatspline.primitives import (
    C1,
    C2,
    C3,
    C4,
    C5,
    C6,
    C7,
    C8,
    S1,
    S2,
    S3,
    S4,
    S5,
    S6,
    S7,
    S8,
    cross,
    mul,
    sinc,
    sinc_near,
)

# notation: the constants of a segment are Q_0 (4), then for each component of phi the coefficients
# from u^0 to u^5 (18).
Q0, PHI = 0, 4
SIZE = 22

_Q, _P = CONSTANTS + Q0, CONSTANTS + PHI

SERIES = 1.0
"""Below this z = |phi|^2 the polynomials serve any curve; above it (1 - s c) / z is accurate."""


@inlined
def coefficients_near(z):
    """a, b, a1, b1 of (2) and (3) for |phi| <= NEAR: no root, no division."""
    s = ((((((S8 * z + S7) * z + S6) * z + S5) * z + S4) * z + S3) * z + S2) * z + S1
    c = ((((((C8 * z + C7) * z + C6) * z + C5) * z + C4) * z + C3) * z + C2) * z + C1
    ds = (((((7 * S8 * z + 6 * S7) * z + 5 * S6) * z + 4 * S5) * z + 3 * S4) * z + 2 * S3) * z + S2
    dc = (((((7 * C8 * z + 6 * C7) * z + 5 * C6) * z + 4 * C5) * z + 3 * C4) * z + 2 * C3) * z + C2
    sine = 1.0 + z * s
    b1 = -2.0 * (ds + dc + s * c + z * (ds * c + s * dc))
    return sine * sine, -(s + c + z * s * c), 2.0 * sine * (c - s), b1


@inlined
def coefficients(z, s, c):
    """a, b, a1, b1 of (2) and (3) from z, s = sin|phi| / |phi| and c = cos|phi|, for any angle."""
    na, nb, na1, nb1 = coefficients_near(min(z, SERIES))
    d = 1.0 / max(z, SERIES)
    b = (1.0 - s * c) * d
    e = (c - s) * d
    b1 = (s * s - e * c - 2.0 * b) * d
    if z < SERIES:
        return na, nb, na1, nb1
    return s * s, b, 2.0 * s * e, b1


@inlined
def set_base(segments, i, w, x, y, z):
    """Q_0 of segment i."""
    segments[i, Q0] = w
    segments[i, Q0 + 1] = x
    segments[i, Q0 + 2] = y
    segments[i, Q0 + 3] = z


@inlined
def set_component(segments, i, k, c0, c1, c2, c3, c4, c5):
    """Coefficients of component k of phi on segment i."""
    p = PHI + 6 * k
    segments[i, p] = c0
    segments[i, p + 1] = c1
    segments[i, p + 2] = c2
    segments[i, p + 3] = c3
    segments[i, p + 4] = c4
    segments[i, p + 5] = c5


@inlined
def _length(x, y, z):
    return math.sqrt(x * x + y * y + z * z)


@inlined
def set_hermite(segments, i, d, e, f, g, k):
    """phi on segment i from 0 to f: slopes d and g, second derivatives e and k, at u = 0 and 1.

    Returns a bound of |phi| on [0, 1]: the longest Bernstein coefficient.
    """
    for c in range(3):
        a = hermite(0.0, d[c], e[c], f[c], g[c], k[c])
        set_component(segments, i, c, a[0], a[1], a[2], a[3], a[4], a[5])
    b1 = _length(d[0], d[1], d[2]) / 5
    b2 = _length(0.4 * d[0] + e[0] / 20, 0.4 * d[1] + e[1] / 20, 0.4 * d[2] + e[2] / 20)
    b3 = _length(
        f[0] - 0.4 * g[0] + k[0] / 20, f[1] - 0.4 * g[1] + k[1] / 20, f[2] - 0.4 * g[2] + k[2] / 20
    )
    b4 = _length(f[0] - g[0] / 5, f[1] - g[1] / 5, f[2] - g[2] / 5)
    return max(b1, b2, b3, b4, _length(f[0], f[1], f[2]))


@inlined
def _value(s, p, j, u):
    return (
        (((s[p + 5, j] * u + s[p + 4, j]) * u + s[p + 3, j]) * u + s[p + 2, j]) * u + s[p + 1, j]
    ) * u + s[p, j]


@inlined
def _slope(s, p, j, u):
    a, b, c, d, e = s[p + 5, j], s[p + 4, j], s[p + 3, j], s[p + 2, j], s[p + 1, j]
    return (((5.0 * a * u + 4.0 * b) * u + 3.0 * c) * u + 2.0 * d) * u + e


@inlined
def _bend(s, p, j, u):
    return ((20.0 * s[p + 5, j] * u + 12.0 * s[p + 4, j]) * u + 6.0 * s[p + 3, j]) * u + (
        2.0 * s[p + 2, j]
    )


@inlined
def _jacobian(near, x, y, z):
    """a, b, a1, b1 at phi = (x, y, z)."""
    r = x * x + y * y + z * z
    if near:
        return coefficients_near(r)
    s, c = sinc(r)
    return coefficients(r, s, c)


def _orientation(near: bool) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            u = s[0, j]
            x, y, z = _value(s, _P, j, u), _value(s, _P + 6, j, u), _value(s, _P + 12, j, u)
            r = x * x + y * y + z * z
            if near:
                k, c = sinc_near(r)
            else:
                k, c = sinc(r)
            w, x, y, z = mul(
                s[_Q, j], s[_Q + 1, j], s[_Q + 2, j], s[_Q + 3, j], c, k * x, k * y, k * z
            )
            s[RESULT, j] = w
            s[RESULT + 1, j] = x
            s[RESULT + 2, j] = y
            s[RESULT + 3, j] = z

    return sample_kernel(kernel)


def _velocity(near: bool) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            u = s[0, j]
            x, y, z = _value(s, _P, j, u), _value(s, _P + 6, j, u), _value(s, _P + 12, j, u)
            dx, dy, dz = _slope(s, _P, j, u), _slope(s, _P + 6, j, u), _slope(s, _P + 12, j, u)
            a, b, _, _ = _jacobian(near, x, y, z)
            tx, ty, tz = cross(x, y, z, dx, dy, dz)
            ux, uy, uz = cross(x, y, z, tx, ty, tz)
            rate = 2.0 * s[1, j]
            s[RESULT, j] = rate * (dx - a * tx + b * ux)
            s[RESULT + 1, j] = rate * (dy - a * ty + b * uy)
            s[RESULT + 2, j] = rate * (dz - a * tz + b * uz)

    return sample_kernel(kernel)


@inlined
def half_acceleration(a, b, a1, b1, x, y, z, dx, dy, dz, ex, ey, ez):
    """(3): alpha/2 of phi = (x, y, z), its slope d and second derivative e."""
    tx, ty, tz = cross(x, y, z, dx, dy, dz)
    ux, uy, uz = cross(x, y, z, tx, ty, tz)
    gx, gy, gz = cross(dx, dy, dz, tx, ty, tz)
    px, py, pz = cross(x, y, z, ex, ey, ez)
    rx, ry, rz = cross(x, y, z, px, py, pz)
    k = x * dx + y * dy + z * dz
    f, g = k * a1, k * b1
    return (
        ex - a * px + b * (rx + gx) - f * tx + g * ux,
        ey - a * py + b * (ry + gy) - f * ty + g * uy,
        ez - a * pz + b * (rz + gz) - f * tz + g * uz,
    )


def _acceleration(near: bool) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            u = s[0, j]
            x, y, z = _value(s, _P, j, u), _value(s, _P + 6, j, u), _value(s, _P + 12, j, u)
            dx, dy, dz = _slope(s, _P, j, u), _slope(s, _P + 6, j, u), _slope(s, _P + 12, j, u)
            ex, ey, ez = _bend(s, _P, j, u), _bend(s, _P + 6, j, u), _bend(s, _P + 12, j, u)
            a, b, a1, b1 = _jacobian(near, x, y, z)
            ax, ay, az = half_acceleration(a, b, a1, b1, x, y, z, dx, dy, dz, ex, ey, ez)
            rate = 2.0 * s[1, j] * s[1, j]
            s[RESULT, j] = rate * ax
            s[RESULT + 1, j] = rate * ay
            s[RESULT + 2, j] = rate * az

    return sample_kernel(kernel)


ROTATION_VECTOR = Family(
    SIZE,
    near=(_orientation(True), _velocity(True), _acceleration(True)),
    far=(_orientation(False), _velocity(False), _acceleration(False)),
)
"""Evaluates (1) and its rates (2), (3)."""
