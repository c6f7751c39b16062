"""Figures of schemes on a skeleton: what they make of its joints at the frames left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from quatspline.catalogue import called
from quatspline.figures import named, style
from quatspline.figures.heat import ROW, scheme_rows

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure


def spans(table: pd.DataFrame, chosen: Sequence[str]) -> Figure:
    """One row per scheme, the best on top: from the joints' median to the worst joint, and the largest angle.

    Schemes ``chosen``, whose joints are drawn beside, are in colour, all others grey; third-party schemes are hollow.
    """
    rows = table[table["rms_median"].notna()]
    fig, panels = style.axes(style.COLUMN, 0.7 + ROW * max(len(rows), 3))
    ax = panels[0, 0]
    for height, row in enumerate(rows.to_dict("records")):
        median, worst, largest = np.degrees(
            [row[k] for k in ("rms_median", "rms_worst", "largest")]
        )
        look = named.looks(str(row["scheme"]), chosen) | {"marker": "o", "ms": 4.0}
        ax.plot(
            [median, worst], [height, height], color=look["color"], lw=2.0, solid_capstyle="butt"
        )
        ax.plot(median, height, **look)
        ax.plot(largest, height, "|", color=look["color"], ms=6.0)
    ax.set(xscale="log", xlabel="degrees at frames left out")
    style.plain_log(ax.xaxis)
    scheme_rows(ax, [called(str(name)) for name in rows["scheme"]])
    return fig


def by_joint(joints: pd.DataFrame, schemes: Sequence[str]) -> Figure:
    """A joint a row, the worst on top: its rms angle by each of a few schemes."""
    rows = joints[joints["scheme"].isin(list(schemes))]
    order = rows.groupby("joint")["rms"].mean().sort_values(ascending=False).index
    places = {str(joint): height for height, joint in enumerate(order)}
    fig, panels = style.axes(style.COLUMN, 1.0 + ROW * max(len(order), 3))
    ax = panels[0, 0]
    for name in schemes:
        own = rows[rows["scheme"] == name]
        looks = style.scheme_style(name) | {"linestyle": "", "markersize": 4.0}
        ax.plot(np.degrees(own["rms"]), own["joint"].map(places), label=called(name), **looks)
    ax.set(xscale="log", xlabel="rms angle (degrees) at frames left out")
    style.plain_log(ax.xaxis)
    scheme_rows(ax, list(places))
    style.legend_of(fig, ax, 2)
    return fig
