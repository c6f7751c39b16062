"""The error of moving frames against the keyframes' spacing, for each degree: order and constant."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.families.frames import DEGREES
from quatspline.figures import style
from quatspline.instruments.frame_error import frame_error
from quatspline.instruments.trials import Row
from quatspline.runs.experiment import Run, crossed

TITLE = "The error of moving frames"
PAPER = False
KEYS = ["degree", "ends", "keyframes"]
NOTE = (
    "moving-frame through keyframes of a closed motion, a spin of one turn times a roll of two; lower is better. "
    "order: of angle, from the previous level to this one. constant: angle divided by h^(k+1); expected: what the "
    "interior of a flat spline predicts, which applies everywhere on closed curves. axis_constant: the largest error "
    "of an entry of the axes divided by h^(k+1) max |R^(k+1)|; axis_bound: the same for the worst function on uniform "
    "knots. 'given': complete ends with the motion's own velocities and, from degree 5, accelerations; 'complete': "
    "all of them estimated. Errors below 1e-14 rad are rounding and have no constant."
)
FORMATS = {
    "spacing": ".3g",
    "angle": ".2e",
    "order": ".2f",
    **dict.fromkeys(("constant", "expected", "axis_constant", "axis_bound"), ".3g"),
}
ENDS = ("closed", "given", "complete", "not-a-knot", "natural")
TITLES = {"closed": "closed", "complete": "complete ends", "natural": "natural ends"}
TICKS = (0.02, 0.05, 0.1, 0.2, 0.5)
LEAST = 1e-16
"""Of the axis: below rounding."""
COUNTS = (12, 24, 48, 96, 192, 384)


def cells(run: Run) -> list[dict[str, Any]]:
    return crossed(degree=DEGREES, ends=ENDS)


def measure_cell(run: Run, degree: int, ends: str) -> list[Row]:
    rows = []
    for count in COUNTS[:4] if run.quick else COUNTS:
        rows.append({"degree": degree, "ends": ends, "keyframes": count})
        rows[-1] |= frame_error(degree, ends, count)
    return rows


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    by = table.groupby(["degree", "ends"])
    order = (table["angle"] / by["angle"].shift()).map(np.log)
    order /= (table["spacing"] / by["spacing"].shift()).map(np.log)
    table.insert(5, "order", order.where(table["constant"].notna()))
    return table


def draw(table: pd.DataFrame) -> Figure:
    fig, panels = style.axes(style.PAGE, 3.2, 1, 3, sharey=True)
    for ax, ends in zip(panels[0], TITLES, strict=True):
        for degree, color, marker in zip(DEGREES, style.PALETTE, style.MARKERS, strict=False):
            rows = table[(table["degree"] == degree) & (table["ends"] == ends)]
            look = {"c": color, "marker": marker, "label": f"degree {degree}"}
            ax.plot(rows["spacing"], rows["angle"], **look)
            if ends == "closed":
                flat = rows["expected"] * rows["spacing"] ** (degree + 1)
                ax.plot(rows["spacing"], flat, ":", c=color, lw=0.8)
        ax.set(xscale="log", yscale="log", title=TITLES[ends])
        ax.set(xlabel="keyframe spacing (unit of time)", ylim=(LEAST, 20.0))
        ax.set_xticks(TICKS, [f"{tick:g}" for tick in TICKS])
        ax.minorticks_off()
    panels[0, 0].set_ylabel("largest error (rad)")
    panels[0, 0].plot([], [], ":", c="#555555", lw=0.8, label="flat spline")
    style.letters(panels[0])
    style.legend_of(fig, panels[0, 0], 5)
    return fig


def caption(table: pd.DataFrame) -> str:
    return (
        "Largest angle between moving frames and the closed motion from which their keyframes come, by spacing and by "
        "degree of the splines: (a) closed curves, with the constants of flat splines dotted; the same motion cut "
        "open (b) with complete ends, estimated from the keyframes, and (c) with natural ends, which have an error of "
        "their own whatever the degree inside."
    )
