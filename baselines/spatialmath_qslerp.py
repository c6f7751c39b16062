"""The Spatial Math Toolbox: qslerp of two quaternions, here on every segment."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.pairwise import PairwiseSlerp
from quatspline.quaternion import FloatArray


class SpatialmathQslerp(PairwiseSlerp):
    """``spatialmath.base.qslerp``, one call per sample.  MIT.

    Documented as interpolation "on a great circle on a 4D hypersphere": C^0, interpolating, local (two
    keyframes shape a segment) [spatialmath].  Orientations only.

    Options
    -------
    shortest
        Whether the package chooses the short way itself (its default is not to); tells only with
        ``align=False``.
    """

    title = "spatialmath qslerp"
    reference = "spatialmath"
    peer = "spatialmath-python"

    def _fit(self, keyframes: Keyframes, *, shortest: bool = False) -> None:
        self.shortest = shortest
        super()._fit(keyframes)

    def _load(self) -> None:
        from spatialmath.base import qslerp

        self.slerp = qslerp

    def _between(self, a: FloatArray, b: FloatArray, u: float) -> FloatArray:
        return self.slerp(a, b, u, shortest=self.shortest)
