"""Spherical biarcs of Wang & Joe: two circular arcs a segment."""

from __future__ import annotations

import math

import numpy as np

from quatspline.families.circles import BIARC, FIRST, SECOND, SPLIT, set_circle
from quatspline.fitting.tangents import CHART, chart_velocities, step
from quatspline.kernels.jit import REACH, compiled, fit_kernel
from quatspline.kernels.values import (
    Vec,
    keyframe,
    norm,
    pure,
    put_quat,
    quat_at,
    unit,
    vec_at,
)
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve

STILL = 1e-14
"""A velocity below this share of its neighbours' has no direction; a sum below it no bisector."""
SHORT = 1e-11
"""An arc with a chord below this share of the step is none: motion turns back on itself there."""


class Biarc(SegmentCurve):
    """Spherical biarcs, after Wang & Joe (1993), at constant speed on each segment.

    G^1, but C^0 as a function of time (the speed jumps at keyframes), interpolating, local (four
    keyframes shape a segment), order 2.  Unit tangents T_i are the directions of the three-point chart
    velocities; where that vanishes (a point of return) the direction of the next step.

        (1 - T_0.T_1) x^2 + (T_0.q_1 - q_0.T_1) x - (1 - q_0.q_1) = 0,    x = tan(a) >= 0           (1)
        b_0 = q_0 cos a + T_0 sin a,  b_1 = q_1 cos a - T_1 sin a,  J = (b_0 + b_1)/|b_0 + b_1|     (2)

    Tangent great arcs of equal length a meet in b_0 and b_1; the arcs q_0 to J and J to q_1 share their
    tangent at the joint J.  Which of the one-parameter family of biarcs the publication prefers is
    not known to us [wang1993].
    """

    title = "Spherical biarcs"
    reference = "wang1993"
    continuity = 0
    order = 2
    support = 4
    constant_rate = "everywhere"
    family = BIARC

    def _fit(self, keyframes: Keyframes) -> None:
        self._solve(FIT)


@compiled
def _direction(q, h, i, sign, closed, v):
    """The direction of v at keyframe i; where it vanishes that of the next step, or of the last."""
    for way in (1, -1):
        if closed or 0 <= i + way < q.shape[0]:
            l = step(q, i, i + way, sign)
            rate = norm(l) / h[(i if way > 0 else i - 1) % h.size]
            if rate > 0.0 and norm(v) <= STILL * rate:
                v = float(way) * l
    return v if v @ v > 0.0 else Vec(1.0, 0.0, 0.0)


@compiled
def _tangents(q, h, sign, closed):
    """T_i of every keyframe, (n, 4)."""
    v = chart_velocities(q, h, closed, sign, 3, CHART)
    tangents = np.empty_like(q)
    for i in range(q.shape[0]):
        direction = _direction(q, h, i, sign, closed, vec_at(v[i], 0))
        put_quat(tangents[i], 0, unit(quat_at(q[i], 0) * pure(direction)))
    return tangents


@compiled
def _joint(q0, t0, q1, t1):
    """(1) and (2)."""
    gap, turn = q1 - q0, t1 - t0
    a, k, c = 0.5 * (turn @ turn), t0 @ q1 - q0 @ t1, 0.5 * (gap @ gap)
    root = math.sqrt(k * k + 4.0 * a * c)
    angle = math.atan2(2.0 * c, k + root) if k >= 0.0 else math.atan2(root - k, 2.0 * a)
    total = math.cos(angle) * (q0 + q1) + math.sin(angle) * (t0 - t1)
    if total @ total < STILL:  # parallel tangents across the step: halfway by symmetry
        total = q0 + q1
    return unit(total)


@compiled
def _arc(p, tangent, end, shortest):
    """The arc from p to end: X, Y of `circles` (1), its angle and its length."""
    chord = end - p
    ahead, size = chord @ tangent, chord @ chord
    if size <= shortest * shortest:  # a point, not a full circle in a plane made of rounding
        return tangent, -p, 0.0, 0.0
    aside = chord - ahead * tangent
    aside = aside - (aside @ tangent) * tangent  # twice is orthogonal to rounding
    # curvature vector c = 2 aside / |chord|^2; its part along p is -1 on the sphere, whatever rounding says
    k = 2.0 / size
    c = k * aside + (-1.0 - k * (aside @ p)) * p
    bend = norm(c)
    r = 1.0 / bend
    angle = 2.0 * math.atan2(0.5 * size * bend, ahead)
    return r * tangent, (r * r) * c, angle, r * angle


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Both arcs of every segment, the second one run backwards from its keyframe."""
    tangents = _tangents(q, h, sign, closed)
    for i in range(h.size):
        q0, q1 = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        t0, t1 = keyframe(tangents, i, sign), keyframe(tangents, i + 1, sign)
        joint, shortest = _joint(q0, t0, q1, t1), SHORT * norm(q1 - q0) + STILL
        x0, y0, angle0, length0 = _arc(q0, t0, joint, shortest)
        x1, y1, angle1, length1 = _arc(q1, -t1, joint, shortest)
        total = length0 + length1
        split = length0 / total if total > 0.0 else 0.5
        k0 = angle0 / split if split > 0.0 else 0.0
        k1 = angle1 / (1.0 - split) if split < 1.0 else 0.0
        set_circle(segments[i], FIRST, q0, x0, y0, (0.0, k0, 0.0))
        set_circle(segments[i], SECOND, q1, x1, y1, (k1, -k1, 0.0))
        segments[i, SPLIT] = split
    report[REACH] = 0.0
