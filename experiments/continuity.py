"""Measured continuity of every scheme: jumps at keyframes, the control order, the speed there."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from quatspline.catalogue import found
from quatspline.figures import rows as scheme_rows
from quatspline.figures import style
from quatspline.figures.heat import ROW
from quatspline.figures.looks import third_party
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
    "Jump: the largest difference between one-sided limits over inner keyframes, for q also inside segments; lower is "
    "smoother. An order counts as continuous if its jump is within rounding (1e-8 of its size for closed forms; for a "
    "library's curve, of which only orientations are known, 1e-7/h, 1e-6/h^2, 1e-3/h^3) or shrinks with the step; the "
    "first that does not shrink is the control. measured_k is k of C^k (-1: the curve leaps; 3: no jump up to the "
    "third derivative). least_key_speed and peak_speed are relative to the mean speed: 0 is a stop at a keyframe. "
    "Iterative schemes are solved to 1e-11."
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
QUANTITIES = {"q": "black", "omega": style.BLUE, "alpha": style.RED}
JUMPS = {"q": "D", "omega": "o", "alpha": "s"}
CONTINUOUS = {"omega": "x", "alpha": "+"}
"""Marks without a face: hollow is third-party.  Of q only leaps are marked: no curve should have any."""
SIZES = {"q": 3.4, "omega": 4.8, "alpha": 3.2}
"""Of marks, in points: neither hides the other where both jump alike."""
WRITTEN = {"q": "q", "omega": r"$\omega$", "alpha": r"$\alpha$"}
FLOOR, TOP = 1e-14, 30.0


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
    table, sharing = table[table["case"].isin(SHOWN)], _sharing(table)
    plain = table[table["case"] == SHOWN[0]]
    measured = plain.groupby("scheme")["measured_k"].first().reindex(list(sharing))
    measured = measured.sort_values(ascending=False, kind="stable")
    names = list(measured.index)
    widths = {"gridspec_kw": {"width_ratios": (1, 1, 1, 0.7)}}
    fig, panels = style.axes(style.PAGE, ROW * len(names) + 1.3, 1, 4, sharey=True, **widths)
    for ax, case in zip(panels[0], SHOWN, strict=False):
        _jumps_of(ax, table[table["case"] == case], names)
        ax.set_title(case.replace(" degrees", "°"))
    ax = panels[0, -1]
    scheme_rows.mark(ax, plain.groupby("scheme")["least_key_speed"].first(), names, None)
    ax.set(title="least key speed", xlabel="over the mean", xlim=(-0.08, 1.08))
    scheme_rows.label(panels[0, 0], names, sharing, chosen=None)
    _continuity_of(ax, measured)
    style.letters(panels[0])
    fig.legend(handles=_key(), loc="outside lower center", ncols=5, columnspacing=1.2)
    return fig


def _sharing(table: pd.DataFrame) -> dict[str, list[str]]:
    """Schemes with a row of their own: jumps, what is continuous, and speeds are those of no other."""
    shown = table[table["case"].isin(SHOWN)]
    jumps_of = np.log10(shown["relative"].clip(FLOOR, TOP)).where(
        shown["continuous"].eq(False), np.log10(FLOOR)
    )
    drawn = shown.assign(drawn=jumps_of.where(shown["relative"].notna()))
    wide = drawn.pivot_table("drawn", "scheme", ["case", "quantity"], aggfunc="first")
    speed = drawn[drawn["case"] == SHOWN[0]].groupby("scheme")["least_key_speed"].first()
    return scheme_rows.shared(
        wide.set_axis([" ".join(column) for column in wide.columns], axis=1).assign(speed=speed)
    )


def _jumps_of(ax: Any, rows: pd.DataFrame, names: list[str]) -> None:
    """Jumps as shares of what jumps: crosses where they fall with the step, other marks where they stay."""
    for jumping, marks in ((False, CONTINUOUS), (True, JUMPS)):
        for quantity, marker in marks.items():
            picked = rows[(rows["quantity"] == quantity) & rows["continuous"].eq(not jumping)]
            for name, x in picked.set_index("scheme")["relative"].clip(FLOOR, TOP).items():
                if name in names:
                    look = _look(quantity, marker, hollow=third_party(str(name)))
                    ax.plot(x, names.index(name), **look)
    ax.set(xscale="log", xlim=(3e-15, 100), xlabel="jump over size")


def _look(quantity: str, marker: str, *, hollow: bool = False) -> dict[str, Any]:
    colour = QUANTITIES[quantity]
    face = "white" if hollow else colour
    return {
        "marker": marker,
        "color": colour,
        "mfc": face,
        "ls": "",
        "mew": 0.9,
        "ms": SIZES[quantity],
    }


def _continuity_of(ax: Any, measured: pd.Series) -> None:
    """Lines between rows of different continuity, and which it is, at the right."""
    ends = np.flatnonzero(np.diff(measured, append=np.inf)) + 0.5
    for above, below in zip([-0.5, *ends], ends, strict=False):
        k = measured.iloc[int(below)]
        reached = f"$C^{k:.0f}$" if k >= 0 else "leaps" if k < 0 else ""
        place = {"transform": ax.get_yaxis_transform(), "va": "center"}
        ax.text(1.04, (above + below) / 2.0, reached, **place)
        for each in ax.figure.axes:
            each.axhline(below, color="#888888", lw=0.6)


def _key() -> list[Line2D]:
    kinds = (("jumps", JUMPS), ("continuous", CONTINUOUS))
    return [
        Line2D([], [], label=f"{WRITTEN[quantity]} {verdict}", **_look(quantity, marker))
        for verdict, marks in kinds
        for quantity, marker in marks.items()
    ]


def caption(table: pd.DataFrame) -> str:
    return (
        "(a) to (c) Largest jump of angular velocity (omega) and acceleration (alpha) at inner keyframes, as a share "
        "of the quantity's size on the curve: crosses where it falls with the step, which is continuity, other marks "
        "where it stays. Leaps of the orientation (q), at keyframes or inside segments, are in rad. Values below "
        f"{FLOOR:g} are drawn there; a panel without marks is of keyframes that the scheme does not take. Hollow marks "
        "are third-party schemes. Rows are sorted by measured continuity, which stands at the right. (d) Least speed "
        f"at an inner keyframe over the mean speed ({SHOWN[0]}): at 0 the curve stops. "
        f"{scheme_rows.said(_sharing(table))}"
    )
