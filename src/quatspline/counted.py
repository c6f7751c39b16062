"""What compiled schemes execute, counted by running their kernels on typical keyframes (`engines.counting`).

Typical are keyframes at equal times, every step 40 degrees about an axis of its own: half angles stay within
`scalars.NEAR`, so that kernels for near angles are counted where a scheme has them.
"""

from __future__ import annotations

import inspect
import math
from collections import Counter
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.engines import counting
from quatspline.inputs.arrays import FloatArray
from quatspline.operations import UNSTATED, Operations, Per

STEP = np.radians(40.0)

SAMPLED = 5
"""Keyframes of the curve that is sampled, in its middle segment."""

FEW, MORE = 8, 4
"""Keyframes beyond those that shape a segment, and how many more a second curve has: its set-up takes as much more."""

PLACES = (0.125, 0.375, 0.625, 0.875)
"""Where samples lie in their segment: the mean counts, for those that iterate."""

NEVER = 1e-300
"""A tolerance that no update meets."""

NAMED = ("slerps", "exps", "logs", "roots")

PACKED = ("multiplications", "additions", "divisions", "roots")
"""What is one arithmetic instruction each, but for additions that are fused with a product."""

Counts = Mapping[str, float]


class Counted:
    """The attribute ``operations`` of compiled schemes: counted when it is first asked for.

    Of a curve with its options, as far as they are numbers or words; of a class with the default ones.
    """

    def __get__(self, curve: Any, cls: Any) -> Operations:
        if inspect.isabstract(cls):
            return UNSTATED
        given = {} if curve is None else curve.options
        plain = {key: x for key, x in given.items() if isinstance(x, (bool, int, float, str))}
        return _of_scheme(cls, tuple(sorted(plain.items())))


def of_a_sample(curve: Any, order: int = 0) -> Counts:
    """Counts of a sample in the middle segment of a compiled curve."""
    kernel, segments = curve.kernels[order], curve.segments[0]
    middle = len(segments) // 2
    start, stop = curve.segment_knots[middle : middle + 2].tolist()
    found: list[Counter[str]] = [
        counting.of_a_sample(kernel, segments[middle], u, 1.0 / (stop - start)) for u in PLACES
    ]
    samples = counting.TOGETHER * len(PLACES)
    return {kind: n / samples for kind, n in sum(found, start=Counter()).items()}


def packed(counts: Counts) -> float:
    """Arithmetic instructions of a sample, each for as many samples as a vector holds."""
    return sum(counts.get(kind, 0.0) for kind in PACKED) - counts.get("fused", 0.0)


def of_a_fit(curve: Any) -> Counts:
    """Counts of the solve of a compiled curve's first track, as it went."""
    frames = curve.keyframes
    given = frames.tracks[0], frames.spacings, frames.closed, float(frames.signs[0])
    shape = curve.segments.shape[1:]
    return counting.of_a_fit(curve.fit_kernel, *given, curve.parameters, shape)


def of_updates(curve: Any) -> tuple[Counts, Counts]:
    """Counts of a compiled curve's solve without its updates, and of each update; nothing where none is made.

    An update takes what the second one does; what others take more or less stays in the rest.
    """
    solved = of_a_fit(curve)
    if not curve.iterative:
        return solved, {}
    once, twice = (
        of_a_fit(_stopped(type(curve), curve.keyframes, curve.options, n)) for n in (1, 2)
    )
    update, made = difference(twice, once), int(curve.solve_report.iterations)
    return difference(solved, {kind: made * n for kind, n in update.items()}), update


def difference(a: Counts, b: Counts) -> Counts:
    """How much larger the counts of a are than those of b."""
    return {kind: a.get(kind, 0) - b.get(kind, 0) for kind in {**a, **b}}


def _stopped(cls: Any, keyframes: Any, options: Mapping[str, Any], updates: int) -> Any:
    """The curve of an iterative scheme after so many updates."""
    ends = {"max_iterations": updates, "tolerance": NEVER, "on_failure": "return"}
    return cls.from_keyframes(keyframes, **{**options, **ends})


@cache
def _of_scheme(cls: Any, options: tuple[tuple[str, Any], ...]) -> Operations:
    curve = cls(None, typical(max(SAMPLED, cls.min_keyframes)), **dict(options))
    parts = [of_a_sample(curve), *_of_a_keyframe(curve)]
    missing = [0, 0 if hasattr(curve, "fit_kernel") else math.nan, 0]
    each = {
        kind: Per(*(_whole(part.get(kind, m)) for part, m in zip(parts, missing, strict=True)))
        for kind in {**dict.fromkeys(NAMED), **parts[0], **parts[1], **parts[2]}
    }
    return Operations(**{kind: each.pop(kind) for kind in NAMED}, others=each)


def _of_a_keyframe(curve: Any) -> tuple[Counts, Counts]:
    """What each further keyframe adds to a set-up without its updates, and to an update."""
    if not hasattr(curve, "fit_kernel"):
        return {}, {}
    cls, few = type(curve), FEW + (curve.support or 0)
    fits = [of_updates(cls(None, typical(n), **curve.options)) for n in (few, few + MORE)]
    added = (difference(more, less) for less, more in zip(*fits, strict=True))
    rest, update = ({kind: n / MORE for kind, n in part.items()} for part in added)
    return rest, update


def _whole(count: float) -> float:
    """An integer where it is one."""
    return int(count) if float(count).is_integer() else count


def typical(count: int) -> FloatArray:
    """Typical keyframes; longer walks begin as shorter ones do."""
    axes = np.random.default_rng(0).normal(size=(count - 1, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    q = [np.array([1.0, 0.0, 0.0, 0.0])]
    for step in quaternion.exp(0.5 * STEP * axes):
        q.append(quaternion.mul(q[-1], step))
    return np.array(q)
