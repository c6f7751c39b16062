"""Keyframe files: CSV, TUM and NPZ; every line checked on reading, written whole or not at all."""

from __future__ import annotations

import math
import zipfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from quatspline.atomic import replacing
from quatspline.keyframes import NORM_TOLERANCE, prepare
from quatspline.options import nearest
from quatspline.quaternion import FloatArray

CSV_COLUMNS = ("t", "qw", "qx", "qy", "qz")
TUM_COLUMNS = ("t", "tx", "ty", "tz", "qx", "qy", "qz", "qw")
NPZ_ARRAYS = ("times", "quaternions")

REPEATED = 1e-6
"""A last orientation this near the first, up to sign, is the return of a closed motion."""

BLOCK = 65536
"""Rows turned into text at a time: as Python numbers they take ten times their memory."""


class KeyframeFileError(ValueError):
    """A keyframe file that cannot be read or written; the message names the file and the line."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Timed orientations, with positions where the file had them.

    Attributes
    ----------
    times : (n,), strictly increasing; (n + 1,) where the last is a closed motion's return
    quaternions : (n, 4), scalar first, as given: unit within `keyframes.NORM_TOLERANCE`
    positions : (len(times), 3), or None
    """

    times: FloatArray
    quaternions: FloatArray
    positions: FloatArray | None = None

    def sampled(self, times: FloatArray, quaternions: FloatArray) -> Motion:
        """Samples (m,), (m, 4) of a curve through this motion; positions follow linearly."""
        if self.positions is None:
            return Motion(times, quaternions)
        t, knots = times - self.times[0], self.times - self.times[0]
        columns = [np.interp(t, knots, column) for column in self.positions.T]
        return Motion(times, quaternions, np.stack(columns, axis=1))

    def returning(self) -> Motion:
        """This motion closed: n keyframes and n + 1 times.

        The last row is the return where it repeats the first orientation; otherwise uniform times
        go on for one more step.  Raises ValueError when neither tells the time of the return.
        """
        q, t, x = self.quaternions, self.times, self.positions
        if len(t) == len(q) + 1 or len(t) < 2:
            return self
        if min(np.abs(q[-1] - q[0]).max(), np.abs(q[-1] + q[0]).max()) < REPEATED:
            return Motion(t, q[:-1], x)
        if not prepare(t, q).uniform:
            raise ValueError(
                "closed: times are not uniform, so the last row must repeat the first orientation "
                "at the time of its return"
            )
        end = t[0] + (t[-1] - t[0]) * (len(t) / (len(t) - 1))
        return Motion(np.append(t, end), q, None if x is None else np.concatenate([x, x[:1]]))


Reader = Callable[[Path], Motion]
Writer = Callable[[Path, Motion], None]


def read(path: str | Path) -> Motion:
    """Read keyframes: .csv, .tum or .txt (TUM), .npz.

    CSV holds ``t,qw,qx,qy,qz``, or names its columns in a header, in any order, among others; TUM
    holds ``t tx ty tz qx qy qz qw``; lines that begin with # are comments.  NPZ holds ``times`` and
    ``quaternions``.

    Raises
    ------
    KeyframeFileError
        A `ValueError` of one sentence that names the file and the first line (NPZ: row) at fault.
    """
    path = Path(path)
    reader, _ = _format(path)
    try:
        return reader(path)
    except OSError as error:
        raise KeyframeFileError(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise KeyframeFileError(f"{path}: not a text file in UTF-8") from None


def write(path: str | Path, motion: Motion) -> None:
    """Write a motion in the format of the suffix, at full precision, whole or not at all.

    TUM carries the positions, zeros where there are none; CSV and NPZ leave them out.  Raises
    KeyframeFileError for an unknown suffix and for a file that cannot be written.
    """
    path = Path(path)
    _, writer = _format(path)
    try:
        with replacing(path) as aside:
            writer(aside, motion)
    except OSError as error:
        raise KeyframeFileError(f"{path}: cannot be written: {error.strerror or error}") from None


def write_csv(stream: TextIO, motion: Motion) -> None:
    """Write a motion as CSV to an open text stream; each number as its shortest exact decimal."""
    _write_rows(stream, motion, CSV_COLUMNS, "", ",")


def check_suffix(path: str | Path) -> None:
    """Refuse a name whose suffix no format has, before any work is done."""
    _format(Path(path))


def _format(path: Path) -> tuple[Reader, Writer]:
    suffix = path.suffix.lower()
    if suffix not in _FORMATS:
        raise KeyframeFileError(f"{path}: unknown suffix {suffix!r}: {nearest(suffix, _FORMATS)}")
    return _FORMATS[suffix]


# -- reading ------------------------------------------------------------------------------------


def _read_text(path: Path, columns: tuple[str, ...], separator: str | None) -> Motion:
    rows: list[list[float]] = []
    pick, width, first = list(range(len(columns))), len(columns), True
    for where, line in _lines(path):
        fields = [part.strip().strip('"') for part in line.split(separator)]
        if first and separator and _is_header(fields):
            pick, width = _picked(where, fields, columns), len(fields)
        elif len(fields) != width:
            raise KeyframeFileError(f"{where}: expected {width} fields, found {len(fields)}")
        else:
            _append(rows, where, columns, [fields[i] for i in pick])
        first = False
    return _motion(path, rows, columns)


def _read_npz(path: Path) -> Motion:
    times, q = _arrays(path)
    rows: list[list[float]] = []
    # A closed motion has one time more: the last keyframe stands in for the one that returns.
    padded = np.concatenate([q, q[-1:]]) if len(times) > len(q) else q
    for i, (t, row) in enumerate(zip(times.tolist(), padded.tolist(), strict=False)):
        _append(rows, f"{path}, row {i}", CSV_COLUMNS, (t, *row))
    motion = _motion(path, rows, CSV_COLUMNS)
    return Motion(motion.times, motion.quaternions[: len(q)])


def _arrays(path: Path) -> tuple[FloatArray, FloatArray]:
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as arrays:
            missing = [name for name in NPZ_ARRAYS if name not in arrays.files]
            if missing:
                hint = nearest(missing[0], arrays.files)
                raise KeyframeFileError(f"{path}: no array {missing[0]!r}: {hint}")
            times, q = (np.asarray(arrays[name]) for name in NPZ_ARRAYS)
    except KeyframeFileError:
        raise
    except (ValueError, TypeError, AttributeError, EOFError, zipfile.BadZipFile):
        raise KeyframeFileError(f"{path}: not an NPZ file of plain arrays") from None
    if times.dtype.kind not in "iuf" or q.dtype.kind not in "iuf":
        raise KeyframeFileError(
            f"{path}: times ({times.dtype}), quaternions ({q.dtype}): not numbers"
        )
    if q.shape[1:] != (4,) or times.ndim != 1 or len(times) - len(q) not in (0, 1):
        shapes = f"times {times.shape}, quaternions {q.shape}"
        raise KeyframeFileError(f"{path}: {shapes}: expected (n,) and (n, 4)")
    return times.astype(float), q.astype(float)


def _append(
    rows: list[list[float]], where: str, columns: tuple[str, ...], fields: Sequence[Any]
) -> None:
    """Check a row by itself and against the one before."""
    row = [_number(where, *pair) for pair in zip(columns, fields, strict=True)]
    norm = math.hypot(*(row[columns.index(name)] for name in CSV_COLUMNS[1:]))
    if abs(norm - 1.0) > NORM_TOLERANCE:
        what = f"quaternion has norm {norm:.6g}, not 1 (within {NORM_TOLERANCE:g})"
        raise KeyframeFileError(f"{where}: {what}")
    if rows and row[0] <= rows[-1][0]:
        raise KeyframeFileError(
            f"{where}: t = {row[0]!r} does not exceed {rows[-1][0]!r} before it"
        )
    rows.append(row)


def _number(where: str, name: str, given: Any) -> float:
    if not _is_number(given):
        raise KeyframeFileError(f"{where}: {name} = {given!r} is not a number")
    if not math.isfinite(float(given)):
        raise KeyframeFileError(f"{where}: {name} = {given} is not a finite number")
    return float(given)


def _is_number(given: Any) -> bool:
    try:
        float(given)
    except ValueError:
        return False
    return "_" not in str(given)  # float() also takes the underscores of Python's literals


def _motion(path: Path, rows: list[list[float]], columns: tuple[str, ...]) -> Motion:
    if not rows:
        raise KeyframeFileError(f"{path}: no keyframes in it")
    named = dict(zip(columns, np.array(rows).T, strict=True))
    q = np.stack([named[name] for name in CSV_COLUMNS[1:]], axis=1)
    x = np.stack([named[name] for name in ("tx", "ty", "tz")], axis=1) if "tx" in named else None
    return Motion(named["t"].copy(), q, x)


def _lines(path: Path) -> Iterator[tuple[str, str]]:
    """Lines that are neither blank nor comments, each with where it stands."""
    with path.open(encoding="utf-8-sig") as stream:
        for number, line in enumerate(stream, 1):
            if line.strip() and not line.lstrip().startswith("#"):
                yield f"{path}, line {number}", line


def _is_header(fields: list[str]) -> bool:
    """Whether a first line names a known column, or has no number in it."""
    return any(text.lower() in CSV_COLUMNS for text in fields) or not any(map(_is_number, fields))


def _picked(where: str, fields: list[str], columns: tuple[str, ...]) -> list[int]:
    """Where a header has the columns that count."""
    names = [text.lower() for text in fields]
    for name in columns:
        if names.count(name) != 1:
            what = "two columns" if name in names else "no column"
            hint = "" if name in names else f": {nearest(name, names)}"
            raise KeyframeFileError(f"{where}: {what} {name!r} in the header{hint}")
    return [names.index(name) for name in columns]


# -- writing ------------------------------------------------------------------------------------


def _write_rows(
    stream: TextIO, motion: Motion, columns: tuple[str, ...], mark: str, separator: str
) -> None:
    x = np.zeros((len(motion.times), 3)) if motion.positions is None else motion.positions
    table = np.column_stack([motion.times, motion.quaternions, x])
    pick = [(*CSV_COLUMNS, "tx", "ty", "tz").index(name) for name in columns]
    stream.write(mark + separator.join(columns) + "\n")
    for block in range(0, len(table), BLOCK):
        rows = table[block : block + BLOCK, pick].tolist()
        stream.writelines(separator.join(map(repr, row)) + "\n" for row in rows)


def _write_npz(path: Path, motion: Motion) -> None:
    with path.open("wb") as stream:  # given a name, savez would add a suffix
        np.savez(stream, times=motion.times, quaternions=motion.quaternions)


def _text(columns: tuple[str, ...], mark: str, separator: str) -> tuple[Reader, Writer]:
    def write_text(path: Path, motion: Motion) -> None:
        with path.open("w", encoding="utf-8", newline="\n") as stream:
            _write_rows(stream, motion, columns, mark, separator)

    # str.split takes runs of blanks as one separator when given None.
    return partial(_read_text, columns=columns, separator=separator.strip() or None), write_text


_TUM = _text(TUM_COLUMNS, "# ", " ")
_FORMATS: dict[str, tuple[Reader, Writer]] = {
    ".csv": _text(CSV_COLUMNS, "", ","),
    ".tum": _TUM,
    ".txt": _TUM,
    ".npz": (_read_npz, _write_npz),
}
