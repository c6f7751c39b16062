"""Motions written as text and NPZ, whole or not at all."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal
from itertools import pairwise
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from quatspline.motion.files.columns import (
    CSV_COLUMNS,
    EUROC_COLUMNS,
    POSITION_COLUMNS,
    TUM_COLUMNS,
)
from quatspline.motion.motion import BODY, Motion
from quatspline.motion.skeleton import Skeleton
from quatspline.quaternion import FloatArray

BLOCK = 65536
"""Rows turned into text at a time: as Python numbers they take ten times their memory."""

STAMPS = {1: "t", 10**3: "timestamp_ms", 10**6: "timestamp_us", 10**9: "timestamp_ns"}
"""What a CSV calls its column of times, by the number of its units in a second."""

NANO = 10**9


def write_csv(to: Path | TextIO, motion: Motion) -> None:
    """Write a motion as CSV, to a path or an open text stream, with positions where it has some.

    Each number is its shortest exact decimal.  Several tracks stand one below another at each time,
    by name.
    """
    columns = [STAMPS[motion.per_second], *CSV_COLUMNS[1:]]
    columns += [] if motion.positions is None else POSITION_COLUMNS
    if list(motion.tracks) == list(BODY):
        rows = _rows(motion.stamps, _table(motion, columns)[:, 0])
    else:
        columns.insert(1, "track")
        rows = _track_rows(motion, _table(motion, [STAMPS[1], *columns[2:]]))
    _write(to, ",".join(columns), (",".join(row) for row in rows))


def write_track_rows(path: Path, motion: Motion, frames: Mapping[str, NDArray[np.intp]]) -> None:
    """Write some frames of each track as CSV, track by track."""
    header = ",".join([STAMPS[motion.per_second], "track", "frame", *CSV_COLUMNS[1:]])
    stamps = motion.stamps.tolist()

    def rows() -> Iterator[str]:
        for k, name in enumerate(motion.tracks):
            index = frames[name].tolist()
            for frame, q in zip(index, motion.quaternions[index, k].tolist(), strict=True):
                yield ",".join([repr(stamps[frame]), _quoted(name), str(frame), *map(repr, q)])

    _write(path, header, rows())


def write_tum(to: Path | TextIO, motion: Motion) -> None:
    """Write a body's motion as a TUM trajectory, in seconds; positions are zeros where there are none."""
    _check_one(motion)
    rows = _rows(_seconds(motion), _table(motion, TUM_COLUMNS)[:, 0])
    _write(to, f"# {' '.join(TUM_COLUMNS)}", map(" ".join, rows))


def write_euroc(to: Path | TextIO, motion: Motion) -> None:
    """Write a body's motion as EuRoC has it: whole nanoseconds, position, quaternion, w first."""
    _check_one(motion)
    table = _table(motion, ("t", *POSITION_COLUMNS, *CSV_COLUMNS[1:]))[:, 0]
    rows = _rows(_nanoseconds(motion), table)
    _write(to, f"#{','.join(EUROC_COLUMNS)}", map(",".join, rows))


def write_npz(path: Path, motion: Motion) -> None:
    """Write a motion as arrays: ``times``, ``quaternions`` and what else it has."""
    q, x = motion.quaternions, motion.positions
    alone = list(motion.tracks) == list(BODY)
    arrays: dict[str, Any] = {"times": motion.stamps, "quaternions": q[:, 0] if alone else q}
    if x is not None:
        arrays["positions"] = x[:, 0] if alone else x
    if not alone:
        arrays["tracks"] = np.array(list(motion.tracks))
    if motion.unit != "file":
        arrays["unit"] = np.array(motion.unit)
    if motion.per_second != 1:
        arrays["per_second"] = np.array(motion.per_second)
    if motion.interpolation is not None:
        arrays["interpolation"] = np.array(motion.interpolation)
    for name in ("in_tangents", "out_tangents"):
        if getattr(motion, name) is not None:
            arrays[name] = getattr(motion, name)
    if motion.skeleton is not None:
        arrays |= _bones(motion.skeleton)
    with path.open("wb") as stream:  # given a name, savez would add a suffix
        np.savez(stream, **arrays)


def _bones(skeleton: Skeleton) -> dict[str, Any]:
    arrays: dict[str, Any] = {
        "parents": skeleton.parents,
        "offsets": skeleton.offsets,
        "orders": np.array(skeleton.orders, dtype=str),
        "end_joints": np.array(list(skeleton.ends), dtype=np.int64),
        "ends": np.array(list(skeleton.ends.values()), dtype=float).reshape(-1, 3),
    }
    if skeleton.mounts is not None:
        arrays |= {"mount_turns": skeleton.mounts.turns, "mount_places": skeleton.mounts.places}
    return arrays


def _check_one(motion: Motion) -> None:
    if len(motion.tracks) != 1:
        names = ", ".join(motion.tracks[:3])
        raise ValueError(f"holds one body, not {len(motion.tracks)} tracks ({names}, ...)")


# -- times ----------------------------------------------------------------------------------------


def _seconds(motion: Motion) -> Any:
    """Stamps in seconds: exact decimals where units are finer."""
    if motion.per_second == 1:
        return motion.stamps
    return [_plain(Decimal(repr(t)) / motion.per_second) for t in motion.stamps.tolist()]


def _plain(number: Decimal) -> str:
    return f"{number:f}"


def _nanoseconds(motion: Motion) -> list[int]:
    scale = NANO // motion.per_second
    whole = [int((Decimal(repr(t)) * scale).to_integral_value()) for t in motion.stamps.tolist()]
    if any(b <= a for a, b in pairwise(whole)):
        raise ValueError("frames are less than a nanosecond apart")
    return whole


# -- rows -----------------------------------------------------------------------------------------


def _table(motion: Motion, columns: Iterable[str]) -> FloatArray:
    """Numbers (n, J, columns less the time)."""
    n, tracks = len(motion.stamps), len(motion.tracks)
    x = np.zeros((n, tracks, 3)) if motion.positions is None else motion.positions
    names = (*CSV_COLUMNS[1:], *POSITION_COLUMNS)
    pick = [names.index(name) for name in list(columns)[1:]]
    return np.concatenate([motion.quaternions, x], axis=-1)[..., pick]


def _rows(stamps: Any, table: FloatArray) -> Iterator[list[str]]:
    """Rows of text.  The times apart: beside floats in one array, integers would become floats."""
    for block in range(0, len(table), BLOCK):
        part = slice(block, block + BLOCK)
        times = stamps[part] if isinstance(stamps, list) else stamps[part].tolist()
        for time, row in zip(times, table[part].tolist(), strict=True):
            yield [time if isinstance(time, str) else repr(time), *map(repr, row)]


def _track_rows(motion: Motion, table: FloatArray) -> Iterator[list[str]]:
    names = [_quoted(name) for name in motion.tracks]
    for time, frame in zip(motion.stamps.tolist(), table.tolist(), strict=True):
        for name, row in zip(names, frame, strict=True):
            yield [repr(time), name, *map(repr, row)]


def _quoted(name: str) -> str:
    """A name as CSV has it."""
    return '"' + name.replace('"', '""') + '"' if any(mark in name for mark in ',"#\n\r') else name


def _write(to: Path | TextIO, header: str, lines: Iterable[str]) -> None:
    if isinstance(to, Path):
        with to.open("w", encoding="utf-8", newline="\n") as stream:
            _write(stream, header, lines)
        return
    to.write(f"{header}\n")
    to.writelines(f"{line}\n" for line in lines)
