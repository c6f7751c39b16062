"""How rows of tables are ordered at first, and how that is said."""

from __future__ import annotations

from dataclasses import dataclass, field

from quatspline.instruments.summary import ALL


@dataclass(frozen=True)
class Ranking:
    """How rows are ordered at first."""

    column: str | None
    """None where the file's order is the ranking."""
    descending: bool
    criterion: str
    among: dict[str, str] = field(default_factory=dict)
    """Values that the table is filtered for at first."""


RANKINGS: dict[str, Ranking] = {
    "fairness": Ranking(
        "median",
        False,
        "the torque energy relative to the least possible, median over the keyframe sets; less is better",
        {"data": "committed"},
    ),
    "compare": Ranking(
        None,
        False,
        "what is recommended first, then what is smooth, does not wander and meets the needs, then all that meets them "
        "and passes through the keyframes, each by torque energy; then what breaks a need, the nearest first; last "
        "what does not pass through the keyframes or was not measured",
    ),
    "kept": Ranking(
        "rms_median",
        False,
        "the rms angle at the frames left out, median over the joints; less is better",
    ),
    "choosing": Ranking(
        "torque",
        False,
        "the torque energy relative to the least possible, median over the committed keyframe sets; less is better",
    ),
    "reconstruct": Ranking(
        "over_slerp",
        False,
        "the rms angle at the frames left out relative to slerp's, geometric mean over the joints; less is better",
        {"clip": ALL},
    ),
    "reduce": Ranking(
        "over_slerp",
        False,
        "the number of keyframes needed relative to slerp's, geometric mean over the joints; less is better",
        {"clip": ALL},
    ),
    "excursion": Ranking(
        "wander_worst",
        False,
        "the largest angle from the keyframe during a hold ten times as long as the moves beside it; less is better",
        {"data": "hold 10 : 1"},
    ),
    "claims": Ranking("verdict", False, "the verdict: departures come first"),
}
