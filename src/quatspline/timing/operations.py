"""What is executed for a curve's keyframes, iterations and samples, counted by running its kernels (`counted`)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from quatspline.counted import of_updates
from quatspline.curve import Curve
from quatspline.segments import SegmentCurve

OPERATIONS = ("slerps", "exps", "logs")
"""The kinds that tables count."""

Counts = dict[str, float]


class Executed(NamedTuple):
    """Counts by operation: of updates of an iteration and of samples, and of the rest.

    The rest is set-up and what an iteration does before its first update and after its last.
    """

    updates: Counts
    rest: Counts

    @property
    def total(self) -> Counts:
        """Both."""
        return {key: number + self.rest[key] for key, number in self.updates.items()}


def executed(curve: Curve, samples: int, solves: int = 1) -> Executed:
    """What a single-track curve takes that is solved so often, as its own solve went, and sampled so often.

    Operations other than `OPERATIONS` are left out.
    """
    sampled = _kinds(per_sample(curve), samples)
    if not (isinstance(curve, SegmentCurve) and hasattr(curve, "fit_kernel")):
        each = {kind: per.keyframe for kind, per in curve.operations.kinds.items()}
        return Executed(sampled, _kinds(each, solves * curve.keyframes.count))
    rest, update = of_updates(curve)
    updated = _kinds(update, solves * iterations(curve))
    return Executed(_sum(sampled, updated), _kinds(rest, solves))


def per_keyframe(curve: Curve) -> Counts:
    """Operations of a set-up per keyframe of many, those of all iterations included."""
    updates, kinds = iterations(curve), curve.operations.kinds
    return _kinds({kind: per.keyframe + updates * per.iteration for kind, per in kinds.items()})


def per_sample(curve: Curve) -> Counts:
    """Operations of a sample."""
    return _kinds({kind: per.sample for kind, per in curve.operations.kinds.items()})


def iterations(curve: Curve) -> int:
    """Updates of the solve of a single-track curve, 0 where nothing is solved."""
    return int(curve.solve_report.iterations) if curve.solve_report is not None else 0


def _kinds(counts: Mapping[str, float], times: float = 1.0) -> Counts:
    return {kind: float(times * counts.get(kind, 0)) for kind in OPERATIONS}


def _sum(a: Counts, b: Counts) -> Counts:
    return {kind: a[kind] + b[kind] for kind in OPERATIONS}
