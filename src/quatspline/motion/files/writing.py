"""Motions written as text and NPZ, whole or not at all."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TextIO

import numpy as np

from quatspline.motion.files.columns import CSV_COLUMNS, POSITION_COLUMNS, TUM_COLUMNS
from quatspline.motion.files.motion import Motion

BLOCK = 65536
"""Rows turned into text at a time: as Python numbers they take ten times their memory."""


def write_csv(to: Path | TextIO, motion: Motion) -> None:
    """Write a motion as CSV, to a path or an open text stream, with positions where it has some.

    Each number is its shortest exact decimal.
    """
    more = () if motion.positions is None else POSITION_COLUMNS
    _write_text(to, motion, (*CSV_COLUMNS, *more), "", ",")


def write_tum(to: Path | TextIO, motion: Motion) -> None:
    """Write a motion as a TUM trajectory; positions are zeros where there are none."""
    _write_text(to, motion, TUM_COLUMNS, "# ", " ")


def write_npz(path: Path, motion: Motion) -> None:
    """Write a motion as arrays ``times``, ``quaternions`` and, where it has some, ``positions``."""
    arrays: dict[str, Any] = {"times": motion.times, "quaternions": motion.quaternions}
    if motion.positions is not None:
        arrays["positions"] = motion.positions
    with path.open("wb") as stream:  # given a name, savez would add a suffix
        np.savez(stream, **arrays)


def _write_text(
    to: Path | TextIO, motion: Motion, columns: tuple[str, ...], mark: str, separator: str
) -> None:
    if isinstance(to, Path):
        with to.open("w", encoding="utf-8", newline="\n") as stream:
            _write_text(stream, motion, columns, mark, separator)
        return
    t = motion.times
    x = np.zeros((len(t), 3)) if motion.positions is None else motion.positions
    pick = [(*CSV_COLUMNS[1:], *POSITION_COLUMNS).index(name) for name in columns[1:]]
    table = np.column_stack([motion.quaternions, x])[:, pick]
    to.write(mark + separator.join(columns) + "\n")
    for block in range(0, len(t), BLOCK):
        part = slice(block, block + BLOCK)
        # The times apart: beside floats in one array, integers would become floats.
        rows = zip(t[part].tolist(), table[part].tolist(), strict=True)
        to.writelines(separator.join(map(repr, (time, *row))) + "\n" for time, row in rows)
