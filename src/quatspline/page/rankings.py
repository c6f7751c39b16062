"""How rows of tables are ordered at first, and how that is said."""

from __future__ import annotations

from dataclasses import dataclass, field

from quatspline.instruments.summary import ALL


@dataclass(frozen=True)
class Ranking:
    """How rows are ordered at first."""

    column: str
    descending: bool
    criterion: str
    among: dict[str, str] = field(default_factory=dict)
    """Values that the table is filtered for at first."""


RANKINGS: dict[str, Ranking] = {
    "fairness": Ranking(
        "median",
        False,
        "the median over the keyframe sets of the torque energy over the least possible; less is better",
        {"data": "committed"},
    ),
    "compare": Ranking(
        "torque_over_least",
        False,
        "torque energy over the least of all schemes compared; less is better",
    ),
    "kept": Ranking(
        "rms_median",
        False,
        "the median over the joints of their rms angles at the frames left out; less is better",
    ),
    "choosing": Ranking(
        "torque",
        False,
        "the median over the committed keyframe sets of the torque energy over the least possible; less is better",
    ),
    "reconstruct": Ranking(
        "over_slerp",
        False,
        "the rms angle at the frames left out over slerp's, geometric mean over the joints; less is better",
        {"clip": ALL},
    ),
    "reduce": Ranking(
        "over_slerp",
        False,
        "the keyframes that are needed over slerp's, geometric mean over the joints; less is better",
        {"clip": ALL},
    ),
    "excursion": Ranking(
        "wander_worst",
        False,
        "the largest angle from the keyframe during a hold ten times as long as the moves beside it; less is better",
        {"data": "hold 10 : 1"},
    ),
    "claims": Ranking("verdict", False, "the verdict: what departs comes first"),
}
