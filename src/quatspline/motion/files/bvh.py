"""Biovision's BVH: a hierarchy of joints with their channels, and a line of numbers for every frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from quatspline import quaternion
from quatspline.motion import euler
from quatspline.motion.errors import warn
from quatspline.motion.files import opening
from quatspline.motion.files.bvh_tree import Tree, tree
from quatspline.motion.files.opening import is_whole, lines_of
from quatspline.motion.files.reading import Reading
from quatspline.motion.files.scripts import Line, matrix, refusal
from quatspline.motion.motion import Motion
from quatspline.motion.skeleton import Skeleton
from quatspline.quaternion import FloatArray

NOMINAL = (*range(1, 2001), *(n * 1000 / 1001 for n in (24, 30, 48, 60, 120, 240)))
"""Rates (Hz) whose periods are printed rounded: whole ones, and those of television."""

ROUNDED = 0.002
"""A printed period tells a nominal rate where half its last digit is less than this share of it."""

LEAP, LEAST = 10.0, 1.0
"""A joint's first step over this many times its largest other, and over a degree, is from an added pose."""


def read_bvh(path: Path, reading: Reading) -> Motion:
    """Read a BVH: positions replace offsets, turns are intrinsic in the order of their channels."""
    lines = lines_of(path)
    start = _start_of_motion(path, lines)
    hierarchy = tree(path, lines[: start - 1])
    count, period, first = _announced(path, lines, start)
    rows = [
        (i + 1, words) for i, line in enumerate(lines[first:], first) if (words := line.split())
    ]
    _check_rows(path, rows, count, len(hierarchy.columns))
    table = matrix(path, rows) if hierarchy.columns else np.zeros((count, 0))
    times = reading.frame_times(path, count, nominal_rate(period))
    q, x = _local(hierarchy, table)
    if not reading.skip:
        _tell_leap(path, hierarchy.names, q, reading.named("skip", 1))
    skeleton = Skeleton(
        np.array(hierarchy.parents, dtype=np.int64),
        np.array(hierarchy.offsets),
        tuple(hierarchy.orders),
        hierarchy.ends,
    )
    return Motion(times, q, x, hierarchy.names, skeleton)


def nominal_rate(printed: str) -> float:
    """The rate (Hz) of a printed frame time: the nominal one whose period it rounds or truncates.

    >>> nominal_rate(".0083333"), round(nominal_rate("0.016683"), 4), nominal_rate("0.01")
    (120.0, 59.9401, 100.0)
    """
    period = float(printed)
    mantissa, _, exponent = printed.lower().partition("e")
    digit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    if 0.5 * digit < ROUNDED * period:
        for rate in NOMINAL:
            off = 1.0 / rate - period
            slack = 1e-9 * digit
            if abs(off) <= 0.5 * digit + slack or -slack <= off < digit - slack:
                return float(rate)
    return 1.0 / period


def _start_of_motion(path: Path, lines: Sequence[str]) -> int:
    """The number of the line MOTION."""
    for number, line in enumerate(lines, 1):
        if line.strip().upper() == "MOTION":
            return number
    raise refusal(path, len(lines), "no line MOTION: the file ends within the hierarchy")


def _announced(path: Path, lines: Sequence[str], start: int) -> tuple[int, str, int]:
    """The number of frames, the frame time as printed, and the index of the line that follows."""
    told: list[Line] = []
    for i, line in enumerate(lines[start:], start):
        if line.strip():
            told.append((i + 1, line.replace(":", ": ").split()))
        if len(told) == 2:
            break
    (at, frames), (number, time) = (*told, (len(lines), []), (len(lines), []))[:2]
    if [word.upper() for word in frames[:-1]] != ["FRAMES:"] or not is_whole(frames[-1]):
        raise refusal(path, at, "'Frames:' and a whole number are expected")
    if [word.upper() for word in time[:-1]] != ["FRAME", "TIME:"] or not _is_period(time[-1]):
        raise refusal(path, number, "'Frame Time:' and a positive number are expected")
    count = int(frames[-1]) if len(frames[-1]) < 10 else 0
    if not count:
        raise refusal(path, at, f"{frames[-1][:20]} frames cannot be read")
    return count, time[-1], number


def _is_period(word: str) -> bool:
    try:
        period = opening.number(word)
    except ValueError:
        return False
    return math.isfinite(1.0 / period if period > 0.0 else math.inf)


def _check_rows(path: Path, rows: Sequence[Line], count: int, width: int) -> None:
    """Refuse a line with another number of values than channels, then another number of frames."""
    if not width:
        return
    for number, words in rows:
        if len(words) != width:
            raise refusal(path, number, f"{width} values expected, found {len(words)}")
    if len(rows) != count:
        last = rows[-1][0] if rows else 0
        raise refusal(path, last, f"{count} frames are announced, and {len(rows)} follow")


def _local(hierarchy: Tree, table: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Local quaternions (n, J, 4) and positions (n, J, 3) of values (n, channels)."""
    n, tracks = len(table), len(hierarchy.names)
    q = np.empty((n, tracks, 4))
    x = np.tile(np.array(hierarchy.offsets), (n, 1, 1))
    turns: list[list[int]] = [[] for _ in range(tracks)]
    for column, (joint, axis, turning) in enumerate(hierarchy.columns):
        if turning:
            turns[joint].append(column)
        else:
            x[:, joint, axis] = table[:, column]
    angles = np.radians(table)
    for joint, (columns, order) in enumerate(zip(turns, hierarchy.orders, strict=True)):
        q[:, joint] = euler.from_angles(angles[:, columns], order)
    return q, x


def _tell_leap(path: Path, names: Sequence[str], q: FloatArray, remedy: str) -> None:
    """Warn of a first frame that does not belong to the motion."""
    if len(q) < 3:
        return
    steps = np.degrees(quaternion.distance(q[1:], q[:-1]))
    leaps = (steps[0] > LEAP * steps[1:].max(axis=0)) & (steps[0] > LEAST)
    if leaps.any():
        joint = int(np.argmax(np.where(leaps, steps[0], 0.0)))
        turned = f"joint {names[joint]!r} turns {steps[0, joint]:.1f} degrees in the first step"
        warn(path, f"{turned}, over ten times any other: {remedy} leaves out a pose that was added")
