"""One look for every figure: sizes, fonts, what panels share. How schemes look stands in `looks`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from quatspline.figures.looks import BLUE, RED, scheme_style

__all__ = [
    "BLUE",
    "COLUMN",
    "MARKERS",
    "PAGE",
    "PALETTE",
    "RC",
    "RED",
    "applied",
    "axes",
    "legend_of",
    "letters",
    "plain_log",
    "scheme_style",
]

COLUMN = 3.4
"""Width in inches of a figure for one column of a journal; PAGE is for both columns."""
PAGE = 7.0

# Okabe & Ito's colour-blind safe palette, darkened where it would vanish on white.
PALETTE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#b8860b", "#5d3a9b", "#444444")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*", "<", ">")

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


@contextmanager
def applied() -> Iterator[None]:
    """This style, for all that is drawn and saved inside."""
    with mpl.rc_context(RC):
        yield


def axes(width: float, height: float, rows: int = 1, columns: int = 1, **options: Any) -> Any:
    """(figure, axes array (rows, columns)), laid out so that labels do not overlap; in inches."""
    fig = Figure(figsize=(width, height), layout="constrained")
    return fig, fig.subplots(rows, columns, squeeze=False, **options)


PLAIN = 100.0
"""Ratio of limits up to which a logarithmic axis has numbers between powers of ten."""


def plain_log(axis: Any) -> None:
    """Write 0.5, 1, 2 on a short logarithmic axis, whose limits are final; powers of ten on a long one."""
    low, high = sorted(axis.get_view_interval())
    if high > PLAIN * low:
        return
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())


def legend_of(fig: Figure, ax: Any, columns: int) -> None:
    """One legend under the whole figure, of one axes' entries."""
    handles, labels = ax.get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=columns, columnspacing=1.2)


def letters(panels: Sequence[Any]) -> None:
    """(a), (b), ... at the panels' upper left corners."""
    for letter, ax in zip("abcdefghijkl", panels, strict=False):
        ax.set_title(f"({letter}) {ax.get_title()}".rstrip(), loc="left", fontsize=9)
        ax.set_title("")
