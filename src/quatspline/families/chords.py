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

from quatspline.kernels.jit import CONSTANTS, RESULT, inlined
from quatspline.kernels.scalars import log_between, mul, polar

A, ASIDE, AXIS, SINE, COVERSINE, VERSINE = 0, 4, 8, 11, 12, 13
"""Constants of a chord: a (4), a n (4), n (3), sin(theta), 1 + cos(theta), 1 - cos(theta)."""

SIZE = 14

_A, _B, _N = CONSTANTS + A, CONSTANTS + ASIDE, CONSTANTS + AXIS
_SINE, _COVERSINE = CONSTANTS + SINE, CONSTANTS + COVERSINE


@inlined
def set_chord(segments, i, a, b):
    """Store the chord from a to b as the constants of segment i; returns its angle."""
    x, y, z = log_between(a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3])
    theta, nx, ny, nz = polar(x, y, z)
    aside = mul(a[0], a[1], a[2], a[3], 0.0, nx, ny, nz)
    for c in range(4):
        segments[i, A + c] = a[c]
        segments[i, ASIDE + c] = aside[c]
    segments[i, AXIS] = nx
    segments[i, AXIS + 1] = ny
    segments[i, AXIS + 2] = nz
    sine, cosine = math.sin(0.5 * theta), math.cos(0.5 * theta)
    segments[i, SINE] = 2.0 * sine * cosine
    segments[i, COVERSINE] = 2.0 * cosine * cosine
    segments[i, VERSINE] = 2.0 * sine * sine
    return theta


@inlined
def set_point(s, j, a, b):
    """(1) for weights a and b into the result rows."""
    apart, lift = a - b, b * s[_COVERSINE, j]
    k = 1.0 / math.sqrt(apart * apart + 2.0 * a * lift)
    cosine, sine = k * (apart + lift), k * b * s[_SINE, j]
    s[RESULT, j] = cosine * s[_A, j] + sine * s[_B, j]
    s[RESULT + 1, j] = cosine * s[_A + 1, j] + sine * s[_B + 1, j]
    s[RESULT + 2, j] = cosine * s[_A + 2, j] + sine * s[_B + 2, j]
    s[RESULT + 3, j] = cosine * s[_A + 3, j] + sine * s[_B + 3, j]


@inlined
def _set_rate(s, j, rate):
    s[RESULT, j] = rate * s[_N, j]
    s[RESULT + 1, j] = rate * s[_N + 1, j]
    s[RESULT + 2, j] = rate * s[_N + 2, j]


@inlined
def set_velocity(s, j, a, a1, b, b1):
    """omega by (2) from the weights and their slopes in u."""
    d = (a - b) * (a - b) + 2.0 * a * b * s[_COVERSINE, j]
    _set_rate(s, j, 2.0 * s[1, j] * (b1 * a - b * a1) * s[_SINE, j] / d)


@inlined
def set_acceleration(s, j, a, a1, a2, b, b1, b2):
    """alpha by (3)."""
    d = (a - b) * (a - b) + 2.0 * a * b * s[_COVERSINE, j]
    d1 = 2.0 * ((a - b) * (a1 - b1) + (a1 * b + a * b1) * s[_COVERSINE, j])
    phi1 = (b1 * a - b * a1) * s[_SINE, j] / d
    phi2 = ((b2 * a - b * a2) * s[_SINE, j] - phi1 * d1) / d
    _set_rate(s, j, 2.0 * s[1, j] * s[1, j] * phi2)
