"""Great arcs: the segments of slerp, and the first level of every nested construction.

An arc from a to b of angle theta is (a, b', theta) with b' orthogonal to a:
p(x) = a cos(x theta) + b' sin(x theta), at constant speed theta in x.
"""

from __future__ import annotations

from quatspline.kernels.family import family
from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import sincos, sincos_near
from quatspline.kernels.values import Vec, log, polar, pure, put_quat, quat_at, vec

A, ASIDE, ANGLE, SIZE = 0, 4, 8, 9
"""Constants of an arc: a (4), b' (4), theta."""


@inlined
def set_arc(c, k, a, b):
    """Store the arc from a to b at places k ... of a segment's constants; returns its angle."""
    theta, n = polar(log(~a * b))
    put_quat(c, k + A, a)
    put_quat(c, k + ASIDE, a * pure(n))
    c[k + ANGLE] = theta
    return theta


@inlined
def along(c, k, sine, cosine):
    """The point of the arc at places k ... at the angle with this sine and cosine."""
    return cosine * quat_at(c, k + A) + sine * quat_at(c, k + ASIDE)


@inlined
def near_point(c, u):
    """p(u) for an angle up to `scalars.NEAR`."""
    sine, cosine = sincos_near(u * c[ANGLE])
    return along(c, 0, sine, cosine)


@inlined
def point(c, u):
    """p(u)."""
    sine, cosine = sincos(u * c[ANGLE])
    return along(c, 0, sine, cosine)


@inlined
def velocity(c, u):
    """theta n, n = vec(~a b')."""
    return c[ANGLE] * vec(~quat_at(c, A) * quat_at(c, ASIDE))


@inlined
def acceleration(c, u):
    """Constant rate."""
    return Vec(0.0, 0.0, 0.0)


_FAR = family(SIZE, point, velocity=velocity, acceleration=acceleration)

ARC = family(SIZE, near_point, velocity=velocity, acceleration=acceleration, far=_FAR)
"""One great arc a segment, at constant speed."""
