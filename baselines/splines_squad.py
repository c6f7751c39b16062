"""The package splines: spherical quadrangle interpolation (squad)."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, reflected, rows, unit_quaternions
from quatspline.quaternion import FloatArray


class SplinesSquad(PeerCurve):
    """``splines.quaternion.Squad``: squad with inner quaternions for uneven times.

    C^1, interpolating, local (four keyframes shape a segment).  The package always closes the curve; for
    open keyframes it is given reflected phantoms (`peers.reflected`) and evaluated between the given
    ones, where its wrap has no influence [splines].  Orientations only.
    """

    title = "splines Squad"
    reference = "splines"
    peer = "splines"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "everywhere"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "puts neighbours on one hemisphere itself",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        from splines.quaternion import Squad

        q, times = keyframes.quaternions, keyframes.knots
        if not keyframes.closed:
            q, times = reflected(keyframes)
        self.first = q[0]
        self.curve = Squad(unit_quaternions(q), times.tolist())

    def _orientation(self, t: FloatArray) -> FloatArray:
        return rows(self.curve.evaluate(t), self.first)
