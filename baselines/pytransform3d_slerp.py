"""The package pytransform3d: slerp between two quaternions, here on every segment."""

from __future__ import annotations

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, with_return
from quatspline.quaternion import FloatArray


class Pytransform3dSlerp(PeerCurve):
    """``pytransform3d.batch_rotations.quaternion_slerp_batch``, one call a segment that has samples.

    C^0, interpolating, local (two keyframes shape a segment).  Orientations only [pytransform3d].
    """

    title = "pytransform3d slerp"
    reference = "pytransform3d"
    peer = "pytransform3d"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"

    def _fit(self, keyframes: Keyframes) -> None:
        from pytransform3d.batch_rotations import quaternion_slerp_batch

        self.slerp = quaternion_slerp_batch
        self.keys = with_return(keyframes)

    def _orientation(self, t: FloatArray) -> FloatArray:
        segment, u = self.keyframes.locate(t)
        order = np.argsort(segment, kind="stable")
        used, starts = np.unique(segment[order], return_index=True)
        q = np.empty((t.size, 4))
        # The library's batch is many steps between one pair: its own interface asks for this loop.
        for i, a, b in zip(used, starts, [*starts, t.size][1:], strict=True):
            samples = order[a:b]
            q[samples] = self.slerp(self.keys[i], self.keys[i + 1], u[samples])
        return q
