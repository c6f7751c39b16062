"""Curves that are known in closed form, for testing what measures curves."""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.quaternion import FloatArray

AXIS = np.array([0.6, 0.0, 0.8])


class Toy(Curve):
    """A curve that a test makes of its keyframes as it likes: no claim holds."""

    name = title = reference = "toy"
    continuity, order, support, constant_rate = 0, 1, None, "no"
    min_keyframes = 1

    def _fit(self, keyframes: Any) -> None:
        """Nothing to prepare."""

    def slerped(self, segment: Any, u: FloatArray) -> FloatArray:
        q = self.keyframes.quaternions
        return quaternion.slerp(q[segment], q[segment + 1], u)


class Turn(Toy):
    """exp(theta(t) n) with an analytic half angle theta and its two derivatives."""

    def theta(self, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        raise NotImplementedError

    def _orientation(self, t: FloatArray) -> FloatArray:
        return quaternion.exp(self.theta(t)[0][:, None] * AXIS)

    def omega(self, t: FloatArray) -> FloatArray:
        """The body rate at times since the first keyframe."""
        return 2.0 * self.theta(t)[1][:, None] * AXIS

    def _velocity(self, t: FloatArray) -> FloatArray:
        return self.omega(t)

    def _acceleration(self, t: FloatArray) -> FloatArray:
        return 2.0 * self.theta(t)[2][:, None] * AXIS


def turned(curve: type[Turn], times: Any) -> Turn:
    """The curve through keyframes of its own (they shape nothing)."""
    times = np.asarray(times, dtype=float)
    blank = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (len(times), 4))
    return curve(times, blank)
