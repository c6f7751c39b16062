"""The speed targets of a folder, with the reference's values beside those of a quick run."""

from __future__ import annotations

from typing import Any

import pandas as pd

from quatspline.findings import targets
from quatspline.page.folder import Folder
from quatspline.page.reference import reference

SPEED = "speed"
VALUE = 2
"""The cell of a target's row that holds what was measured."""


def speed(folder: Folder) -> dict[str, Any]:
    """Where it was measured, one row a target with the reference's value (or nothing), and a note."""
    rows = _cells(folder.frame(SPEED))
    full = reference(folder, SPEED)
    others = [""] * len(rows) if full is None else [cells[VALUE] for cells in _cells(full)]
    beside = [other if other != row[VALUE] else "" for row, other in zip(rows, others, strict=True)]
    return {
        "where": targets.measured_on(folder.manifest),
        "rows": list(zip(rows, beside, strict=True)),
        "note": targets.ACCURACY,
    }


def _cells(table: pd.DataFrame) -> list[tuple[str, ...]]:
    return [tuple(targets.cells(each)) for each in targets.verdicts(lambda _: table)]
