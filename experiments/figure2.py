"""Figure 2 of the paper: the cumulative blending functions, read off the curve."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.instruments.blending import blending
from quatspline.registry import scheme
from quatspline.report import style
from quatspline.running import Run

TITLE = "Figure 2: cumulative blending functions of the quartic"
PAPER = True


def measure(run: Run) -> pd.DataFrame:
    return blending(scheme("quartic"), np.linspace(0.0, 1.0, 201), cumulative=True)


def draw(table: pd.DataFrame) -> Figure:
    fig, panels = style.axes(style.COLUMN, 2.5)
    ax = panels[0, 0]
    for j, color in enumerate(style.PALETTE[:4]):
        ax.plot(table["u"], table[f"B{j}"], color=color, label=rf"$\tilde B_{j}(u)$")
    ax.set(xlabel="$u$", ylabel="cumulative blending function", xlim=(0, 1))
    style.legend_of(fig, ax, 4)
    return fig


def caption(table: pd.DataFrame) -> str:
    return (
        "Cumulative blending functions (sums of B_j from j to 3) of the quartic on one segment of uniform "
        "knots, read off the curve: ln q(t) of keyframes about one axis that turn once, by one step."
    )
