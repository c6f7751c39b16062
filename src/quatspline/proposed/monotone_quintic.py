"""The local quintic for keyframes that hold still: its rates limited, so that nothing overshoots."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np

from quatspline.families.rotation_vector import ROTATION_VECTOR
from quatspline.fitting.joined_rates import join, steps_and_rates
from quatspline.fitting.monotone_rates import monotone
from quatspline.kernels.jit import REACH, fit_kernel
from quatspline.kernels.values import put_vec, vec_at
from quatspline.keyframes import Keyframes
from quatspline.options import AtLeast, AtMost
from quatspline.segments import SegmentCurve

WINDOW = 3
"""Keyframes on either side from which rates are taken."""


class MonotoneQuinticSpline(SegmentCurve):
    """Monotone quintic spline: C^2, interpolating, local, and still where the keyframes are.

    The construction of `local-quintic`, whose velocity v_i and acceleration a_i are limited at every keyframe
    before segments join them (docs: monotone-quintic.md).  With l, h, d the angular speed, the spacing and
    the direction of a step, at the keyframe's either side:

        v . d >= 0 as far as both sides allow                                                   (1)
        |v| <= 5/4 of the three-point velocity, and 5/2 of either l                             (2)
        |a| <= 10 of either l / h                                                               (3)
        -4 v . d <= h a . d <= 10 l - 8 v . d, after the keyframe, mirrored before it           (4)

    Two equal neighbours are a hold, to the last digit.  About one axis every step is monotone, which is
    proven; of other motions the overshoot is measured (excursion.csv).  Order 4 while the motion moves:
    dense keyframes meet the limits by themselves.  At an instant of rest it is 2, which no curve with
    exact holds can help.

    Options
    -------
    overshoot
        "none" takes (1) to (4); "limited" takes (2) and (3): fairer, holds are as still, and a step may be
        overshot by about half of itself.
    slack
        Lets the derivative of a step's progress have a negative Bezier coefficient, where its neighbours
        make up for it: limits are wider by it, the promise is the same.  0.5 costs least torque.
    """

    title = "Monotone quintic C2 spline"
    reference = "fritsch1980"
    continuity = 2
    order = 4
    support = 2 * WINDOW + 2
    constant_rate = "everywhere"
    family = ROTATION_VECTOR

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        overshoot: Literal["none", "limited"] = "none",
        slack: Annotated[float, AtLeast(0.0), AtMost(0.5)] = 0.0,
    ) -> None:
        self._solve(FIT, np.array([float(WINDOW), float(overshoot == "none"), float(slack)]))


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Constants of every segment; parameters are the window m, 1 for all limits, the slack."""
    strict = parameters[1] > 0.0
    steps, rates = steps_and_rates(q, h, closed, sign, int(parameters[0]))
    for i in range(q.shape[0]):
        before, after = i - 1, i
        if not closed:  # at an end both sides are its only step
            before, after = max(before, 0), min(after, h.size - 1)
        h0, h1 = h[before], h[after]
        s0, s1 = (1.0 / h0) * vec_at(steps[before], 0), (1.0 / h1) * vec_at(steps[after], 0)
        v, a = vec_at(rates[i], 0), vec_at(rates[i], 3)
        v, a = monotone(v, a, s0, s1, h0, h1, strict, parameters[2])
        put_vec(rates[i], 0, v)
        put_vec(rates[i], 3, a)
    report[REACH] = join(q, h, steps, rates, segments)
