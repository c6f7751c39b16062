"""How many iterations random keyframes take, against the step angle: what two cases cannot show."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import scheme
from quatspline.figures import named, style
from quatspline.figures.direct import End
from quatspline.quaternion import FloatArray
from quatspline.runs.experiment import Run
from quatspline.trajectories.paper import CASES, RECONSTRUCTED, SOLVE, PaperCase, steps
from quatspline.trajectories.walks import loop, walk

TITLE = "Iterations of random keyframes against the step angle"
PAPER = True
KEYS = ["data", "scheme", "method", "step_degrees"]
NOTE = (
    "Random walks of 5 keyframes (open) and random loops of 6 (closed), with every step about a random axis, "
    f"solved to a relative change of 1e-6. {RECONSTRUCTED} The rows of the reconstructed cases give their largest step."
)
SOLVERS = (
    ("nielson", "jacobi"),
    ("nielson", "gauss-seidel"),
    ("kim", "fixed-point"),
    ("kim", "newton"),
)
TICKS = (2, 4, 8, 16, 40, 100, 400, 1000)
QUANTILES = {
    "least": 0.0,
    "q05": 0.05,
    "q25": 0.25,
    "median": 0.5,
    "q75": 0.75,
    "q95": 0.95,
    "most": 1.0,
}


def cells(run: Run) -> list[dict[str, Any]]:
    angles = range(10, 171, 20 if run.quick else 10)
    random = [{"data": "random", "degrees": degrees} for degrees in angles]
    return random + [{"data": case} for case in CASES]


def measure_cell(run: Run, data: str, degrees: int = 0) -> list[dict[str, object]]:
    if data in CASES:
        return _reconstructed(CASES[data])
    trials, step = 200 if run.quick else 1000, float(degrees)
    rng = run.rng("iterations", degrees)
    rows = _solved("open, 5 keyframes", walk(rng, 5, step, trials), False, step)
    return rows + _solved("closed, 6 keyframes", loop(rng, 6, step, trials), True, step)


def _reconstructed(case: PaperCase) -> list[dict[str, object]]:
    largest = float(steps(case.quaternions[None], case.closed).max())
    data = f"{case.name} (reconstructed)"
    return _solved(data, case.quaternions[:, None], case.closed, largest)


def _solved(
    data: str, keyframes: FloatArray, closed: bool, degrees: float
) -> list[dict[str, object]]:
    rows = []
    for name, method in SOLVERS:
        options: dict[str, Any] = {"method": method, "on_failure": "return", **SOLVE}
        curve = scheme(name)(None, keyframes, closed=closed, **options)
        report = curve.solve_report
        assert report is not None
        counts = report.iterations[report.converged]
        spread = np.quantile(counts, list(QUANTILES.values())) if counts.size else [np.nan] * 7
        rows.append(
            {
                "data": data,
                "scheme": name,
                "method": method,
                "step_degrees": degrees,
                "sets": report.converged.size,
                "not_converged": int((~report.converged).sum()),
                **dict(zip(QUANTILES, spread, strict=True)),
                "share_of_16": float((counts == 16).sum() / report.converged.size),
                "share_of_40": float((counts == 40).sum() / report.converged.size),
            }
        )
    return rows


def draw(table: pd.DataFrame) -> Figure:
    fig, panels = style.axes(style.PAGE, 2.9, 1, 2, sharey=True)
    for ax, data, case, mark in zip(
        panels[0], ("open, 5 keyframes", "closed, 6 keyframes"), CASES, (16, 40), strict=True
    ):
        ends = _solvers(ax, table[table.data == data])
        own = table[(table.data == f"{case} (reconstructed)") & (table.method == "jacobi")]
        ax.axhline(mark, color="black", lw=0.7, ls=":", label="the paper's count")
        star = {"ls": "", "marker": "*", "color": "black", "ms": 8}
        ax.plot(own["step_degrees"], own["median"], label="reconstructed case (jacobi)", **star)
        ax.set(title=data, xlabel="step angle (degrees)", yscale="log")
        ax.set_xticks(range(0, 181, 30))
        ax.set_yticks(TICKS, [str(tick) for tick in TICKS])
        ax.minorticks_off()
    panels[0, 0].set_ylabel("iterations to a change of 1e-6")
    panels[0, 0].legend(loc="upper left")
    style.letters(panels[0])
    named.name_ends(fig, {ax: ends})
    return fig


def _solvers(ax: Any, rows: pd.DataFrame) -> dict[str, End]:
    """Draw medians and bands; the ends of the medians, by what is written there."""
    ends = {}
    for (name, method), color in zip(SOLVERS, style.PALETTE, strict=False):
        picked = rows[(rows.scheme == name) & (rows.method == method) & rows["median"].notna()]
        ax.plot(picked["step_degrees"], picked["median"], color=color)
        band = (picked["q05"], picked["q95"])
        ax.fill_between(picked["step_degrees"], *band, color=color, alpha=0.15, lw=0)
        if len(picked):
            at = picked["step_degrees"].iloc[-1], picked["median"].iloc[-1]
            ends[f"{name} {method}"] = End(*at, f"{name} ({method})", color)
    return ends


def caption(table: pd.DataFrame) -> str:
    sets = int(table.sets.max())
    return (
        f"Iterations on {sets} random keyframe sets per step angle: median (line) and the 5 % to 95 % band of "
        "the sets that converge. The paper's counts, 16 and 40, are dotted; stars are the reconstructed "
        f"cases at their largest step. {RECONSTRUCTED}"
    )
