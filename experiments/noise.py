"""How a curve responds to small errors of its keyframes and of their times."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.figures import rows, style
from quatspline.figures.heat import ROW, SMALL
from quatspline.figures.looks import third_party
from quatspline.instruments.noise import noise
from quatspline.instruments.trials import Row, attempted, builder, facts
from quatspline.runs.experiment import Run, crossed
from quatspline.trajectories.walks import walk

TITLE = "Response to noise"
PAPER = False
KEYS = ["step_degrees", "error", "scheme"]
NOTE = (
    "Keyframes with rotation errors of 1e-4 rad about each axis (error 'keyframes'), or with inner times off by 1e-4 "
    "of the spacing ('times', converted to angles by the rms speed). gain: rms movement of the orientation relative "
    "to the rms of the errors; gain_omega, gain_alpha: the same for body velocity and acceleration, times the spacing "
    "and its square. Lower is calmer; slerp's gain is sqrt(2/3) for keyframes far from the ends. Random walks of 9 "
    "keyframes at uniform times; schemes that take no other times are not tried with errors of times."
)
FORMATS = dict.fromkeys(("gain", "gain_omega", "gain_alpha"), ".3f")
COUNT = 9
GAINS = {"gain": "orientation", "gain_omega": "velocity", "gain_alpha": "acceleration"}
LOOKS = {"keyframes": ("o", style.BLUE, 4.4), "times": ("s", style.RED, 3.2)}
"""Mark, colour and size in points: one shows behind the other."""
ANGLE = 60
"""Of the steps in the figure."""
ENDS = {"gain": 1.5, "gain_omega": 5.0, "gain_alpha": 50.0}
"""Of the axes: gains beyond are written there."""
WIDE = 34.0
"""Points that such a number takes."""


def cells(run: Run) -> list[dict[str, Any]]:
    return crossed(scheme=run.names, degrees=(60,) if run.quick else (10, 60, 120))


def measure_cell(run: Run, scheme: str, degrees: int) -> list[Row]:
    found = []
    for kind in LOOKS:
        measured = partial(_measured, run, scheme, degrees, kind)
        found += attempted(measured, step_degrees=degrees, scheme=scheme, error=kind)
    return found


def _measured(run: Run, name: str, degrees: int, kind: str) -> list[Row]:
    keyframes = walk(run.rng("noise", degrees), COUNT, float(degrees))[:, 0]
    times = np.arange(float(COUNT))
    build = builder(name)
    rng = run.rng("noise", degrees, kind)
    row = noise(build, times, keyframes, kind, rng, 3 if run.quick else 30)
    return [row | facts(build(times, keyframes))]


def draw(table: pd.DataFrame) -> Figure:
    gains, sharing = _gains(table), _sharing(table)
    calm = gains["gain_alpha"]["keyframes"].loc[list(sharing)].round(2)
    names = list(calm.sort_values(na_position="last", kind="stable").index)
    fig, panels = style.axes(style.PAGE, ROW * len(names) + 1.3, 1, 3, sharey=True)
    for ax, (column, title) in zip(panels[0], GAINS.items(), strict=True):
        for error in LOOKS:
            _mark(ax, gains[column][error], names, error, ENDS[column])
        for height, name in enumerate(names):
            _beyond(ax, height, gains.loc[name, column], ENDS[column], third_party(name))
        ax.set(title=title, xlabel="gain", xlim=(0.0, ENDS[column]))
    panels[0, 2].set_xscale("symlog", linthresh=0.1)
    panels[0, 2].set_xlim(-0.02, ENDS["gain_alpha"])
    rows.label(panels[0, 0], names, sharing, chosen=None)
    style.letters(panels[0])
    style.legend_of(fig, panels[0, 0], 2)
    return fig


def _gains(table: pd.DataFrame) -> pd.DataFrame:
    """Columns (gain, error) by scheme."""
    shown = table[table["step_degrees"] == ANGLE]
    wide = shown.pivot(index="scheme", columns="error", values=list(GAINS))
    return wide.dropna(how="all").astype(float)


def _sharing(table: pd.DataFrame) -> dict[str, list[str]]:
    gains = _gains(table)
    ends = pd.Series(ENDS).reindex(gains.columns, level=0)
    return rows.shared(gains.clip(upper=ends, axis=1))


def _mark(ax: Any, gains: pd.Series, names: list[str], error: str, end: float) -> None:
    marker, color, size = LOOKS[error]
    look = {"marker": marker, "c": color, "ls": "", "ms": size, "mew": 0.9}
    ax.plot([], [], label=f"errors of {error}", **look)
    for height, name in enumerate(names):
        if gains[name] <= end:
            face = "white" if third_party(name) else color
            ax.plot(gains[name], height, **look, mfc=face, clip_on=False)


def _beyond(ax: Any, height: int, gains: pd.Series, end: float, hollow: bool) -> None:
    """Gains beyond the end of an axis, in figures there, one left of the other."""
    arrow = r"$\triangleright$" if hollow else r"$\blacktriangleright$"
    at = {"textcoords": "offset points", "ha": "right", "va": "center", "fontsize": SMALL}
    far = [error for error in LOOKS if gains[error] > end]
    for place, error in enumerate(far):
        text = f"{float(f'{gains[error]:.2g}'):g}".replace("e+0", "e")
        where = ((end, height), (2.0 - WIDE * place, 0.0))
        ax.annotate(f"{text} {arrow}", *where, color=LOOKS[error][1], **at)


def caption(table: pd.DataFrame) -> str:
    return (
        "Gain of small errors in keyframes and in their times for (a) orientation, (b) angular velocity and (c) "
        f"angular acceleration, in units of the spacing ({ANGLE} degree steps); lower is calmer. Rows are sorted by "
        "the gain of acceleration for errors in keyframes; a piecewise constant rate has no acceleration. Numbers at "
        f"an arrow are gains beyond the axis; hollow marks are third-party schemes. {rows.said(_sharing(table))}"
    )
