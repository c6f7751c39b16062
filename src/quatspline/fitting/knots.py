"""Knots of a spline that has fewer of them than keyframes: taken as given or chosen, and held to what they need."""

from __future__ import annotations

import numbers
from typing import Any

import numpy as np

from quatspline.inputs import stamps
from quatspline.inputs.arrays import refuse_infinite
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray

ORDER = 4
"""Of a cubic: so many controls shape a segment."""

PER_SEGMENT = 2
"""Intervals between keyframes that a segment has by default, or one more."""


def knots_of(keyframes: Keyframes, wanted: Any) -> FloatArray:
    """Knots since the first keyframe, both ends among them, of interior ones or of a number of them.

    Chosen ones lie at keyframes, the same number apart as nearly as can be.

    Raises
    ------
    ValueError
        Where they are none, or controls would have no keyframe of their own (`_refuse_bare`).
    """
    n = keyframes.count
    if wanted is None:
        return _at_keyframes(keyframes, max((n - 1) // PER_SEGMENT, 1))
    if isinstance(wanted, numbers.Integral) and not isinstance(wanted, bool):
        count = int(wanted)
        if not 0 <= count <= n - ORDER:
            raise ValueError(f"knots={count}: {n} keyframes take from 0 to {n - ORDER} inside")
        return _at_keyframes(keyframes, count + 1)
    knots = np.concatenate([[0.0], _interior(keyframes, wanted), keyframes.knots[-1:]])
    _refuse_bare(keyframes, knots)
    return knots


def _at_keyframes(keyframes: Keyframes, segments: int) -> FloatArray:
    shares = np.arange(segments + 1) * (keyframes.count - 1) / segments
    return keyframes.knots[np.round(shares).astype(int)]


def _interior(keyframes: Keyframes, wanted: Any) -> FloatArray:
    """Interior knots as times since the first keyframe, refused where they are out of order or outside."""
    given = stamps.stamps("knots", wanted)
    if given.ndim != 1:
        raise ValueError(
            f"knots has shape {given.shape}: expected times inside the domain (k,), or their number"
        )
    if given.dtype.kind == "f":
        refuse_infinite("knots", given)
    times = keyframes.times
    if (
        given.dtype.kind in "mM" or times.dtype.kind in "mM"
    ) and given.dtype.kind != times.dtype.kind:
        raise ValueError(f"knots: {given.dtype}, but the keyframes' times are {times.dtype}")
    inner = stamps.elapsed(given, times[0])
    bounded = np.concatenate([[0.0], inner, keyframes.knots[-1:]])
    late = np.flatnonzero(np.diff(bounded) <= 0.0)
    if late.size:
        i = min(int(late[0]), inner.size - 1)
        raise ValueError(
            f"knots[{i}] = {given[i]}: knots must increase, between the first keyframe's time and the last's"
        )
    return inner


def _refuse_bare(keyframes: Keyframes, knots: FloatArray) -> None:
    """Refuse knots of which a control has no keyframe of its own within the four segments that it shapes.

    That is Schoenberg and Whitney's condition: keyframes x_j, one a control, with t_j < x_j < t_{j+4}; the
    ends count.  Taking the earliest that serves for one control after the other finds them if they exist.
    """
    ends = np.concatenate([[knots[0]] * (ORDER - 1), knots, [knots[-1]] * (ORDER - 1)])
    t, i = keyframes.knots, 0
    for j in range(ends.size - ORDER):
        low, high = ends[j], ends[j + ORDER]
        while i < t.size and not (t[i] > low or low == t[0]):
            i += 1
        if i == t.size or not (t[i] < high or (high == t[-1] and t[i] <= high)):
            raise ValueError(
                f"knots: too many for the keyframes from {low:g} to {high:g} after the first, where "
                "a control has none of its own (Schoenberg and Whitney's condition)"
            )
        i += 1
