"""The package rowan: slerp between two quaternions, here on every segment."""

from __future__ import annotations

from quatspline import quaternion
from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, with_return
from quatspline.quaternion import FloatArray


class RowanSlerp(PeerCurve):
    """``rowan.interpolate.slerp``, called once with the two keyframes of every sample.

    C^0, interpolating, local (two keyframes shape a segment).  The angular velocity is taken from
    ``slerp_prime``, the library's derivative with respect to the parameter [rowan].
    """

    title = "rowan slerp"
    reference = "rowan"
    peer = "rowan"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    orders = (0, 1)

    def _fit(self, keyframes: Keyframes) -> None:
        import rowan

        self.library = rowan.interpolate
        self.keys = with_return(keyframes)

    def _orientation(self, t: FloatArray) -> FloatArray:
        i, u = self.keyframes.locate(t)
        return self.library.slerp(self.keys[i], self.keys[i + 1], u, ensure_shortest=False)

    def _velocity(self, t: FloatArray) -> FloatArray:
        i, u = self.keyframes.locate(t)
        slope = self.library.slerp_prime(self.keys[i], self.keys[i + 1], u, ensure_shortest=False)
        rate = quaternion.mul(quaternion.conj(self._orientation(t)), slope)[:, 1:]
        return 2.0 * rate / self._keyframes.spacings[i][:, None]
