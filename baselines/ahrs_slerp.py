"""The package ahrs: slerp between two quaternions, here on every segment."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.pairwise import SegmentSlerp
from quatspline.quaternion import FloatArray


class AhrsSlerp(SegmentSlerp):
    """``ahrs.common.quaternion.slerp``, one call per segment that has samples.  MIT.

    Documented as an array of orientations "along the minor arc of the great circle": C^0, interpolating,
    local (two keyframes shape a segment).  Steps below 3.6 degrees are interpolated along the chord
    (its ``threshold``) [ahrs].  Orientations only.
    """

    title = "ahrs slerp"
    reference = "ahrs"
    peer = "AHRS"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "goes the short way",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        from ahrs.common.quaternion import slerp

        super()._fit(keyframes)
        self.slerp = slerp

    def _segment(self, i: int, u: FloatArray) -> FloatArray:
        return self.slerp(self.keys[i], self.keys[i + 1], u)
