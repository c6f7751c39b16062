"""Products of exponentials about fixed axes, the cumulative form of Kim, Kim & Shin (1995).

On a segment, with u in [0, 1],

    Q(u) = Q_0 exp(theta_1(u) n_1) exp(theta_2(u) n_2) exp(theta_3(u) n_3)                    (1)

with unit axes n_k and polynomials theta_k of degree 5 at most (`quintics`).  The paper's quartic, the quintic,
the cumulative cubic Hermite and B-spline curves all have this form.  Rates come from a scan over
the factors, each turning what stands to its left into its own frame [kim1995general].
"""

from __future__ import annotations

from numba import carray

from quatspline.families.polynomials import bound, from_powers, quintic, quintic_jet
from quatspline.kernels.jit import BLOCK, CONSTANTS, RESULT, ROWS, Kernel, inlined, sample_kernel
from quatspline.kernels.scalars import (
    NEAR,
    SMALL,
    cross,
    mul,
    polar,
    sincos,
    sincos_any,
    sincos_near,
    sincos_small,
    unrotate,
)
from quatspline.segments import Family

# notation: the constants of a segment are Q_0 (4), Q_0 n_1 (4), n_1, n_2, n_3 (9), and the six
# constants of theta_1, theta_2, theta_3 as `quintics` has them (18).
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
    """Factor k (0, 1, 2) of segment i: exp(f(u) v), v = (x, y, z), f given by its powers of u.

    Returns a bound of the half angle over u in [0, 1].
    """
    length, nx, ny, nz = polar(x, y, z)
    f = from_powers(c0, c1, c2, c3, c4, c5)
    set_turn(segments, i, k, length, nx, ny, nz, f[0], f[1], f[2], f[3], f[4], f[5])
    return length * bound(f[0], f[1], f[2], f[3], f[4], f[5])


@inlined
def set_turn(segments, i, k, length, nx, ny, nz, c0, c1, c2, c3, c4, c5):
    """Factor k of segment i from the length and the axis of v, f in the form of `quintics`."""
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


# Kernels: `near` for half angles up to NEAR, `small` for outer factors up to SMALL, `anywhere` for any.


def _orientation(near: bool, small: bool = False, anywhere: bool = False) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            u = s[0, j]
            a, b, c = quintic(s, _P, j, u), quintic(s, _P + 6, j, u), quintic(s, _P + 12, j, u)
            if small:
                s1, c1 = sincos_small(a)
                s2, c2 = sincos_near(b)
                s3, c3 = sincos_small(c)
            elif near:
                s1, c1 = sincos_near(a)
                s2, c2 = sincos_near(b)
                s3, c3 = sincos_near(c)
            elif anywhere:
                s1, c1 = sincos_any(a)
                s2, c2 = sincos_any(b)
                s3, c3 = sincos_any(c)
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


def _velocity(near: bool, small: bool = False) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            u = s[0, j]
            _, r1, _ = quintic_jet(s, _P, j, u)
            b, r2, _ = quintic_jet(s, _P + 6, j, u)
            c, r3, _ = quintic_jet(s, _P + 12, j, u)
            if small:
                s2, c2 = sincos_near(b)
                s3, c3 = sincos_small(c)
            elif near:
                s2, c2 = sincos_near(b)
                s3, c3 = sincos_near(c)
            else:
                s2, c2 = sincos_any(b)
                s3, c3 = sincos_any(c)
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
    """Half of alpha behind a factor: turned into its frame, its own part added.

    alpha <- R^T alpha + R^T omega x 2 theta' n + 2 theta'' n = R^T (alpha + omega x 2 theta' n)
    + 2 theta'' n, for R leaves n in its place; here with halved rates.
    """
    tx, ty, tz = cross(x, y, z, nx, ny, nz)
    k = 2.0 * r1
    x, y, z = unrotate(sn, cs, nx, ny, nz, ax + k * tx, ay + k * ty, az + k * tz)
    return x + r2 * nx, y + r2 * ny, z + r2 * nz


def _acceleration(near: bool, small: bool = False) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            u = s[0, j]
            _, r1, e1 = quintic_jet(s, _P, j, u)
            b, r2, e2 = quintic_jet(s, _P + 6, j, u)
            c, r3, e3 = quintic_jet(s, _P + 12, j, u)
            if small:
                s2, c2 = sincos_near(b)
                s3, c3 = sincos_small(c)
            elif near:
                s2, c2 = sincos_near(b)
                s3, c3 = sincos_near(c)
            else:
                s2, c2 = sincos_any(b)
                s3, c3 = sincos_any(c)
            px, py, pz = s[_N + 3, j], s[_N + 4, j], s[_N + 5, j]
            mx, my, mz = unrotate(s2, c2, px, py, pz, s[_N, j], s[_N + 1, j], s[_N + 2, j])
            # behind two factors: omega = r1 m + r2 p, alpha = e1 m + 2 r1 r2 m x p + e2 p
            tx, ty, tz = cross(mx, my, mz, px, py, pz)
            k = 2.0 * r1 * r2
            ax, ay, az = _join(
                s3,
                c3,
                s[_N + 6, j],
                s[_N + 7, j],
                s[_N + 8, j],
                r3,
                e3,
                r1 * mx + r2 * px,
                r1 * my + r2 * py,
                r1 * mz + r2 * pz,
                e1 * mx + k * tx + e2 * px,
                e1 * my + k * ty + e2 * py,
                e1 * mz + k * tz + e2 * pz,
            )
            rate = 2.0 * s[1, j] * s[1, j]
            s[RESULT, j] = rate * ax
            s[RESULT + 1, j] = rate * ay
            s[RESULT + 2, j] = rate * az

    return sample_kernel(kernel)


_NEAR = (_orientation(True), _velocity(True), _acceleration(True))
_RATES = (_velocity(False), _acceleration(False))
_ANYWHERE = (_orientation(False, anywhere=True), *_RATES)

CUMULATIVE = Family(SIZE, near=_NEAR, far=(_orientation(False), *_RATES))
"""Evaluates (1) and its rates."""

UNBOUNDED = Family(SIZE, near=_NEAR, far=_ANYWHERE)
"""The same where, beside spacings of extreme ratio, angles may be of any size."""

MIDDLE = Family(
    SIZE,
    near=(_orientation(True, True), _velocity(True, True), _acceleration(True, True)),
    far=_ANYWHERE,
)
"""That where the outer factors are small: a fit kernel counts their angles SIDE times."""

SIDE = NEAR / SMALL
