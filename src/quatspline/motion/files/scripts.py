"""Lines of text formats that are made of words: each keeps its number, for what is said of it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from quatspline.motion.errors import MotionFileError
from quatspline.motion.files import opening
from quatspline.quaternion import FloatArray

Line = tuple[int, list[str]]
"""The number of a line and its words."""


def refusal(path: Path, number: int, what: object) -> MotionFileError:
    """A refusal that names the file and the line."""
    return MotionFileError(f"{path}, line {number}: {what}")


def numbers(path: Path, number: int, words: Sequence[str], count: int, what: str) -> FloatArray:
    """So many finite numbers of a line."""
    if len(words) != count:
        raise refusal(path, number, f"{what}: {count} numbers expected, found {len(words)}")
    return matrix(path, [(number, list(words))])[0]


def matrix(path: Path, rows: Sequence[Line]) -> FloatArray:
    """Rows of as many words each as finite numbers (n, k); the first that is none is refused."""
    words = [word for _, row in rows for word in row]
    width = len(rows[0][1]) if rows else 0
    try:
        table = np.array(opening.numbers(words)).reshape(len(rows), width)
    except ValueError:
        raise _no_number(path, rows) from None
    if not np.isfinite(table).all():
        row, column = np.argwhere(~np.isfinite(table))[0].tolist()
        number, told = rows[row]
        raise refusal(path, number, f"{told[column]} is not a finite number")
    return table


def _no_number(path: Path, rows: Sequence[Line]) -> MotionFileError:
    for number, words in rows:
        for word in words:
            try:
                opening.number(word)
            except ValueError:
                return refusal(path, number, f"{word!r} is not a number")
    raise AssertionError("a row without a fault was refused")
