"""Measured continuity of every scheme: jumps at keyframes, the control order, the speed there."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import found
from quatspline.figures import style
from quatspline.figures.heat import ROW, scheme_rows
from quatspline.instruments.continuity import jumps, measured_continuity, speeds
from quatspline.instruments.trials import Row, attempted, builder, facts, records
from quatspline.quaternion import FloatArray
from quatspline.runs.experiment import Run, crossed
from quatspline.trajectories.smooth import SPAN, tumble
from quatspline.trajectories.walks import walk

TITLE = "Continuity at keyframes"
PAPER = False
KEYS = ["case", "scheme", "order"]
NOTE = (
    "Jump: the largest difference of one-sided limits over inner keyframes, of q also inside segments; lower is "
    "smoother. An order counts as continuous when its jump is rounding (1e-8 of its size in closed forms; for a "
    "library's curve, known by its orientations, 1e-7/h, 1e-6/h^2, 1e-3/h^3) or falls with the step; the first that "
    "stays is the control. measured_k is k of C^k (-1: the curve leaps; 3: no jump up to the third derivative). "
    "least_key_speed and peak_speed are over the mean speed: 0 is a stop at a keyframe. Iterative schemes are solved "
    "to 1e-11."
)
FORMATS = {
    "jump": ".2e",
    "coarse_jump": ".2e",
    "size": ".3g",
    "relative": ".1e",
    "least_key_speed": ".3f",
    "peak_speed": ".2f",
}
COUNT = 7
SMOOTH = "smooth motion"
COUNTS = (11, 21, 41, 81)
SHOWN = ("60 degrees, uniform", "60 degrees, uneven", "170 degrees, uneven")
LOOKS = {"q": ("D", "#000000"), "omega": ("o", style.BLUE), "alpha": ("s", style.RED)}


def cells(run: Run) -> list[dict[str, Any]]:
    cells = crossed(case=_cases(run), scheme=run.names)
    return [cell for cell in cells if not (run.quick and _is_slow(**cell))]


def _cases(run: Run) -> list[str]:
    angles = (60, 170) if run.quick else (60, 120, 170)
    walks = [f"{degrees} degrees, {knots}" for degrees in angles for knots in ("uniform", "uneven")]
    return walks + [f"{SMOOTH}, {count} keyframes" for count in COUNTS]


def _is_slow(case: str, scheme: str) -> bool:
    """A library's curve through many keyframes."""
    cls = found()[scheme].scheme
    return case.startswith(SMOOTH) and (cls is None or cls.peer is not None)


def measure_cell(run: Run, case: str, scheme: str) -> list[Row]:
    measured = partial(_measured, scheme, *keyframes_of(run, case))
    return attempted(measured, case=case, scheme=scheme)


def keyframes_of(run: Run, case: str) -> tuple[FloatArray, FloatArray]:
    kind, which = case.split(", ")
    if kind == SMOOTH:
        t = np.linspace(0.0, SPAN, int(which.split()[0]))
        return t, tumble(t)
    degrees = int(kind.split()[0])
    rng = run.rng("continuity", degrees)
    keyframes = walk(rng, COUNT, float(degrees))[:, 0]
    uneven = np.concatenate([[0.0], np.cumsum(np.exp(rng.uniform(-1.0, 1.0, COUNT - 1)))])
    return (np.arange(float(COUNT)) if which == "uniform" else uneven), keyframes


def _measured(name: str, times: FloatArray, keyframes: FloatArray) -> list[Row]:
    curve = builder(name)(times, keyframes)
    table = jumps(curve)
    more = {"measured_k": measured_continuity(table), "claimed_k": curve.continuity}
    return [row | more | facts(curve) | speeds(curve) for row in records(table)]


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    """A failure stands at order 0, so that every case and scheme has a row there."""
    return table.assign(order=table["order"].fillna(0).astype(int)) if "order" in table else table


def draw(table: pd.DataFrame) -> Figure:
    smooth = table[table["case"] == SHOWN[0]].groupby("scheme")["measured_k"].first()
    names = list(smooth.sort_values(ascending=False, kind="stable").index)
    widths = {"gridspec_kw": {"width_ratios": (1, 1, 1, 0.7)}}
    fig, panels = style.axes(style.PAGE, ROW * len(names) + 1.3, 1, 4, sharey=True, **widths)
    for ax, case in zip(panels[0], SHOWN, strict=False):
        _jumps_of(ax, table[table["case"] == case], names)
        ax.set_title(case.replace(" degrees", "°"))
    speeds_at = table[(table["case"] == SHOWN[0]) & table["least_key_speed"].notna()]
    speeds_at = speeds_at.drop_duplicates("scheme")
    ax = panels[0, -1]
    ax.plot(speeds_at["least_key_speed"], speeds_at["scheme"].map(names.index), "k.", ms=5)
    ax.set(title="speed at keys", xlabel="least over mean", xlim=(-0.08, 1.08))
    scheme_rows(ax, names)
    style.letters(panels[0])
    style.legend_of(fig, panels[0, 0], 5)
    return fig


def _jumps_of(ax: Any, rows: pd.DataFrame, names: list[str]) -> None:
    """Jumps as shares, filled where they stay put."""
    for quantity, (marker, color) in LOOKS.items():
        for jumping, fill, verdict in ((True, color, "jumps"), (False, "none", "continuous")):
            if quantity == "q" and not jumping:
                continue  # what every curve should be: only leaps are worth a mark
            picked = rows[(rows["quantity"] == quantity) & rows["continuous"].eq(not jumping)]
            x = picked["relative"].clip(1e-14, 30.0)
            label = f"{quantity} {verdict}"
            ax.plot(x, picked["scheme"].map(names.index), marker, c=color, mfc=fill, label=label)
    ax.set(xscale="log", xlim=(3e-15, 100), xlabel="jump over size")


def caption(table: pd.DataFrame) -> str:
    return (
        "(a) to (c) Largest jump of angular velocity (omega) and acceleration (alpha) at inner keyframes, as a share "
        "of the quantity's size on the curve; filled: it stays put when the step shrinks. Leaps of the orientation "
        "(q), at keyframes or inside segments, are in rad. Values below 1e-14 are drawn there. Rows are sorted by "
        "measured continuity. (d) Least speed at an inner keyframe over the mean speed "
        f"({SHOWN[0]}); at 0 the curve stops."
    )
