"""The package quat-numpy: squad of four quaternions, here on every segment."""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.pairwise import SegmentwiseCurve
from quatspline.quaternion import FloatArray, conj, mul


class QuatNumpySquad(SegmentwiseCurve):
    """``quat.squad`` of a segment's two keyframes and their neighbours, one call per sample.  Apache-2.0.

    Documented as "spherical cubic (squad) interpolation" with "C^1 continuity through the four control
    points": interpolating, local (four keyframes shape a segment).  It takes no times, so that evenly
    spaced keyframes are its domain.  Open ends get the reflected neighbour q_0 q_1^-1 q_0, at which its inner
    quaternion is the keyframe itself [quat_numpy].  Orientations only.
    """

    title = "quat-numpy squad"
    reference = "quat_numpy"
    peer = "quat-numpy"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "everywhere"
    non_uniform = False
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "its slerps go the short way",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        import quat

        super()._fit(keyframes)
        self.squad: Any = quat.squad
        self.points: list[Any] = [quat.Quaternion(*row) for row in self._with_neighbours().tolist()]

    def _with_neighbours(self) -> FloatArray:
        """The keyframes with one more on either side."""
        q, keyframes = self.keys, self._keyframes
        if keyframes.closed:
            sign = float(keyframes.sign)
            return np.concatenate([sign * q[-2:-1], q, sign * q[1:2]])
        before = mul(mul(q[0], conj(q[1])), q[0])
        after = mul(mul(q[-1], conj(q[-2])), q[-1])
        return np.concatenate([before[None], q, after[None]])

    def _segment(self, i: int, u: FloatArray) -> FloatArray:
        four = self.points[i : i + 4]
        return np.array([list(self.squad(*four, x)) for x in u.tolist()], dtype=float)
