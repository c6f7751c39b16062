"""One exponential a segment: quintic rotation vectors in the chart of a base orientation.

On a segment, with u in [0, 1],

    Q(u) = Q_0 exp(phi(u))                                                                       (1)

with phi a polynomial in R^3 of degree 5 at most, in log units (half rotation vectors).  Rates come
from the right Jacobian [barr1992; park1997]: with z = |phi|^2, s = sin|phi| / |phi|, c = cos|phi|,

    omega/2 = phi' - a phi x phi' + b phi x (phi x phi'),    a = s^2,  b = (1 - s c) / z         (2)
    alpha/2 = phi'' - a phi x phi'' + b phi x (phi x phi'') + b phi' x (phi x phi')
              + k (-a1 phi x phi' + b1 phi x (phi x phi')),  k = phi . phi'                      (3)

where a1 = 2 da/dz and b1 = 2 db/dz.  All four are entire in z: with s = 1 + z S and c = 1 + z C
they are polynomials in z, S and C, so that no angle, however small, loses digits.
"""

from __future__ import annotations

import math

from numba import carray

from quatspline.families.polynomials import hermite, quintic, quintic_jet
from quatspline.kernels import scalars as sines
from quatspline.kernels.jit import BLOCK, CONSTANTS, RESULT, ROWS, Kernel, inlined, sample_kernel
from quatspline.kernels.scalars import cross, mul, sinc, sinc_near
from quatspline.segments import Family

# notation: the constants of a segment are Q_0 (4), then for each component of phi the six constants
# of `quintics` (18).
Q0, PHI = 0, 4
SIZE = 22

_Q, _P = CONSTANTS + Q0, CONSTANTS + PHI

SERIES = 1.0
"""Below this z = |phi|^2 the polynomials serve any curve; above it (1 - s c) / z is accurate."""


@inlined
def coefficients_near(z):
    """a, b, a1, b1 of (2) and (3) for |phi| <= NEAR: no root, no division."""
    # notation: s and c are S and C of the module's text, ds and dc their derivatives by z
    k1, k2, k3, k4 = sines.S1, sines.S2, sines.S3, sines.S4
    k5, k6, k7, k8 = sines.S5, sines.S6, sines.S7, sines.S8
    s = ((((((k8 * z + k7) * z + k6) * z + k5) * z + k4) * z + k3) * z + k2) * z + k1
    ds = (((((7 * k8 * z + 6 * k7) * z + 5 * k6) * z + 4 * k5) * z + 3 * k4) * z + 2 * k3) * z + k2
    k1, k2, k3, k4 = sines.C1, sines.C2, sines.C3, sines.C4
    k5, k6, k7, k8 = sines.C5, sines.C6, sines.C7, sines.C8
    c = ((((((k8 * z + k7) * z + k6) * z + k5) * z + k4) * z + k3) * z + k2) * z + k1
    dc = (((((7 * k8 * z + 6 * k7) * z + 5 * k6) * z + 4 * k5) * z + 3 * k4) * z + 2 * k3) * z + k2
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


@inlined
def set_base(segments, i, w, x, y, z):
    """Q_0 of segment i."""
    segments[i, Q0] = w
    segments[i, Q0 + 1] = x
    segments[i, Q0 + 2] = y
    segments[i, Q0 + 3] = z


@inlined
def _set_component(segments, i, k, d0, e0, f1, d1, e1):
    """Component k of phi on segment i: the quintic from 0 to f1 with slopes d and bends e."""
    p = PHI + 6 * k
    a = hermite(0.0, d0, e0, f1, d1, e1)
    segments[i, p] = a[0]
    segments[i, p + 1] = a[1]
    segments[i, p + 2] = a[2]
    segments[i, p + 3] = a[3]
    segments[i, p + 4] = a[4]
    segments[i, p + 5] = a[5]


@inlined
def _length(x, y, z):
    return math.sqrt(x * x + y * y + z * z)


@inlined
def inverse_jacobian(x, y, z, vx, vy, vz):
    """Jr^-1(2 phi) v, phi = (x, y, z): v + phi x v + d phi x (phi x v); singular at |phi| = pi."""
    r = x * x + y * y + z * z
    s, c = sinc(r)
    a, _, a1, _ = coefficients(r, s, c)
    d = -0.5 * a1 / a  # (s - c) / (z s) = (1 - |phi| cot |phi|) / |phi|^2
    tx, ty, tz = cross(x, y, z, vx, vy, vz)
    ux, uy, uz = cross(x, y, z, tx, ty, tz)
    return vx + tx + d * ux, vy + ty + d * uy, vz + tz + d * uz


@inlined
def set_end_rates(segments, i, y):
    """phi on segment i from 0 to L with given rates at both ends; returns a bound of |phi|.

    y (15): L, h v_0, h^2 a_0, h v_1, h^2 a_1, where v and a are half the body velocity and
    acceleration.  (2) and (3) are solved for the derivatives at u = 1; those at 0 are the rates.
    """
    x, w, z = y[0], y[1], y[2]
    r = x * x + w * w + z * z
    s, c = sinc(r)
    a, b, a1, b1 = coefficients(r, s, c)
    dx, dy, dz = inverse_jacobian(x, w, z, y[9], y[10], y[11])
    fx, fy, fz = half_acceleration(a, b, a1, b1, x, w, z, dx, dy, dz, 0.0, 0.0, 0.0)
    ex, ey, ez = inverse_jacobian(x, w, z, y[12] - fx, y[13] - fy, y[14] - fz)
    _set_component(segments, i, 0, y[3], y[6], x, dx, ex)
    _set_component(segments, i, 1, y[4], y[7], w, dy, ey)
    _set_component(segments, i, 2, y[5], y[8], z, dz, ez)
    # Bernstein coefficients
    b1 = _length(y[3], y[4], y[5]) / 5
    b2 = _length(0.4 * y[3] + y[6] / 20, 0.4 * y[4] + y[7] / 20, 0.4 * y[5] + y[8] / 20)
    b3 = _length(x - 0.4 * dx + ex / 20, w - 0.4 * dy + ey / 20, z - 0.4 * dz + ez / 20)
    b4 = _length(x - dx / 5, w - dy / 5, z - dz / 5)
    return max(b1, b2, b3, b4, math.sqrt(r))


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
            x, y, z = quintic(s, _P, j, u), quintic(s, _P + 6, j, u), quintic(s, _P + 12, j, u)
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
            x, dx, _ = quintic_jet(s, _P, j, u)
            y, dy, _ = quintic_jet(s, _P + 6, j, u)
            z, dz, _ = quintic_jet(s, _P + 12, j, u)
            a, b, _, _ = _jacobian(near, x, y, z)
            tx, ty, tz = cross(x, y, z, dx, dy, dz)
            ux, uy, uz = cross(x, y, z, tx, ty, tz)
            rate = 2.0 * s[1, j]
            s[RESULT, j] = rate * (dx - a * tx + b * ux)
            s[RESULT + 1, j] = rate * (dy - a * ty + b * uy)
            s[RESULT + 2, j] = rate * (dz - a * tz + b * uz)

    return sample_kernel(kernel)


def _acceleration(near: bool) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            u = s[0, j]
            x, dx, ex = quintic_jet(s, _P, j, u)
            y, dy, ey = quintic_jet(s, _P + 6, j, u)
            z, dz, ez = quintic_jet(s, _P + 12, j, u)
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
