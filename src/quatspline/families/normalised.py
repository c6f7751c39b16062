"""Cubics in R^4, normalised: what libraries do that interpolate a quaternion's four numbers.

On a segment from a to b, with u in [0, 1],

    Q(u) = x / |x|                                                                               (1)
    x(u) = a + u d + u (1 - u) ((1 - u) f - u g),  d = b - a                                     (2)

where f = x'(0) - d and g = x'(1) - d are what the slopes at the ends have beyond the chord's.  (2) is a at u = 0
and a + d at u = 1 to the last digit, however large f and g are.  The length of x cancels from the rates:

    omega/2 = vec(~x x') / |x|^2                                                                 (3)
    alpha/2 = vec(~x x'') / |x|^2 - (2 x . x' / |x|^2) omega/2                                   (4)
"""

from __future__ import annotations

import math

from quatspline.kernels.family import family
from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import TINY
from quatspline.kernels.values import put_quat, quat_at, vec

# notation: the constants of a segment are a, d, f, g of (2), each a quaternion of four numbers.
START, CHORD, LEAVING, ARRIVING, SIZE = 0, 4, 8, 12, 16


@inlined
def set_ends(c, a, b, leaving, arriving):
    """A segment from a to b with slopes x'(0) and x'(1) by u."""
    set_excess(c, a, b, leaving - (b - a), arriving - (b - a))


@inlined
def set_excess(c, a, b, f, g):
    """A segment from a to b with f and g of (2)."""
    put_quat(c, START, a)
    put_quat(c, CHORD, b - a)
    put_quat(c, LEAVING, f)
    put_quat(c, ARRIVING, g)


@inlined
def cubic(c, u):
    """(2)."""
    bend = (1.0 - u) * quat_at(c, LEAVING) - u * quat_at(c, ARRIVING)
    return quat_at(c, START) + u * quat_at(c, CHORD) + (u - u * u) * bend


@inlined
def slope(c, u):
    """x'."""
    leaving = ((1.0 - u) * (1.0 - 3.0 * u)) * quat_at(c, LEAVING)
    return quat_at(c, CHORD) + leaving + (u * (3.0 * u - 2.0)) * quat_at(c, ARRIVING)


@inlined
def bend(c, u):
    """x''."""
    return (6.0 * u - 4.0) * quat_at(c, LEAVING) + (6.0 * u - 2.0) * quat_at(c, ARRIVING)


@inlined
def point(c, u):
    """(1); where x vanishes it has no direction."""
    x = cubic(c, u)
    return (1.0 / math.sqrt(x @ x + TINY)) * x


@inlined
def velocity(c, u):
    """(3)."""
    x = cubic(c, u)
    return (1.0 / (x @ x + TINY)) * vec(~x * slope(c, u))


@inlined
def acceleration(c, u):
    """(4)."""
    x, x1 = cubic(c, u), slope(c, u)
    k = 1.0 / (x @ x + TINY)
    return k * vec(~x * bend(c, u)) - (2.0 * k * (x @ x1)) * (k * vec(~x * x1))


@inlined
def start(c, u):
    """What takes the place of a point without a direction."""
    return quat_at(c, START)


NORMALISED = family(SIZE, point, velocity=velocity, acceleration=acceleration, spare=start)
"""Evaluates (1) and its rates (3), (4)."""
