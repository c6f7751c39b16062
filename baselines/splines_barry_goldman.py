"""The package splines: the Barry-Goldman algorithm with slerps."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.splines import SplinesCurve


class SplinesBarryGoldman(SplinesCurve):
    """``splines.quaternion.BarryGoldman``: Catmull-Rom by Barry & Goldman's pyramid with slerps.

    C^1, interpolating, local (four keyframes shape a segment).  The package always closes the curve; for
    open keyframes it is given reflected phantoms (`peers.splines`) and evaluated between the given
    ones, where its wrap has no influence [splines; barry1988].  Orientations only.
    """

    title = "splines BarryGoldman"
    constant_rate = "everywhere"
    departs = SplinesCurve.departs | {
        "test_rounded_holds": "misses keyframes beside a hold written with rounding",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        from splines.quaternion import BarryGoldman

        self._without_ends(BarryGoldman, keyframes)
