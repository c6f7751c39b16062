"""Pinocchio's SE3.Interpolate, here on every segment."""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline.peers.pairwise import UnsignedSlerp
from quatspline.quaternion import FloatArray


class PinocchioInterpolate(UnsignedSlerp):
    """``pinocchio.SE3.Interpolate`` of poses at the origin, one call per sample.  BSD-3-Clause.

    Documented as "linear interpolation on the SE3 manifold"; with no translation a slerp: C^0,
    interpolating, local (two keyframes shape a segment).  Rotations are matrices, without a sign
    [pinocchio].  Orientations only.
    """

    title = "Pinocchio SE3.Interpolate"
    reference = "pinocchio"
    peer = "pin"

    def _load(self) -> None:
        import pinocchio

        self.library = pinocchio

    def _rotation(self, q: FloatArray) -> Any:
        return self.library.SE3(self.library.Quaternion(*q.tolist()).matrix(), np.zeros(3))

    def _between(self, a: Any, b: Any, u: float) -> FloatArray:
        pose = self.library.SE3.Interpolate(a, b, u)
        return self.library.Quaternion(pose.rotation).coeffs()[[3, 0, 1, 2]]
