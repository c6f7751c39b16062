"""The paper's curve: quartic, C^2, local, interpolating, nothing to solve."""

from __future__ import annotations

import numpy as np

from quatspline.families.cumulative import MIDDLE
from quatspline.fitting.four_keyframes import FIT
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve


class QuarticSpline(SegmentCurve):
    """Quartic interpolatory unit quaternion spline of Xing, Fan, Tan & Xu (2017).

    C^2, interpolating, local (four keyframes shape a segment), one product of three exponentials
    a sample [xing2017, (1)-(5)]: with L_j = ln(q_j^-1 q_{j+1}) and u from 0 to 1 on segment i,

        Q(u) = q_{i-1} exp(B_1(u) L_{i-1}) exp(B_2(u) L_i) exp(B_3(u) L_{i+1})                   (1)
        B_1 = 1 + u (1 - u)^3 / 2,  B_2 = u/2 + 3u^2/2 - u^3,  B_3 = -u^3 (1 - u) / 2            (2)

    (2) is for uniform knots.  `fitting.four_keyframes` takes any, and closed curves, by what (2) is
    made to meet at keyframes, the second derivative being kappa = 3 times the three-point estimate:
    for which smooth motion is approximated to order 2 only.  Its f_1 is B_1 - 1, after q_i.

    Examples
    --------
    >>> import quatspline as qs
    >>> from scipy.spatial.transform import Rotation
    >>> spin = Rotation.from_rotvec([[0, 0, a] for a in (0, 40, 80, 120)], degrees=True)
    >>> qs.QuarticSpline(None, spin).rotation(1.5).as_rotvec(degrees=True).round(6)
    array([ 0.,  0., 60.])
    """

    title = "Quartic C2 interpolatory spline"
    reference = "xing2017"
    continuity = 2
    order = 2
    support = 4
    constant_rate = "interior"
    family = MIDDLE

    def _fit(self, keyframes: Keyframes) -> None:
        self._solve(FIT, np.array([3.0]))  # kappa: `four_keyframes` (3)
