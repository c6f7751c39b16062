"""The reference tables beside a quick run's: what a number is when it is measured in full."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd

from quatspline.discovery import shipped
from quatspline.findings.findings import reader
from quatspline.findings.quotes import Cell, Quote
from quatspline.page.folder import Folder
from quatspline.runs.experiment import QUICK

REFERENCE = "results/reference"


def place() -> Path | None:
    """The folder of reference tables; None where they were not installed."""
    folder = shipped(REFERENCE)
    return folder if folder.is_dir() else None


def quick(folder: Folder) -> list[str]:
    """Tables of the folder that were measured at quick size."""
    sizes = folder.manifest.get("sizes", {})
    return [name for name in folder.tables if QUICK in (sizes.get(name), _noted(folder, name))]


def _noted(folder: Folder, name: str) -> str:
    """The size that a derived table says of what it was derived from."""
    if "run_size" not in folder.tables[name].columns:
        return ""
    return QUICK if folder.frame(name)["run_size"].eq(QUICK).any() else ""


def reference(folder: Folder, table: str) -> pd.DataFrame | None:
    """The reference's table, where the folder's own is of quick size."""
    where = place()
    if where is None or table not in quick(folder):
        return None
    try:
        return reader(where)(table)
    except FileNotFoundError:
        return None


class Beside:
    """What quotes of a quick run are in the reference."""

    def __init__(self, folder: Folder) -> None:
        self._quick = set(quick(folder))
        where = place() if self._quick else None
        self._read = reader(where) if where else None

    def __call__(self, quote: Quote) -> str:
        """The reference's text of a number that is another there; empty where it is the same or unknown."""
        if self._read is None or not {cell.table for cell in quote.cells} & self._quick:
            return ""
        if isinstance(quote.value, str):  # a name, or the run's own size
            return ""
        try:
            other = str(replace(quote, cells=self._cells(quote.cells)))
        except (FileNotFoundError, LookupError, ValueError):
            return ""
        return "" if other == str(quote) else other

    def _cells(self, cells: Sequence[Cell]) -> tuple[Cell, ...]:
        return tuple(replace(cell, value=self._value(cell)) for cell in cells)

    def _value(self, cell: Cell) -> Any:
        assert self._read is not None
        rows = self._read(cell.table)
        for key, value in cell.row.items():
            rows = rows[rows[key] == value]
        if len(rows) != 1 or pd.isna(rows.iloc[0][cell.column]):
            raise LookupError(cell.column)
        return rows.iloc[0][cell.column]
