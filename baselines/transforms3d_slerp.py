"""The package transforms3d: slerp by the power of a quaternion, here on every segment."""

from __future__ import annotations

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.pairwise import SegmentSlerp
from quatspline.quaternion import FloatArray


class Transforms3dSlerp(SegmentSlerp):
    """a (a^-1 b)^u by ``qmult``, ``qconjugate`` and ``qpow`` of ``transforms3d.quaternions``.  BSD.

    The library has no slerp.  Its power is documented as "the nth power of quaternion q", n "a real
    number": C^0, interpolating, local (two keyframes shape a segment), two calls per sample
    [transforms3d].  Orientations only.
    """

    title = "transforms3d qpow"
    reference = "transforms3d"
    peer = "transforms3d"

    def _fit(self, keyframes: Keyframes) -> None:
        from transforms3d import quaternions as library

        super()._fit(keyframes)
        self.library = library
        inverses = map(library.qconjugate, self.keys[:-1])
        self.steps = [library.qmult(a, b) for a, b in zip(inverses, self.keys[1:], strict=True)]

    def _segment(self, i: int, u: FloatArray) -> FloatArray:
        power, times = self.library.qpow, self.library.qmult
        return np.array([times(self.keys[i], power(self.steps[i], x)) for x in u.tolist()])
