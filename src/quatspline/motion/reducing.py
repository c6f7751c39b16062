"""Keyframe reduction: the frames of a dense motion from which a scheme rebuilds it within a bound.

Greedy insertion at the worst frame between keyframes, then trimming of every keyframe whose removal keeps
the bound; what comes out is measured once more on all frames.  Where a solver fails on that, segments are
halved until it does not.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from quatspline import catalogue, quaternion
from quatspline.motion.resampling import named
from quatspline.options import among
from quatspline.quaternion import FloatArray
from quatspline.solving import ConvergenceError

if TYPE_CHECKING:
    from quatspline.curve import Curve
    from quatspline.motion.motion import Motion

Frames = NDArray[np.intp]
"""Indices of frames, increasing."""

FAR = 16
"""Keyframes around one within which a global scheme is tried without it: C^2 splines forget by a factor
of 3 to 4 per keyframe.  What that leaves over is found when all frames are measured."""

TRIED = 30
"""Iterations of a solver while keyframes are tried: one that does not settle would take all of its own."""


class Impractical(ValueError):
    """More keyframes are needed than a scheme says are practical."""


@dataclass(frozen=True, eq=False)
class Reduction:
    """Keyframes of a motion; see `Motion.reduce`.

    Attributes
    ----------
    frames : indices of the frames that are kept, by joint
    motion : the motion rebuilt from them at the times of the source, with the source's positions
    largest : the largest local angle (rad) of a joint at a frame left out
    failures : why the scheme has no curve for a joint, which then keeps all of its frames
    """

    frames: dict[str, Frames]
    motion: Motion
    largest: float
    failures: dict[str, str] = field(default_factory=dict)


def reduction(
    motion: Motion,
    scheme: str,
    error: float,
    together: bool,
    options: dict[str, Any],
    progress: Callable[[list[slice]], Iterable[slice]] = iter,
) -> Reduction:
    """See `Motion.reduce`; ``progress`` goes over the joints, and may say so."""
    if not (isinstance(error, int | float | np.floating) and 0.0 < error < np.inf):
        raise ValueError(f"error={error!r}: a positive angle in rad is expected")
    if len(motion.edges) > 2:
        raise ValueError(
            f"the motion has gaps: reduce its {len(motion.edges) - 1} pieces one by one"
        )
    if motion.closed or len(motion.stamps) < 2:
        raise ValueError("an open motion of at least 2 frames is expected")
    if not catalogue.scheme(scheme).interpolates:
        raise ValueError(
            f"{scheme} passes near its keyframes, so no choice of keyframes keeps a bound"
        )
    names = list(motion.tracks)
    groups = [slice(0, len(names))] if together else [slice(k, k + 1) for k in range(len(names))]
    source = quaternion.normalise(motion.quaternions)
    rebuilt = source.copy()
    frames: dict[str, Frames] = {}
    errors: dict[str, ConvergenceError | Impractical] = {}
    for group in progress(groups):
        track = _Track(motion.times, source[:, group], scheme, error, options)
        keys = np.arange(len(motion.times))
        try:
            keys, rebuilt[:, group] = track.reduced()
        except (ConvergenceError, Impractical) as failure:
            errors |= dict.fromkeys(names[group], failure)
        frames |= dict.fromkeys(names[group], keys)
    if len(errors) == len(names):
        raise named(names[0], errors[names[0]])
    largest = float(quaternion.distance(rebuilt, source).max())
    whole = motion.moved(motion.stamps, rebuilt, motion.positions)
    return Reduction(frames, whole, largest, {name: str(e) for name, e in errors.items()})


class _Track:
    """One set of keyframes, for one joint or for all together."""

    def __init__(
        self, t: FloatArray, q: FloatArray, scheme: str, bound: float, options: dict[str, Any]
    ) -> None:
        self.t, self.q, self.bound = t, q, bound
        cls = catalogue.scheme(scheme)
        self.least = min(max(cls.min_keyframes, 2), len(t))
        self.name, self.most = scheme, cls.practical_keyframes or len(t)
        self.margin = (cls.support or FAR) // 2
        self.build: Callable[..., Curve] = partial(catalogue.build, scheme, **options)
        # A solve on few keyframes may fail where more succeed: frames judge what it gives, not its report.
        self.excused = among(cls, {"on_failure": "return"})
        self.tried = cls.rough | among(cls, {"max_iterations": TRIED} | self.excused) | options

    def reduced(self) -> tuple[Frames, FloatArray]:
        """Keyframes, and what they rebuild.

        Raises
        ------
        ConvergenceError
            Where the solver fails even on all frames.
        Impractical
            Where the scheme is not meant for as many keyframes as the bound needs.
        """
        keys = np.unique(np.linspace(0, len(self.t) - 1, self.least).astype(int))
        keys = self._trimmed(self._within(keys, self.tried))
        while True:
            keys = self._within(keys, self.excused)  # all frames are measured, once more
            try:
                return keys, self.build(self.t[keys], self.q[keys])(self.t)
            except ConvergenceError as failure:
                keys = self._denser(keys, failure)

    def _denser(self, keys: Frames, failure: ConvergenceError) -> Frames:
        """Keyframes with the segments halved at which the solver failed, or all of them.

        Raises
        ------
        ConvergenceError
            The failure, where there is nothing to halve.
        """
        wide = np.diff(keys) > 1
        if not wide.any():
            raise failure
        t, q = self.t[keys], self.q[keys]
        missed = quaternion.distance(self.build(t, q, **self.excused)(t), q).max(axis=1)
        lost = ~(missed <= failure.report.tolerance)
        there = wide & (lost[:-1] | lost[1:])
        halved = there if there.any() else wide
        return np.union1d(keys, (keys[:-1] + keys[1:])[halved] // 2)

    def _errors(self, keys: Frames, first: int, last: int, options: dict[str, Any]) -> FloatArray:
        """Angles of the frames from first to last, the largest of all joints."""
        curve = self.build(self.t[keys], self.q[keys], **options)
        rebuilt = curve(self.t[first : last + 1])
        angles = quaternion.distance(rebuilt, self.q[first : last + 1])
        return np.asarray(angles.max(axis=1))

    def _within(self, keys: Frames, options: dict[str, Any]) -> Frames:
        """Keyframes with the worst frame of each segment beyond the bound added, until none is."""
        while True:
            errors = self._errors(keys, 0, len(self.t) - 1, options)
            worst = np.maximum.reduceat(errors, keys[:-1])
            worst = np.maximum(worst, errors[keys[1:]])
            beyond = np.flatnonzero(~(worst <= self.bound) & (np.diff(keys) > 1))
            if not beyond.size:
                return keys
            inner = [errors[keys[i] + 1 : keys[i + 1]] for i in beyond]
            new = [keys[i] + 1 + int(np.argmax(e)) for i, e in zip(beyond, inner, strict=True)]
            keys = np.union1d(keys, new)
            if len(keys) > self.most:
                raise Impractical(
                    f"{self.name} is practical up to {self.most} keyframes, and more are needed "
                    f"within {np.degrees(self.bound):.3g} degrees"
                )

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
        errors = self._errors(around, int(keys[first]), int(keys[last]), self.tried)
        return bool(errors.max() <= self.bound)
