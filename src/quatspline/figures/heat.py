"""Heat maps of schemes against columns, on a logarithmic scale, legible with dozens of rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd

MISSING = "#dddddd"
COLOURS = "YlGnBu"
"""Pale is little, dark is much, even in grey print; none is the grey of what is missing."""

ROW = 0.17
"""Inches a row, for what is read along."""
TIGHT = 0.135
"""The least at which names do not touch, for as many schemes as there are."""


SMALL = 7.0
"""Points of text in cells: the least that prints."""

SHARE = 0.4
"""Of the width of several maps, what their bar takes."""

APART = 0.08
"""Inches between a map, with what is written under it, and its bar, however many rows it has."""


def log_heat(
    ax: Any,
    frame: pd.DataFrame,
    label: str,
    limits: tuple[float, float],
    *,
    names_shown: bool = True,
    colours: str = COLOURS,
    ticks: Mapping[float, str] | None = None,
    under: Sequence[Any] | None = None,
) -> None:
    """Colour a frame of positive numbers, first row on top; grey where there is none.

    Numbers outside the limits take the colour of the nearer one, which the colour bar marks.  ``ticks`` are
    what stands at numbers of the bar, by default powers of ten; it stands ``under`` these axes, by default
    the map's own, under none where they are empty: maps of one scale share a bar.
    """
    low, high = limits
    values = np.ma.masked_invalid(frame.to_numpy(dtype=float))
    shades = mpl.colormaps[colours].with_extremes(bad=MISSING)
    norm = mpl.colors.LogNorm(low, high, clip=True)
    image = ax.imshow(np.ma.clip(values, low, high), cmap=shades, norm=norm, aspect="auto")
    _label(ax, frame, names_shown)
    if under is not None and not under:
        return
    share = SHARE if under else 1.0
    apart = APART / ax.figure.get_figheight()
    place = {"orientation": "horizontal", "aspect": 40, "extend": "both", "shrink": share}
    bar = ax.figure.colorbar(image, ax=list(under or [ax]), pad=apart, **place)
    bar.set_label(label)
    if ticks is not None:
        bar.set_ticks(list(ticks), labels=list(ticks.values()))
        bar.minorticks_off()


def label_cells(ax: Any, texts: pd.DataFrame, dark: pd.DataFrame) -> None:
    """Write into a map's cells, white where they are dark."""
    for i, row in enumerate(texts.to_numpy()):
        for j, text in enumerate(row):
            colour = "white" if dark.iat[i, j] else "black"
            ax.text(j, i, text, ha="center", va="center", fontsize=SMALL, color=colour)


def scheme_rows(ax: Any, names: Sequence[str], *, shown: bool = True) -> None:
    """A row of height 1 a name, the first on top."""
    ax.set_yticks(range(len(names)), list(names) if shown else [])
    ax.set_ylim(max(len(names), 1) - 0.5, -0.5)


def _label(ax: Any, frame: pd.DataFrame, names_shown: bool) -> None:
    ax.set_xticks(range(frame.shape[1]), [str(column) for column in frame.columns])
    scheme_rows(ax, list(map(str, frame.index)), shown=names_shown)
    ax.tick_params(length=0)
    ax.grid(visible=False)
    for i in range(1, len(frame)):
        ax.axhline(i - 0.5, color="white", lw=0.6)
