"""Rows that are refused: every kind of fault with its count and the first place, in one sentence."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from quatspline.keyframes import NORM_TOLERANCE
from quatspline.motion.errors import MotionFileError
from quatspline.motion.motion import Times
from quatspline.quaternion import FloatArray, normalise

Rows = NDArray[np.intp]
"""Indices of rows, in increasing order."""


@dataclass
class Faults:
    """Faults of a file's rows, told together.

    Attributes
    ----------
    path : the file
    place : what a row is called, as "line 7"
    """

    path: Path
    place: Callable[[int], str]
    found: list[tuple[int, str]] = field(default_factory=list)

    def add(self, rows: Rows, tell: Callable[[int], str]) -> None:
        """Rows that have a fault of one kind; ``tell`` says what is wrong with the first."""
        if len(rows):
            first = int(rows[0])
            count = f"the first of {len(rows)} rows" if len(rows) > 1 else "1 row"
            self.found.append((first, f"{self.place(first)}: {tell(first)} ({count})"))

    def refuse(self) -> None:
        """Raise MotionFileError if there are any faults."""
        if self.found:
            told = "; ".join(sentence for _, sentence in sorted(self.found))
            raise MotionFileError(f"{self.path}, {told}")


def check_numbers(
    faults: Faults,
    names: tuple[str, ...],
    table: FloatArray,
    refused: dict[int, str],
    missing: str = "refuse",
) -> NDArray[np.bool_]:
    """Faults of rows (n, m) by themselves; which rows are numbers throughout.

    ``refused`` has what is wrong with rows that are no numbers for another reason than a gap;
    ``missing`` is "skip" where gaps are no fault.
    """
    other = np.zeros(len(table), dtype=bool)
    other[list(refused)] = True
    gaps = np.isnan(table).any(axis=1) & ~other
    infinite = np.isinf(table).any(axis=1) & ~other & ~gaps

    def named(bad: NDArray[np.bool_], row: int) -> str:
        return names[int(np.argmax(bad))] + f" = {table[row][bad][0]}"

    faults.add(np.flatnonzero(other), lambda row: refused[row])
    faults.add(
        np.flatnonzero(gaps & (missing == "refuse")),
        lambda row: f"{names[int(np.argmax(np.isnan(table[row])))]} holds no number (blank or nan)",
    )
    faults.add(
        np.flatnonzero(infinite),
        lambda row: f"{named(np.isinf(table[row]), row)} is not a finite number",
    )
    return ~(other | gaps | infinite)


def check_norms(faults: Faults, rows: Rows, q: FloatArray) -> None:
    """Faults of quaternions (n, 4), which stand in the given rows of the file."""
    with np.errstate(over="ignore"):
        norms = np.linalg.norm(q, axis=1)
    off = np.flatnonzero(~(np.abs(norms - 1.0) <= NORM_TOLERANCE))
    by_row = dict(zip(rows[off].tolist(), norms[off].tolist(), strict=True))
    limit = f"not 1 (within {NORM_TOLERANCE:g})"
    faults.add(rows[off], lambda row: f"quaternion has norm {by_row[row]:.6g}, {limit}")


def distinct(
    how: str, t: Times, same: Callable[[int, int], bool] = lambda i, j: True
) -> NDArray[np.intp]:
    """Indices of rows whose stamps differ from the one before; all where repeats are to be refused."""
    equal = np.flatnonzero(t[1:] == t[:-1])
    repeats = [] if how == "refuse" else [i + 1 for i in equal.tolist() if same(i, i + 1)]
    return np.setdiff1d(np.arange(len(t)), repeats)


def combined(how: str, values: FloatArray, first: NDArray[np.intp]) -> FloatArray:
    """One row (..., 3 or 4) for each group of rows that begins at ``first``.

    The "first" or the "last" of them, or their "mean": of quaternions on one hemisphere, normalised.
    """
    if how == "refuse" or len(first) == len(values):
        return values
    if how != "mean":
        return values[first if how == "first" else np.append(first[1:], len(values)) - 1]
    counts = np.diff(np.append(first, len(values)))
    heads = np.repeat(values[first], counts, axis=0)
    turns = values.shape[-1] == 4
    dots = np.einsum("n...i,n...i->n...", heads, values)[..., np.newaxis]
    signed = np.where(dots < 0.0, -values, values) if turns else values
    mean = np.add.reduceat(signed, first, axis=0)
    mean = normalise(mean) if turns else mean / counts.reshape(-1, *[1] * (mean.ndim - 1))
    mean[counts == 1] = values[first][counts == 1]  # as given
    return mean


def check_times(
    faults: Faults, rows: Rows, t: Times, same: Callable[[int, int], bool] = lambda i, j: True
) -> None:
    """Faults of the order of times (n,): back, repeated, or too close for float64.

    ``same`` tells whether two of them that are equal as numbers are so in the file.
    """
    before = np.flatnonzero(t[1:] == t[:-1])
    equal = np.array([same(i, i + 1) for i in before.tolist()], dtype=bool)
    at = {int(rows[i + 1]): i for i in np.flatnonzero(t[1:] <= t[:-1]).tolist()}

    def stamp(row: int) -> str:
        return f"t = {t[at[row] + 1].item()!r}"

    faults.add(
        rows[np.flatnonzero(t[1:] < t[:-1]) + 1],
        lambda row: f"{stamp(row)} goes back behind {t[at[row]].item()!r} before it",
    )
    faults.add(rows[before[equal] + 1], lambda row: f"{stamp(row)} repeats the stamp before it")
    faults.add(
        rows[before[~equal] + 1],
        lambda row: (
            f"{stamp(row)} is too close to the stamp before it: float64 cannot tell them "
            "apart; give integers, or times since the first"
        ),
    )
