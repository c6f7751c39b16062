"""Warnings about keyframes: what a user has to know about them before any scheme is advised, with its numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np
import pandas as pd

from quatspline import quaternion
from quatspline.catalogue import called
from quatspline.findings.candidates import direct, rank, smooth, still, usable
from quatspline.findings.findings import Finding
from quatspline.findings.needs import Needs, significant
from quatspline.findings.questions import Table
from quatspline.findings.quotes import Part, Quote, multiple
from quatspline.findings.recommendation import take
from quatspline.instruments.excursion import HOLD
from quatspline.instruments.own_keyframes import steps
from quatspline.instruments.trials import Row, records
from quatspline.keyframes import Keyframes
from quatspline.motion.closing import REPEATED, nearly
from quatspline.motion.summary import GAP
from quatspline.quaternion import FloatArray

Pair = Callable[[int], str]
"""The keyframes of a segment in words."""

WARNING = "warning"
KNOWN = "slerp"
"""What readers compare with: it stands still where keyframes do."""

WIDE, AMBIGUOUS = 120.0, 1.0
"""Degrees from which on a step is wide, and those within which it is half a turn."""
ROUNDING = 1e-6
"""Degrees within which half a turn is exactly that."""
CROWDED = 0.01
"""A spacing below this share of the median: two keyframes at almost the same time."""
COPIES, ENOUGH = 0.2, 20
"""The share of steps from which on holds are repeated samples, and the steps that tell."""
LISTED = 4
"""Steps that a sentence names."""

LOOP = 4
"""Keyframes of the least motion that goes round: three, and the return."""
APART = 10.0
"""The ends agree where the motion went this many times as far away."""

COARSE, FINE = 1e4, 1e6
"""Median spacings from which on times count microseconds, or nanoseconds: in seconds they would be hours apart."""
CLOCKS = {"microseconds": ("us", 1e6), "nanoseconds": ("ns", 1e9)}


def cautions(
    keyframes: Keyframes, frame: pd.DataFrame, *, second: float = 1.0, told: bool = False
) -> list[Finding]:
    """Warnings about the keyframes of a table of `quatspline.compare`, each with its numbers.

    Parameters
    ----------
    second : units of the times in a second
    told : whether that is known, from the file or from its user
    """
    angles, h = np.degrees(steps(keyframes)), keyframes.spacings / second
    pair = partial(_pair, keyframes, second)
    said = [
        *([] if told else _clock(keyframes)),
        *_crowded(h, pair),
        *_gaps(h, angles, pair),
        *_holds(angles, pair, frame),
        *_half_turns(angles, pair),
        *_wide(angles, pair),
        *_closing(keyframes, angles, second),
        *_noise(frame),
    ]
    return [Finding(WARNING, ("Warning: ", *parts)) for parts in said]


# -- times ----------------------------------------------------------------------------------------


def _clock(keyframes: Keyframes) -> Iterator[list[Part]]:
    """Times that hardly count seconds."""
    since, spacing = keyframes.knots, float(np.median(keyframes.spacings))
    if keyframes.count > 2 and np.array_equal(since, np.arange(since.size)):
        yield [
            f"the times count 0, 1, 2 ... {since[-1]:.0f} as frame numbers do, and are taken for seconds. If they are "
            'frames, say how long one lasts, as in --time-unit "1/30 s".'
        ]
    elif spacing >= COARSE and np.array_equal(since, np.round(since)):
        name = "nanoseconds" if spacing >= FINE else "microseconds"
        short, count = CLOCKS[name]
        yield [
            f"the times are {significant(spacing)} apart (median) as {name} are at {significant(count / spacing)} Hz, "
            f"and are taken for seconds. If they are {name}, say --time-unit {short}."
        ]


def _crowded(h: FloatArray, pair: Pair) -> Iterator[list[Part]]:
    close = np.flatnonzero(h < CROWDED * np.median(h))
    if close.size:
        k = int(close[h[close].argmin()])
        yield [
            f"{pair(k)} are almost duplicates, {significant(float(h[k]))} s apart where the median "
            f"spacing is {significant(float(np.median(h)))} s{_others(close.size, 'such pair')}: whatever "
            "turns between them turns at once."
        ]


def _gaps(h: FloatArray, angles: FloatArray, pair: Pair) -> Iterator[list[Part]]:
    median = float(np.median(h))
    wide = np.flatnonzero((h > GAP * median) & (np.radians(angles) >= HOLD))  # a hold may last
    if wide.size:
        k = int(wide[h[wide].argmax()])
        yield [
            f"a gap of {significant(float(h[k]))} s between {pair(k)}, "
            f"{significant(h[k] / median)} times the median spacing{_others(wide.size, 'gap')}: what a curve does "
            "there is its own invention."
        ]


# -- orientations ---------------------------------------------------------------------------------


def _holds(angles: FloatArray, pair: Pair, frame: pd.DataFrame) -> Iterator[list[Part]]:
    """Equal neighbours, and what schemes do between them."""
    still = np.flatnonzero(np.radians(angles) < HOLD)
    if not still.size or still.size == angles.size:
        return
    if still.size >= COPIES * angles.size and angles.size >= ENOUGH:
        yield [
            f"{still.size} of {angles.size} steps do not turn at all, as where samples are repeated: leave the copies "
            "out, or every curve stops and starts at each."
        ]
        return
    head = f"{pair(int(still[0]))} are equal{_others(still.size, 'hold')}"
    yield [f"{head}: while they stand still, ", *_told(_holding(frame)), "."]


def _holding(frame: pd.DataFrame) -> list[tuple[Row, Quote]]:
    """What schemes turn during holds: the one to take if these did not count, the calmest, and a known one."""
    table = Table("compare", frame, frame)
    usual = table.asked((each for each in take(Needs()) if each not in (still, direct)), rank)
    calm = table.asked((usable, smooth), lambda row: (row["hold_rotation"], rank(row)))
    known = table.asked((lambda rows, _: (rows["scheme"] == KNOWN) & rows["failure"].isna(),))
    rows = [row for found in (usual, calm, known) for row in records(found.rows[:1])]
    once = {row["scheme"]: row for row in rows}.values()
    return [(row, multiple(table.cell("hold_rotation", row))) for row in once]


def _told(turns: Sequence[tuple[Row, Quote]]) -> list[Part]:
    parts: list[Part] = []
    for row, angle in turns:
        verb = " turns up to " if not parts else " "
        parts += [", " if parts else "", called(row["scheme"]), verb, angle]
        parts += [" degrees away" if len(parts) < 5 else ""]
    return parts or ["no scheme measured tells how far curves turn"]


def _half_turns(angles: FloatArray, pair: Pair) -> Iterator[list[Part]]:
    half = np.flatnonzero(angles > 180.0 - AMBIGUOUS)
    if half.size:
        k = int(half[angles[half].argmax()])
        left = 180.0 - float(angles[k])
        told = "exactly half a turn, so that rounding decides which way round it goes"
        if left > ROUNDING:
            more = significant(left)
            told = f"{angles[k]:.4g} degrees: {more} more, and it goes the other way round"
        yield [
            f"the step between {pair(k)} is {told}{_others(half.size, 'such step')}. A keyframe between them would "
            "settle which way is meant."
        ]


def _wide(angles: FloatArray, pair: Pair) -> Iterator[list[Part]]:
    wide = np.flatnonzero((angles > WIDE) & (angles <= 180.0 - AMBIGUOUS))
    if wide.size:
        k = int(wide[angles[wide].argmax()])
        yield [
            f"the step between {pair(k)} is {significant(float(angles[k]))} degrees"
            f"{_others(wide.size, f'step over {WIDE:g}')}: schemes differ most where steps are that wide, and a "
            "keyframe between them settles more than any choice of scheme."
        ]


def _closing(keyframes: Keyframes, angles: FloatArray, second: float) -> Iterator[list[Part]]:
    """Open keyframes that end where they began, after they were elsewhere."""
    q = keyframes.quaternions
    away = quaternion.distance(q, q[:1])
    gap, median = float(away[-1]), float(np.median(np.radians(angles)))
    exact = gap < REPEATED
    if keyframes.closed or len(q) < LOOP or max(away) < max(HOLD, APART * gap):
        return
    if exact or nearly(gap, median):
        off = significant(float(np.degrees(gap))) if gap > np.radians(ROUNDING) else "0"
        later = significant(float(keyframes.knots[-1]) / second)
        row = (
            "takes the last row for the return"
            if exact
            else "asks that its last row repeat the first"
        )
        yield [
            f"the last keyframe is {off} degrees from the first, {later} s later: the motion closes. If it goes on "
            f"from there as it began, say --closed, which {row}; without it the curve has two ends there."
        ]


def _noise(frame: pd.DataFrame) -> Iterator[list[Part]]:
    noisy = Table("compare", frame, frame[frame["noise"] > 0.0])
    if len(noisy.rows):
        yield [
            "the keyframes have about ",
            multiple(noisy.cell("noise")),
            " degrees of noise about each axis, judging by their third differences: smooth them, or expect every curve "
            "that passes through them to repeat it, and its rates to amplify it.",
        ]


def _pair(keyframes: Keyframes, second: float, segment: int) -> str:
    """The keyframes of a segment, counted from 0, and when they are."""
    last = 0 if keyframes.closed and segment == keyframes.count - 1 else segment + 1
    start, stop = (f"{keyframes.knots[k] / second:.6g}" for k in (segment, segment + 1))
    return f"keyframes {segment} and {last} ({start} s and {stop} s after the first)"


def _others(count: int, what: str) -> str:
    """How many more there are of what was named once."""
    if count == 1:
        return ""
    if what == "hold":
        return f" (the first of {count} holds)"
    return f" ({count - 1} more {what}{'s' if count > 2 else ''})"
