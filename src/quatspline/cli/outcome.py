"""One line per table: what a run ends with."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

    from quatspline.findings.quotes import Reader


def outcomes(folder: Path, names: Iterable[str]) -> Iterator[str]:
    """For each table its first finding, or what it holds where none is drawn from it."""
    from quatspline.findings.findings import reader

    read = reader(folder)
    said = _first(read)
    for name in names:
        yield f"{name}: {said[name] if name in said else _holds(read(name))}"


def _first(read: Reader) -> dict[str, str]:
    """The first finding of each table, told by where its first number stands."""
    from quatspline.findings.findings import findings

    found = [(finding.cells, finding.text) for finding in findings(read)]
    return {cells[0].table: text for cells, text in reversed(found) if cells}


def _holds(table: pd.DataFrame) -> str:
    rows = f"{len(table)} row{'' if len(table) == 1 else 's'}"
    failed = int(table["failure"].notna().sum()) if "failure" in table else 0
    if failed:
        rows += f" ({failed} not measured)"
    if "scheme" in table:
        count = table["scheme"].nunique()
        rows += f", {count} scheme{'' if count == 1 else 's'}"
    return f"{rows}."
