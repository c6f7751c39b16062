"""Motions as lines of text: rows of numbers in columns that a header names."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from quatspline.motion.errors import MotionFileError
from quatspline.motion.files import checks, spelled
from quatspline.motion.files.checks import Faults, Rows
from quatspline.motion.files.columns import KITTI_COLUMNS, Layout, layout
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
from quatspline.motion.files.opening import numbers
from quatspline.motion.files.reading import Reading
from quatspline.motion.motion import BODY, Motion, Times
from quatspline.quaternion import FloatArray


def read_text(path: Path, reading: Reading, columns: tuple[str, ...], unit: str) -> Motion:
    """Read a text file whose columns are as named, unless a header names others.

    Rows of twelve numbers without a header are KITTI's poses.
    """
    with path.open(encoding="utf-8-sig") as stream:
        return _read(Lines(path, stream), reading, columns, unit)


def _read(lines: Lines, reading: Reading, columns: tuple[str, ...], unit: str) -> Motion:
    content = iter(lines)
    fields, mark = _first(lines, content)
    header = is_header(fields)
    if not header and len(fields) == len(KITTI_COLUMNS):
        columns, unit = KITTI_COLUMNS, "m"
    found, width = layout(columns), len(columns)
    if header:
        found, width = laid_out(lines, fields, lines.number), len(fields)
        fields, mark = _first(lines, content)
    lines.heading = False
    named = commented(lines, width if header else len(fields), found, header)
    if named:
        found, width = named, len(fields)
    rows = _Rows(lines, reading, mark, found, width, unit)
    rows.append(fields)
    for line in content:
        rows.append(split(lines, line, mark, content, width))
    return rows.motion()


def _first(lines: Lines, content: Iterator[str]) -> tuple[list[str], str]:
    """The fields of the line that comes first, and what separates them."""
    line = next(content, None)
    if line is None:
        raise MotionFileError(f"{lines.path}: no keyframes in it")
    mark = separator(line)
    return split(lines, line, mark, content), mark


NANO = 10**9
"""Stamps in a second where they are nanoseconds, which are whole."""


class _Rows:
    """Rows of numbers, gathered; what they hold that is no number is told at the end, counted."""

    def __init__(
        self, lines: Lines, reading: Reading, mark: str, found: Layout, width: int, unit: str
    ) -> None:
        self.lines, self.reading, self.mark, self.layout = lines, reading, mark, found
        self.width, self.unit, self.names = width, unit, found.names
        self.numbers = array("q")
        self.values = array("d")
        self.stamps: list[str] = []
        self.tracks: list[str] = []
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
            values = numbers(picked)
        except ValueError:
            values = None
        self.values.extend(values or map(self._value, self.names, picked))
        self.numbers.append(self.lines.number)
        self.stamps.append(picked[0])
        if self.layout.track is not None:
            self.tracks.append(fields[self.layout.track].strip())

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
        """The motion of all rows, checked."""
        table = np.frombuffer(self.values).reshape(len(self.numbers), -1)
        faults = Faults(self.lines.path, lambda row: f"line {self.numbers[row]}")
        good = checks.check_numbers(faults, self.names, table, self.refused, self.reading.missing)
        rows = np.flatnonzero(good)
        if self.layout.time is not None:
            self.reading.check_use(self.lines.path, ("duplicates", "missing"))
        begin = 0 if self.layout.time is None else 1
        end = begin + len(self.layout.orientation)
        self.layout.form.check(faults, rows, table[good, begin:end])
        tracks = {name: rows[own] for name, own in self._by_track(rows).items()}
        timed = [self._timed(faults, own, table) for own in tracks.values()]
        faults.refuse()
        t = self._common([t for t, _ in timed], list(tracks))
        parts = [
            (table[own], first) for own, (_, first) in zip(tracks.values(), timed, strict=True)
        ]
        how = self.reading.duplicates
        form = self.layout.form
        q = [checks.combined(how, form.quaternions(part[:, begin:end]), i) for part, i in parts]
        x = [checks.combined(how, part[:, end:], i) for part, i in parts]
        return Motion(
            t,
            np.stack(q, axis=1),
            np.stack(x, axis=1) if self.layout.position else None,
            list(tracks),
            unit=self.unit,
            per_second=self.layout.per_second,
            unread=self.layout.unread,
        )

    def _by_track(self, rows: Rows) -> dict[str, Rows]:
        """Which of the rows are of which track, by its name."""
        if self.layout.track is None:
            return {BODY[0]: np.arange(len(rows))}
        names = np.array(self.tracks)[rows]
        return {name: np.flatnonzero(names == name) for name in dict.fromkeys(names.tolist())}

    def _timed(self, faults: Faults, rows: Rows, table: FloatArray) -> tuple[Times, Rows]:
        """Stamps of a track, each once, and the rows that begin with them."""
        if self.layout.time is None:
            return self.reading.frame_times(self.lines.path, len(rows), None), np.arange(len(rows))
        stamps = [self.stamps[row].strip() for row in rows]
        t = self._times(stamps, table[rows, 0].copy(), rows)

        def same(i: int, j: int) -> bool:
            return spelled.same(stamps[i], stamps[j])

        if self.layout.per_second == NANO:
            broken = rows[t != np.floor(t)]
            faults.add(broken, lambda row: f"t = {self.stamps[row]} is no whole nanosecond")
        first = checks.distinct(self.reading.duplicates, t, same)
        stamps = [stamps[i] for i in first.tolist()]
        checks.check_times(faults, rows[first], t[first], same)
        return t[first], first

    def _common(self, times: list[Times], tracks: list[str]) -> Times:
        """The stamps of all tracks, which must be the same."""
        if not times:
            raise MotionFileError(f"{self.lines.path}: no keyframes in it")
        for name, t in zip(tracks, times, strict=True):
            if not np.array_equal(t, times[0]):
                what = f"{name!r} has other stamps than {tracks[0]!r}"
                raise MotionFileError(f"{self.lines.path}: {what}: one motion has one set of them")
        return times[0]

    def _times(self, stamps: list[str], times: FloatArray, rows: Rows) -> Times:
        try:
            return spelled.exact(stamps, times)
        except OverflowError as error:
            i = error.args[0]
            what = f"t = {stamps[i]} does not fit into 64 bits"
            raise self.lines.error(what, self.numbers[rows[i]]) from None


def _is_decimal(text: str) -> bool:
    return DECIMAL_COMMA.fullmatch(text.strip()) is not None
