"""The package splines: the Barry-Goldman algorithm with slerps."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, reflected, rows, unit_quaternions
from quatspline.quaternion import FloatArray


class SplinesBarryGoldman(PeerCurve):
    """``splines.quaternion.BarryGoldman``: Catmull-Rom by Barry & Goldman's pyramid with slerps.

    C^1, interpolating, local (four keyframes shape a segment).  The package always closes the curve; for
    open keyframes it is given reflected phantoms (`peers.reflected`) and evaluated between the given
    ones, where its wrap has no influence [splines; barry1988].  Orientations only.
    """

    title = "splines BarryGoldman"
    reference = "splines"
    peer = "splines"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "everywhere"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_rounded_holds": "misses keyframes beside a hold written with rounding",
        "test_keeps_given_signs": "puts neighbours on one hemisphere itself",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        from splines.quaternion import BarryGoldman

        q, times = keyframes.quaternions, keyframes.knots
        if not keyframes.closed:
            q, times = reflected(keyframes)
        self.first = q[0]
        self.curve = BarryGoldman(unit_quaternions(q), times.tolist())

    def _orientation(self, t: FloatArray) -> FloatArray:
        return rows(self.curve.evaluate(t), self.first)
