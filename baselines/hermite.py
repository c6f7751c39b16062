"""Cumulative cubic Hermite spline of Kim, Kim and Shin: three exponentials from end velocities."""

from __future__ import annotations

from typing import Literal

import numpy as np

from quatspline.families.cumulative import CUMULATIVE, set_base, set_factor
from quatspline.fitting.tangents import CHART, SECANT, chart_velocities
from quatspline.kernels.jit import REACH, fit_kernel
from quatspline.kernels.values import exp, keyframe, log, vec_at
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve

B1 = (0.0, 3.0, -3.0, 1.0, 0.0, 0.0)
B2 = (0.0, 0.0, 3.0, -2.0, 0.0, 0.0)
B3 = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0)
"""(2), coefficients from u^0 to u^5."""


class Hermite(SegmentCurve):
    """Cumulative cubic Hermite quaternion curve of Kim, Kim & Shin (1995).

    C^1, interpolating, local (four keyframes shape a segment, six with ``window=5``); order 3
    however good the velocities, and not symmetric in time, because the factors do not commute:

        Q(u) = q_i exp(b_1 w_1) exp(b_2 w_2) exp(b_3 w_3)                                        (1)
        b_1 = 1 - (1 - u)^3,  b_2 = 3u^2 - 2u^3,  b_3 = u^3                                      (2)
        w_1 = h v_i / 3,  w_3 = h v_{i+1} / 3,
        w_2 = ln(exp(-w_1) q_i^-1 q_{i+1} exp(-w_3))                                             (3)

    with u from 0 to 1 on a segment of duration h.  The velocities v_i, half rotation vectors per
    unit of time, are slopes of the polynomial through 3 or 5 points in the logarithmic chart at q_i
    (`fitting.tangents` (1)) [kim1995general].

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
    family = CUMULATIVE

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        window: Literal[3, 5] = 3,
        ends: Literal["chart", "secant"] = "chart",
    ) -> None:
        if window == 5:
            self.support = 6
        self._solve(FIT, np.array([window, SECANT if ends == "secant" else CHART]))


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """q_i, and the factors exp(b_k w_k) of (1), k = 1, 2, 3; parameters: window, ends."""
    v = chart_velocities(q, h, closed, sign, int(parameters[0]), parameters[1])
    reach = 0.0
    for i in range(h.size):
        p, r, c = keyframe(q, i, sign), keyframe(q, i + 1, sign), segments[i]  # q_i, q_{i+1}
        # A velocity is the same of q and -q: v_{i+1} wraps without the sign.
        w1 = (h[i] / 3.0) * vec_at(v[i], 0)  # (3)
        w3 = (h[i] / 3.0) * vec_at(v[(i + 1) % q.shape[0]], 0)  # (3)
        w2 = log(~(p * exp(w1)) * r * exp(-w3))  # (3)
        set_base(c, p)  # (1), and what the half angles |b_k w_k| may reach:
        r1, r2, r3 = set_factor(c, 0, w1, B1), set_factor(c, 1, w2, B2), set_factor(c, 2, w3, B3)
        reach = max(reach, r1, r2, r3)
    report[REACH] = reach  # the largest half angle: which sines the family takes
