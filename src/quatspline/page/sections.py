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
        "Answer the questions that you can. The schemes that qualify remain, with the least torque first. The address "
        "holds your answers, so you can share the view.",
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
        "Table 1 as the paper prints it, with our measurements beside it. The paper fits its B-spline again for "
        "every frame. Fitted once, the same curve costs less, so both protocols are shown. The paper's seconds come "
        "from another machine: compare ratios.",
        ("table1", "figure3", "figure4", "figure1", "figure2"),
        block="table1",
        topics=("reproduction", "protocol"),
        folded=True,
    ),
    Section(
        "motions",
        "The motions",
        "The same keyframes under two schemes. The arrow on the body is its angular velocity. The curve beside it is "
        "the path of the unit quaternion, with the arriving and the leaving tangent at each keyframe. Where the two "
        "form a corner, the velocity jumps.",
        block="player",
        needs="scenes",
    ),
    Section(
        "draw",
        "Draw your own",
        "Go to a keyframe and drag the body to turn it; drag its number on the timeline to move it in time. This page "
        "computes five schemes exactly as the package does.",
        block="draw",
        needs="scenes",
    ),
    Section(
        "log-curves",
        "Log-curves",
        "ln q(t), half the rotation vector, in rad. Drag to turn and scroll to zoom. A click in the legend hides or "
        "shows a curve.",
        block="logs",
        needs="scenes",
    ),
    Section(
        "rates",
        "Angular velocity and acceleration",
        "Norms of the body's angular velocity and acceleration along the motion, with keyframes marked. A C2 curve has "
        "no step in the lower strip.",
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
        "The error relative to an analytic motion, by keyframe spacing, and the error of substitutes for slerp.",
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
        "Set-up and evaluation are timed separately. Compare seconds only within one run; counts are the same on every "
        "machine.",
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
        "Bounds, the measured values, and whether the bounds are met. Ratios compare rows of the same run.",
        ("speed",),
        block="speed",
    ),
    Section(
        "continuity",
        "Continuity",
        "Jumps between one-sided limits at keyframes, and the resulting k of C^k.",
        ("continuity",),
    ),
    Section(
        "fairness",
        "Fairness",
        "How much more a curve turns and accelerates than it has to.",
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
        "How a curve responds to another frame of reference, to a change of one keyframe, to small errors in all of "
        "them, and to hard keyframes.",
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
        "Recorded motion, rebuilt from every n-th frame. The recorded motion is pale, two schemes are drawn over it, "
        "and the plot below shows their error angle.",
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
    Section("claims", "Claims and verdicts", "Each claim, beside what was measured.", ("claims",)),
)

OTHER = Section("other", "Further measurements")
"""Tables of the folder that no section names."""
