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
CLOCKS = {
    "microseconds": ("us", 1e6, "milliseconds", "ms"),
    "nanoseconds": ("ns", 1e9, "microseconds", "us"),
}
"""Each with its unit, how many are in a second, and what the same numbers count where they are farther apart."""
SLOW = 0.25
"""Degrees per unit of time below which the fastest step hardly counts seconds: a satellite takes more."""


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
        *([] if told else _clock(keyframes, angles)),
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


def _clock(keyframes: Keyframes, angles: FloatArray) -> Iterator[list[Part]]:
    """Whole numbers that hardly count seconds: 0, 1, 2 ..., or far apart, or little turns from one to the next."""
    since, h = keyframes.knots, keyframes.spacings
    spacing, fastest = float(np.median(h)), float((angles / h).max())
    if keyframes.count <= 2 or not np.array_equal(since, np.round(since)):
        return
    if np.array_equal(since, np.arange(since.size)):
        yield [
            f"counted from the first, the times are 0, 1, 2 ... {since[-1]:.0f}, like frame numbers. They are taken as "
            'seconds. If they are frames, give the length of one, as in --time-unit "1/30 s".'
        ]
    elif spacing >= COARSE:
        name = "nanoseconds" if spacing >= FINE else "microseconds"
        short, count, other, longer = CLOCKS[name]
        yield [
            f"the times are {significant(spacing)} apart (median), like {name} at {significant(count / spacing)} Hz. "
            f"They are taken as seconds. If they are {name}, use --time-unit {short}; if {other}, --time-unit {longer}."
        ]
    elif 0.0 < fastest < SLOW:
        yield [
            f"the times are whole numbers, {significant(spacing)} apart (median), and the fastest step turns at "
            f"{significant(fastest)} degrees per unit. They are taken as seconds. If they are milliseconds or frames, "
            'use --time-unit ms, or the length of a frame, as in --time-unit "1/30 s".'
        ]


def _crowded(h: FloatArray, pair: Pair) -> Iterator[list[Part]]:
    close = np.flatnonzero(h < CROWDED * np.median(h))
    if close.size:
        k = int(close[h[close].argmin()])
        yield [
            f"{pair(k)} are almost duplicates: they are {significant(float(h[k]))} s apart, and the median spacing "
            f"is {significant(float(np.median(h)))} s{_others(close.size, 'such pair')}. Any rotation between them "
            "happens almost instantly."
        ]


def _gaps(h: FloatArray, angles: FloatArray, pair: Pair) -> Iterator[list[Part]]:
    median = float(np.median(h))
    wide = np.flatnonzero((h > GAP * median) & (np.radians(angles) >= HOLD))  # a hold may last
    if wide.size:
        k = int(wide[h[wide].argmax()])
        yield [
            f"there is a gap of {significant(float(h[k]))} s between {pair(k)}, {significant(h[k] / median)} times "
            f"the median spacing{_others(wide.size, 'gap')}. The keyframes do not say what happens there, so every "
            "curve invents it."
        ]


# -- orientations ---------------------------------------------------------------------------------


def _holds(angles: FloatArray, pair: Pair, frame: pd.DataFrame) -> Iterator[list[Part]]:
    """Equal neighbours, and what schemes do between them."""
    still = np.flatnonzero(np.radians(angles) < HOLD)
    if not still.size or still.size == angles.size:
        return
    if still.size >= COPIES * angles.size and angles.size >= ENOUGH:
        yield [
            f"{still.size} of {angles.size} steps do not turn at all, as if samples were repeated. Leave the copies "
            "out; otherwise every curve stops and starts at each of them."
        ]
        return
    head = f"{pair(int(still[0]))} are equal{_others(still.size, 'hold')}"
    yield [f"{head}. While the keyframes hold, ", *_told(_holding(frame)), "."]


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
    return parts or ["schemes may turn away, but none was measured"]


def _half_turns(angles: FloatArray, pair: Pair) -> Iterator[list[Part]]:
    half = np.flatnonzero(angles > 180.0 - AMBIGUOUS)
    if half.size:
        k = int(half[angles[half].argmax()])
        left = 180.0 - float(angles[k])
        told = "exactly half a turn, so rounding decides which way the curve turns"
        if left > ROUNDING:
            more = significant(left)
            told = f"{angles[k]:.4g} degrees. With {more} more, the curve would turn the other way"
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
            f"{_others(wide.size, f'step over {WIDE:g}')}. Schemes differ most on such large steps; a keyframe "
            "between the two matters more than the choice of scheme."
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
        off = f"differs from the first by {significant(float(np.degrees(gap)))}°"
        later = significant(float(keyframes.knots[-1]) / second)
        how = (
            "use --closed, which takes the last row as the return"
            if exact
            else "make the last row equal to the first, and use --closed"
        )
        yield [
            f"the last keyframe {'repeats the first' if exact else off}, {later} s later. For a loop, {how}."
        ]


def _noise(frame: pd.DataFrame) -> Iterator[list[Part]]:
    noisy = Table("compare", frame, frame[frame["noise"] > 0.0])
    if len(noisy.rows):
        yield [
            "the keyframes have about ",
            multiple(noisy.cell("noise")),
            " degrees of noise about each axis, judging by their third differences. Smooth them; a curve that passes "
            "through them repeats the noise, and its rates amplify it.",
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
