"""Many schemes in one picture: eight with colour and name, the rest grey, third-party schemes hollow."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from quatspline.catalogue import called
from quatspline.figures import direct, style
from quatspline.figures.direct import GREY, End
from quatspline.figures.looks import third_party

NAMED = (
    *("slerp", "squad", "quartic", "quintic", "nielson", "kim", "local-quintic"),
    "scipy-rotation-spline",
)
"""Drawn in colour where many schemes are compared: what readers know, the paper's, ours, and a library's."""


def said(chosen: Sequence[str] = NAMED) -> str:
    """Which schemes are in colour, for captions."""
    names = f"{', '.join(chosen[:-1])} and {chosen[-1]}"
    return f"In colour {names}, in grey all other schemes; third-party schemes are hollow."


SAID = said()


def looks(name: str, chosen: Collection[str] = NAMED) -> dict[str, Any]:
    """The style of a scheme among many, of which those chosen are in colour."""
    known = name in chosen
    own = style.scheme_style(name) if known else {"color": GREY, "marker": ".", "linestyle": "-"}
    face = {"markerfacecolor": "white", "mew": 0.7} if third_party(name) else {}  # grey ones, too
    return own | face | {"lw": 1.2 if known else 0.6, "ms": 3.2, "zorder": 3 if known else 2}


def draw_curves(ax: Any, curves: Iterable[tuple[str, pd.Series, pd.Series]]) -> dict[str, End]:
    """Draw curves (name, x, y); the ends of those with a name, at their last number."""
    ends = {}
    for name, x, y in curves:
        look = looks(name)
        ax.plot(x, y, **look)
        finite = np.isfinite(y.to_numpy(dtype=float))
        if name in NAMED and finite.any():
            tip = (x[finite].iloc[-1], y[finite].iloc[-1])
            ends[name] = End(*tip, called(name), look["color"], look["linestyle"])
    return ends


def name_ends(fig: Any, panels: Mapping[Any, Mapping[str, End]]) -> None:
    """Write names right of the curves of some axes, after all else is laid out with the room that they take."""
    held = [text for ax, ends in panels.items() for text in direct.hold_room(ax, ends.values())]
    fig.draw_without_rendering()
    fig.set_layout_engine("none")
    for text in held:
        text.remove()
    for ax, ends in panels.items():
        direct.label_ends(ax, list(ends.values()))
