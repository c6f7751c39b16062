"""The package transformations: slerp between two quaternions, here on every segment."""

from __future__ import annotations

from quatspline.peers.pairwise import PairwiseSlerp
from quatspline.quaternion import FloatArray


class TransformationsSlerp(PairwiseSlerp):
    """``transformations.quaternion_slerp``, one call per sample.  BSD-3-Clause.

    Documented as "spherical linear interpolation between two quaternions": C^0, interpolating, local
    (two keyframes shape a segment).  The library's ``shortestpath`` is switched off, because keyframes arrive
    on one hemisphere or are to keep their signs [transformations].  Orientations only.
    """

    title = "transformations slerp"
    reference = "transformations"
    peer = "transformations"

    def _load(self) -> None:
        from transformations import quaternion_slerp

        self.slerp = quaternion_slerp

    def _between(self, a: FloatArray, b: FloatArray, u: float) -> FloatArray:
        return self.slerp(a, b, u, shortestpath=False)
