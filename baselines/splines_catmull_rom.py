"""The package splines: Catmull-Rom-like rotation spline."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.splines import SplinesCurve
from quatspline.quaternion import FloatArray


class SplinesCatmullRom(SplinesCurve):
    """``splines.quaternion.CatmullRom``: de Casteljau's algorithm with slerps.

    C^1, interpolating, local (four keyframes shape a segment), open ends "natural" (which start a
    constant spin at 1.5 times its rate), closed with ``endconditions="closed"``; a call with an array
    of times loops in Python [splines].  Orientations only: the package's own ``evaluate(t, 1)`` is not
    the derivative of its curve inside a segment.
    """

    title = "splines CatmullRom"
    constant_rate = "interior"

    def _fit(self, keyframes: Keyframes) -> None:
        from splines.quaternion import CatmullRom

        self._with_ends(CatmullRom, keyframes)

    def _published(self, t: FloatArray, order: int) -> FloatArray | None:
        return self._published_velocity(t) if order == 1 else None
