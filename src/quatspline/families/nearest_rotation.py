"""The rotation nearest to a matrix B, in the Frobenius norm: the one that maximises g = tr(C^T B).

With Cayley parameters d, the vector part of its quaternion over the scalar part,

    C(d) = ((1 - |d|^2) I + 2 d d^T + 2 [d]) / (1 + |d|^2)                                         (1)

and with tau = tr B, z = vee(B) = (B_32 - B_23, B_13 - B_31, B_21 - B_12), the maximum has

    A(g) d = z,   A(g) = (tau + g) I - (B + B^T),   f(g) = g - tau - z . d = 0.                    (2)

f increases and is concave beyond the largest pole, where A is positive definite; its root there is the
maximum.  Newton's step, f / (1 + |d|^2), makes g the Rayleigh quotient of d.  Every step solves one linear
system of order three.

In axes of which the third is along z, z = zeta e_3, only the third equation of (2) has a right side.  With M the
first two rows and columns of A there, and p those of B + B^T beside its third column,

    M x = p,   d = y (x_1, x_2, 1),   y = zeta / (A_33 - p . x)                                    (3)

and every step solves a system of order two, for the same iterates.
"""

from __future__ import annotations

import math

from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.values import Mat, Quat, Vec, solve_symmetric, transposed, unit

LIMIT = 60
"""Steps of the iteration: Newton takes 3 to 8, bisection beside a pole the rest."""
CLOSE = 1e-14
"""A step of g (about 3) that moves the orientation by rounding only."""


@compiled
def nearest(b):
    """The unit quaternion of the nearest rotation."""
    d, _ = by_three(b)
    return unit(Quat(1.0, d.x, d.y, d.z))


@compiled
def by_three(b):
    """(2): d, and the linear systems solved for it.

    Newton's iteration from g = 3, kept between a point below the root and the bound
    g <= sqrt(3) |B|; what leaves that bracket, or makes A indefinite, is bisected.
    """
    tau, z = trace(b), vee(b)
    both = b + transposed(b)
    low, g, high = bracket(b)
    d = Vec(0.0, 0.0, 0.0)
    steps = 0
    while steps < LIMIT:
        steps += 1
        x, definite = solve_symmetric(scalar(tau + g) - both, z)
        step = 0.0
        if definite:
            d = x
            step = -(g - tau - z @ d) / (1.0 + d @ d)
            if abs(step) < CLOSE:
                break
        low, g, high = narrowed(low, g, high, step, definite)
    return d, steps


@compiled
def by_two(b):
    """(3): the same d by systems of order two, after one reflection that takes z to the third axis."""
    tau, z = trace(b), vee(b)
    both = b + transposed(b)
    zeta = math.sqrt(z @ z)
    side = math.copysign(1.0, z.z)
    v = Vec(z.x, z.y, z.z + side * zeta)  # H = I - f v v^T takes z to -side zeta e_3
    f = 1.0 / (zeta * (zeta + abs(z.z))) if zeta > 0.0 else 0.0
    p = f * (both @ v)
    w = p - (0.5 * f * (v @ p)) * v
    xx, yy, zz = both.a.x - 2.0 * v.x * w.x, both.b.y - 2.0 * v.y * w.y, both.c.z - 2.0 * v.z * w.z
    xy = both.b.x - v.x * w.y - w.x * v.y
    zx, yz = both.c.x - v.x * w.z - w.x * v.z, both.c.y - v.y * w.z - w.y * v.z
    low, g, high = bracket(b)
    d = Vec(0.0, 0.0, 0.0)
    steps = 0
    while steps < LIMIT:
        steps += 1
        a, e, c = tau + g - xx, tau + g - yy, tau + g - zz
        minor = a * e - xy * xy
        x, y = zx * e + xy * yz, a * yz + xy * zx  # p of (3) times the minor
        det = c * minor - (zx * x + yz * y)
        definite = a > 0.0 and minor > 0.0 and det > 0.0
        step = 0.0
        if definite:
            k = zeta / det
            d = k * Vec(x, y, minor)
            step = -(g - tau - zeta * d.z) / (1.0 + d @ d)
            if abs(step) < CLOSE:
                break
        low, g, high = narrowed(low, g, high, step, definite)
    return (-side) * (d - (f * (v @ d)) * v), steps


@inlined
def bracket(b):
    """A bound of g from below, where the iteration starts, and a bound from above."""
    high = math.sqrt(3.0 * (b.a @ b.a + b.b @ b.b + b.c @ b.c))
    return -high, min(3.0, high), high


@inlined
def narrowed(low, g, high, step, definite):
    """The bracket and g after a step: Newton's, or the middle."""
    if definite and step < 0.0:
        high = g
    else:
        low = g
    g = g + step if definite and low < g + step < high else 0.5 * (low + high)
    return low, g, high


@inlined
def trace(m):
    """The trace."""
    return m.a.x + m.b.y + m.c.z


@inlined
def vee(m):
    """(M_32 - M_23, M_13 - M_31, M_21 - M_12)."""
    return Vec(m.b.z - m.c.y, m.c.x - m.a.z, m.a.y - m.b.x)


@inlined
def scalar(f):
    """f I."""
    return Mat(Vec(f, 0.0, 0.0), Vec(0.0, f, 0.0), Vec(0.0, 0.0, f))
