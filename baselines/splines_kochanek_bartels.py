"""The package splines: Kochanek-Bartels-like rotation spline."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, published_velocity, rows, unit_quaternions
from quatspline.quaternion import FloatArray


class SplinesKochanekBartels(PeerCurve):
    """``splines.quaternion.KochanekBartels`` with one (tension, continuity, bias) for all keyframes.

    C^1 for continuity = 0 and C^0 otherwise, interpolating, local (four keyframes shape a segment), open
    ends "natural", closed with ``endconditions="closed"`` [splines].  Orientations only.

    Options
    -------
    tension, continuity, bias
        As in [kochanek1984], for every inner keyframe; with all three 0 the curve is Catmull-Rom's.
    """

    title = "splines KochanekBartels"
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

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        tension: float = 0.0,
        continuity: float = 0.0,
        bias: float = 0.0,
    ) -> None:
        from splines.quaternion import KochanekBartels

        if continuity != 0.0:
            self.continuity = 0
        if tension != 0.0:
            self.constant_rate = "no"
        if (tension, continuity, bias) != (0.0, 0.0, 0.0):
            self.order = 2
        self.curve = KochanekBartels(
            unit_quaternions(keyframes.quaternions),
            keyframes.knots.tolist(),
            tcb=(tension, continuity, bias),
            endconditions="closed" if keyframes.closed else "natural",
        )

    def _orientation(self, t: FloatArray) -> FloatArray:
        return rows(self.curve.evaluate(t), self._keyframes.quaternions[0])

    def _published(self, t: FloatArray, order: int) -> FloatArray | None:
        return published_velocity(self.curve, t, self._orientation(t)) if order == 1 else None
