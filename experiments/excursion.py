"""How far curves overshoot their keyframes, and how far they wander where keyframes hold still."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import version
from quatspline.figures import rows as scheme_rows
from quatspline.figures import style
from quatspline.figures.heat import ROW
from quatspline.figures.named import NAMED, coloured, said
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
    "How far a curve leaves the arc from one keyframe to the next, for every segment that moves, as a share of its "
    "step. off: the largest distance from the arc; over: the furthest overshoot beyond either end, along its great "
    "circle; back: the largest retreat from the furthest progress so far; each with the median, the 95 % quantile and "
    "the worst of all segments. overshot: the share of segments in which over exceeds 1 % of the step; over_degrees: "
    "the worst over as an angle. wander: the largest angle from the keyframe during a hold, in degrees of rotation, "
    "where a full turn is 360. Less is better; off cannot be 0 where a curve of continuous velocity turns a corner. "
    "Seeded open sets: 'generic', those of the table fairness; 'hold 1 : 1' and 'hold 10 : 1', 90 degree moves about "
    "random axes beside a hold that lasts as long as one of them or ten times as long; 'one axis', back and forth. "
    "Iterative schemes are solved to 1e-11."
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

COLOURED = (*NAMED[:-1], "monotone-quintic")
"""Instead of a library the scheme that is made not to overshoot."""
LEAST = 1e-3
"""Of a step: overshoots below it are drawn there."""
HOLD = "hold 10 : 1"
PANELS = {
    HOLD: ("during a hold", "wander (degrees)", "wander_median", "wander_worst"),
    AXIS: ("about one axis", "overshoot / step", "over_q95", "over_worst"),
    GENERIC: ("generic sets", "overshoot / step", "over_q95", "over_worst"),
}
"""Title, axis, and the columns between which a bar is drawn."""


def draw(table: pd.DataFrame) -> Figure:
    ends, sharing = _ends(table), _sharing(table)
    order = ends[HOLD]["wander_median"].reindex(list(sharing)).round(3)
    names = list(order.sort_values(kind="stable", na_position="last").index)
    fig, panels = style.axes(style.PAGE, ROW * len(names) + 1.0, 1, 3, sharey=True)
    for ax, (data, (title, label, *_)) in zip(panels[0], PANELS.items(), strict=True):
        _ranges(ax, ends[data], names)
        ax.set(title=title, xlabel=label)
    panels[0, 0].set(xticks=range(0, 361, 90), xlim=(-10.0, None))
    for ax in panels[0, 1:]:
        ax.set(xscale="log", xlim=(0.8 * LEAST, None))
    scheme_rows.label(panels[0, 0], names, sharing, COLOURED)
    style.letters(panels[0])
    return fig


def _ends(table: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """By the data: where bars begin and end, as drawn."""
    measured = table[table["segments"] > 0]
    return {
        data: measured[measured["data"] == data]
        .set_index("scheme")[columns]
        .clip(lower=0.0 if data == HOLD else LEAST)
        for data, (_, _, *columns) in PANELS.items()
    }


def _sharing(table: pd.DataFrame) -> dict[str, list[str]]:
    ends = _ends(table)
    drawn = {data: x if data == HOLD else x.transform(np.log10) for data, x in ends.items()}
    return scheme_rows.shared(pd.concat(drawn, axis=1))


def _ranges(ax: Any, ends: pd.DataFrame, names: list[str]) -> None:
    """A bar from a mark at one column to the other."""
    low, high = (ends[column].reindex(names) for column in ends)
    lit = coloured(names, COLOURED)
    for y, name in enumerate(names):
        colour = scheme_rows.look(name, lit)["color"]
        ax.plot([low[name], high[name]], [y, y], color=colour, lw=1.6, solid_capstyle="butt")
    scheme_rows.mark(ax, low, names, COLOURED)


def caption(table: pd.DataFrame) -> str:
    sets, sharing = int(table["sets"].max()), _sharing(table)
    return (
        f"What curves do between keyframes that slerp does not, on {sets} seeded keyframe sets of each kind. (a) Angle "
        "from the keyframe during a hold that is ten times as long as the moves beside it: median (mark) to worst "
        "(end of the bar). (b) Overshoot of steps about one axis, as a share of the step: 95 % quantile to worst. (c) "
        f"The same for generic sets. Values below {LEAST:g} are drawn there. Rows are sorted by (a), those without a "
        f"value there last.{said(sharing, COLOURED)} {scheme_rows.said(sharing)}"
    )
