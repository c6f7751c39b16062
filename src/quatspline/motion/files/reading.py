"""How a file is to be read where it leaves that open: the options of `read_motion`."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from quatspline.inputs.arrays import FloatArray
from quatspline.motion.errors import MotionFileError
from quatspline.motion.files.opening import lines_of, number
from quatspline.options import nearest

CHOICES = {
    "duplicates": ("refuse", "first", "last", "mean"),
    "missing": ("refuse", "skip"),
    "units": ("cmu", "spec"),
}

ALWAYS = ("skip", "max_gap")
"""Options that every format takes."""


@dataclass(frozen=True)
class Reading:
    """Options of `read_motion`, checked."""

    skeleton: str | Path | None = None
    rate: float | None = None
    times: ArrayLike | str | Path | None = None
    units: str | None = None
    skip: int = 0
    duplicates: str = "refuse"
    missing: str = "refuse"
    max_gap: float | None = None
    animation: str | int | None = None

    clocks: ClassVar[tuple[str, ...]] = ("times", "rate")
    """Options that say when frames are."""

    def named(self, option: str, value: object = "") -> str:
        """An option as those who read so write it, for sentences that tell them to."""
        return f"{option}={value}"

    def __post_init__(self) -> None:
        for name, known in CHOICES.items():
            value = getattr(self, name)
            if value not in known and value != getattr(Reading, name):
                raise ValueError(f"{name}={value!r}: {nearest(value, known)}")
        for name in ("rate", "max_gap"):
            _check_positive(name, getattr(self, name))
        try:
            whole = operator.index(self.skip)
        except TypeError:
            whole = -1
        if whole < 0:
            raise ValueError(
                f"skip={self.skip!r}: a whole number of frames, at least 0, is expected"
            )
        if self.rate is not None and self.times is not None:
            raise ValueError("rate and times are both given: one of them says when frames are")

    def check_use(self, path: Path, takes: Iterable[str]) -> None:
        """Refuse options that say nothing of a format, instead of leaving them out."""
        for option in fields(self):
            idle = option.name not in (*ALWAYS, *takes)
            if idle and getattr(self, option.name) is not option.default:
                given = self.named(option.name, repr(getattr(self, option.name)))
                raise MotionFileError(f"{path}: {given} is of no use in a file of this format")

    def frame_times(self, path: Path, count: int, rate: float | None) -> FloatArray:
        """Times of frames that a file does not have: by ``times``, ``rate`` or the format's own rate."""
        if self.times is not None:
            return self._given_times(path, count)
        chosen = self.rate or rate
        if chosen is None:
            wanted = " or ".join(map(self.named, self.clocks))
            raise MotionFileError(f"{path}: has no times of its own: give {wanted}")
        return np.arange(count) / chosen

    def _given_times(self, path: Path, count: int) -> FloatArray:
        times = _numbers(self.times)
        if times.shape != (count,):
            what = f"times has shape {times.shape} for {count} frames"
            raise MotionFileError(f"{path}: {what}")
        stuck = np.flatnonzero(~(np.diff(times) > 0.0))
        if not np.isfinite(times).all() or stuck.size:
            place = int(stuck[0]) + 1 if stuck.size else int(np.argmin(np.isfinite(times)))
            raise MotionFileError(f"{path}: times[{place}] = {times[place]} does not follow on")
        return times


def _numbers(times: Any) -> FloatArray:
    """Times as given, or one per line in a file."""
    if not isinstance(times, str | Path):
        return np.asarray(times, dtype=float)
    path = Path(times)
    try:
        words = " ".join(lines_of(path)).split()
        return np.array([number(word) for word in words])
    except OSError as error:
        raise MotionFileError(f"{path}: cannot be read: {error.strerror or error}") from None
    except ValueError as error:
        raise MotionFileError(f"{path}: not a list of times, one per line: {error}") from None


def _check_positive(name: str, value: Any) -> None:
    number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    if value is not None and not (number and 0.0 < value < math.inf):
        raise ValueError(f"{name}={value!r}: a positive number is expected")
