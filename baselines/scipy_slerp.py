"""scipy's Slerp: piecewise spherical linear interpolation."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, with_return
from quatspline.quaternion import FloatArray


class ScipySlerp(PeerCurve):
    """``scipy.spatial.transform.Slerp``, one vectorised call for all times.

    C^0, interpolating, local (two keyframes shape a segment), constant rate on each segment.  Offers
    orientations only.  Always the short way round; closed curves repeat the first keyframe [scipy].
    """

    title = "scipy Slerp"
    reference = "scipy"
    peer = "scipy"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    departs = {"test_keeps_given_signs": "rotations carry no sign"}

    def _fit(self, keyframes: Keyframes) -> None:
        from scipy.spatial.transform import Rotation, Slerp

        rotations = Rotation.from_quat(with_return(keyframes), scalar_first=True)
        self.curve = Slerp(keyframes.knots, rotations)

    def _orientation(self, t: FloatArray) -> FloatArray:
        return self.curve(t).as_quat(scalar_first=True)
