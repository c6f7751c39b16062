"""Keyframe reduction: the frames of a dense motion from which a scheme rebuilds it within a bound.

Greedy insertion at the worst frame between keyframes, then trimming of every keyframe whose removal keeps
the bound; what comes out is measured once more on all frames.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quatspline import catalogue, quaternion
from quatspline.motion.motion_curve import named
from quatspline.quaternion import FloatArray
from quatspline.solving import ConvergenceError

if TYPE_CHECKING:
    from quatspline.curve import Curve
    from quatspline.motion.motion import Motion

Frames = NDArray[np.intp]
"""Indices of frames, increasing."""

FAR = 24
"""Keyframes around one within which a global scheme is tried without it: C^2 splines forget by a factor
of 3 to 4 per keyframe.  What that leaves over is found when all frames are measured."""


@dataclass(frozen=True, eq=False)
class Reduction:
    """Keyframes of a motion; see `Motion.reduce`.

    Attributes
    ----------
    frames : indices of the frames that are kept, by joint
    motion : rebuilt from them at the times of the source; positions are the source's
    largest : the largest local angle (rad) of a joint at a frame left out
    """

    frames: dict[str, Frames]
    motion: Motion
    largest: float


def reduction(
    motion: Motion, scheme: str, error: float, together: bool, options: dict[str, Any]
) -> Reduction:
    """See `Motion.reduce`."""
    if not (isinstance(error, int | float | np.floating) and 0.0 < error < np.inf):
        raise ValueError(f"error={error!r}: a positive angle in rad is expected")
    if len(motion.edges) > 2:
        raise ValueError(
            f"the motion has gaps: reduce its {len(motion.edges) - 1} pieces one by one"
        )
    if motion.closed or len(motion.stamps) < 2:
        raise ValueError("an open motion of at least 2 frames is expected")
    names = list(motion.tracks)
    groups = [slice(0, len(names))] if together else [slice(k, k + 1) for k in range(len(names))]
    rebuilt = np.empty_like(motion.quaternions)
    frames: dict[str, Frames] = {}
    for group in groups:
        q = quaternion.normalise(motion.quaternions[:, group])
        try:
            keys, rebuilt[:, group] = _Track(motion.times, q, scheme, error, options).reduced()
        except (ConvergenceError, ValueError) as failure:
            raise named(", ".join(names[group]), failure) from failure
        frames |= dict.fromkeys(names[group], keys)
    largest = float(quaternion.distance(rebuilt, quaternion.normalise(motion.quaternions)).max())
    return Reduction(frames, motion.moved(motion.stamps, rebuilt, motion.positions), largest)


class _Track:
    """One set of keyframes, for one joint or for all together."""

    def __init__(
        self, t: FloatArray, q: FloatArray, scheme: str, bound: float, options: dict[str, Any]
    ) -> None:
        self.t, self.q, self.bound = t, q, bound
        cls = catalogue.scheme(scheme)
        self.least = min(max(cls.min_keyframes, 2), len(t))
        self.margin = (cls.support or FAR) // 2
        self.build: Callable[..., Curve] = partial(catalogue.build, scheme, **options)

    def reduced(self) -> tuple[Frames, FloatArray]:
        """Keyframes, and what they rebuild."""
        keys = np.unique(np.linspace(0, len(self.t) - 1, self.least).astype(int))
        keys = self._trimmed(self._within(keys))
        keys = self._within(keys)  # all frames are measured, once more
        return keys, self._curve(keys)(self.t)

    def _curve(self, keys: Frames) -> Curve:
        return self.build(self.t[keys], self.q[keys])

    def _errors(self, keys: Frames, first: int, last: int) -> FloatArray:
        """Angles of the frames from first to last, the largest of all joints."""
        rebuilt = self._curve(keys)(self.t[first : last + 1])
        angles = quaternion.distance(rebuilt, self.q[first : last + 1])
        return np.asarray(angles.max(axis=1))

    def _within(self, keys: Frames) -> Frames:
        """Keyframes with the worst frame of each segment beyond the bound added, until none is."""
        while True:
            errors = self._errors(keys, 0, len(self.t) - 1)
            errors[keys] = 0.0
            starts = keys[:-1]
            worst = np.maximum.reduceat(errors, starts)
            beyond = np.flatnonzero(worst > self.bound)
            if not beyond.size:
                return keys
            new = [starts[i] + int(np.argmax(errors[keys[i] : keys[i + 1]])) for i in beyond]
            keys = np.union1d(keys, new)

    def _trimmed(self, keys: Frames) -> Frames:
        """Keyframes without those whose removal keeps the bound around them, one after the other."""
        i = 1
        while i < len(keys) - 1 and len(keys) > self.least:
            fewer = np.delete(keys, i)
            if self._holds(fewer, i):
                keys = fewer
            else:
                i += 1
        return keys

    def _holds(self, keys: Frames, gone: int) -> bool:
        """Whether the bound holds where a keyframe before index ``gone`` was taken out."""
        first, last = max(gone - 1 - self.margin, 0), min(gone + self.margin, len(keys) - 1)
        around = keys[max(first - self.margin, 0) : last + self.margin + 1]
        if len(around) < self.least:
            around = keys
        errors = self._errors(around, int(keys[first]), int(keys[last]))
        return bool(errors.max() <= self.bound)
