"""Cumulative cubic Hermite spline of Kim, Kim and Shin: three exponentials from end velocities."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from quatspline.families.cumulative import UNBOUNDED, set_base, set_factor
from quatspline.fitting.tangents import CHART, SECANT, chart_velocities, keyframe
from quatspline.kernels.jit import REACH, fit_kernel
from quatspline.kernels.operations import Operations, Per
from quatspline.kernels.scalars import between, exp, log, mul
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve


class Hermite(SegmentCurve):
    """Cumulative cubic Hermite quaternion curve of Kim, Kim & Shin (1995).

    C^1, interpolating, local (four keyframes shape a segment, six with ``window=5``); order 3
    however good the velocities, and not symmetric in time, because the factors do not commute:

        Q(u) = q_i exp(b_1 w_1) exp(b_2 w_2) exp(b_3 w_3)                                        (1)
        b_1 = 1 - (1 - u)^3,  b_2 = 3u^2 - 2u^3,  b_3 = u^3                                      (2)
        w_1 = h v_i / 3,  w_3 = h v_{i+1} / 3,
        w_2 = ln(exp(-w_1) q_i^-1 q_{i+1} exp(-w_3))                                             (3)

    The velocities v_i at keyframes are slopes of the polynomial through 3 or 5 points in the
    logarithmic chart there [kim1995general].

    Options
    -------
    window
        Keyframes that give a velocity: 3, or 5 (oscillates on rough data).
    ends
        "chart": the window shifted inward; "secant": v_0 = s_0.  Closed curves have no ends.
    """

    title = "Kim-Kim-Shin cumulative Hermite spline"
    reference = "kim1995general"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "everywhere"
    family = UNBOUNDED
    operations = Operations(exps=Per(sample=3, keyframe=2), logs=Per(keyframe=5))

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        window: Literal[3, 5] = 3,
        ends: Literal["chart", "secant"] = "chart",
    ) -> None:
        if window == 5:
            self.support = 6
            self.operations = replace(self.operations, logs=Per(keyframe=9))
        self._solve(FIT, np.array([window, SECANT if ends == "secant" else CHART]))


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The factors of (1) in powers of u; parameters: window, ends."""
    v = chart_velocities(q, h, closed, sign, int(parameters[0]), parameters[1])
    n = q.shape[0]
    for i in range(h.size):
        a, b = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        j, k = (i + 1) % n, h[i] / 3.0
        x, y, z = k * v[i, 0], k * v[i, 1], k * v[i, 2]
        set_base(segments, i, a[0], a[1], a[2], a[3])
        r1 = set_factor(segments, i, 0, x, y, z, 0.0, 3.0, -3.0, 1.0, 0.0, 0.0)
        # (3), from the left: q_i exp(w_1), and the rest
        w, ex, ey, ez = exp(x, y, z)
        a = mul(a[0], a[1], a[2], a[3], w, ex, ey, ez)
        c = between(a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3])
        x, y, z = k * v[j, 0], k * v[j, 1], k * v[j, 2]
        r3 = set_factor(segments, i, 2, x, y, z, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0)
        w, ex, ey, ez = exp(-x, -y, -z)
        c = mul(c[0], c[1], c[2], c[3], w, ex, ey, ez)
        x, y, z = log(c[0], c[1], c[2], c[3])
        r2 = set_factor(segments, i, 1, x, y, z, 0.0, 0.0, 3.0, -2.0, 0.0, 0.0)
        report[REACH] = max(report[REACH], r1, r2, r3)
