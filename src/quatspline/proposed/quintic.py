"""The paper's construction with its curvature weight set free: quintic, C^2, local, order 3."""

from __future__ import annotations

import numpy as np

from quatspline.families.cumulative import MIDDLE
from quatspline.fitting.four_keyframes import FIT
from quatspline.keyframes import Keyframes
from quatspline.options import Factor
from quatspline.segments import SegmentCurve


class QuinticSpline(SegmentCurve):
    """Quintic interpolatory unit quaternion spline: the quartic family's member of order 3.

    C^2, interpolating, local (four keyframes shape a segment), one product of three exponentials
    a sample, on arbitrary knots and closed too.  The construction of [xing2017] (`four_keyframes`)
    with the second derivative at a keyframe, in the notation there,

        a_i = 2 kappa (s_i - s_{i-1}) / (h_{i-1} + h_i)                                          (1)

    Options
    -------
    curvature
        kappa of (1).  1, the default, is the parabola through three keyframes: order 3.  Any other
        weight has order 2; 3 cancels the terms of degree 5, which is the paper's quartic.
    """

    title = "Quintic C2 interpolatory spline"
    reference = "xing2017"
    continuity = 2
    order = 3
    support = 4
    constant_rate = "interior"
    family = MIDDLE

    def _fit(self, keyframes: Keyframes, *, curvature: Factor = 1.0) -> None:
        self.order = 3 if curvature == 1.0 else 2
        self._solve(FIT, np.array([float(curvature)]))
