"""Matrices of answers: a colour per kind with its key, a row per scheme or per schemes that answer alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib as mpl
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from quatspline.catalogue import called, plug_ins
from quatspline.figures import style
from quatspline.figures.heat import ROW, SMALL, label_cells, scheme_rows
from quatspline.figures.looks import third_party
from quatspline.figures.named import NAMED

KEY = 0.35
"""Inches of the key below."""
NONE = "#ffffff"

Alike = Mapping[str, Sequence[str]]
"""Schemes whose cells are those of another, by its name."""


def alike(kinds: pd.DataFrame, texts: pd.DataFrame) -> dict[str, list[str]]:
    """The schemes with a row of their own, in their order, each with those whose cells are the same.

    A plug-in has its own row: whoever adds one looks for it.

    Parameters
    ----------
    kinds, texts : one row per scheme: what colours the cells, and what is written into them
    """
    cells = pd.concat([kinds, texts], axis=1).astype(object).fillna("")
    groups: dict[tuple[str, ...], list[str]] = {}
    added = plug_ins()
    for name, row in zip(cells.index, cells.to_numpy(), strict=True):
        groups.setdefault((*row, str(name) if name in added else ""), []).append(str(name))
    ranked = (sorted(names, key=_rank) for names in groups.values())
    return {first: others for first, *others in ranked}


def _rank(name: str) -> tuple[bool, bool]:
    """A row has the name that readers know: one of this package, of those shown elsewhere."""
    return third_party(name), name not in NAMED


def draw(
    kinds: pd.DataFrame,
    texts: pd.DataFrame,
    colours: Mapping[str, str],
    *,
    heads: Sequence[str],
    head: float,
    dark: str,
    rotation: float = 0.0,
) -> Figure:
    """Draw a matrix over a page's width, its first row on top; cells without a kind are white.

    Parameters
    ----------
    kinds, texts : one row per scheme
    colours : of the kinds, in the order of the key
    heads : what stands over the columns, in ``head`` inches
    dark : the kind that is written on in white
    """
    rows = alike(kinds, texts)
    kinds, texts = kinds.loc[list(rows)], texts.loc[list(rows)].fillna("")
    fig, panels = style.axes(style.PAGE, ROW * len(rows) + head + KEY)
    ax = panels[0, 0]
    codes = kinds.apply(lambda column: column.map(list(colours).index, na_action="ignore"))
    shades = mpl.colors.ListedColormap(list(colours.values())).with_extremes(bad=NONE)
    ax.imshow(codes.astype(float), cmap=shades, vmin=0, vmax=len(colours) - 1, aspect="auto")
    label_cells(ax, texts, kinds == dark)
    lines = {"va": "bottom", "ma": "left" if rotation else "center", "rotation": rotation}
    ax.set_xticks(
        range(kinds.shape[1]), heads if rotation else _level(heads), fontsize=SMALL, **lines
    )
    scheme_rows(ax, [_row(name, others) for name, others in rows.items()])
    ax.tick_params(length=0, top=True, labeltop=True, bottom=False, labelbottom=False)
    _ruled(ax, kinds.shape)
    _key(fig, {kind: colours[kind] for kind in colours if (kinds == kind).any(axis=None)})
    return fig


def _level(heads: Sequence[str]) -> list[str]:
    """Heads of as many lines as the longest has: others' last lines would stand lower."""
    most = max(head.count("\n") for head in heads)
    return ["\n" * (most - head.count("\n")) + head for head in heads]


def _row(name: str, others: Sequence[str]) -> str:
    return called(name) + (f" + {len(others)} more" if others else "")


def _ruled(ax: Any, shape: tuple[int, int]) -> None:
    """Lines between cells, for the eye to follow rows and columns of one colour; no frame."""
    ax.grid(visible=False)
    ax.spines[:].set_visible(False)
    ax.hlines([i - 0.5 for i in range(1, shape[0])], -0.5, shape[1] - 0.5, color=NONE, lw=0.6)
    ax.vlines([j - 0.5 for j in range(1, shape[1])], -0.5, shape[0] - 0.5, color=NONE, lw=0.6)


def _key(fig: Figure, colours: Mapping[str, str]) -> None:
    patches = [Patch(facecolor=colour, label=kind) for kind, colour in colours.items()]
    fig.legend(handles=patches, loc="outside lower center", ncols=len(patches), columnspacing=1.2)


def said(rows: Alike) -> str:
    """Who shares a row with whom, for captions; nothing where nobody does."""
    told = [
        f"{', '.join(map(called, others))} with {called(name)}"
        for name, others in rows.items()
        if others
    ]
    return f" Schemes with the same cells share a row: {'; '.join(told)}." if told else ""
