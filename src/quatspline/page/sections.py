"""The page's sections in order: what each is about, its tables and plots."""

from __future__ import annotations

from dataclasses import dataclass

from quatspline.findings.decisions import TABLE
from quatspline.findings.recorded import TOPIC
from quatspline.instruments.summary import ALL
from quatspline.page.plots import Plot


@dataclass(frozen=True)
class Section:
    """A section; it is left out when the folder has nothing for it.

    Attributes
    ----------
    key, title, text : anchor, heading, introduction
    tables : names of tables, each shown with its note and its figure
    plots : interactive plots of them
    block : a template of its own, `assets/blocks/<block>.html`
    needs : what the block shows, if it is no table: "scenes", "replays" or "nothing"
    topics : of findings that stand here and not at the top
    folded : whether tables start folded (they hold what a figure draws)
    leads : whether the section stands before the findings
    """

    key: str
    title: str
    text: str = ""
    tables: tuple[str, ...] = ()
    plots: tuple[Plot, ...] = ()
    block: str = ""
    needs: str = ""
    topics: tuple[str, ...] = ()
    folded: bool = False
    leads: bool = False


SECTIONS: tuple[Section, ...] = (
    Section(
        "choosing",
        "Which scheme?",
        "Answer what you know; the schemes that qualify remain, the least torque first. The address holds the "
        "answers, so that a view can be shared.",
        ("choosing",),
        (
            Plot(
                "choosing",
                ("nanoseconds_per_sample", "microseconds_per_keyframe", "operations_sample"),
                ("torque", "torque_worst", "order"),
                "points",
                log=(True, True),
                ratios=("torque", "torque_worst"),
            ),
        ),
        block="chooser",
        topics=(TABLE,),
        folded=True,
        leads=True,
    ),
    Section(
        "paper",
        "The paper, reproduced",
        "Table 1 as the paper prints it, with what is measured here beside it. The paper fits its B-spline anew for "
        "every frame; fitted once, the same curve costs less, so both protocols stand there. Its seconds come from "
        "another machine: compare ratios.",
        ("table1", "figure3", "figure4", "figure1", "figure2"),
        block="table1",
        topics=("reproduction", "protocol"),
        folded=True,
    ),
    Section(
        "motions",
        "The motions",
        "The same keyframes under two schemes. The arrow on the body is its angular velocity; the curve beside it is "
        "the path of the unit quaternion, with the tangents that arrive at each keyframe and leave it. Where they "
        "form a corner, the velocity jumps.",
        block="player",
        needs="scenes",
    ),
    Section(
        "draw",
        "Draw your own",
        "Go to a keyframe and drag the body to turn it; drag its number on the timeline to move it in time. Five "
        "schemes are computed in this page, as the package computes them.",
        block="draw",
        needs="scenes",
    ),
    Section(
        "log-curves",
        "Log-curves",
        "ln q(t), half the rotation vector, in rad. Drag to turn, scroll to zoom; a click in the legend hides a "
        "curve or shows it.",
        block="logs",
        needs="scenes",
    ),
    Section(
        "rates",
        "Angular velocity and acceleration",
        "Norms of the body's rates along the motion; keyframes are marked. A curve that is C2 has no step in the "
        "lower strip.",
        block="rates",
        needs="scenes",
    ),
    Section(
        "convergence",
        "Iterations and convergence",
        "How many updates the iterative schemes need, and where they stop converging.",
        ("iterations", "convergence"),
        (
            Plot(
                "iterations",
                ("step_degrees",),
                ("median", "q95", "most"),
                split=("method",),
                facets=("data",),
                log=(False, True),
            ),
            Plot(
                "convergence",
                ("unevenness",),
                ("step_degrees",),
                "map",
                (
                    *("share_converged", "iterations_median", "iterations_q95", "iterations_most"),
                    *("rate", "rate_theory", "share_jumping", "jump_worst", "seconds_median"),
                ),
                facets=("scheme", "method", "keyframes"),
            ),
        ),
    ),
    Section(
        "accuracy",
        "Accuracy",
        "Error to an analytic motion against the keyframe spacing; what stands in for slerp, against slerp.",
        ("accuracy", "slerp-variants"),
        (
            Plot(
                "accuracy",
                ("spacing", "keyframes"),
                ("inner_angle", "angle", "inner_omega", "inner_alpha", "slope"),
                facets=("knots",),
                start={"knots": "uniform"},
                log=(True, True),
            ),
        ),
    ),
    Section(
        "cost",
        "Cost",
        "Set-up and evaluation apart. Compare seconds within one run only; counts change on no machine.",
        ("cost",),
        (
            Plot(
                "cost",
                ("size",),
                ("seconds_median", "times_fastest", "times_memory"),
                facets=("task",),
                start={"task": "set-up"},
                log=(True, True),
            ),
        ),
    ),
    Section(
        "speed",
        "Speed",
        "Bounds, what was measured, and whether they are met. Ratios are between rows of one run.",
        ("speed",),
        block="speed",
    ),
    Section(
        "continuity",
        "Continuity",
        "Jumps of one-sided limits at keyframes, and the k of C^k that follows.",
        ("continuity",),
    ),
    Section(
        "fairness",
        "Fairness",
        "How much more a curve turns and accelerates than it must.",
        ("fairness",),
    ),
    Section(
        "excursion",
        "Excursion",
        "How far curves overshoot their keyframes, and how far they wander where keyframes hold still.",
        ("excursion",),
    ),
    Section(
        "robustness",
        "Invariance, locality, noise, edge cases",
        "What a change of the frame, of one keyframe or of all a little does to a curve, and what hard keyframes do.",
        ("invariance", "locality", "noise", "edge-cases"),
        (
            Plot(
                "locality",
                ("offset",),
                ("response",),
                facets=("step_degrees",),
                log=(False, True),
            ),
        ),
    ),
    Section(
        "recorded",
        "Recorded motion",
        "What people record, rebuilt from every so many-th frame: the motion itself is pale, two schemes lie over it, "
        "and below stands by what angle they are off.",
        ("reconstruct", "reduce"),
        (
            Plot(
                "reconstruct",
                ("every",),
                ("over_slerp", "rms_degrees", "largest_degrees", "end_cm", "omega", "alpha"),
                facets=("clip", "filter"),
                start={"clip": ALL, "filter": "none"},
                log=(True, True),
            ),
            Plot(
                "reduce",
                ("error_degrees",),
                ("over_slerp", "share", "per_second"),
                facets=("clip", "filter"),
                start={"clip": ALL, "filter": "none"},
                log=(True, False),
            ),
        ),
        block="recorded",
        needs="replays",
        topics=(TOPIC,),
        folded=True,
    ),
    Section("claims", "Claims and verdicts", "Each claim beside what was measured.", ("claims",)),
)

OTHER = Section("other", "Further measurements")
"""Tables of the folder that no section names."""
