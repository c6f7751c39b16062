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
    "result: exact (to 1e-6 of the largest step), as claimed (deviates only where the scheme claims nothing), wrong, "
    "NaN, or error with its reason. checked: depending on claimed_constant_rate, the curve is compared with the true "
    "motion at a constant rate or at rest that the keyframes imply, everywhere or away from the ends, or only the "
    "keyframes must be met. All values must be finite and of norm 1, and no curve may be off by half a step. "
    "deviation: the largest angle (for a wrong result, the largest at fault); lower is better. relative: the same "
    "relative to the largest step. Iterative schemes are solved to 1e-11. Both sizes are the same."
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
        "How each scheme handles edge cases. Numbers: how far off the result is, relative to the largest step, where "
        "it is wrong or off only where nothing is claimed; 'error': refused or failed, with the reason in the table. "
        "A scheme without a closed curve refuses the full turn; a scheme for uniform times refuses others. Rows are "
        f"sorted by the number of cases without a fault.{matrix.said(matrix.alike(*_matrices(table)))}"
    )
