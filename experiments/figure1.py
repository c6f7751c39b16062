"""Figure 1 of the paper: the blending functions B_j, read off the curve."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.instruments.blending import blending
from quatspline.registry import scheme
from quatspline.report import style
from quatspline.running import Run

TITLE = "Figure 1: blending functions of the quartic"
PAPER = True


def measure(run: Run) -> pd.DataFrame:
    return blending(scheme("quartic"), np.linspace(0.0, 1.0, 201), cumulative=False)


def draw(table: pd.DataFrame) -> Figure:
    fig, panels = style.axes(style.COLUMN, 2.5)
    ax = panels[0, 0]
    for j, color in enumerate(style.PALETTE[:4]):
        ax.plot(table["u"], table[f"B{j}"], color=color, label=f"$B_{j}(u)$")
    ax.set(xlabel="$u$", ylabel="blending function", xlim=(0, 1))
    style.legend_of(fig, ax, 4)
    return fig


def caption(table: pd.DataFrame) -> str:
    return (
        "Blending functions B_0 to B_3 of the quartic on one segment of uniform knots, read off the "
        "curve: ln q(t) of keyframes about one axis of which a single one is turned."
    )
