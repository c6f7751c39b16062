"""Operations: what schemes state that they execute, which no machine changes, and what that adds up to.

A scheme states counts as {"exps per sample": 3, "logs per segment": 1, "slerps per inner keyframe and
iteration": 2}.  Units of a solve are sample; keyframe; inner keyframe, one with neighbours on both sides (all
of a closed curve); segment; knot, an end of segments (a closed curve's last is its first again); solve.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from quatspline.curve import Curve

OPERATIONS = ("slerps", "exps", "logs")

SAMPLE = "sample"

SET_UP = ("keyframe", "inner keyframe", "segment", "knot")
"""Units of a set-up of which there is about one per keyframe."""

AGAIN = " and iteration"


class Stated(NamedTuple):
    """So many of an operation per unit; ``iterated``: in every iteration."""

    operation: str
    number: float
    unit: str
    iterated: bool


class Executed(NamedTuple):
    """Counts by operation: of updates of an iteration and of samples; and of the rest, which is set-up and
    what an iteration does before its first update and after its last."""

    updates: dict[str, float]
    rest: dict[str, float]

    @property
    def total(self) -> dict[str, float]:
        """Both."""
        return {key: number + self.rest[key] for key, number in self.updates.items()}


def stated(operations: Mapping[str, float]) -> list[Stated]:
    """The entries of a scheme's ``operations``."""
    found = []
    for key, number in operations.items():
        operation, _, unit = key.partition(" per ")
        found.append(Stated(operation, number, unit.removesuffix(AGAIN), unit.endswith(AGAIN)))
    return found


def executed(curve: Curve, samples: int, solves: int = 1) -> Executed:
    """What a single-track curve takes that is solved so often, as its own solve went, and sampled so often.

    Operations other than `OPERATIONS` are left out.

    Raises
    ------
    ValueError
        Where a scheme counts them per unit that is not known.
    """
    units = {unit: solves * number for unit, number in _units(curve).items()} | {SAMPLE: samples}
    counts = Executed(dict.fromkeys(OPERATIONS, 0.0), dict.fromkeys(OPERATIONS, 0.0))
    for entry in stated(curve.operations):
        if entry.operation in OPERATIONS:
            if entry.unit not in units:
                known = ", ".join(units)
                raise ValueError(f"operations of {curve.name}: {entry.unit!r} is none of {known}")
            part = counts.updates if entry.iterated or entry.unit == SAMPLE else counts.rest
            times = iterations(curve) if entry.iterated else 1
            part[entry.operation] += entry.number * units[entry.unit] * times
    return counts


def per_keyframe(curve: Curve) -> dict[str, float]:
    """Operations of a set-up per keyframe of many, those of all iterations included."""
    return _one_of(curve, SET_UP)


def per_sample(curve: Curve) -> dict[str, float]:
    """Operations of a sample."""
    return _one_of(curve, (SAMPLE,))


def iterations(curve: Curve) -> int:
    """Updates of the solve of a single-track curve, 0 where nothing is solved."""
    return int(curve.solve_report.iterations) if curve.solve_report is not None else 0


def _one_of(curve: Curve, units: tuple[str, ...]) -> dict[str, float]:
    counts = dict.fromkeys(OPERATIONS, 0.0)
    for entry in stated(curve.operations):
        if entry.operation in OPERATIONS and entry.unit in units:
            counts[entry.operation] += entry.number * (iterations(curve) if entry.iterated else 1)
    return counts


def _units(curve: Curve) -> dict[str, int]:
    """How many there are of each unit in one solve."""
    count, segments = curve.keyframes.count, curve.keyframes.spacings.size
    inner = count if curve.closed else max(count - 2, 0)
    return {
        "keyframe": count,
        "inner keyframe": inner,
        "segment": segments,
        "knot": segments + 1,
        "solve": 1,
    }
