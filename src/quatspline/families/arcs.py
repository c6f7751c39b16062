"""Great arcs: the segments of slerp, and the first level of every nested construction.

An arc from a to b of angle theta is (a, b', theta) with b' orthogonal to a:
p(x) = a cos(x theta) + b' sin(x theta), at constant speed theta in x.
"""

from __future__ import annotations

from numba import carray

from quatspline.kernels.jit import BLOCK, CONSTANTS, RESULT, ROWS, Kernel, inlined, sample_kernel
from quatspline.kernels.scalars import between, log_between, mul, polar, sincos, sincos_near
from quatspline.segments import Family

SIZE = 9
"""Constants of an arc: a (4), b' (4), theta."""


@inlined
def set_arc(segments, i, c, a0, a1, a2, a3, b0, b1, b2, b3):
    """Store the arc from a to b as constants c ... c + 8 of segment i; returns its angle."""
    x, y, z = log_between(a0, a1, a2, a3, b0, b1, b2, b3)
    theta, nx, ny, nz = polar(x, y, z)
    w, x, y, z = mul(a0, a1, a2, a3, 0.0, nx, ny, nz)
    segments[i, c] = a0
    segments[i, c + 1] = a1
    segments[i, c + 2] = a2
    segments[i, c + 3] = a3
    segments[i, c + 4] = w
    segments[i, c + 5] = x
    segments[i, c + 6] = y
    segments[i, c + 7] = z
    segments[i, c + 8] = theta
    return theta


@inlined
def along(s, c, j, sine, cosine):
    """The point of the arc in rows c ... at the angle with this sine and cosine."""
    return (
        cosine * s[c, j] + sine * s[c + 4, j],
        cosine * s[c + 1, j] + sine * s[c + 5, j],
        cosine * s[c + 2, j] + sine * s[c + 6, j],
        cosine * s[c + 3, j] + sine * s[c + 7, j],
    )


def _orientation(near: bool) -> Kernel:
    def kernel(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            angle = s[0, j] * s[CONSTANTS + 8, j]
            if near:
                sine, cosine = sincos_near(angle)
            else:
                sine, cosine = sincos(angle)
            w, x, y, z = along(s, CONSTANTS, j, sine, cosine)
            s[RESULT, j] = w
            s[RESULT + 1, j] = x
            s[RESULT + 2, j] = y
            s[RESULT + 3, j] = z

    return sample_kernel(kernel)


@sample_kernel
def VELOCITY(sheet, n):
    """omega = 2 theta n / h, n = vec(a^-1 b')."""
    s = carray(sheet, (ROWS, BLOCK))
    c = CONSTANTS
    for j in range(n):
        _, x, y, z = between(
            s[c, j],
            s[c + 1, j],
            s[c + 2, j],
            s[c + 3, j],
            s[c + 4, j],
            s[c + 5, j],
            s[c + 6, j],
            s[c + 7, j],
        )
        rate = 2.0 * s[1, j] * s[c + 8, j]
        s[RESULT, j] = rate * x
        s[RESULT + 1, j] = rate * y
        s[RESULT + 2, j] = rate * z


@sample_kernel
def ACCELERATION(sheet, n):
    """Constant rate: alpha = 0."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        s[RESULT, j] = 0.0
        s[RESULT + 1, j] = 0.0
        s[RESULT + 2, j] = 0.0


ARC = Family(
    SIZE,
    near=(_orientation(True), VELOCITY, ACCELERATION),
    far=(_orientation(False), VELOCITY, ACCELERATION),
)
"""One great arc a segment, at constant speed."""
