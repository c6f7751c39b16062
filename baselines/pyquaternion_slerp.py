"""The package pyquaternion: slerp between two quaternions, here on every segment."""

from __future__ import annotations

from typing import Any

from quatspline.peers.pairwise import PairwiseSlerp
from quatspline.quaternion import FloatArray


class PyquaternionSlerp(PairwiseSlerp):
    """``pyquaternion.Quaternion.slerp``, one call per sample.  MIT.

    Documented as "along the minor arc of a great circle", the result "guaranteed to be a unit
    quaternion": C^0, interpolating, local (two keyframes shape a segment).  Steps below 3.6 degrees are
    interpolated along the chord, and the short way is taken by negating the first argument in place
    [pyquaternion].  Orientations only.
    """

    title = "pyquaternion slerp"
    reference = "pyquaternion"
    peer = "pyquaternion"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "goes the short way",
    }

    def _load(self) -> None:
        from pyquaternion import Quaternion

        self.library = Quaternion

    def _rotation(self, q: FloatArray) -> Any:
        return self.library(q)

    def _between(self, a: Any, b: Any, u: float) -> FloatArray:
        return self.library.slerp(a, b, u).elements
