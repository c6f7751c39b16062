"""Great arcs run at uneven speed: Q = (A a + B b)/|A a + B b| with weights A(u), B(u).

The point stays on the arc from a to b (angle theta, axis n), phi = atan2(B sin, A + B cos) from a,

    phi' = (B' A - B A') sin(theta) / D                                                          (1)
    phi'' = ((B'' A - B A'') sin(theta) - phi' D') / D                                           (2)

with D = |A a + B b|^2 = (A + B)^2 - 2 A B (1 - cos(theta)),
and omega = 2 n phi', alpha = 2 n phi''.
"""

from __future__ import annotations

import math

from quatspline._jit import CONSTANTS, RESULT, inlined
from quatspline.primitives import log_between, polar

A, B, AXIS, SINE, VERSINE = 0, 4, 8, 11, 12
"""Constants of a chord: a (4), b (4), n (3), sin(theta), 1 - cos(theta)."""

SIZE = 13

_A, _B, _N = CONSTANTS + A, CONSTANTS + B, CONSTANTS + AXIS
_SINE, _VERSINE = CONSTANTS + SINE, CONSTANTS + VERSINE


@inlined
def set_chord(segments, i, a, b):
    """Store the chord from a to b as the constants of segment i; returns its angle."""
    x, y, z = log_between(a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3])
    theta, nx, ny, nz = polar(x, y, z)
    for c in range(4):
        segments[i, A + c] = a[c]
        segments[i, B + c] = b[c]
    segments[i, AXIS] = nx
    segments[i, AXIS + 1] = ny
    segments[i, AXIS + 2] = nz
    half = math.sin(0.5 * theta)
    segments[i, SINE] = math.sin(theta)
    segments[i, VERSINE] = 2.0 * half * half
    return theta


@inlined
def set_point(s, j, a, b):
    """The normalised a-weighted and b-weighted sum into the result rows."""
    k = 1.0 / math.sqrt((a + b) * (a + b) - 2.0 * a * b * s[_VERSINE, j])
    a *= k
    b *= k
    s[RESULT, j] = a * s[_A, j] + b * s[_B, j]
    s[RESULT + 1, j] = a * s[_A + 1, j] + b * s[_B + 1, j]
    s[RESULT + 2, j] = a * s[_A + 2, j] + b * s[_B + 2, j]
    s[RESULT + 3, j] = a * s[_A + 3, j] + b * s[_B + 3, j]


@inlined
def _set_rate(s, j, rate):
    s[RESULT, j] = rate * s[_N, j]
    s[RESULT + 1, j] = rate * s[_N + 1, j]
    s[RESULT + 2, j] = rate * s[_N + 2, j]


@inlined
def set_velocity(s, j, a, a1, b, b1):
    """omega by (1) from the weights and their slopes in u."""
    d = (a + b) * (a + b) - 2.0 * a * b * s[_VERSINE, j]
    _set_rate(s, j, 2.0 * s[1, j] * (b1 * a - b * a1) * s[_SINE, j] / d)


@inlined
def set_acceleration(s, j, a, a1, a2, b, b1, b2):
    """alpha by (2)."""
    d = (a + b) * (a + b) - 2.0 * a * b * s[_VERSINE, j]
    d1 = 2.0 * ((a + b) * (a1 + b1) - (a1 * b + a * b1) * s[_VERSINE, j])
    phi1 = (b1 * a - b * a1) * s[_SINE, j] / d
    phi2 = ((b2 * a - b * a2) * s[_SINE, j] - phi1 * d1) / d
    _set_rate(s, j, 2.0 * s[1, j] * s[1, j] * phi2)
