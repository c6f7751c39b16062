"""What changes of frame, of clock and of key signs do to a curve beyond that change."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import scheme as scheme_class
from quatspline.figures import rows, style
from quatspline.figures.heat import ROW, label_cells, log_heat
from quatspline.instruments.invariance import INVARIANT, PROPERTIES, invariance
from quatspline.instruments.trials import Row, attempted, builder, facts
from quatspline.quaternion import FloatArray
from quatspline.runs.experiment import Run, crossed
from quatspline.trajectories.walks import walk

TITLE = "Invariance"
PAPER = False
KEYS = ["step_degrees", "scheme", "property"]
NOTE = (
    "deviation: the largest angle between the curve through changed keyframes and the original curve changed in the "
    "same way (lower is better); relative: its share of the step; invariant: relative is at most 1e-7. half-turn "
    "shell: base frames in which a keyframe lies 170 to 190 degrees from the frame of reference. Random walks of 7 "
    "keyframes at uneven times (uniform for schemes that take no others); iterative schemes are solved to 1e-11."
)
FORMATS = {"deviation": ".1e", "relative": ".1e"}
LIMITS = (1e-12, 10.0)
"""Of colours: less is rounding."""
DARK = 1e-3
"""Deviations beyond this are written in white."""
COUNT = 7
GRID = 1024.0
"""Times are multiples of 1 / GRID: shifts of them are exact."""


def cells(run: Run) -> list[dict[str, Any]]:
    return crossed(scheme=run.names, degrees=(60,) if run.quick else (20, 60, 120, 170))


def measure_cell(run: Run, scheme: str, degrees: int) -> list[Row]:
    measured = partial(_measured, run, scheme, degrees)
    return attempted(measured, step_degrees=degrees, scheme=scheme)


def _measured(run: Run, name: str, degrees: int) -> list[Row]:
    times, keyframes = _keyframes(run, degrees)
    if not scheme_class(name).non_uniform:
        times = np.arange(float(COUNT))
    build = builder(name)
    found = invariance(build, times, keyframes, run.rng("invariance", degrees, "changes"))
    return [row | facts(build(times, keyframes)) for row in found]


def _keyframes(run: Run, degrees: int) -> tuple[FloatArray, FloatArray]:
    rng = run.rng("invariance", degrees)
    h = np.round(GRID * np.exp(rng.uniform(-1.0, 1.0, COUNT - 1))) / GRID
    return np.concatenate([[0.0], np.cumsum(h)]), walk(rng, COUNT, float(degrees))[:, 0]


def draw(table: pd.DataFrame) -> Figure:
    worst, sharing = _worst(table), _sharing(table)
    worst = worst.loc[list(sharing)]
    shown = worst.loc[(worst > INVARIANT).sum(axis=1).sort_values(kind="stable").index]
    fig, panels = style.axes(style.PAGE, ROW * len(shown) + 1.2)
    shown.columns = [str(name).replace(" ", "\n", 1) for name in shown]
    log_heat(panels[0, 0], shown, "largest deviation over the step", LIMITS)
    label_cells(panels[0, 0], shown.map(_text), shown.gt(DARK))
    rows.label(panels[0, 0], list(shown.index), sharing, chosen=None)
    return fig


def _text(deviation: float) -> str:
    """Of what does not hold."""
    return f"{deviation:.1g}".replace("e-0", "e-") if deviation > INVARIANT else ""


def _worst(table: pd.DataFrame) -> pd.DataFrame:
    worst = table.groupby(["scheme", "property"])["relative"].max().unstack()
    worst = worst.reindex(columns=list(PROPERTIES)).dropna(how="all")
    return worst.clip(lower=LIMITS[0])


def _sharing(table: pd.DataFrame) -> dict[str, list[str]]:
    return rows.shared(_worst(table).clip(*LIMITS).transform(np.log10))


def caption(table: pd.DataFrame) -> str:
    angles = ", ".join(str(a) for a in sorted(table["step_degrees"].unique()))
    return (
        f"Largest deviation from each invariance over walks with steps of {angles} degrees, as a share of the step; "
        f"below {LIMITS[0]:g}, where it is rounding, palest. Rows are sorted by the number of properties that do not "
        f"hold to {INVARIANT:g}; those are written in the cells; grey: not measured. {rows.said(_sharing(table))}"
    )
