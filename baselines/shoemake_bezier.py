"""Shoemake's slerp-Bezier spline of 1985: controls by doubling and bisecting, uniform knots."""

from __future__ import annotations

from typing import Literal

import numpy as np

from quatspline.families.nested import TRIANGLE
from quatspline.fitting.bezier import set_controls
from quatspline.fitting.tangents import CHART, SECANT, end_velocity
from quatspline.kernels.jit import REACH, compiled, fit_kernel, inlined
from quatspline.kernels.values import exp, keyframe, norm, put_quat, restored, slerp, unit
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


@inlined
def _double(p, q):
    """p reflected about q."""
    return (2.0 * (p @ q)) * q - p


@compiled
def _handle(q, sign, i, share):
    """(1) and the first of (2) at a keyframe with neighbours."""
    b, c = keyframe(q, i, sign), keyframe(q, i + 1, sign)
    total = _double(keyframe(q, i - 1, sign), b) + c
    if norm(total) < ANTIPODES:  # half a turn forth and back: no mean direction, no velocity
        return b
    return restored(slerp(b, unit(total), share), b)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Controls of every segment; parameters: the share of (2), ends."""
    n, reach = q.shape[0], 0.0
    handles, chart = np.empty((n, 4)), np.empty((5, 4))
    for i in range(n):
        p = keyframe(q, i, sign)
        if closed or 0 < i < n - 1:
            p = _handle(q, sign, i, parameters[0])
        elif parameters[1] != STATIONARY:
            v = end_velocity(q, h, i, 3, parameters[1], chart)
            p = p * exp((parameters[0] * h[0]) * v)
        put_quat(handles[i], 0, p)
    for i in range(h.size):
        p0, p3 = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        p1, p2 = keyframe(handles, i, sign), _double(keyframe(handles, i + 1, sign), p3)
        reach = max(reach, set_controls(segments[i], p0, p1, p2, p3))
    report[REACH] = reach
