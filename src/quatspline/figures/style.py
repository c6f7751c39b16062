"""One look for every figure: sizes, fonts, and one colour and marker a scheme everywhere."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

COLUMN = 3.4
"""Width in inches of a figure for one column of a journal; PAGE is for both columns."""
PAGE = 7.0

RED, BLUE = "#c62828", "#1f5fbf"
"""The paper's colours of the quartic and of the B-spline."""

# Okabe & Ito's colour-blind safe palette, darkened where it would vanish on white.
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#b8860b", "#5d3a9b", "#444444")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*", "<", ">")
DASHES = ("-", "--", "-.", ":")

OWN: dict[str, dict[str, Any]] = {
    "quartic": {"color": RED, "marker": "o"},
    "nielson": {"color": BLUE, "marker": "s"},
    "kim": {"color": "#009e73", "marker": "^"},
    "local-quintic": {"color": "#000000", "marker": "D"},
    "monotone-quintic": {"color": "#5d3a9b", "marker": "P"},
    "quintic": {"color": "#d55e00", "marker": "v"},
    "slerp": {"color": "#8a8a8a", "marker": "x"},
    "min-torque": {"color": "#b8860b", "marker": "*"},
}
"""Schemes that every figure tells apart at a glance; all others get theirs from their name."""

SEED = 802
"""Of the names' checksums: the least with which no two schemes of the catalogue share colour and marker."""

RC: Any = {
    "figure.dpi": 150,
    "savefig.facecolor": "white",
    "font.family": "serif",
    "font.serif": ["STIXGeneral", "DejaVu Serif"],
    "mathtext.fontset": "stix",
    "font.size": 8.5,
    "axes.titlesize": 9,
    "axes.labelsize": 8.5,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#d9d9d9",
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.2,
    "lines.markersize": 3.5,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "svg.fonttype": "path",
}


def scheme_style(name: str) -> dict[str, Any]:
    """Colour, marker and line style of a scheme: the same in every figure and every run."""
    if name in OWN:
        return {"linestyle": "-", **OWN[name]}
    lot = zlib.crc32(name.encode(), SEED)
    return {
        "color": PALETTE[lot % len(PALETTE)],
        "marker": MARKERS[lot // 8 % len(MARKERS)],
        "linestyle": DASHES[1 + lot // 128 % 3],
    }


@contextmanager
def house() -> Iterator[None]:
    """The house style, for all that is drawn and saved inside."""
    with mpl.rc_context(RC):
        yield


def axes(width: float, height: float, rows: int = 1, columns: int = 1, **options: Any) -> Any:
    """(figure, axes array (rows, columns)), laid out so that labels do not overlap; in inches."""
    fig = Figure(figsize=(width, height), layout="constrained")
    return fig, fig.subplots(rows, columns, squeeze=False, **options)


def legend_of(fig: Figure, ax: Any, columns: int) -> None:
    """One legend under the whole figure, of one axes' entries."""
    handles, labels = ax.get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=columns, columnspacing=1.2)


def letters(panels: Sequence[Any]) -> None:
    """(a), (b), ... at the panels' upper left corners."""
    for letter, ax in zip("abcdefghijkl", panels, strict=False):
        ax.set_title(f"({letter}) {ax.get_title()}".rstrip(), loc="left", fontsize=9)
        ax.set_title("")
