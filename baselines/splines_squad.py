"""The package splines: spherical quadrangle interpolation (squad)."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.splines import SplinesCurve


class SplinesSquad(SplinesCurve):
    """``splines.quaternion.Squad``: squad with inner quaternions for uneven times.

    C^1, interpolating, local (four keyframes shape a segment).  The package always closes the curve; for
    open keyframes it is given reflected phantoms (`peers.splines`) and evaluated between the given
    ones, where its wrap has no influence [splines].  Orientations only.
    """

    title = "splines Squad"
    constant_rate = "everywhere"

    def _fit(self, keyframes: Keyframes) -> None:
        from splines.quaternion import Squad

        self._without_ends(Squad, keyframes)
