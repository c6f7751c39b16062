"""InterpolatePy's QuaternionSpline."""

from __future__ import annotations

from typing import Literal

from quatspline.keyframes import Keyframes
from quatspline.peers.interpolatepy import InterpolatePyCurve


class InterpolatePyQuaternionSpline(InterpolatePyCurve):
    """``interpolatepy.QuaternionSpline``: squad inside, slerp on the first and last segment.

    Published as C^1; interpolating, local.  The inner quaternions are those of even times
    [interpolatepy; shoemake1987].  Rates by differences, world frame, turned into the body frame here;
    one call per sample.  Open curves only.

    Options
    -------
    method
        "auto" (squad from four keyframes on) or "slerp", as the library calls them.
    """

    title = "InterpolatePy QuaternionSpline"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "no"
    departs = {
        "test_continuity_holds": "slerp on the first and the last segment, squad between",
        "test_keeps_given_signs": "its slerps go the short way",
        "test_rates_are_the_curves_own": "takes differences over 1e-6, for accelerations twice",
        "test_time_scale": "takes differences over 1e-6, whatever the unit of time",
        "test_time_shift": "the second difference over 1e-6 magnifies rounding of the times",
    }

    def _fit(self, keyframes: Keyframes, *, method: Literal["auto", "slerp"] = "auto") -> None:
        from interpolatepy import QuaternionSpline

        if method == "slerp":
            self.continuity, self.order, self.support = 0, 2, 2
        self._construct(QuaternionSpline, method)
