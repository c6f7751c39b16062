"""Interactive plots of tables: which columns, and what a reader may choose.  The browser draws from the CSV."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

from matplotlib.colors import to_hex, to_rgb

from quatspline.catalogue import plug_ins
from quatspline.figures.looks import Dash, scheme_style, third_party
from quatspline.figures.named import NAMED, coloured
from quatspline.page.folder import Table
from quatspline.page.glossary import label

Kind = Literal["lines", "points", "map"]


@dataclass(frozen=True)
class Plot:
    """A plot of a table.  Where columns are several, a reader chooses; the first is shown.

    Attributes
    ----------
    table : the table's name
    x, y : columns of the axes; of a map, the first of each
    kind : lines per series, a point per row, or a map of z over x and y
    z : columns of a map's colour
    series : the column whose values are told apart, each of which can be picked out or hidden
    split : columns that divide a series into several lines
    facets : columns of which one value is shown at a time
    start : the value of a facet shown at first, where it is not the first in the table
    log : whether the axes (of a map: its colour) start logarithmic
    ratios : columns that are ratios to a least value, of which a logarithmic axis shows the excess over 1
    """

    table: str
    x: tuple[str, ...]
    y: tuple[str, ...]
    kind: Kind = "lines"
    z: tuple[str, ...] = ()
    series: str = "scheme"
    split: tuple[str, ...] = ()
    facets: tuple[str, ...] = ()
    start: dict[str, str] = field(default_factory=dict)
    log: tuple[bool, bool] = (False, False)
    ratios: tuple[str, ...] = ()


def specification(plot: Plot, table: Table) -> dict[str, Any] | None:
    """A plot as the browser takes it, with the columns that the table has; None if too few."""
    have = set(table.columns)
    x, y, z, facets = (
        [{"column": name, "label": label(plot.table, name)} for name in names if name in have]
        for names in (plot.x, plot.y, plot.z, plot.facets)
    )
    if not x or not y or plot.series not in have or (plot.kind == "map" and not z):
        return None
    axes = {"x": x, "y": y, "z": z, "facets": facets}
    split = [name for name in plot.split if name in have]
    rest = {
        "series": plot.series,
        "split": split,
        "kind": plot.kind,
        "log": list(plot.log),
        "start": plot.start,
        "ratios": list(plot.ratios),
        "lit": list(coloured([*NAMED, *plug_ins()])),
    }
    return {"id": f"plot-{plot.table}-{plot.kind}", "table": plot.table, **axes, **rest}


SYMBOLS = {
    "o": "circle",
    "s": "square",
    "^": "triangle-up",
    "v": "triangle-down",
    "<": "triangle-left",
    ">": "triangle-right",
    "D": "diamond",
    "P": "cross",
    "X": "x",
    "*": "star",
    "p": "pentagon",
    "h": "hexagon",
}
DASHES = {"-": "solid", "--": "dash", "-.": "dashdot", ":": "dot"}


def _dash(dash: Dash) -> str:
    """A dash as Plotly takes it: by name, or lengths in pixels."""
    return (
        DASHES[dash] if isinstance(dash, str) else ",".join(f"{length:g}px" for length in dash[1])
    )


NIGHT, VISIBLE = "#14171b", 4.0
"""The dark look's ground, and the least contrast ratio of a line on it (WCAG asks for 3)."""


def scheme_look(name: str) -> dict[str, str]:
    """Colour (on light and dark ground), marker and dash of a scheme: those of the figures."""
    look = scheme_style(name)
    color = to_hex(look["color"])
    return {
        "light": color,
        "dark": _lightened(color),
        "symbol": SYMBOLS[look["marker"]] + ("-open" if third_party(name) else ""),
        "dash": _dash(look["linestyle"]),
    }


def _lightened(color: str) -> str:
    """A colour mixed with white until it stands out from the dark ground."""
    for share in range(0, 100, 5):
        mixed = [c + (1.0 - c) * share / 100.0 for c in to_rgb(color)]
        if _luminance(mixed) + 0.05 >= VISIBLE * (_luminance(to_rgb(NIGHT)) + 0.05):
            break
    return to_hex((mixed[0], mixed[1], mixed[2]))


def _luminance(rgb: Any) -> float:
    """Relative luminance of an sRGB colour (WCAG 2.2)."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in rgb]
    return float(0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2])
