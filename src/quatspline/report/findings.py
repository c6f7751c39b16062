"""Findings: sentences made of table cells, each of which is named beside its sentence."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

Reader = Callable[[str], pd.DataFrame]


@dataclass(frozen=True)
class Cell:
    """A number with the place that it stands in."""

    table: str
    row: dict[str, Any]
    column: str
    value: Any

    def __format__(self, spec: str) -> str:
        return format(self.value, spec)

    def __str__(self) -> str:
        where = ", ".join(f"{key}={value}" for key, value in self.row.items())
        return f"{self.table}.csv[{where}].{self.column}"


@dataclass(frozen=True)
class Finding:
    """A sentence and the cells that its numbers come from."""

    topic: str
    text: str
    cells: tuple[Cell, ...] = field(default=())


class Ledger:
    """Looks cells up and remembers which were used."""

    def __init__(self, read: Reader) -> None:
        self._read = read
        self.used: list[Cell] = []

    def __call__(self, table: str, column: str, **row: Any) -> Cell:
        """The one cell of a table in the row that matches."""
        frame = self._read(table)
        picked = frame
        for key, value in row.items():
            picked = picked[picked[key] == value]
        if len(picked) != 1:
            raise LookupError(f"{table}: {len(picked)} rows match {row}, one is needed")
        cell = Cell(table, row, column, picked.iloc[0][column])
        self.used.append(cell)
        return cell


def findings(read: Reader) -> list[Finding]:
    """All findings that the tables at hand support, in the order of the page."""
    found = []
    for topic, sentence in FINDINGS:
        ledger = Ledger(read)
        try:
            text = sentence(ledger)
        except FileNotFoundError:  # an experiment that was not run
            continue
        found.append(Finding(topic, text, tuple(ledger.used)))
    return found


def reader(folder: Path) -> Reader:
    """Tables of a folder, each read once."""
    from quatspline.report.results import Results

    tables: dict[str, pd.DataFrame] = {}

    def read(name: str) -> pd.DataFrame:
        if name not in tables:
            tables[name] = Results(folder).read_table(name)
        return tables[name]

    return read


ROWS = (("key", 101), ("key", 201), ("teapot", 150), ("teapot", 300))


def _iterations(cell: Ledger) -> str:
    key = cell(
        "table1", "iterations", case="key", frames=101, scheme="nielson", protocol="per-frame"
    )
    pot = cell(
        "table1", "iterations", case="teapot", frames=150, scheme="nielson", protocol="per-frame"
    )
    return (
        f"Nielson's iteration takes {key:d} steps for the key and {pot:d} for the teapot, as in the paper; the "
        "keyframes are reconstructed so that it does, for the paper prints none."
    )


def _ratios(cell: Ledger, scheme: str, protocol: str) -> list[Cell]:
    return [
        cell(
            "table1", "ratio_to_quartic", case=case, frames=frames, scheme=scheme, protocol=protocol
        )
        for case, frames in ROWS
    ]


def _protocol(cell: Ledger) -> str:
    paper = [
        cell(
            "table1",
            "paper_ratio",
            case=case,
            frames=frames,
            scheme="nielson",
            protocol="per-frame",
        )
        for case, frames in ROWS
    ]
    slow, fast = (_ratios(cell, "nielson", p) for p in ("per-frame", "solve-once"))
    return (
        f"The paper finds its quartic {_range(paper)} times faster than the B-spline. Solving anew for every "
        f"frame, as it does, we measure {_range(slow)} (key at 101 and 201 frames, teapot at 150 and 300); solving "
        f"once and then evaluating, {_range(fast)}. The difference is protocol, the rest is the scheme."
    )


def _newton(cell: Ledger) -> str:
    slow, fast = (_ratios(cell, "kim", p) for p in ("per-frame", "solve-once"))
    steps = cell(
        "table1", "iterations", case="teapot", frames=150, scheme="kim", protocol="per-frame"
    )
    return (
        f"The cumulative B-spline of Kim, Kim & Shin, solved by Newton's method ({steps:d} steps for the teapot), "
        f"costs {_range(slow)} times the quartic per frame and {_range(fast)} times solved once."
    )


def _jump(cell: Ledger) -> str:
    where = {"case": "60 degrees, uniform", "quantity": "alpha"}
    nielson = cell("continuity", "relative", scheme="nielson", **where)
    uneven = {"case": "60 degrees, uneven", "quantity": "alpha"}
    rough = cell("continuity", "relative", scheme="nielson", **uneven)
    quartic = cell("continuity", "relative", scheme="quartic", **uneven)
    kim = cell("continuity", "relative", scheme="kim", **uneven)
    return (
        "The paper's baseline does not have what its title is about: Nielson's curve is C1, its acceleration "
        f"jumps at keyframes by {100 * nielson.value:.1f} % of its size on random keyframes 60 degrees apart "
        f"({100 * rough.value:.1f} % on uneven times), while the jumps of the quartic ({quartic:.0e}) and of the "
        f"cumulative B-spline ({kim:.0e}) are rounding."
    )


def _cubic_fall(cell: Ledger) -> str:
    sizes = [
        cell(
            "continuity",
            "jump",
            scheme="nielson",
            quantity="alpha",
            case=f"smooth motion, {n} keyframes",
        )
        for n in (41, 81)
    ]
    fall = sizes[0].value / sizes[1].value
    return f"On smooth motion that jump falls by a factor {fall:.1f} when the keyframe spacing is halved (third order)."


def _orders(cell: Ledger) -> str:
    names = ("slerp", "quartic", "quintic", "kim", "nielson", "local-quintic")
    where = {"knots": "uniform", "keyframes": 641}
    slopes = [cell("accuracy", "slope", scheme=name, **where) for name in names]
    listed = ", ".join(f"{name} {slope:.2f}" for name, slope in zip(names, slopes, strict=True))
    return (
        f"Interior orders on a smooth motion, read between 321 and 641 uniform keyframes: {listed}. The paper's "
        "quartic converges no faster than slerp; with the second derivative of the parabola through three "
        "keyframes (quintic) the same construction gains an order."
    )


def _torque(cell: Ledger) -> str:
    names = ("nielson", "kim", "local-quintic", "scipy-rotation-spline", "squad", "quartic")
    medians = [cell("fairness", "median", scheme=name) for name in names]
    sets = cell("fairness", "sets", scheme="local-quintic")
    listed = ", ".join(f"{name} {m:.4f}" for name, m in zip(names, medians, strict=True))
    return (
        f"Torque energy over the least possible, median of {sets:d} committed keyframe sets: {listed}. local-quintic "
        "is local and solves nothing."
    )


FINDINGS: tuple[tuple[str, Callable[[Ledger], str]], ...] = (
    ("reproduction", _iterations),
    ("protocol", _protocol),
    ("protocol", _newton),
    ("continuity", _jump),
    ("continuity", _cubic_fall),
    ("accuracy", _orders),
    ("fairness", _torque),
)


def _range(cells: list[Cell]) -> str:
    low, high = min(c.value for c in cells), max(c.value for c in cells)
    return f"{low:.3g} to {high:.3g}"


def lines(folder: Path) -> Iterator[str]:
    """The findings of a folder of tables as a Markdown list."""
    for finding in findings(reader(folder)):
        yield f"- {finding.text}"
