"""Great arcs run at uneven speed: Q = (A a + B b)/|A a + B b| with weights A(u), B(u) >= 0.

The point stays on the arc from a to b (angle theta, axis n), at the angle phi from a,

    cos(phi) = (A + B cos(theta)) / sqrt(D),  sin(phi) = B sin(theta) / sqrt(D)                  (1)
    phi' = (B' A - B A') sin(theta) / D                                                          (2)
    phi'' = ((B'' A - B A'') sin(theta) - phi' D') / D                                           (3)

with D = |A a + B b|^2 = (A - B)^2 + 2 A B (1 + cos(theta)), omega = 2 n phi', alpha = 2 n phi''.
Written so, nothing cancels however near b is to -a, where A a + B b would.
"""

from __future__ import annotations

import math

from quatspline.kernels.jit import inlined
from quatspline.kernels.values import log, polar, pure, put_quat, put_vec, quat_at, vec_at

A, ASIDE, AXIS, SINE, COVERSINE, VERSINE = 0, 4, 8, 11, 12, 13
"""Constants of a chord: a (4), a n (4), n (3), sin(theta), 1 + cos(theta), 1 - cos(theta)."""

SIZE = 14


@inlined
def set_chord(c, a, b):
    """Store the chord from a to b as the constants of a segment; returns its angle."""
    theta, n = polar(log(~a * b))
    put_quat(c, A, a)
    put_quat(c, ASIDE, a * pure(n))
    put_vec(c, AXIS, n)
    sine, cosine = math.sin(0.5 * theta), math.cos(0.5 * theta)
    c[SINE], c[COVERSINE], c[VERSINE] = (
        2.0 * sine * cosine,
        2.0 * cosine * cosine,
        2.0 * sine * sine,
    )
    return theta


@inlined
def weighted_point(c, a, b):
    """(1) for weights a and b."""
    apart, lift = a - b, b * c[COVERSINE]
    k = 1.0 / math.sqrt(apart * apart + 2.0 * a * lift)
    return (k * (apart + lift)) * quat_at(c, A) + (k * b * c[SINE]) * quat_at(c, ASIDE)


@inlined
def weighted_velocity(c, a, a1, b, b1):
    """phi' n by (2) from the weights and their slopes in u."""
    d = (a - b) * (a - b) + 2.0 * a * b * c[COVERSINE]
    return ((b1 * a - b * a1) * c[SINE] / d) * vec_at(c, AXIS)


@inlined
def weighted_acceleration(c, a, a1, a2, b, b1, b2):
    """phi'' n by (3)."""
    d = (a - b) * (a - b) + 2.0 * a * b * c[COVERSINE]
    d1 = 2.0 * ((a - b) * (a1 - b1) + (a1 * b + a * b1) * c[COVERSINE])
    phi1 = (b1 * a - b * a1) * c[SINE] / d
    return (((b2 * a - b * a2) * c[SINE] - phi1 * d1) / d) * vec_at(c, AXIS)
