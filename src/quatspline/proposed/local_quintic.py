"""Fair without equations: rates of a local cubic spline at every keyframe, joined by quintics."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from quatspline.families.rotation_vector import ROTATION_VECTOR
from quatspline.fitting.joined_rates import join, steps_and_rates
from quatspline.kernels.jit import REACH, fit_kernel
from quatspline.keyframes import Keyframes
from quatspline.options import AtMost, Count
from quatspline.segments import FITTED, SegmentCurve

WIDE = 6.0
"""The window from which on its square tells what a fit takes in plain Python: 4 ms a keyframe for 30, 86 for 100."""


class LocalQuinticSpline(SegmentCurve):
    """Local quintic spline: C^2, interpolating, order 4, nearly of least torque, nothing solved.

    At every keyframe, velocity v_i and acceleration a_i are the derivatives at t_i of a cubic
    spline through the points x_j = ln(q_i^-1 q_j), |j - i| <= m, of the chart centred there, in
    which derivatives are body rates (`local_rates`).  Its ends are not-a-knot where the window is
    cut, natural where it meets the curve's end.  Windows whose chart would fold give way, smoothly,
    to smaller ones.  One exponential per segment, Q = q_i exp(phi(u)), matches the rates of both ends
    (docs: local-quintic.md):

        phi(0) = 0,    phi'(0) = h v_i,                     phi''(0) = h^2 a_i                   (1)
        phi(1) = L_i,  phi'(1) = Jr^-1(2 L_i) h v_{i+1},
        phi''(1) = Jr^-1(2 L_i) (h^2 a_{i+1} - (d/du Jr(2 phi)) phi')                            (2)

    Every keyframe's rates are the same from both sides, so that the curve is C^2 whatever they are.

    Options
    -------
    window
        m, keyframes on either side; a segment is shaped by 2 m + 2 keyframes.  1 has order 2.
    """

    title = "Local quintic C2 spline"
    reference = "park1997"
    continuity = 2
    order = 4
    support = 8
    constant_rate = "everywhere"
    family = ROTATION_VECTOR

    def _fit(self, keyframes: Keyframes, *, window: Annotated[Count, AtMost(100)] = 3) -> None:
        self.order = 4 if window > 1 else 2
        self.support = 2 * window + 2
        self.fitted = FITTED * (1.0 + (window / WIDE) ** 2)
        self._solve(FIT, np.array([float(window)]))


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Constants of every segment; parameters[0] is the window m."""
    steps, rates = steps_and_rates(q, h, closed, sign, int(parameters[0]))
    report[REACH] = join(q, h, steps, rates, segments)
