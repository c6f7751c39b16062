"""The package splines: Kochanek-Bartels-like rotation spline."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.splines import SplinesCurve
from quatspline.quaternion import FloatArray


class SplinesKochanekBartels(SplinesCurve):
    """``splines.quaternion.KochanekBartels`` with one (tension, continuity, bias) for all keyframes.

    C^1 for continuity = 0 and C^0 otherwise, interpolating, local (four keyframes shape a segment), open
    ends "natural", closed with ``endconditions="closed"`` [splines].  Orientations only.

    Options
    -------
    tension, continuity, bias
        As in [kochanek1984], for every inner keyframe; with all three 0 the curve is Catmull-Rom's.
    """

    title = "splines KochanekBartels"
    constant_rate = "interior"

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
        self._with_ends(KochanekBartels, keyframes, tcb=(tension, continuity, bias))

    def _published(self, t: FloatArray, order: int) -> FloatArray | None:
        return self._published_velocity(t) if order == 1 else None
