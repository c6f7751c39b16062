"""The package pytransform3d: slerp between two quaternions, here on every segment."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.pairwise import SegmentSlerp
from quatspline.quaternion import FloatArray


class Pytransform3dSlerp(SegmentSlerp):
    """``pytransform3d.batch_rotations.quaternion_slerp_batch``, one call per segment that has samples.

    C^0, interpolating, local (two keyframes shape a segment).  The library's batch is many steps between
    one pair, which asks for the loop over segments.  Orientations only [pytransform3d].
    """

    title = "pytransform3d slerp"
    reference = "pytransform3d"
    peer = "pytransform3d"

    def _fit(self, keyframes: Keyframes) -> None:
        from pytransform3d.batch_rotations import quaternion_slerp_batch

        super()._fit(keyframes)
        self.slerp = quaternion_slerp_batch

    def _segment(self, i: int, u: FloatArray) -> FloatArray:
        return self.slerp(self.keys[i], self.keys[i + 1], u)
