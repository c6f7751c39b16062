"""What the operations that schemes state add up to, for a curve's keyframes, iterations and samples."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from quatspline.curve import Curve
from quatspline.operations import UNSTATED, Operations, Per

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

    def set_up(per: Per) -> float:
        return solves * _of_a_solve(per, curve)

    own, updates = curve.operations, _updates(curve)
    sampled = _counted(own, lambda per: samples * per.sample)
    updated = _counted(updates, lambda per: iterations(curve) * set_up(per))
    return Executed(_sum(sampled, updated), _counted(own, set_up))


def per_keyframe(curve: Curve) -> Counts:
    """Operations of a set-up per keyframe of many, those of all iterations included."""
    updates = _counted(_updates(curve), lambda per: iterations(curve) * of_a_keyframe(per))
    return _sum(_counted(curve.operations, of_a_keyframe), updates)


def per_sample(curve: Curve) -> Counts:
    """Operations of a sample."""
    return _counted(curve.operations, of_a_sample)


def of_a_sample(per: Per) -> float:
    """The count of a sample."""
    return per.sample


def of_a_keyframe(per: Per) -> float:
    """Counts of the units of a set-up of which there is about one per keyframe."""
    return per.keyframe + per.inner_keyframe + per.segment + per.knot


def iterations(curve: Curve) -> int:
    """Updates of the solve of a single-track curve, 0 where nothing is solved."""
    return int(curve.solve_report.iterations) if curve.solve_report is not None else 0


def _of_a_solve(per: Per, curve: Curve) -> float:
    count, segments = curve.keyframes.count, curve.keyframes.spacings.size
    inner = count if curve.closed else max(count - 2, 0)
    each = per.keyframe * count + per.inner_keyframe * inner
    return each + per.segment * segments + per.knot * (segments + 1) + per.solve


def _updates(curve: Curve) -> Operations:
    return curve.operations.iteration or UNSTATED


def _counted(operations: Operations, count: Callable[[Per], float]) -> Counts:
    return {kind: float(count(operations.kinds[kind])) for kind in OPERATIONS}


def _sum(a: Counts, b: Counts) -> Counts:
    return {kind: a[kind] + b[kind] for kind in OPERATIONS}
