"""Needs: what a user cannot do without in a curve, which schemes have it, and what the others break."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from quatspline.findings.quotes import Cell, Part, multiple, three_digits
from quatspline.instruments.trials import Row, records

ROUNDING = 1e-6
"""What a curve may exceed a limit by, in the unit of that: slerp leaves its own arcs by 1e-14 degrees."""


@dataclass(frozen=True)
class Limit:
    """One need: a quantity of a scheme that may be ``most`` at most.

    Attributes
    ----------
    flag : as it was asked for
    column : of the comparison, where the quantity stands
    most : the largest that is allowed
    quantity : of what the column holds, by default that times ``scale``; the less, the better
    words : what is said of what the column holds, or the unit of the quantity
    scale : of the limit's unit in the column's
    table : where the column stands
    """

    flag: str
    column: str
    most: float
    words: str | Callable[[Any], str]
    quantity: Callable[[Any], float] | None = None
    scale: float = 1.0
    table: str = "compare"

    def has(self, row: Row) -> float:
        """The quantity of a scheme."""
        value = row[self.column]
        return self.quantity(value) if self.quantity else self.scale * value

    def met(self, row: Row) -> bool:
        """Whether a scheme that was measured keeps to it."""
        return self.has(row) <= self.most + ROUNDING

    def excess(self, row: Row) -> float:
        """How far a scheme is beyond it, 0 for one that is not, as a share of it where it is no count."""
        beyond = self.has(row) - self.most
        return 0.0 if self.met(row) else beyond / max(abs(self.most), ROUNDING)

    def said(self, row: Row) -> list[Part]:
        """What a scheme has, in words; a number that stands in the table is tied to its cell."""
        cell = Cell(self.table, {"scheme": row["scheme"]}, self.column, row[self.column])
        if not isinstance(self.words, str):
            return [self.words(cell.value)]
        if np.isinf(self.has(row)):
            return ["unbounded"]
        number = multiple(cell) if self.scale == 1.0 else significant(self.has(row))
        return [number, f" {self.words}"]


@dataclass(frozen=True)
class Needs:
    """What is needed; None and False ask for nothing.

    Attributes
    ----------
    smooth : k of C^k, as measured
    local : whether a changed keyframe may change the curve nearby only
    causal : keyframes after a segment's own two that a curve may wait for
    max_rate, max_accel : degrees per second and per second squared
    max_excursion : degrees off the arcs between keyframes
    second : units of the keyframes' times in a second
    table : that the quantities stand in
    """

    smooth: int | None = None
    local: bool = False
    causal: int | None = None
    max_rate: float | None = None
    max_accel: float | None = None
    max_excursion: float | None = None
    second: float = 1.0
    table: str = "compare"

    @property
    def limits(self) -> list[Limit]:
        """What is asked for."""
        return [replace(limit, table=self.table) for limit in self._limits()]

    def met(self, rows: pd.DataFrame, _: Row) -> list[bool]:
        """Which rows of a comparison meet all: a filter of questions."""
        return [all(limit.met(row) for limit in self.limits) for row in records(rows)]

    def broken(self, row: Row) -> list[Limit]:
        """What a scheme that was measured breaks."""
        return [limit for limit in self.limits if not limit.met(row)]

    def distance(self, row: Row) -> tuple[int, float]:
        """How far a scheme is from meeting all: by number, then by how much."""
        return len(self.broken(row)), sum(limit.excess(row) for limit in self.limits)

    def _limits(self) -> Iterator[Limit]:
        if self.smooth is not None:
            flag, least = f"--smooth {self.smooth}", -self.smooth
            yield Limit(flag, "continuity", least, _smoothness, lambda k: -k)
        if self.local:
            yield Limit("--local", "support", sys.maxsize, _shaped_by, reach)
        if self.causal is not None:
            yield Limit(f"--causal {self.causal}", "lookahead", self.causal, _waits, reach)
        for name, column, unit, scale in (
            ("rate", "peak_rate", "deg/s", self.second),
            ("accel", "peak_acceleration", "deg/s^2", self.second**2),
            ("excursion", "excursion", "deg", 1.0),
        ):
            most = getattr(self, f"max_{name}")
            if most is not None:
                yield Limit(f"--max-{name} {most:g}", column, most, unit, scale=scale)


def reach(count: Any) -> float:
    """A count of keyframes as it stands in a table, where "all" is one, too."""
    return np.inf if count == "all" else float(count)


def significant(value: float) -> str:
    """A number to three significant digits, in plain notation unless it is astronomical."""
    rounded = three_digits(value)
    return f"{rounded:.0f}" if 100.0 <= abs(rounded) < 1e7 else f"{rounded:.3g}"


def _smoothness(k: float) -> str:
    return f"C{int(k)}" if k >= 0 else "leaps"


def _shaped_by(count: Any) -> str:
    return "shaped by all keyframes" if count == "all" else f"shaped by {count} keyframes"


def _waits(count: Any) -> str:
    if count == "all":
        return "waits for all keyframes"
    return f"waits for {int(count)} keyframe{'' if int(count) == 1 else 's'}"


# -- sentences ----------------------------------------------------------------------------------

LISTED = 5
"""Schemes that a sentence names; the table has the others."""


def breaches(needs: Needs, rows: pd.DataFrame, name: Callable[[str], str]) -> Iterator[list[Part]]:
    """For each need the schemes that break it with what they have, the nearest first.

    Parameters
    ----------
    rows : of schemes that were measured
    name : how a scheme is called
    """
    for limit in needs.limits:
        lost = [row for row in records(rows) if not limit.met(row)]
        lost.sort(key=lambda row: (limit.excess(row), str(row["scheme"])))
        if lost:
            yield [f"Ruled out by {limit.flag}: ", *_listed(limit, lost, name), "."]


def _listed(limit: Limit, lost: list[Row], name: Callable[[str], str]) -> list[Part]:
    parts: list[Part] = []
    for row in lost[:LISTED]:
        parts += ["; " if parts else "", f"{name(str(row['scheme']))}, ", *limit.said(row)]
    return [*parts, f"; and {len(lost) - LISTED} more" if len(lost) > LISTED else ""]


def unmet(needs: Needs, nearest: Row, name: Callable[[str], str]) -> list[Part]:
    """That no scheme meets all needs, and what the one that comes nearest has."""
    every = ", ".join(limit.flag for limit in needs.limits)
    head = f"No scheme measured meets your needs ({every}). The nearest is "
    lost = had(needs.broken(nearest), nearest)
    return [f"{head}{name(str(nearest['scheme']))}: ", *lost, "."]


def had(limits: Iterable[Limit], row: Row) -> list[Part]:
    """What a scheme has of needs, beside what was asked for."""
    parts: list[Part] = []
    for limit in limits:
        parts += [", " if parts else "", *limit.said(row), f" ({limit.flag})"]
    return parts
