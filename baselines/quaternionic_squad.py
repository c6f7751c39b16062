"""The package quaternionic: squad."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve
from quatspline.quaternion import FloatArray


class QuaternionicSquad(PeerCurve):
    """``quaternionic.squad``: one vectorised call that sets up and evaluates.

    Published as continuous in first derivatives (C^1), interpolating, local (four keyframes shape a
    segment), uneven times by a ratio in the inner quaternions.  The inner quaternions are found anew in
    every call, so that a timing of the evaluation contains the set-up [quaternionic].  Signs are taken as
    they come.  Orientations only, open curves only.
    """

    title = "quaternionic squad"
    reference = "quaternionic"
    peer = "quaternionic"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "everywhere"
    closable = False
    departs = {"test_spacing_ratios": "norms off by 1e-8 where one spacing is 1e9 times the next"}

    def _fit(self, keyframes: Keyframes) -> None:
        import quaternionic

        self.squad = quaternionic.squad
        self.rotors = quaternionic.array(keyframes.quaternions.copy())

    def _orientation(self, t: FloatArray) -> FloatArray:
        return self.squad(self.rotors, self._keyframes.knots, t).ndarray
