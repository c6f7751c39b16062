"""Figures of a comparison on a user's own keyframes."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from quatspline.catalogue import called
from quatspline.curve import Curve
from quatspline.figures import style
from quatspline.inputs.arrays import FloatArray
from quatspline.instruments.derivatives import rates_since
from quatspline.keyframes import Keyframes

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

CURVES = 4
"""Schemes drawn over time."""
FAINT = 0.35
"""Opacity of what is not C2."""

SAMPLES = 2000
STRETCHES = 250
"""Of a curve through more segments than a page resolves."""


def bars(table: pd.DataFrame) -> Figure:
    """Torque over the least, one row per scheme with its continuity as measured; third-party schemes are hollow."""
    rows = table[table["failure"].isna() & np.isfinite(table["torque_over_least"])]
    rows = rows.sort_values("torque_over_least", ascending=False)
    fig, panels = style.axes(style.COLUMN, 0.6 + 0.17 * max(len(rows), 3))
    ax = panels[0, 0]
    for height, (_, row) in enumerate(rows.iterrows()):
        looks = style.scheme_style(str(row["scheme"])) | {"linestyle": ""}
        ax.plot(row["torque_over_least"], height, **looks)
    ax.set(xscale="log", xlabel="torque over the least", yticks=range(len(rows)))
    told = zip(rows["scheme"].map(called), rows["continuity"], strict=True)
    ax.set_yticklabels([f"{name} C{k:.0f}" for name, k in told])
    return fig


def rates(curves: Mapping[str, Curve], keyframes: Keyframes) -> Figure:
    """Norms of angular velocity and acceleration over time of the curves that were measured, by name."""
    fig, panels = style.axes(style.PAGE, 3.6, 2, 1, sharex=True)
    t = keyframes.inside(max(2, SAMPLES // len(keyframes.spacings)))  # some rates jump at keyframes
    long = len(keyframes.spacings) > STRETCHES
    for name, curve in curves.items():
        looks = style.scheme_style(name) | {"marker": ""}
        for ax, rate in zip(panels[:, 0], rates_since(curve, t), strict=True):
            size = np.linalg.norm(rate, axis=-1)
            ax.plot(*(largest(t, size) if long else (t, size)), label=called(name), **looks)
    for ax, label in zip(
        panels[:, 0], (r"$|\omega|$ (rad/t)", r"$|\alpha|$ (rad/t$^2$)"), strict=True
    ):
        ax.set_ylabel(label)
        if keyframes.count <= 60:
            for knot in keyframes.knots:
                ax.axvline(knot, color="#dddddd", lw=0.5, zorder=0)
    within = f", of which each of {STRETCHES} stretches shows its largest" if long else ""
    panels[1, 0].set_xlabel(f"t since the first keyframe{within}")
    if curves:
        style.legend_of(fig, panels[0, 0], CURVES)
    return fig


def largest(t: FloatArray, size: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The largest of each of STRETCHES equal stretches of time, at its own time; stretches may be empty.

    Parameters
    ----------
    t : (m,) ascending times
    size : (m,) what is drawn over them
    """
    edges = np.linspace(t[0], t[-1], STRETCHES + 1)[:-1]
    starts = np.unique(np.searchsorted(t, edges))
    peaks = [a + np.argmax(size[a:b]) for a, b in pairwise([*starts, len(t)])]
    return t[peaks], size[peaks]
