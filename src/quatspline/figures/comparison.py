"""Figures of a comparison on a user's own keyframes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from quatspline.catalogue import called
from quatspline.curve import Curve
from quatspline.figures import named, style
from quatspline.figures.direct import End
from quatspline.figures.heat import ROW, SMALL, scheme_rows
from quatspline.inputs.arrays import FloatArray
from quatspline.instruments.derivatives import rates_since
from quatspline.keyframes import Keyframes

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

CURVES = 4
"""Schemes drawn over time."""
LEAST = 0.5
"""Torque over the least below which no mark is drawn, but the number written: of curves that miss the keyframes."""
BESIDE: Any = {"va": "center", "fontsize": SMALL, "color": "#555555"}
MARKED = 60
"""Keyframes that lines can mark."""

SAMPLES = 2000
STRETCHES = 250
"""Of a curve through more segments than a page resolves."""


def bars(table: pd.DataFrame, lit: Sequence[str] = ()) -> Figure:
    """Torque over the least, one row per scheme with its continuity as measured; third-party schemes are hollow.

    Schemes ``lit``, whose rates are drawn beside, are in colour, all others grey.
    """
    rows = table[table["failure"].isna() & np.isfinite(table["torque_over_least"])]
    rows = rows.sort_values("torque_over_least")
    fig, panels = style.axes(style.COLUMN, 0.6 + ROW * max(len(rows), 3))
    ax = panels[0, 0]
    for height, (name, torque) in enumerate(
        zip(rows["scheme"], rows["torque_over_least"], strict=True)
    ):
        if torque < LEAST:
            _beyond(ax, height, torque)
        else:
            ax.plot(torque, height, **named.looks(name, lit) | {"linestyle": "", "ms": 4.0})
    ax.set(xscale="log", xlabel="torque over the least")
    if (rows["torque_over_least"] < LEAST).any():
        ax.set_xlim(left=LEAST)
    style.plain_log(ax.xaxis)
    told = zip(rows["scheme"].map(called), rows["continuity"], strict=True)
    scheme_rows(ax, [f"{name} $C^{k:.0f}$" for name, k in told])
    return fig


def _beyond(ax: Any, height: int, torque: float) -> None:
    told = f"{torque:.1g}".replace("e-0", "e-")
    ax.annotate(
        rf"$\leftarrow$ {told}", (LEAST, height), (2, 0), textcoords="offset points", **BESIDE
    )


def rates(curves: Mapping[str, Curve], keyframes: Keyframes) -> Figure:
    """Norms of angular velocity and acceleration over time of the curves that were measured, by name."""
    fig, panels = style.axes(style.PAGE, 3.6, 2, 1, sharex=True)
    t = keyframes.inside(max(2, SAMPLES // len(keyframes.spacings)))  # some rates jump at keyframes
    long = len(keyframes.spacings) > STRETCHES
    ends: dict[Any, dict[str, End]] = {ax: {} for ax in panels[:, 0]}
    for name, curve in curves.items():
        look = style.scheme_style(name) | {"marker": ""}
        for ax, rate in zip(panels[:, 0], rates_since(curve, t), strict=True):
            x, y = t, np.linalg.norm(rate, axis=-1)
            x, y = largest(x, y) if long else (x, y)
            ax.plot(x, y, **look)
            ends[ax][name] = End(x[-1], y[-1], called(name), look["color"], look["linestyle"])
    for ax, label in zip(
        panels[:, 0], (r"$|\omega|$ (rad/t)", r"$|\alpha|$ (rad/t$^2$)"), strict=True
    ):
        _dress(ax, label, keyframes)
    within = f", of which each of {STRETCHES} stretches shows its largest" if long else ""
    panels[1, 0].set_xlabel(f"t since the first keyframe{within}")
    named.name_ends(fig, ends)
    return fig


def _dress(ax: Any, label: str, keyframes: Keyframes) -> None:
    """From 0, since sizes are shown; and upright lines at keyframes alone."""
    ax.set(ylabel=label, xmargin=0.01)
    ax.set_ylim(bottom=-0.04 * ax.get_ylim()[1])
    ax.grid(visible=False, axis="x")
    for knot in keyframes.knots if keyframes.count <= MARKED else ():
        ax.axvline(knot, color="#bbbbbb", lw=0.6, zorder=0)


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
