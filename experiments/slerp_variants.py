"""Substitutes for slerp, and how far they are off: terms of a polynomial, steps of a recurrence, the chord."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import version
from quatspline.figures import direct, named, style
from quatspline.instruments.slerp_variants import largest_error, nlerp_error
from quatspline.instruments.trials import Row, attempted
from quatspline.runs.experiment import Run

TITLE = "Variants of slerp: errors against terms, steps and angle"
PAPER = False
KEYS = ["scheme", "sphere_degrees", "terms", "steps"]
NOTE = (
    "Two keyframes, sphere_degrees apart on the sphere of unit quaternions, which is a rotation by twice that angle, "
    "step_degrees. error: the largest angle from slerp, as a rotation in rad, at 8193 samples per arc in random "
    "frames; sphere_error_degrees: the same on the sphere in degrees, which is half of it; lower is better. "
    "fast-slerp is tried by terms, incremental-slerp by steps; growth: the power of the number of steps with which "
    "its drift grows, by regression over all of them. closed_form: nlerp's error by its formula, which is independent "
    "of the samples."
)
FORMATS = {
    "error": ".3e",
    "sphere_error_degrees": ".4g",
    "closed_form": ".3e",
    "growth": ".2f",
}
ANGLES, ANGLES_QUICK = tuple(range(5, 91, 5)), (5, 15, 30, 45, 60, 75, 90)
"""Of arcs on the sphere: a right angle is half a turn, the longest step between aligned keyframes."""
BEYOND = (105, 120, 135, 150, 165)
"""Of arcs the long way round, which only nlerp is asked for: the polynomial is not made for them."""
TERMS, TERMS_QUICK = (1, 2, 3, 4, 6, 8, 10, 12, 16, 20, 24, 28, 32), (2, 4, 8, 12, 16, 24, 32)
STEPS = tuple(2**k for k in range(2, 13))
DRIFTING, DRIFTING_QUICK = (5, 15, 45, 90), (5, 45, 90)
FRAMES, FRAMES_QUICK = 100, 10
FORMULAS = {"nlerp": nlerp_error}
"""The largest error of an arc, where it is known in closed form."""
ARC = ["scheme", "sphere_degrees"]
SHOWN = (5, 45, 90)
"""Angles in the figure."""


def cells(run: Run) -> list[dict[str, Any]]:
    angles = ANGLES_QUICK if run.quick else ANGLES
    drifting = DRIFTING_QUICK if run.quick else DRIFTING
    arcs = {"fast-slerp": angles, "incremental-slerp": drifting, "nlerp": angles + BEYOND}
    names = [name for name in arcs if run.schemes is None or name in run.schemes]
    if not names:
        raise ValueError(f"schemes={run.schemes}: only {', '.join(arcs)} stand in for slerp")
    return [{"scheme": name, "degrees": degrees} for name in names for degrees in arcs[name]]


def measure_cell(run: Run, scheme: str, degrees: int) -> list[Row]:
    rows = []
    for options in _settings(run, scheme):
        where = {"scheme": scheme, "sphere_degrees": degrees, "step_degrees": 2 * degrees}
        measured = partial(_measured, run, scheme, degrees, options)
        rows += attempted(measured, **where, **options)
    return rows


def _settings(run: Run, name: str) -> list[dict[str, int]]:
    """The options that a scheme is measured with."""
    if name == "fast-slerp":
        return [{"terms": terms} for terms in (TERMS_QUICK if run.quick else TERMS)]
    return [{"steps": steps} for steps in STEPS] if name == "incremental-slerp" else [{}]


def _measured(run: Run, name: str, degrees: int, options: dict[str, int]) -> list[Row]:
    rng = run.rng("slerp-variants", degrees)
    theta, frames = np.radians(degrees), FRAMES_QUICK if run.quick else FRAMES
    error = largest_error(name, theta, rng, frames, **options)
    row = {"error": error, "sphere_error_degrees": np.degrees(0.5 * error)}
    closed_form = FORMULAS[name](theta) if name in FORMULAS else None
    return [row | {"closed_form": closed_form, "version": version(name)}]


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    columns = ["scheme", "sphere_degrees", "step_degrees", "terms", "steps"]
    measured = ["error", "sphere_error_degrees", "growth", "closed_form", "version", "failure"]
    table = table.reindex(columns=columns + measured)
    table = table.astype({"terms": "Int64", "steps": "Int64"})
    slopes = {
        arc: np.polyfit(np.log2(rows["steps"].astype(float)), np.log2(rows["error"]), 1)[0]
        for arc, rows in table.dropna(subset=["steps", "error"]).groupby(ARC)
        if len(rows) > 1
    }
    growth = [slopes.get(arc) for arc in table[ARC].itertuples(index=False, name=None)]
    return table.assign(growth=np.array(growth, dtype=float))


def draw(table: pd.DataFrame) -> Figure:
    fig, panels = style.axes(style.PAGE, 2.8, 1, 3)
    ends = {}
    for ax, name, setting in (
        (panels[0, 0], "fast-slerp", "terms"),
        (panels[0, 1], "incremental-slerp", "steps"),
    ):
        ends[ax] = _arcs(ax, table[table["scheme"] == name].sort_values(setting), setting)
        ax.set(title=name, xlabel=setting, yscale="log", ylabel="largest angle from slerp (rad)")
    panels[0, 1].set_xscale("log", base=2)
    _chord(panels[0, 2], table[table["scheme"] == "nlerp"].sort_values("sphere_degrees"))
    style.letters(panels[0])
    named.name_ends(fig, ends)
    return fig


def _arcs(ax: Any, rows: pd.DataFrame, setting: str) -> dict[str, direct.End]:
    """A curve per angle, and its end."""
    ends = {}
    for degrees, color, marker in zip(SHOWN, style.PALETTE, style.MARKERS, strict=False):
        arc = rows[(rows["sphere_degrees"] == degrees) & rows["error"].notna()]
        ax.plot(arc[setting], arc["error"], color=color, marker=marker)
        if len(arc):
            text = f"{degrees}°"
            ends[text] = direct.End(arc[setting].iloc[-1], arc["error"].iloc[-1], text, color)
    return ends


def _chord(ax: Any, rows: pd.DataFrame) -> None:
    """nlerp's error as measured, on its formula; in no colour that stands for an angle."""
    angles = np.linspace(1.0, max(rows["sphere_degrees"].max(), 2.0), 200)
    formula = [np.degrees(0.5 * nlerp_error(theta)) for theta in np.radians(angles)]
    ax.plot(angles, formula, color="#8a8a8a", lw=1.0)
    ax.plot(rows["sphere_degrees"], rows["sphere_error_degrees"], "k.", ms=5)
    ax.set(title="nlerp", xlabel="angle on the sphere (degrees)", yscale="log")
    ax.set_ylabel("largest angle from slerp\non the sphere (degrees)")


def caption(table: pd.DataFrame) -> str:
    return (
        "Largest angle from slerp: (a) of Eberly's polynomial against its terms and (b) of the incremental recurrence "
        "against its steps an arc, as a rotation, for arcs of the angles beside the curves, on the sphere of unit "
        "quaternions (90 degrees there are half a turn); (c) of nlerp against the angle, on the sphere: measured "
        "(dots), by its formula (line). Lower is better; rounding is 1e-16 to 1e-15."
    )
