"""Products of exponentials about fixed axes, the cumulative form of Kim, Kim & Shin (1995).

On a segment, with u in [0, 1],

    Q(u) = Q_0 exp(theta_1(u) n_1) exp(theta_2(u) n_2) exp(theta_3(u) n_3)                    (1)

with unit axes n_k and polynomials theta_k of degree 5 at most.  The paper's quartic, the quintic,
the cumulative cubic Hermite and B-spline curves all have this form.  Rates come from a scan over
the factors, each turning what stands to its left into its own frame [kim1995general].
"""

from __future__ import annotations

from numba import carray

from quatspline._jit import (
    BLOCK,
    CONSTANTS,
    RESULT,
    ROWS,
    Kernel,
    inlined,
    sample_kernel,
)
from quatspline.families.segments import Family
from quatspline.primitives import cross, mul, polar, sincos, sincos_near, unrotate

# notation: the constants of a segment are Q_0 (4), Q_0 n_1 (4), n_1, n_2, n_3 (9), and the six
# coefficients of theta_1, theta_2, theta_3 from u^0 to u^5 (18).
Q0, Q0N1, AXES, ANGLES = 0, 4, 8, 17
SIZE = 35

_Q, _QN, _N, _P = (CONSTANTS + offset for offset in (Q0, Q0N1, AXES, ANGLES))


@inlined
def set_base(segments, i, w, x, y, z):
    """Q_0 of segment i; set the factors afterwards."""
    segments[i, Q0] = w
    segments[i, Q0 + 1] = x
    segments[i, Q0 + 2] = y
    segments[i, Q0 + 3] = z


@inlined
def set_factor(segments, i, k, x, y, z, c0, c1, c2, c3, c4, c5):
    """Factor k (0, 1, 2) of segment i: exp(f(u) v), v = (x, y, z), f given by its coefficients.

    Returns a bound of the half angle over u in [0, 1].
    """
    length, nx, ny, nz = polar(x, y, z)
    set_turn(segments, i, k, length, nx, ny, nz, c0, c1, c2, c3, c4, c5)
    return length * bound(c0, c1, c2, c3, c4, c5)


@inlined
def set_turn(segments, i, k, length, nx, ny, nz, c0, c1, c2, c3, c4, c5):
    """Factor k of segment i from the length and the axis of v."""
    segments[i, AXES + 3 * k] = nx
    segments[i, AXES + 3 * k + 1] = ny
    segments[i, AXES + 3 * k + 2] = nz
    p = ANGLES + 6 * k
    segments[i, p] = length * c0
    segments[i, p + 1] = length * c1
    segments[i, p + 2] = length * c2
    segments[i, p + 3] = length * c3
    segments[i, p + 4] = length * c4
    segments[i, p + 5] = length * c5
    if k == 0:
        w, a, b, c = segments[i, 0], segments[i, 1], segments[i, 2], segments[i, 3]
        w, a, b, c = mul(w, a, b, c, 0.0, nx, ny, nz)
        segments[i, Q0N1] = w
        segments[i, Q0N1 + 1] = a
        segments[i, Q0N1 + 2] = b
        segments[i, Q0N1 + 3] = c


@inlined
def bound(c0, c1, c2, c3, c4, c5):
    """A bound of |f| on [0, 1]: the largest Bernstein coefficient of degree 5."""
    b1 = c0 + c1 / 5
    b2 = c0 + 2 * c1 / 5 + c2 / 10
    b3 = c0 + 3 * c1 / 5 + 3 * c2 / 10 + c3 / 10
    b4 = c0 + 4 * c1 / 5 + 6 * c2 / 10 + 4 * c3 / 10 + c4 / 5
    b5 = c0 + c1 + c2 + c3 + c4 + c5
    return max(abs(c0), abs(b1), abs(b2), abs(b3), abs(b4), abs(b5))


@inlined
def hermite(f0, d0, c0, f1, d1, c1):
    """Coefficients of the quintic with values f, slopes d, second derivatives c at u = 0 and 1."""
    rise = f1 - f0 - d0 - 0.5 * c0
    slope = d1 - d0 - c0
    bend = c1 - c0
    return (
        f0,
        d0,
        0.5 * c0,
        10.0 * rise - 4.0 * slope + 0.5 * bend,
        -15.0 * rise + 7.0 * slope - bend,
        6.0 * rise - 3.0 * slope + 0.5 * bend,
    )


@inlined
def _angle(s, p, j, u):
    return (
        (((s[p + 5, j] * u + s[p + 4, j]) * u + s[p + 3, j]) * u + s[p + 2, j]) * u + s[p + 1, j]
    ) * u + s[p, j]


@inlined
def _angle_jet(s, p, j, u):
    """theta, theta', theta'' with respect to u."""
    a, b, c, d, e = s[p + 5, j], s[p + 4, j], s[p + 3, j], s[p + 2, j], s[p + 1, j]
    f0 = ((((a * u + b) * u + c) * u + d) * u + e) * u + s[p, j]
    f1 = (((5.0 * a * u + 4.0 * b) * u + 3.0 * c) * u + 2.0 * d) * u + e
    f2 = ((20.0 * a * u + 12.0 * b) * u + 6.0 * c) * u + 2.0 * d
    return f0, f1, f2


def _orientation(near: bool) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            u = s[0, j]
            a, b, c = _angle(s, _P, j, u), _angle(s, _P + 6, j, u), _angle(s, _P + 12, j, u)
            if near:
                s1, c1 = sincos_near(a)
                s2, c2 = sincos_near(b)
                s3, c3 = sincos_near(c)
            else:
                s1, c1 = sincos(a)
                s2, c2 = sincos(b)
                s3, c3 = sincos(c)
            w = c1 * s[_Q, j] + s1 * s[_QN, j]
            x = c1 * s[_Q + 1, j] + s1 * s[_QN + 1, j]
            y = c1 * s[_Q + 2, j] + s1 * s[_QN + 2, j]
            z = c1 * s[_Q + 3, j] + s1 * s[_QN + 3, j]
            w, x, y, z = mul(
                w, x, y, z, c2, s2 * s[_N + 3, j], s2 * s[_N + 4, j], s2 * s[_N + 5, j]
            )
            w, x, y, z = mul(
                w, x, y, z, c3, s3 * s[_N + 6, j], s3 * s[_N + 7, j], s3 * s[_N + 8, j]
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
            _, r1, _ = _angle_jet(s, _P, j, u)
            b, r2, _ = _angle_jet(s, _P + 6, j, u)
            c, r3, _ = _angle_jet(s, _P + 12, j, u)
            if near:
                s2, c2 = sincos_near(b)
                s3, c3 = sincos_near(c)
            else:
                s2, c2 = sincos(b)
                s3, c3 = sincos(c)
            # omega <- R_k^T omega + 2 theta_k' n_k, factor by factor
            x, y, z = unrotate(
                s2,
                c2,
                s[_N + 3, j],
                s[_N + 4, j],
                s[_N + 5, j],
                r1 * s[_N, j],
                r1 * s[_N + 1, j],
                r1 * s[_N + 2, j],
            )
            x += r2 * s[_N + 3, j]
            y += r2 * s[_N + 4, j]
            z += r2 * s[_N + 5, j]
            x, y, z = unrotate(s3, c3, s[_N + 6, j], s[_N + 7, j], s[_N + 8, j], x, y, z)
            rate = 2.0 * s[1, j]
            s[RESULT, j] = rate * (x + r3 * s[_N + 6, j])
            s[RESULT + 1, j] = rate * (y + r3 * s[_N + 7, j])
            s[RESULT + 2, j] = rate * (z + r3 * s[_N + 8, j])

    return sample_kernel(kernel)


@inlined
def _join(sn, cs, nx, ny, nz, r1, r2, x, y, z, ax, ay, az):
    """Half rates (omega, alpha)/2 behind a factor: turned into its frame, its own part added.

    alpha <- R^T alpha + R^T omega x 2 theta' n + 2 theta'' n, here with halved rates.
    """
    x, y, z = unrotate(sn, cs, nx, ny, nz, x, y, z)
    ax, ay, az = unrotate(sn, cs, nx, ny, nz, ax, ay, az)
    tx, ty, tz = cross(x, y, z, nx, ny, nz)
    k = 2.0 * r1
    return (
        x + r1 * nx,
        y + r1 * ny,
        z + r1 * nz,
        ax + k * tx + r2 * nx,
        ay + k * ty + r2 * ny,
        az + k * tz + r2 * nz,
    )


def _acceleration(near: bool) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            u = s[0, j]
            _, r1, e1 = _angle_jet(s, _P, j, u)
            b, r2, e2 = _angle_jet(s, _P + 6, j, u)
            c, r3, e3 = _angle_jet(s, _P + 12, j, u)
            if near:
                s2, c2 = sincos_near(b)
                s3, c3 = sincos_near(c)
            else:
                s2, c2 = sincos(b)
                s3, c3 = sincos(c)
            nx, ny, nz = s[_N, j], s[_N + 1, j], s[_N + 2, j]
            x, y, z, ax, ay, az = r1 * nx, r1 * ny, r1 * nz, e1 * nx, e1 * ny, e1 * nz
            x, y, z, ax, ay, az = _join(
                s2, c2, s[_N + 3, j], s[_N + 4, j], s[_N + 5, j], r2, e2, x, y, z, ax, ay, az
            )
            x, y, z, ax, ay, az = _join(
                s3, c3, s[_N + 6, j], s[_N + 7, j], s[_N + 8, j], r3, e3, x, y, z, ax, ay, az
            )
            rate = 2.0 * s[1, j] * s[1, j]
            s[RESULT, j] = rate * ax
            s[RESULT + 1, j] = rate * ay
            s[RESULT + 2, j] = rate * az

    return sample_kernel(kernel)


CUMULATIVE = Family(
    SIZE,
    near=(_orientation(True), _velocity(True), _acceleration(True)),
    far=(_orientation(False), _velocity(False), _acceleration(False)),
)
"""Evaluates (1) and its rates."""
