"""Figure 1 of the paper: the blending functions B_j, read off the curve."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import scheme
from quatspline.figures.blending import draw_blending
from quatspline.instruments.blending import blending
from quatspline.runs.experiment import Run

TITLE = "Figure 1: blending functions of the quartic"
PAPER = True


def measure(run: Run) -> pd.DataFrame:
    return blending(scheme("quartic"), np.linspace(0.0, 1.0, 201), cumulative=False)


def draw(table: pd.DataFrame) -> Figure:
    return draw_blending(table, "B", "blending function")


def caption(table: pd.DataFrame) -> str:
    return (
        "Blending functions B_0 to B_3 of the quartic on one segment of uniform knots, read off the curve as ln q(t) "
        "for keyframes about one axis of which a single one is turned."
    )
