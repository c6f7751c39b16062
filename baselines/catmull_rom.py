"""Catmull-Rom-like slerp-Bezier spline: tangents from neighbours, De Casteljau by slerps."""

from __future__ import annotations

from typing import Literal

import numpy as np

from quatspline.families.nested import TRIANGLE
from quatspline.fitting.bezier import FIT
from quatspline.fitting.tangents import CHART, SECANT
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve


class CatmullRom(SegmentCurve):
    """Catmull-Rom-like curve of slerp-Bezier segments, Shoemake (1985) on arbitrary knots.

    C^1, interpolating, local (four keyframes shape a segment); order 3.  Velocities are those of
    the parabola through three keyframes,

        v_i = (h_i s_{i-1} + h_{i-1} s_i) / (h_{i-1} + h_i),    s_i = L_i / h_i                  (1)

    and segment i is De Casteljau's algorithm by slerps on

        (q_i, q_i exp(h_i v_i / 3), q_{i+1} exp(-h_i v_{i+1} / 3), q_{i+1})                      (2)

    The plain member of `kochanek-bartels` [shoemake1985; kochanek1984].

    Options
    -------
    ends
        "chart": the parabola through the first (last) three keyframes; "secant": v_0 = s_0, which
        has order 2 there.  Closed curves have no ends.
    """

    title = "Catmull-Rom-like slerp-Bezier spline"
    reference = "kochanek1984"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "everywhere"
    family = TRIANGLE

    def _fit(self, keyframes: Keyframes, *, ends: Literal["chart", "secant"] = "chart") -> None:
        self._solve(FIT, np.array([SECANT if ends == "secant" else CHART]))
