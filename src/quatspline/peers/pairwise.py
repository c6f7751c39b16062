"""What wrappers share whose library interpolates between two rotations: a call on every segment."""

from __future__ import annotations

import abc
from collections.abc import Sequence
from typing import Any

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, with_return
from quatspline.quaternion import FloatArray


class SegmentwiseCurve(PeerCurve):
    """A curve whose library is asked for one segment at a time."""

    def _fit(self, keyframes: Keyframes) -> None:
        self.keys = with_return(keyframes)

    @abc.abstractmethod
    def _segment(self, i: int, u: FloatArray) -> FloatArray:
        """Quaternions (k, 4) on segment i at u (k,), from 0 to 1."""

    def _orientation(self, t: FloatArray) -> FloatArray:
        segment, u = self.keyframes.locate(t)
        order = np.argsort(segment, kind="stable")
        used, starts = np.unique(segment[order], return_index=True)
        q = np.empty((t.size, 4))
        for i, a, b in zip(used.tolist(), starts, [*starts, t.size][1:], strict=True):
            samples = order[a:b]
            q[samples] = self._segment(i, u[samples])
        return q


class SegmentSlerp(SegmentwiseCurve):
    """A piecewise slerp: segments share a keyframe and nothing else."""

    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"


class PairwiseSlerp(SegmentSlerp):
    """A piecewise slerp by a call that takes two rotations and a share of the way, for every sample.

    The library's own rotations are made once, from every keyframe.
    """

    def _fit(self, keyframes: Keyframes) -> None:
        super()._fit(keyframes)
        self._load()
        self.ends = [self._rotation(row) for row in self.keys]

    @abc.abstractmethod
    def _load(self) -> None:
        """Import the library and keep what is called."""

    @abc.abstractmethod
    def _between(self, a: Any, b: Any, u: float) -> Sequence[float] | FloatArray:
        """The library's interpolation from a to b, as four numbers, scalar first."""

    def _rotation(self, q: FloatArray) -> Any:
        """A keyframe (4,) in the library's form."""
        return q

    def _segment(self, i: int, u: FloatArray) -> FloatArray:
        a, b = self.ends[i], self.ends[i + 1]
        return np.array([self._between(a, b, x) for x in u.tolist()], dtype=float)


class UnsignedSlerp(PairwiseSlerp):
    """The same where rotations carry no sign: it is that of the segment's first keyframe.

    On a step of at most half a turn the curve stays on that keyframe's hemisphere.
    """

    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "rotations carry no sign",
    }

    def _segment(self, i: int, u: FloatArray) -> FloatArray:
        q = super()._segment(i, u)
        return np.where(q @ self.keys[i] < 0.0, -1.0, 1.0)[:, None] * q
