"""Motions sampled from their curves: at a rate, so many, or at given times."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from quatspline.inputs import stamps
from quatspline.inputs.arrays import real_array
from quatspline.motion.grid import sample_times
from quatspline.motion.motion_curve import MotionCurve
from quatspline.quaternion import FloatArray
from quatspline.solving import ConvergenceError

if TYPE_CHECKING:
    from quatspline.motion.motion import Motion, Times


def resampled(
    motion: Motion,
    rate: float | None,
    scheme: str,
    times: ArrayLike | None,
    positions: str,
    options: dict[str, Any],
) -> Motion:
    """See `Motion.resample`."""
    if (rate is None) == (times is None):
        raise ValueError("give a rate or times, and not both")
    curve = motion.curve(scheme, positions=positions, **options)
    if times is None:
        return sampled(curve, grid(curve, rate))
    given = real_array("times", times).astype(float).reshape(-1)
    return sampled(curve, stamps_since(motion, given), given)


def grid(curve: MotionCurve, rate: float | None = None, count: int | None = None) -> Times:
    """Stamps at a rate (Hz), or so many of them, from the first frame to the last; gaps are left out."""
    motion = curve.motion
    ends = motion.stamps[0].item(), motion.stamps[-1].item()
    t = sample_times(*ends, rate, count, motion.per_second)
    if len(curve.pieces) == 1:
        return t
    since = stamps.elapsed(t, motion.stamps[0]) / motion.per_second
    inside = [(since >= piece.first) & (since <= piece.last) for piece in curve.pieces]
    return t[np.any(inside, axis=0)]


def sampled(curve: MotionCurve, at_stamps: Times, times: FloatArray | None = None) -> Motion:
    """The motion of a curve at stamps (m,), or at the times (m,) that these stand for.

    Raises
    ------
    ConvergenceError
        Where a solver failed on a track, which it names.
    """
    if curve.errors:
        raise named(*next(iter(curve.errors.items())))
    motion = curve.motion
    if times is None:
        times = stamps.elapsed(at_stamps, motion.stamps[0]) / motion.per_second
    return motion.moved(at_stamps, *curve(times))


def named(track: str, error: Exception) -> Exception:
    """An error that names the track."""
    if isinstance(error, ConvergenceError):
        return ConvergenceError(f"{track}: {error}", error.report)
    return ValueError(f"{track}: {error}")


def stamps_since(motion: Motion, times: FloatArray) -> Times:
    """Stamps of times since the start, in the file's unit: whole ones where its own are."""
    units = times * motion.per_second
    if motion.stamps.dtype.kind == "i":
        return motion.stamps[0] + np.rint(units).astype(np.int64)
    return np.asarray(motion.stamps[0] + units)
