"""Quotes: the numbers in a sentence, each tied to the table cells that it follows from."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from string import Formatter
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

    def __str__(self) -> str:
        where = ", ".join(f"{key}={value}" for key, value in self.row.items())
        return f"{self.table}.csv[{where}].{self.column}"


def three_digits(value: float) -> float:
    """A number to three significant digits."""
    return float(f"{value:.3g}")


def without_name(reason: str, name: str) -> str:
    """A scheme's reason to fail, said of no one by name: schemes of one reason are named together."""
    return re.sub(rf"(?<![\w-]){re.escape(name)}(?![\w-])", "it", reason)


EXPRESSIONS: dict[str, Callable[..., Any]] = {
    "value": lambda value: value,
    "percent": lambda value: 100.0 * value,
    "ratio": lambda above, below: above / below,
    "halved": lambda order: 2.0**order,
    "rounded": three_digits,
    "rounded degrees": lambda value: three_digits(math.degrees(value)),
    "rounded ratio": lambda above, below: three_digits(above / below),
    "reason": without_name,
    "count": lambda *values: len(values),
    "least": lambda *values: min(values),
    "most": lambda *values: max(values),
}
"""How a number in a sentence follows from its cells."""


@dataclass(frozen=True)
class Quote:
    """A number in a sentence: the cells that it follows from, how, and how it is written.

    Attributes
    ----------
    cells : in the order that the expression takes them
    expression : a key of `EXPRESSIONS`
    spec : the format specification
    """

    cells: tuple[Cell, ...]
    expression: str = "value"
    spec: str = ""

    @property
    def value(self) -> Any:
        """What the expression makes of the cells."""
        return EXPRESSIONS[self.expression](*(cell.value for cell in self.cells))

    @property
    def source(self) -> Cell:
        """The cell to look at first: for the least and the most the one that attains it."""
        return next((cell for cell in self.cells if cell.value == self.value), self.cells[0])

    def __str__(self) -> str:
        value = self.value
        if self.spec == "d" and isinstance(value, float) and value.is_integer():
            value = int(value)  # of a column with gaps, whose counts are read as floats
        try:
            return format(value, self.spec)
        except (TypeError, ValueError) as error:  # text where a number is expected
            raise ValueError(f"{self.cells[0]}: {error}") from error


def multiple(*cells: Cell) -> Quote:
    """One cell, or the first over the second, to three significant digits in plain notation."""
    quote = Quote(cells, "rounded" if len(cells) == 1 else "rounded ratio")
    size = quote.value
    decimals = 2 - math.floor(math.log10(size)) if size and math.isfinite(size) else 0
    return replace(quote, spec=f".{max(decimals, 0)}f")


Span = tuple[Quote, Quote]
"""The least and the most of several cells, written "a to b"."""

Part = str | Quote


def said(template: str, **quantities: Cell | Quote | Span) -> tuple[Part, ...]:
    """The parts of a sentence; the template names quantities as `str.format` does: ``{steps:d}``."""
    return filled(template, lambda name, spec: _written(quantities[name], spec))


def filled(template: str, field: Callable[[str, str], Iterable[Part]]) -> tuple[Part, ...]:
    """The parts of a sentence, those of a field by its name and format specification."""
    parts: list[Part] = []
    for text, name, spec, _ in Formatter().parse(template):
        parts += [text, *(field(name, spec or "") if name is not None else ())]
    return tuple(part for part in parts if part != "")


def fields(template: str) -> list[str]:
    """The names in a template."""
    return [name for _, name, *_ in Formatter().parse(template) if name]


def _written(quantity: Cell | Quote | Span, spec: str) -> list[Part]:
    if isinstance(quantity, Cell):
        return [Quote((quantity,), spec=spec)]
    if isinstance(quantity, Quote):
        return [replace(quantity, spec=spec)]
    low, high = quantity
    return [replace(low, spec=spec), " to ", replace(high, spec=spec)]


class Ledger:
    """Looks cells up."""

    def __init__(self, read: Reader) -> None:
        self._read = read

    def __call__(self, table: str, column: str, **row: Any) -> Cell:
        """The one cell of a table in the row that matches."""
        picked = self._matching(table, row)
        if len(picked) != 1:
            raise LookupError(f"{table}: {len(picked)} rows match {row}, one is needed")
        return Cell(table, row, column, picked.iloc[0][column])

    def values(self, table: str, column: str, **row: Any) -> list[Any]:
        """What a column holds in the rows that match, sorted, each value once."""
        return sorted(self._matching(table, row)[column].dropna().unique().tolist())

    def _matching(self, table: str, row: Mapping[str, Any]) -> pd.DataFrame:
        picked = self._read(table)
        for key, value in row.items():
            picked = picked[picked[key] == value]
        return picked
