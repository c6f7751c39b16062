"""The package splines: Catmull-Rom-like rotation spline."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, published_velocity, rows, unit_quaternions
from quatspline.quaternion import FloatArray


class SplinesCatmullRom(PeerCurve):
    """``splines.quaternion.CatmullRom``: de Casteljau's algorithm with slerps.

    C^1, interpolating, local (four keyframes shape a segment), open ends "natural" (which start a
    constant spin at 1.5 times its rate), closed with ``endconditions="closed"``; a call with an array
    of times loops in Python [splines].  Orientations only: the package's own ``evaluate(t, 1)`` is not
    the derivative of its curve inside a segment.
    """

    title = "splines CatmullRom"
    reference = "splines"
    peer = "splines"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "interior"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "puts neighbours on one hemisphere itself",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        from splines.quaternion import CatmullRom

        self.curve = CatmullRom(
            unit_quaternions(keyframes.quaternions),
            keyframes.knots.tolist(),
            endconditions="closed" if keyframes.closed else "natural",
        )

    def _orientation(self, t: FloatArray) -> FloatArray:
        return rows(self.curve.evaluate(t), self._keyframes.quaternions[0])

    def _published(self, t: FloatArray, order: int) -> FloatArray | None:
        return published_velocity(self.curve, t, self._orientation(t)) if order == 1 else None
