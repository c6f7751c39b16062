"""Figure 2 of the paper: the cumulative blending functions, read off the curve."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import scheme
from quatspline.figures.blending import draw_blending
from quatspline.instruments.blending import blending
from quatspline.runs.experiment import Run

TITLE = "Figure 2: cumulative blending functions of the quartic"
PAPER = True


def measure(run: Run) -> pd.DataFrame:
    return blending(scheme("quartic"), np.linspace(0.0, 1.0, 201), cumulative=True)


def draw(table: pd.DataFrame) -> Figure:
    return draw_blending(table, r"\tilde B", "cumulative blending function")


def caption(table: pd.DataFrame) -> str:
    return (
        "Cumulative blending functions (sums of B_j from j to 3) of the quartic on one segment of uniform knots, read "
        "off the curve as ln q(t) for keyframes about one axis that turn once, by one step."
    )
