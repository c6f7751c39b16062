"""Kochanek-Bartels (TCB) slerp-Bezier spline: tension, continuity and bias at every keyframe."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from quatspline.families.nested import TRIANGLE
from quatspline.fitting.bezier import FIT
from quatspline.fitting.tangents import CHART, SECANT
from quatspline.keyframes import Keyframes
from quatspline.options import per_keyframe
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve


class KochanekBartels(SegmentCurve):
    """Kochanek-Bartels (TCB) spline (1984) by De Casteljau with slerps, on arbitrary knots.

    C^1 (C^0 where a continuity is not zero), interpolating, local (four keyframes shape a segment);
    order 3 while all three are zero, 2 with bias or continuity, 1 where the weights of the slopes
    no longer add up to one (tension, or bias and continuity together).  With s_i = L_i / h_i and
    a = h_i / (h_{i-1} + h_i), b = 1 - a,

        v_i^out = (1 - T) ((1 + C)(1 + B) a s_{i-1} + (1 - C)(1 - B) b s_i)                      (1)
        v_i^in  = (1 - T) ((1 - C)(1 + B) a s_{i-1} + (1 + C)(1 - B) b s_i)                      (2)

    and segment i is De Casteljau's algorithm by slerps on

        (q_i, q_i exp(h_i v_i^out / 3), q_{i+1} exp(-h_i v_{i+1}^in / 3), q_{i+1})               (3)

    [kochanek1984].

    Options
    -------
    tension, continuity, bias
        T, C, B: numbers, or one per keyframe.  Ends of open data lack a neighbour and have none.
    ends
        "chart" or "secant", as for `catmull-rom`.
    """

    title = "Kochanek-Bartels (TCB) slerp-Bezier spline"
    reference = "kochanek1984"
    continuity = 1
    order = 3
    support = 4
    constant_rate: Literal["everywhere", "no"] = "everywhere"
    family = TRIANGLE

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        tension: ArrayLike = 0.0,
        continuity: ArrayLike = 0.0,
        bias: ArrayLike = 0.0,
        ends: Literal["chart", "secant"] = "chart",
    ) -> None:
        n = keyframes.count
        tcb = np.array(
            [
                per_keyframe("tension", tension, n),
                per_keyframe("continuity", continuity, n),
                per_keyframe("bias", bias, n),
            ]
        )
        self._claim(tcb if keyframes.closed else tcb[:, 1:-1], keyframes.uniform)
        switch = SECANT if ends == "secant" else CHART
        if tcb.any():
            self._solve(FIT, np.concatenate([[switch], tcb.reshape(-1)]), whole=True)
        else:
            self._solve(FIT, np.array([switch]))

    def _claim(self, tcb: FloatArray, uniform: bool) -> None:
        """On uniform knots the weights add up to (1 - T)(1 + C B) and (1 - T)(1 - C B)."""
        t, c, b = tcb
        if c.any():
            self.continuity = 0
        if t.any() or (c * b).any():
            self.order, self.constant_rate = 1, "no"
        elif c.any() or b.any():
            self.order, self.constant_rate = 2, "everywhere" if uniform else "no"
