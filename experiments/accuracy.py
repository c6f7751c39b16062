"""Accuracy against keyframe spacing on a smooth motion, and the orders that it falls with."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import found
from quatspline.figures import named, style
from quatspline.instruments.accuracy import TARGETS, errors, knots, with_reach, with_slopes
from quatspline.instruments.trials import Row, attempted, builder, facts
from quatspline.quaternion import FloatArray
from quatspline.runs.experiment import Run
from quatspline.timing.budget import Budget, calls
from quatspline.trajectories.smooth import SPAN, tumble

TITLE = "Accuracy on a smooth motion"
PAPER = False
KEYS = ["knots", "scheme", "keyframes"]
NOTE = (
    "Largest errors against the analytic truth; lower is better. 'inner' is the window [3, 7] of [0, 10], away "
    "from the ends. slope, slope_omega and slope_alpha: orders of inner_angle, inner_omega and inner_alpha relative "
    "to the previous level; regression: over the last five levels. spacing_1deg, spacing_0.1deg, spacing_0.01deg: the "
    "largest spacing below which inner_angle stays under that angle; larger is better. unreached says why there is "
    "none."
)
FORMATS = {
    "spacing": ".3g",
    **dict.fromkeys(("inner_angle", "angle", "inner_omega", "inner_alpha"), ".2e"),
    **{f"{kind}{of}": ".2f" for kind in ("slope", "regression") for of in ("", "_omega", "_alpha")},
    **dict.fromkeys(TARGETS, ".3g"),
}
QUICK, FULL = (21, 41, 81), (11, 21, 41, 81, 161, 321, 641)
"""Keyframes of the levels; quick runs measure all for our own schemes at uniform times, which orders are read from."""
KINDS = ("uniform", "jittered", "log-uniform")

BUDGET = Budget(limit=1e8, meter=calls)
"""Of a level of a library's scheme, about half a minute."""
SAMPLED = (40, 4, 4)
"""Samples of a segment, for its forecast: with the nine orientations of each rate that a scheme does not offer."""

GUIDES, NAMED = 0.1, 3.0
"""How much lower than all curves guides are at the end, where the name takes that ratio of spacings."""
EDGE = 1.1
"""Ratio of limits to spacings."""


def cells(run: Run) -> list[dict[str, Any]]:
    names = run.schemes or list(found())
    kinds = KINDS[:2] if run.quick else KINDS
    return [{"knots": kind, "scheme": name} for name in names for kind in kinds]


def measure_cell(run: Run, knots: str, scheme: str) -> list[Row]:
    rows, counts = [], levels(run, knots, scheme)
    refusals = _refusals(scheme, counts)
    for count in counts:
        base = {"knots": knots, "scheme": scheme, "keyframes": count, "spacing": SPAN / (count - 1)}
        measure = partial(_measured, run, knots, scheme, count)
        failure = refusals.get(count)
        rows += [base | row for row in ([{"failure": failure}] if failure else attempted(measure))]
    return rows


def _refusals(name: str, counts: tuple[int, ...]) -> dict[int, str]:
    """Why levels are not measured; none where the finest is, which costs most."""
    cls = found()[name].scheme
    if cls is None or BUDGET.refusal(cls, counts[-1], SAMPLED) is None:
        return {}
    reasons = {count: BUDGET.refusal(cls, count, SAMPLED) for count in counts}
    return {count: reason for count, reason in reasons.items() if reason}


def levels(run: Run, knots: str, scheme: str) -> tuple[int, ...]:
    cls = found()[scheme].scheme
    whole = not run.quick or (knots == KINDS[0] and cls is not None and cls.peer is None)
    return FULL if whole else QUICK


def _measured(run: Run, kind: str, name: str, count: int) -> list[Row]:
    times: FloatArray = knots(run.rng("accuracy", kind, count), kind, count)
    curve = builder(name)(times, tumble(times))
    return [{**errors(curve), **facts(curve)}]


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    columns = ["inner_angle", "angle", "inner_omega", "inner_alpha", "rates", "version", "failure"]
    table = table.reindex(columns=["knots", "scheme", "keyframes", "spacing", *columns])
    by = ["knots", "scheme"]
    return with_reach(with_slopes(table, by), by)


def draw(table: pd.DataFrame) -> Figure:
    kinds = [kind for kind in KINDS if (table["knots"] == kind).any()]
    lit = named.coloured(_drawn(table))
    fig, panels = style.axes(style.PAGE, 3.9, 1, len(kinds), sharey=True)
    for ax, kind in zip(panels[0], kinds, strict=True):
        own = table[(table["knots"] == kind) & table["inner_angle"].notna()]
        groups = own.sort_values("keyframes").groupby("scheme")
        rows = ((str(name), each["spacing"], each["inner_angle"]) for name, each in groups)
        ends = named.draw_curves(ax, rows, lit)
        _guides(ax, own)
        ax.set(xscale="log", yscale="log", title=f"{kind} times", xlabel="keyframe spacing (t)")
        ax.set_xlim(EDGE * own["spacing"].max(), own["spacing"].min() / EDGE)
        style.plain_log(ax.xaxis)
    panels[0, 0].set_ylabel("largest error on the inner window (rad)")
    style.letters(panels[0])
    named.name_ends(fig, {ax: ends})
    return fig


def _drawn(table: pd.DataFrame) -> list[str]:
    return list(table.loc[table["inner_angle"].notna(), "scheme"].unique())


def _guides(ax: Any, table: pd.DataFrame) -> None:
    """Slopes 2, 3 and 4, below the curves, and the target angles, in grey."""
    far, near = table["spacing"].max(), table["spacing"].min()
    x = np.array([far, np.sqrt(near * far)])
    below = GUIDES * table.loc[table["spacing"] >= x[1] / NAMED, "inner_angle"].min()
    for order in (2, 3, 4):
        y = below * (x[0] / x[1]) ** 2 * (x / x[0]) ** order
        ax.plot(x, y, color="#999999", lw=0.7, ls=":")
        place = {"textcoords": "offset points", "va": "center", "fontsize": 6.5, "color": "#777777"}
        ax.annotate(f"order {order}", (x[1], y[1]), (3, 0), **place)
    for degrees in TARGETS.values():
        ax.axhline(np.radians(degrees), color="#888888", lw=0.5)
        place = {"transform": ax.get_yaxis_transform(), "va": "bottom", "ha": "left"}
        ax.text(0.01, np.radians(degrees), f"{degrees:g}°", fontsize=6.5, color="#777777", **place)


def caption(table: pd.DataFrame) -> str:
    return (
        "Largest angle between each curve and the analytic motion that its keyframes come from, on the inner window "
        "[3, 7] of [0, 10], against the mean keyframe spacing, which falls to the right; lower is better."
        f"{named.said(_drawn(table))} Dotted lines have slopes 2, 3, 4; "
        "horizontal lines are at 1, 0.1 and 0.01 degrees."
    )
