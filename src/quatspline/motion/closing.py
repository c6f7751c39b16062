"""Closed motions: where files say when the first orientation returns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from quatspline import quaternion
from quatspline.keyframes import prepare
from quatspline.motion.motion import Motion, Times
from quatspline.quaternion import FloatArray

REPEATED = 1e-6
"""A last orientation within this angle (rad) of the first is the return of a closed motion."""

NEARLY, SHARE = np.radians(3.0), 0.25
"""Beyond that, a last orientation this near (rad), by this share of the median step, is ambiguous."""


def opened(motion: Motion) -> Motion:
    """A motion as an open one; raises ValueError where it has a time for its return."""
    if motion.closed:
        raise ValueError(
            f"{len(motion.stamps)} times for {len(motion.quaternions)} quaternions: an open motion has "
            "one time per keyframe; --closed takes the last time as that of the return"
        )
    return motion


def nearly(gap: float, median: float) -> bool:
    """Whether a last orientation this far from the first may be meant to repeat it, by the median step (rad)."""
    return gap < min(NEARLY, SHARE * median)


def returning(motion: Motion) -> Motion:
    """A motion closed: n keyframes and n + 1 times.

    The last row is the return where it repeats the first orientation (within `REPEATED`) of every
    track; otherwise uniform times go on for one more step.  A last row that nearly repeats the first
    is a keyframe like any other, so that none is dropped, and the note says so.  Raises ValueError
    when neither tells the time of the return.
    """
    t, q = motion.stamps, motion.quaternions
    if motion.closed or len(t) < 2:
        return motion
    gap = float(quaternion.distance(*quaternion.normalise(q[[-1, 0]])).max())
    if gap < REPEATED:
        into, out = _tangents_round(motion)
        return replace(motion, quaternions=q[:-1], in_tangents=into, out_tangents=out)
    near = f"the last row is {np.degrees(gap):.2g} degrees from the first orientation"
    ambiguous = nearly(gap, _median_step(q))
    if not prepare(t, q).uniform:
        raise ValueError(
            "closed: times are not uniform, so the last row must repeat the first orientation "
            f"at the time of its return{f'; {near}' if ambiguous else ''}"
        )
    note = (
        f"closed: {near}; it is kept as a keyframe, and the curve returns one step later "
        "(to return at that row, make it equal to the first)"
    )
    return _one_step_more(motion, note if ambiguous else "")


def _one_step_more(motion: Motion, note: str) -> Motion:
    t, x = motion.stamps, motion.positions
    end = _one_step_after(t)
    x = None if x is None else np.concatenate([x, x[:1]])
    longer = motion.without_tangents()  # a file's splines know nothing of the step more
    return replace(longer, stamps=np.append(t, np.asarray(end, t.dtype)), positions=x, note=note)


def _tangents_round(motion: Motion) -> tuple[FloatArray | None, FloatArray | None]:
    """Tangents without the return's row: what arrives there arrives at the first keyframe, as that is signed."""
    into, out, q = motion.in_tangents, motion.out_tangents, motion.quaternions
    if into is None or out is None:
        return None, None
    sign = np.sign(np.sum(q[-1] * q[0], axis=-1, keepdims=True))
    return np.concatenate([(sign * into[-1])[None], into[1:-1]]), out[:-1]


def _median_step(q: FloatArray) -> float:
    """The median over frames of the largest step of a track."""
    q = quaternion.normalise(q)
    return float(np.median(quaternion.distance(q[1:], q[:-1]).max(axis=-1)))


def _one_step_after(t: Times) -> float | int:
    """The time after uniform times: of integers, the nearest integer, without rounding to float64."""
    first, last, steps = t[0].item(), t[-1].item(), len(t) - 1
    if t.dtype.kind == "f":
        return first + (last - first) * (len(t) / steps)
    end = first + (2 * (last - first) * len(t) + steps) // (2 * steps)
    if end > np.iinfo(t.dtype).max:
        raise ValueError(f"closed: the return at {end} is beyond 64-bit integers")
    return end
