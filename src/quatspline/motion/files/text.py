"""Keyframes as lines of text: rows of numbers in columns that a header names."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from quatspline.motion.files import checks, spelled
from quatspline.motion.files.checks import Faults, Rows
from quatspline.motion.files.columns import CSV_COLUMNS, POSITION_COLUMNS, Layout, layout
from quatspline.motion.files.headers import commented, is_header, laid_out
from quatspline.motion.files.lines import (
    DECIMAL_COMMA,
    MISSING,
    SEPARATORS,
    Lines,
    is_number,
    separator,
    split,
)
from quatspline.motion.files.motion import KeyframeFileError, Motion, Times
from quatspline.quaternion import FloatArray

NAMES = (*CSV_COLUMNS, *POSITION_COLUMNS)


def read_text(path: Path, columns: tuple[str, ...]) -> Motion:
    """Read a text file whose columns are as named, unless a header names others."""
    with path.open(encoding="utf-8-sig") as stream:
        return _read(Lines(path, stream), columns)


def _read(lines: Lines, columns: tuple[str, ...]) -> Motion:
    content = iter(lines)
    fields, mark = _first(lines, content)
    found, width = layout(columns), len(columns)
    header = is_header(fields)
    if header:
        found, width = laid_out(lines, fields, lines.number), len(fields)
        fields, mark = _first(lines, content)
    lines.heading = False
    named = commented(lines, width if header else len(fields), found, header)
    if named:
        found, width = named, len(fields)
    rows = _Rows(lines, mark, found, width)
    rows.append(fields)
    for line in content:
        rows.append(split(lines, line, mark, content, width))
    return rows.motion()


def _first(lines: Lines, content: Iterator[str]) -> tuple[list[str], str]:
    """The fields of the line that comes first, and what separates them."""
    line = next(content, None)
    if line is None:
        raise KeyframeFileError(f"{lines.path}: no keyframes in it")
    mark = separator(line)
    return split(lines, line, mark, content), mark


class _Rows:
    """Rows of numbers, gathered; what they hold that is no number is told at the end, counted."""

    def __init__(self, lines: Lines, mark: str, found: Layout, width: int) -> None:
        self.lines, self.mark, self.layout, self.width = lines, mark, found, width
        self.names = NAMES[: len(found.picked)]
        self.numbers = array("q")
        self.values = array("d")
        self.stamps: list[str] = []
        self.refused: dict[int, str] = {}
        self.marks: dict[str, int] = {}

    def append(self, fields: Sequence[str]) -> None:
        if len(fields) != self.width:
            raise self.lines.error(self._miscounted(fields))
        picked = [fields[i] for i in self.layout.picked]
        joined = "".join(picked)
        if "." in joined:
            self._mark(".")
        if "," in joined:
            self._mark(",")
            picked = [part.replace(",", ".") if _is_decimal(part) else part for part in picked]
        try:
            values = None if "_" in joined else list(map(float, picked))
        except ValueError:
            values = None
        self.values.extend(values or map(self._value, self.names, picked))
        self.numbers.append(self.lines.number)
        self.stamps.append(picked[0])

    def _mark(self, mark: str) -> None:
        """Refuse decimal commas and decimal points in one file."""
        number = self.marks.setdefault(mark, self.lines.number)
        if len(self.marks) > 1 and number == self.lines.number:
            raise self.lines.error("decimal commas and decimal points in one file")

    def _value(self, name: str, text: str) -> float:
        text = text.strip()
        if text.lower() in MISSING:
            return math.nan
        if is_number(text, decimal_comma=False):
            return float(text)
        self.refused.setdefault(len(self.numbers), f"{name} = {text!r} is not a number")
        return math.nan

    def _miscounted(self, fields: Sequence[str]) -> str:
        told = f"expected {self.width} fields, found {len(fields)}"
        return f"{told} (separated by {SEPARATORS[self.mark]})"

    def motion(self) -> Motion:
        table = np.frombuffer(self.values).reshape(len(self.numbers), -1)
        faults = Faults(self.lines.path, lambda row: f"line {self.numbers[row]}")
        good = checks.check_numbers(faults, self.names, table, self.refused)
        rows = np.flatnonzero(good)
        table = table[good]
        checks.check_norms(faults, rows, table[:, 1:5])
        stamps = [self.stamps[row].strip() for row in rows]
        t = self._times(stamps, table[:, 0].copy(), rows)
        checks.check_times(faults, rows, t, lambda i, j: spelled.same(stamps[i], stamps[j]))
        faults.refuse()
        x = table[:, 5:].copy() if self.layout.position else None
        return Motion(t, table[:, 1:5].copy(), x, self.layout.unread)

    def _times(self, stamps: list[str], times: FloatArray, rows: Rows) -> Times:
        try:
            return spelled.exact(stamps, times)
        except OverflowError as error:
            i = error.args[0]
            what = f"t = {stamps[i]} does not fit into 64 bits"
            raise self.lines.error(what, self.numbers[rows[i]]) from None


def _is_decimal(text: str) -> bool:
    return DECIMAL_COMMA.fullmatch(text.strip()) is not None
