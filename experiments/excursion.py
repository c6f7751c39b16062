"""How far curves overshoot their keyframes, and how far they wander where keyframes hold still."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import version
from quatspline.figures import style
from quatspline.figures.heat import ROW, scheme_rows
from quatspline.instruments.excursion import excursion
from quatspline.instruments.trials import Row, attempted, builder
from quatspline.quaternion import FloatArray
from quatspline.runs.experiment import Run, crossed
from quatspline.trajectories.holds import axis_sets, hold_sets
from quatspline.trajectories.sets import torque_sets

TITLE = "Excursion: overshoot, and wandering during holds"
PAPER = False
KEYS = ["data", "scheme"]
NOTE = (
    "How far a curve leaves the arc from one keyframe to the next, of every segment that moves, as a share of its "
    "step: off, the largest distance to the arc; over, the largest way beyond either end along its great circle; "
    "back, the largest fall from the farthest progress so far; each with the median, the 95 % quantile and the worst "
    "of all segments. overshot: the share of segments with over above 1 % of the step; over_degrees: the worst over "
    "as an angle. wander: the largest angle from the keyframe during a hold, in degrees of rotation, a full turn "
    "being 360. Less is better; off cannot be 0 where a curve of continuous velocity turns a corner. Seeded open "
    "sets: 'generic', those of the table fairness; 'hold 1 : 1' and '10 : 1', 90 degree moves about random axes "
    "beside a hold that lasts as long as one of them or ten times as long; 'one axis', back and forth. Iterative "
    "schemes are solved to 1e-11."
)
SHARES, LEVELS = ("off", "over", "back"), {"median": 0.5, "q95": 0.95, "worst": 1.0}
FORMATS = {
    **{f"{share}_{level}": ".3g" for share in SHARES for level in LEVELS},
    "overshot": ".3f",
    "over_degrees": ".3g",
    "wander_median": ".3g",
    "wander_worst": ".3g",
}
GENERIC, AXIS, HOLDS = "generic", "one axis", {"hold 1 : 1": 1, "hold 10 : 1": 10}
QUICK, FULL = 3, 100
"""Sets of each kind."""
OVERSHOT = 0.01
"""Of a step: an overshoot that one sees."""


def cells(run: Run) -> list[dict[str, Any]]:
    return crossed(data=[GENERIC, *HOLDS, AXIS], scheme=run.names)


def _sets(data: str, count: int) -> list[tuple[FloatArray, FloatArray]]:
    if data == GENERIC:
        return [(times, q) for times, q, _ in torque_sets(count)]
    return axis_sets(count) if data == AXIS else hold_sets(HOLDS[data], count)


def measure_cell(run: Run, scheme: str, data: str) -> list[Row]:
    rows = []
    for index, (times, q) in enumerate(_sets(data, QUICK if run.quick else FULL)):
        measured = partial(_measured, scheme, times, q)
        rows += attempted(measured, scheme=scheme, data=data, set=index)
    return rows


def _measured(name: str, times: FloatArray, q: FloatArray) -> list[Row]:
    """A row per segment: shares of its step, or what it wanders; in degrees."""
    found, measured = excursion(builder(name)(times, q)), version(name)
    degrees = zip(*map(np.degrees, found), strict=True)
    rows: list[Row] = []
    for hold, (step, *out) in zip(found.hold, degrees, strict=True):
        moved = {share: angle / step for share, angle in zip(SHARES, out, strict=True) if not hold}
        angle = {"wander": out[0]} if hold else {"over_degrees": out[1]}
        rows.append({**moved, **angle, "version": measured})
    return rows


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    """The distribution over all segments of a kind of data."""
    columns = ["scheme", "data", "set", *SHARES, "over_degrees", "wander", "version", "failure"]
    groups = table.reindex(columns=columns).groupby(["data", "scheme"], sort=False)
    return pd.DataFrame([_summary(rows) for _, rows in groups])


def _summary(rows: pd.DataFrame) -> Row:
    failed = rows["failure"].notna()
    moves, holds = rows["over"].dropna(), rows["wander"].dropna()
    summary: Row = {
        "data": rows["data"].iloc[0],
        "scheme": rows["scheme"].iloc[0],
        "sets": rows["set"].nunique(),
        "failed": int(failed.sum()),
        "segments": len(rows) - int(failed.sum()),
        "version": rows["version"].dropna().iloc[0] if not failed.all() else None,
        "failure": rows.loc[failed, "failure"].iloc[0] if failed.any() else None,
    }
    if len(moves):
        for share in SHARES:
            summary |= {f"{share}_{name}": rows[share].quantile(q) for name, q in LEVELS.items()}
        summary["overshot"] = float((moves > OVERSHOT).mean())
        summary["over_degrees"] = rows["over_degrees"].max()
    if len(holds):
        summary |= {"wander_median": holds.median(), "wander_worst": holds.max()}
    return summary


# -- the figure -----------------------------------------------------------------------------------

COLOURED = (
    *(
        "slerp",
        "squad",
        "nielson",
        "kim",
        "quartic",
        "quintic",
        "local-quintic",
        "monotone-quintic",
    ),
)
"""Schemes that the figure names by colour: eight at most can be told apart."""
GREY = "#b5b5b5"
LEAST = 1e-3
"""Of a step: overshoots below it are drawn there."""


def draw(table: pd.DataFrame) -> Figure:
    measured = table[table["segments"] > 0]
    hold, axis, generic = (
        measured[measured["data"] == data].set_index("scheme")
        for data in (*list(HOLDS)[1:], AXIS, GENERIC)
    )
    names = list(hold["wander_median"].sort_values(kind="stable").index)
    names += sorted(set(axis.index) - set(names))
    fig, panels = style.axes(style.PAGE, ROW * len(names) + 1.0, 1, 3, sharey=True)
    _ranges(panels[0, 0], hold, names, ("wander_median", "wander_worst"), least=0.0)
    _ranges(panels[0, 1], axis, names, ("over_q95", "over_worst"))
    _ranges(panels[0, 2], generic, names, ("over_q95", "over_worst"))
    panels[0, 0].set(title="during a hold", xlabel="wander (degrees)", xticks=range(0, 361, 90))
    for ax, title in zip(panels[0, 1:], ("about one axis", "generic sets"), strict=True):
        ax.set(title=title, xlabel="overshoot / step", xscale="log", xlim=(0.8 * LEAST, None))
    scheme_rows(panels[0, 0], names)
    for label in panels[0, 0].get_yticklabels():
        label.set_color("black" if label.get_text() in COLOURED else "#777777")
    style.letters(panels[0])
    return fig


def _ranges(
    ax: Any, rows: pd.DataFrame, names: list[str], columns: tuple[str, str], least: float = LEAST
) -> None:
    """A bar from one column to the other, a marker at the first; what is less than the least stands there."""
    rows = rows.reindex(names)
    low, high = (rows[column].clip(lower=least) for column in columns)
    for y, name in enumerate(names):
        looks = style.scheme_style(name)
        colour = looks["color"] if name in COLOURED else GREY
        ax.hlines(y, low.iloc[y], high.iloc[y], color=colour, lw=1.6)
        ax.plot(low.iloc[y], y, **looks | {"color": colour, "linestyle": ""}, ms=4)
        ax.plot(high.iloc[y], y, color=colour, marker="|", ms=6)


def caption(table: pd.DataFrame) -> str:
    sets = int(table["sets"].max())
    return (
        f"What curves do between keyframes that slerp does not, on {sets} seeded keyframe sets of each kind. (a) Angle "
        "from the keyframe during a hold beside moves a tenth as long: median (marker) to worst. (b) Overshoot of "
        "steps about one axis, as a share of the step: 95 % quantile to worst. (c) The same of generic sets. What is "
        f"below {LEAST:g} is drawn there. Rows are sorted by (a), those without a curve there last; eight are coloured."
    )
