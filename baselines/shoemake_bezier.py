"""Shoemake's slerp-Bezier spline of 1985: controls by doubling and bisecting, uniform knots."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from quatspline.families.nested import TRIANGLE, restored
from quatspline.fitting.bezier import set_controls
from quatspline.fitting.tangents import CHART, SECANT, end_velocity, keyframe, moved
from quatspline.kernels.jit import REACH, compiled, fit_kernel
from quatspline.kernels.operations import Operations, Per
from quatspline.kernels.scalars import slerp
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve

STATIONARY = 2.0

ANTIPODES = 1e-12
"""A sum of unit quaternions shorter than this has no direction."""


class ShoemakeBezier(SegmentCurve):
    """Slerp-Bezier spline of Shoemake (1985), for uniform times.

    C^1, interpolating, local (four keyframes shape a segment); order 3 inside.  With
    Double(p, q) = 2 (p . q) q - p and Bisect(p, q) = (p + q)/|p + q|,

        A_i = Bisect(Double(q_{i-1}, q_i), q_{i+1})                                              (1)
        b_i = slerp(q_i, A_i; 1/3),    c_i = Double(b_i, q_i)                                    (2)

    and segment i is De Casteljau's algorithm by slerps on (q_i, b_i, c_{i+1}, q_{i+1}).  The
    construction knows no times: on non-uniform knots its velocity would jump [shoemake1985].

    Options
    -------
    handle
        "third": (2); "whole": b_i = A_i, with rates at keyframes three times too large.
    ends
        "stationary": b_0 = q_0, starts and stops at rest and has order 1 there; "chart" and
        "secant" as for `catmull-rom`.
    """

    title = "Shoemake's slerp-Bezier spline of 1985"
    reference = "shoemake1985"
    continuity = 1
    order = 3
    support = 4
    constant_rate: Literal["everywhere", "interior", "no"] = "interior"
    non_uniform = False
    family = TRIANGLE
    operations = Operations(slerps=Per(sample=6, inner_keyframe=1), logs=Per(segment=3))

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        handle: Literal["third", "whole"] = "third",
        ends: Literal["stationary", "chart", "secant"] = "stationary",
    ) -> None:
        if handle == "whole":
            self.order, self.constant_rate = 1, "no"
        elif ends != "stationary" or keyframes.closed:
            self.constant_rate = "everywhere"
        code = {"chart": CHART, "secant": SECANT, "stationary": STATIONARY}[ends]
        self._solve(FIT, np.array([1.0 / 3.0 if handle == "third" else 1.0, code]))


@compiled
def _double(p, q):
    """p reflected about q."""
    k = 2.0 * (p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3])
    return k * q[0] - p[0], k * q[1] - p[1], k * q[2] - p[2], k * q[3] - p[3]


@compiled
def _handle(q, sign, i, share):
    """(1) and the first of (2) at a keyframe with neighbours."""
    b, c = keyframe(q, i, sign), keyframe(q, i + 1, sign)
    a = _double(keyframe(q, i - 1, sign), b)
    w, x, y, z = a[0] + c[0], a[1] + c[1], a[2] + c[2], a[3] + c[3]
    length = math.sqrt(w * w + x * x + y * y + z * z)
    if length < ANTIPODES:  # half a turn forth and back: no mean direction, no velocity
        return b
    k = 1.0 / length
    p = slerp(b[0], b[1], b[2], b[3], k * w, k * x, k * y, k * z, share)
    return restored(p, b)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Controls of every segment; parameters: the share of (2), ends."""
    n = q.shape[0]
    handles, time, x = np.empty((n, 4)), np.empty(5), np.empty((5, 3))
    for i in range(n):
        p = keyframe(q, i, sign)
        if closed or 0 < i < n - 1:
            p = _handle(q, sign, i, parameters[0])
        elif parameters[1] != STATIONARY:
            v = end_velocity(q, h, i, 3, parameters[1], time, x)
            k = parameters[0] * h[0]
            p = moved(p, k * v[0], k * v[1], k * v[2])
        handles[i, 0], handles[i, 1], handles[i, 2], handles[i, 3] = p
    for i in range(h.size):
        p0, p3 = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        p1, p2 = keyframe(handles, i, sign), _double(keyframe(handles, i + 1, sign), p3)
        report[REACH] = max(report[REACH], set_controls(segments, i, p0, p1, p2, p3))
