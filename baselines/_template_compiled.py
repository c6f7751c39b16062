"""What the scheme is, in one line.  The file's name is the scheme's: my_scheme.py is my-scheme."""

from __future__ import annotations

import math

import numpy as np

from quatspline.kernels.family import family
from quatspline.kernels.jit import REACH, compiled, fit_kernel, inlined
from quatspline.kernels.scalars import TINY
from quatspline.kernels.values import keyframe, put_quat, quat_at, vec
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve

START, RISE, G0, G1, SIZE = 0, 4, 8, 12, 16
"""Constants of a segment: q_i, q_{i+1} - q_i, g_0, g_1 of (2), each a quaternion of four numbers."""

# The family: the curve at u, 0 <= u <= 1, from the constants c of its segment.


@inlined
def cubic(c, u):
    """(2): P."""
    g = quat_at(c, G0) + u * quat_at(c, G1)
    return quat_at(c, START) + u * quat_at(c, RISE) + (u - u * u) * g


@inlined
def cubic_slope(c, u):
    """P', by u."""
    g = quat_at(c, G0) + u * quat_at(c, G1)
    return quat_at(c, RISE) + (1.0 - 2.0 * u) * g + (u - u * u) * quat_at(c, G1)


@inlined
def cubic_bend(c, u):
    """P''."""
    return (2.0 - 6.0 * u) * quat_at(c, G1) - 2.0 * quat_at(c, G0)


@inlined
def point(c, u):
    """(1); where P vanishes it has no length either."""
    p = cubic(c, u)
    return (1.0 / math.sqrt(p @ p + TINY)) * p


@inlined
def velocity(c, u):
    """(4): half the body velocity, by u."""
    p = cubic(c, u)
    return (1.0 / (p @ p + TINY)) * vec(~p * cubic_slope(c, u))


@inlined
def acceleration(c, u):
    """(5): the derivative of (4) by u."""
    p, p1 = cubic(c, u), cubic_slope(c, u)
    k = 1.0 / (p @ p + TINY)
    return k * vec(~p * cubic_bend(c, u)) - (2.0 * k * (p @ p1)) * (k * vec(~p * p1))


@inlined
def start(c, u):
    """What takes the place of a point without a length."""
    return quat_at(c, START)


# The fit: from keyframes to the constants of every segment.


@compiled
def slopes(q, h, closed, sign):
    """(3): v_i at every keyframe, (n, 4); at open ends the slope of the end's parabola."""
    n = q.shape[0]
    v = np.empty((n, 4))
    for i in range(n):
        if closed or 0 < i < n - 1:
            before, after = h[i - 1], h[i]
            s0 = (1.0 / before) * (keyframe(q, i, sign) - keyframe(q, i - 1, sign))
            s1 = (1.0 / after) * (keyframe(q, i + 1, sign) - keyframe(q, i, sign))
            put_quat(v[i], 0, (1.0 / (before + after)) * (after * s0 + before * s1))
    if not closed:
        s0 = (1.0 / h[0]) * (quat_at(q[1], 0) - quat_at(q[0], 0))
        s1 = (1.0 / h[n - 2]) * (quat_at(q[n - 1], 0) - quat_at(q[n - 2], 0))
        put_quat(v[0], 0, 2.0 * s0 - quat_at(v[1], 0) if n > 2 else s0)
        put_quat(v[n - 1], 0, 2.0 * s1 - quat_at(v[n - 2], 0) if n > 2 else s1)
    return v


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The constants of (2) from the slopes (3)."""
    v = slopes(q, h, closed, sign)
    for i in range(h.size):
        a, b, c = keyframe(q, i, sign), keyframe(q, i + 1, sign), segments[i]
        leaving, arriving = h[i] * keyframe(v, i, sign), h[i] * keyframe(v, i + 1, sign)
        put_quat(c, START, a)
        put_quat(c, RISE, b - a)
        put_quat(c, G0, leaving - (b - a))
        put_quat(c, G1, 2.0 * (b - a) - leaving - arriving)
    report[REACH] = 0.0  # the largest half angle that a sine is taken of: here none


class Template(SegmentCurve):
    """Normalised cubic Hermite interpolation in R^4: proper name, author (year), acronym.

    C^1, interpolating, local (four keyframes shape a segment):

        Q(u) = P / |P|                                                                           (1)
        P(u) = q_i + u (q_{i+1} - q_i) + u (1 - u) (g_0 + g_1 u),                                (2)
        g_0 = h_i v_i - (q_{i+1} - q_i),  g_1 = 2 (q_{i+1} - q_i) - h_i (v_i + v_{i+1})
        v_i = (h_i s_{i-1} + h_{i-1} s_i) / (h_{i-1} + h_i),  s_i = (q_{i+1} - q_i) / h_i        (3)
        w = vec(Q^-1 Q') = vec(P^-1 P'),  P^-1 = ~P / |P|^2                                      (4)
        w' = vec(P^-1 P'') - 2 (P . P' / |P|^2) w                                                (5)
    """

    # Claims, each of them measured by tests/schemes/test_claims.py.
    title = "Template"
    reference = "shoemake1985"  # a key of references.bib
    continuity = 1  # k of C^k on the unit sphere
    order = 3  # interior approximation order on smooth motion
    support = 4  # keyframes that shape one segment; None means all
    constant_rate = "no"  # "everywhere", "interior" or "no": is a constant spin reproduced?
    family = family(SIZE, point, velocity=velocity, acceleration=acceleration, spare=start)

    def _fit(self, keyframes: Keyframes) -> None:
        # Called once for all tracks.  Options are keyword-only parameters, and go to the kernel as
        # numbers: self._solve(FIT, np.array([...])).
        self._solve(FIT)
