"""What every scheme does with keyframes that schemes are known to stumble over."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import found, version
from quatspline.figures import matrix
from quatspline.instruments.edge_cases import edge_result
from quatspline.instruments.trials import TIGHT, Row
from quatspline.runs.experiment import Run, crossed
from quatspline.trajectories.edge_cases import edge_cases

TITLE = "Edge cases"
PAPER = False
KEYS = ["case", "scheme"]
NOTE = (
    "result: exact (to 1e-6 of the largest step), as claimed (off only where the scheme claims nothing), wrong, NaN, "
    "or error with its reason. checked: by claimed_constant_rate, against the truth, the constant rate or rest that "
    "keyframes suggest, everywhere or away from the ends, or that keys are met; of all, that values are finite and of "
    "norm 1, and that no curve is off by half a step. deviation: the largest angle, of a wrong one where it is at "
    "fault, lower is better; relative: over the largest step. Iterative schemes are solved to 1e-11. Both "
    "sizes are one."
)
FORMATS = {"deviation": ".1e", "relative": ".1e"}
RESULTS = {
    "exact": "#cdebe0",
    "as claimed": "#7cc4ab",
    "wrong": "#e6b84c",
    "NaN": "#d55e00",
    "error": "#b0b0b0",
}
"""Colours of results, apart for colour-blind readers and, with the text in all cells but the exact, without colour."""


def cells(run: Run) -> list[dict[str, Any]]:
    return crossed(scheme=run.names)


def measure_cell(run: Run, scheme: str) -> list[Row]:
    cls = found()[scheme].scheme
    options = {"tolerance": TIGHT} if cls is not None and cls.iterative else {}
    claim = None if cls is None else cls.constant_rate
    base = {"scheme": scheme, "claimed_constant_rate": claim, "version": version(scheme)}
    return [
        {"case": case.name, "difficulty": case.difficulty}
        | base
        | edge_result(case, scheme, **options)
        for case in edge_cases().values()
    ]


def draw(table: pd.DataFrame) -> Figure:
    results, texts = _matrices(table)
    heads = ["\n".join(str(name).split()) for name in results]
    return matrix.draw(results, texts, RESULTS, heads=heads, head=0.5, dark="NaN")


def _matrices(table: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Results, and what is written on them: a row per scheme, those with fewest faults first."""
    cases = list(edge_cases())
    results = table.pivot(index="scheme", columns="case", values="result")[cases]
    faultless = results.isin(["exact", "as claimed"]).sum(axis=1)
    results = results.loc[faultless.sort_values(ascending=False, kind="stable").index]
    relative = table.pivot(index="scheme", columns="case", values="relative")
    relative = relative.loc[results.index, cases]
    texts = results.where(~results.isin(["wrong", "as claimed"]), relative.map(_short))
    return results, texts.where(results != "exact", "")


def _short(relative: float) -> str:
    return (
        "wrong"
        if np.isnan(relative)
        else f"{relative:.0e}".replace("e-0", "e-").replace("e+00", "")
    )


def caption(table: pd.DataFrame) -> str:
    return (
        "What each scheme makes of edge cases. Numbers: how far off, over the largest step, where the result is wrong "
        "or off only where nothing is claimed; 'error': refused or failed, with the reason in the table. A scheme "
        "without a closed curve refuses the full turn, one of uniform times refuses others. Rows are sorted by the "
        f"number of cases without a fault.{matrix.said(matrix.alike(*_matrices(table)))}"
    )
