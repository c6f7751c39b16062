"""Pictures of blending functions: what Figures 1 and 2 of the paper share."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from quatspline.figures import direct, style

# Told apart in print without colour, too; B_0 lies over others and is drawn first.
_DASHES = ("-", "--", "-.", ":")


def draw_blending(table: pd.DataFrame, symbol: str, name: str) -> Figure:
    """One panel, one column wide: the columns B0 ... B3 of `blending` against u (dimensionless).

    ``symbol`` is the mathematics of one function without its index, ``name`` the axis' text.
    """
    fig, panels = style.axes(style.COLUMN, 2.3)
    ax = panels[0, 0]
    for j, (color, dash) in enumerate(zip(style.PALETTE, _DASHES, strict=False)):
        ax.plot(table["u"], table[f"B{j}"], color=color, ls=dash, label=f"${symbol}_{j}(u)$")
    ax.set(xlabel="$u$", ylabel=name, xlim=(0, 1), ymargin=0.12)
    fig.draw_without_rendering()
    fig.set_layout_engine("none")
    direct.label_curves(ax)
    return fig
