"""GTSAM's Rot3.slerp, here on every segment."""

from __future__ import annotations

from typing import Any

from quatspline.peers.pairwise import UnsignedSlerp
from quatspline.quaternion import FloatArray


class GtsamSlerp(UnsignedSlerp):
    """``gtsam.Rot3.slerp``, one call per sample.  BSD-2-Clause.

    Documented as "spherical linear interpolation between *this and other": C^0, interpolating, local (two
    keyframes shape a segment).  Rotations are matrices, without a sign [gtsam].  Orientations only.
    """

    title = "GTSAM Rot3.slerp"
    reference = "gtsam"
    peer = "gtsam"

    def _load(self) -> None:
        import gtsam

        self.library = gtsam.Rot3

    def _rotation(self, q: FloatArray) -> Any:
        return self.library.Quaternion(*q.tolist())

    def _between(self, a: Any, b: Any, u: float) -> tuple[float, ...]:
        q = a.slerp(u, b).toQuaternion()
        return q.w(), q.x(), q.y(), q.z()
