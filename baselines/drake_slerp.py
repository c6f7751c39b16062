"""Drake's PiecewiseQuaternionSlerp."""

from __future__ import annotations

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, body_frame, with_return
from quatspline.quaternion import FloatArray


class DrakeSlerp(PeerCurve):
    """``pydrake.trajectories.PiecewiseQuaternionSlerp``, one call per sample.  BSD-3-Clause.

    Documented as "a trajectory for quaternions that are interpolated using piecewise slerp": C^0,
    interpolating, local (two keyframes shape a segment).  Velocity and acceleration are "expressed in the
    parent frame", the world's, and turned into the body frame here; "the internal quaternion representations
    ensure that q_n.dot(q_{n+1}) >= 0" [drake].  The package installs Mosek, which is proprietary.
    """

    title = "Drake PiecewiseQuaternionSlerp"
    reference = "drake"
    peer = "drake"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    orders = (0, 1, 2)
    departs = {"test_keeps_given_signs": "puts neighbours on one hemisphere itself"}

    def _fit(self, keyframes: Keyframes) -> None:
        from pydrake.common.eigen_geometry import Quaternion
        from pydrake.trajectories import PiecewiseQuaternionSlerp

        q = [Quaternion(row) for row in with_return(keyframes)]
        self.curve = PiecewiseQuaternionSlerp(keyframes.knots.tolist(), q)

    def _orientation(self, t: FloatArray) -> FloatArray:
        q = [self.curve.orientation(x).wxyz() for x in t.tolist()]
        return np.array(q, dtype=float).reshape(-1, 4)

    def _velocity(self, t: FloatArray) -> FloatArray:
        world = np.array([self.curve.angular_velocity(x) for x in t.tolist()], dtype=float)
        return body_frame(self._orientation(t), world.reshape(-1, 3))

    def _acceleration(self, t: FloatArray) -> FloatArray:
        world = np.array([self.curve.angular_acceleration(x) for x in t.tolist()], dtype=float)
        return body_frame(self._orientation(t), world.reshape(-1, 3))
