"""What a curve makes of small errors of its keyframes and of their times."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.figures import style
from quatspline.figures.heat import ROW, scheme_rows
from quatspline.instruments.noise import noise
from quatspline.instruments.trials import Row, attempted, builder, facts
from quatspline.runs.experiment import Run, crossed
from quatspline.trajectories.walks import walk

TITLE = "Response to noise"
PAPER = False
KEYS = ["step_degrees", "error", "scheme"]
NOTE = (
    "Keyframes with rotation errors of 1e-4 rad an axis (error 'keyframes'), or with inner times off by 1e-4 of the "
    "spacing ('times', counted as the turns that the rms speed makes of them). gain: rms movement of orientation over "
    "that of the errors; gain_omega, gain_alpha: the same for body velocity and acceleration, times the spacing and "
    "its square. Lower is calmer; slerp's gain is sqrt(2/3) for keyframes far from the ends. Random walks of 9 "
    "keyframes, uniform times; schemes that take no others see no errors of times."
)
FORMATS = dict.fromkeys(("gain", "gain_omega", "gain_alpha"), ".3f")
COUNT = 9
GAINS = {"gain": "orientation", "gain_omega": "velocity", "gain_alpha": "acceleration"}
LOOKS = {"keyframes": ("o", style.BLUE), "times": ("s", style.RED)}


def cells(run: Run) -> list[dict[str, Any]]:
    return crossed(scheme=run.names, degrees=(60,) if run.quick else (10, 60, 120))


def measure_cell(run: Run, scheme: str, degrees: int) -> list[Row]:
    rows = []
    for kind in LOOKS:
        measured = partial(_measured, run, scheme, degrees, kind)
        rows += attempted(measured, step_degrees=degrees, scheme=scheme, error=kind)
    return rows


def _measured(run: Run, name: str, degrees: int, kind: str) -> list[Row]:
    keyframes = walk(run.rng("noise", degrees), COUNT, float(degrees))[:, 0]
    times = np.arange(float(COUNT))
    build = builder(name)
    rng = run.rng("noise", degrees, kind)
    row = noise(build, times, keyframes, kind, rng, 3 if run.quick else 30)
    return [row | facts(build(times, keyframes))]


def draw(table: pd.DataFrame) -> Figure:
    table = table[table["step_degrees"] == 60]
    keys = table[table["error"] == "keyframes"].set_index("scheme")
    names = list(keys["gain_alpha"].sort_values(na_position="last").index)
    fig, panels = style.axes(style.PAGE, ROW * len(names) + 1.3, 1, 3, sharey=True)
    for ax, (column, title) in zip(panels[0], GAINS.items(), strict=True):
        for error, (marker, color) in LOOKS.items():
            rows = table[table["error"] == error]
            y = rows["scheme"].map(names.index)
            ax.plot(rows[column], y, marker, c=color, mfc="none", label=f"errors of {error}")
        ax.set(title=title, xlabel="gain")
    panels[0, 2].set_xscale("symlog", linthresh=0.1)
    scheme_rows(panels[0, 0], names)
    style.letters(panels[0])
    style.legend_of(fig, panels[0, 0], 2)
    return fig


def caption(table: pd.DataFrame) -> str:
    return (
        "Gain of small errors of keyframes and of their times in (a) orientation, (b) angular velocity, (c) angular "
        "acceleration, in units of the spacing (60 degree steps); lower is calmer. Rows are sorted by the "
        "gain of acceleration for errors of keyframes; a piecewise constant rate has no acceleration to be noisy."
    )
