"""The package numpy-quaternion: squad."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve
from quatspline.quaternion import FloatArray


class NumpyQuaternionSquad(PeerCurve):
    """``quaternion.squad``: one vectorised call that sets up and evaluates.

    Published as continuous in value and first derivative everywhere (C^1), interpolating, local (four
    keyframes shape a segment), uneven times by a ratio in the inner quaternions, which are found anew
    in every call [numpy_quaternion].  Orientations only, open curves only.

    Options
    -------
    unflip
        Whether the package puts neighbours on one hemisphere itself (its default is not to); tells
        only with ``align=False``.
    """

    title = "numpy-quaternion squad"
    reference = "numpy_quaternion"
    peer = "numpy-quaternion"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "everywhere"
    closable = False
    departs = {
        "test_keeps_given_signs": "its slerps go the short way",
        "test_spacing_ratios": "norms off by 1e-8 where one spacing is 1e9 times the next",
    }

    def _fit(self, keyframes: Keyframes, *, unflip: bool = False) -> None:
        import quaternion

        self.library = quaternion
        self.unflip = unflip
        self.rotors = quaternion.as_quat_array(keyframes.quaternions.copy())

    def _orientation(self, t: FloatArray) -> FloatArray:
        curve = self.library.squad(self.rotors, self._keyframes.knots, t, self.unflip)
        return self.library.as_float_array(curve)
