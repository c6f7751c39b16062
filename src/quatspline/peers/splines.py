"""What the wrappers of the package splines share."""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, body_frame
from quatspline.quaternion import FloatArray
from quatspline.system.quiet import quiet


class SplinesCurve(PeerCurve):
    """What the curves of ``splines.quaternion`` share: quaternions of its own, a call that loops in Python."""

    peer = "splines"
    reference = "splines"
    continuity = 1
    order = 3
    support = 4
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "puts neighbours on one hemisphere itself",
    }

    def _with_ends(self, curve: type, keyframes: Keyframes, **options: Any) -> None:
        """Construct a class that takes end conditions."""
        ends = "closed" if keyframes.closed else "natural"
        q, times = keyframes.quaternions, keyframes.knots
        self._construct(curve, q, times, endconditions=ends, **options)

    def _without_ends(self, curve: type, keyframes: Keyframes) -> None:
        """Construct a class that closes every curve: an open one's wrap is put outside."""
        q, times = keyframes.quaternions, keyframes.knots
        self._construct(curve, *((q, times) if keyframes.closed else reflected(keyframes)))

    def _construct(self, curve: type, q: FloatArray, times: FloatArray, **options: Any) -> None:
        from splines.quaternion import UnitQuaternion

        units = [UnitQuaternion.from_unit_xyzw((x, y, z, w)) for w, x, y, z in q.tolist()]
        self.curve = curve(units, times.tolist(), **options)
        self.sign = -1.0 if q[0, 0] < 0.0 else 1.0  # it makes the first scalar part positive

    def _orientation(self, t: FloatArray) -> FloatArray:
        q = [q.wxyz for q in self.curve.evaluate(t)]
        return self.sign * np.array(q, dtype=float).reshape(-1, 4)

    def _published_velocity(self, t: FloatArray) -> FloatArray:
        """``evaluate(t, 1)``, world frame, in the body frame (m, 3)."""
        with quiet():
            rates = np.array([self.curve.evaluate(x, 1) for x in t], dtype=float)
        return body_frame(self._orientation(t), rates)


def reflected(keyframes: Keyframes) -> tuple[FloatArray, FloatArray]:
    """Keyframes (n + 2, 4) and times (n + 3,) that put the wrap of an always closed library outside.

    Both ends get a reflected phantom, q_{-1} = q_0 q_1^{-1} q_0 at t_{-1} = 2 t_0 - t_1, so that no
    segment between given keyframes meets the wrap of a curve that four keyframes shape.
    """
    q, t = keyframes.quaternions, keyframes.knots
    before = _mirror(q[0], q[1])
    after = _mirror(q[-1], q[-2])
    last = 2.0 * t[-1] - t[-2]
    times = np.concatenate([[2.0 * t[0] - t[1]], t, [last, last + t[-1] - t[-2]]])
    return np.concatenate([before[None], q, after[None]]), times


def _mirror(a: FloatArray, b: FloatArray) -> FloatArray:
    """The point that follows b, a on their great arc at the same step: a b^-1 a."""
    return quaternion.mul(quaternion.mul(a, quaternion.conj(b)), a)
