"""What the wrappers of InterpolatePy share."""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline.peers.wrapping import PeerCurve, body_frame
from quatspline.quaternion import FloatArray


class InterpolatePyCurve(PeerCurve):
    """What the curves of InterpolatePy share: one call per sample, rates in the world frame."""

    peer = "InterpolatePy"
    reference = "interpolatepy"
    closable = False
    orders = (0, 1, 2)

    def _construct(self, curve: type, *arguments: Any) -> None:
        """Call a class of the library; some flip all signs, so ours is read off the first key."""
        from interpolatepy import Quaternion

        keyframes = self._keyframes
        q = [Quaternion(*row) for row in keyframes.quaternions.tolist()]
        self.curve = curve(keyframes.knots.tolist(), q, *arguments)
        self.sign = 1.0
        first = self._orientation(keyframes.knots[:1])[0]
        self.sign = -1.0 if first @ keyframes.quaternions[0] < 0.0 else 1.0

    def _orientation(self, t: FloatArray) -> FloatArray:
        q = [(p.w, p.x, p.y, p.z) for p in map(self.curve.evaluate, t.tolist())]
        return self.sign * np.array(q, dtype=float).reshape(-1, 4)

    def _velocity(self, t: FloatArray) -> FloatArray:
        return self._rates(self.curve.evaluate_velocity, t)

    def _acceleration(self, t: FloatArray) -> FloatArray:
        return self._rates(self.curve.evaluate_acceleration, t)

    def _rates(self, evaluate: Any, t: FloatArray) -> FloatArray:
        world = np.array([evaluate(x) for x in t.tolist()], dtype=float).reshape(-1, 3)
        return body_frame(self._orientation(t), world)
