"""Many schemes in one picture: eight with colour and name, the rest grey, third-party schemes hollow.

Schemes that do not come with the package are among the eight: whoever adds one looks for it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from quatspline.catalogue import called, plug_ins
from quatspline.figures import direct, style
from quatspline.figures.direct import GREY, End
from quatspline.figures.looks import third_party

NAMED = (
    *("slerp", "squad", "quartic", "quintic", "nielson", "kim", "local-quintic"),
    "scipy-rotation-spline",
)
"""Drawn in colour where many schemes are compared: what readers know, the paper's, ours, and a library's."""
FEW = 4
"""Plug-ins in colour at most: of more, the first by name."""


def coloured(names: Iterable[str], preferred: Sequence[str] = NAMED) -> tuple[str, ...]:
    """Which schemes of a figure are in colour: as many as are preferred, of those that it shows.

    Plug-ins take the places of the last where there is no room for all.
    """
    there = set(names)
    own = sorted(there & plug_ins())[:FEW]
    known = [name for name in preferred if name in there and name not in own]
    return (*known[: len(preferred) - len(own)], *own)


def said(names: Iterable[str], preferred: Sequence[str] = NAMED) -> str:
    """Which schemes of a figure are in colour and which are hollow, for captions; nothing where all look alike."""
    names = list(names)
    lit = coloured(names, preferred)
    listed = " and ".join(filter(None, (", ".join(lit[:-1]), *lit[-1:])))
    grey = f"in colour {listed}, in grey all other schemes" if lit and set(names) - {*lit} else ""
    hollow = "third-party schemes are hollow" if any(map(third_party, names)) else ""
    told = "; ".join(filter(None, (grey, hollow)))
    return f" {told[0].upper()}{told[1:]}." if told else ""


def looks(name: str, lit: Collection[str]) -> dict[str, Any]:
    """The style of a scheme among many, of which some are in colour."""
    known = name in lit
    own = style.scheme_style(name) if known else {"color": GREY, "marker": ".", "linestyle": "-"}
    face = {"markerfacecolor": "white", "mew": 0.7} if third_party(name) else {}  # grey ones, too
    return own | face | {"lw": 1.2 if known else 0.6, "ms": 3.2, "zorder": 3 if known else 2}


def draw_curves(
    ax: Any, curves: Iterable[tuple[str, pd.Series, pd.Series]], lit: Collection[str]
) -> dict[str, End]:
    """Draw curves (name, x, y); the ends of those in colour, which are named, at their last number."""
    ends = {}
    for name, x, y in curves:
        look = looks(name, lit)
        ax.plot(x, y, **look)
        finite = np.isfinite(y.to_numpy(dtype=float))
        if name in lit and finite.any():
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
