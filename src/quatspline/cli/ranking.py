"""The order of ``compare``'s table; in a terminal its five best rows, and in one line what became of the others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from quatspline.catalogue import called
from quatspline.findings import candidates
from quatspline.findings.candidates import rank
from quatspline.findings.needs import Needs, significant
from quatspline.findings.questions import Table
from quatspline.findings.recommendation import smoothing, take
from quatspline.instruments.trials import Row, records

if TYPE_CHECKING:
    import pandas as pd

ROWS = 5
SMALL = 1e-3
"""What is less is not told apart."""

Show = Callable[[Row], str]


def ranked(frame: pd.DataFrame, needs: Needs) -> list[Row]:
    """Rows of schemes that were measured: those recommended, the candidates, what meets the needs, the others."""
    table = Table("compare", frame, frame)
    pool = candidates.candidates(needs)
    passing, met = pool[:2]

    def nearest(row: Row) -> tuple[object, ...]:
        return needs.distance(row), rank(row)

    first = [
        records(table.asked(which, rank).rows)[:1] for which in (smoothing(needs), take(needs))
    ]
    groups = ((pool, rank), ((passing, met), rank), ((candidates.through,), nearest))
    others = [*groups, ((candidates.measured,), rank)]
    rows = [*first, *(records(table.asked(*group).rows) for group in others)]
    return list({row["scheme"]: row for group in rows for row in group}.values())


def sort(frame: pd.DataFrame, needs: Needs) -> pd.DataFrame:
    """The rows of a table as the page and the terminal show them: as `ranked`, then schemes that were not measured."""
    places = {row["scheme"]: place for place, row in enumerate(ranked(frame, needs))}
    order = frame["scheme"].map(lambda name: places.get(name, len(places)))
    return frame.loc[order.sort_values(kind="stable").index].reset_index(drop=True)


def table(frame: pd.DataFrame, needs: Needs) -> list[str]:
    """The best rows as lines of text, and a line about the others."""
    rows = ranked(frame, needs)
    if not rows:
        return []
    columns = _columns(frame, needs.second)
    cells = [[head for head, _ in columns]]
    cells += [[show(row) for _, show in columns] for row in rows[:ROWS]]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    lines = ["  ".join(_set(line, widths)).rstrip() for line in cells]
    return [*lines, *_others(frame, rows, needs)]


def _set(line: list[str], widths: list[int]) -> Iterator[str]:
    """Names to the left, numbers to the right."""
    yield line[0].ljust(widths[0])
    yield from map(str.rjust, line[1:], widths[1:])


def _columns(frame: pd.DataFrame, second: float) -> list[tuple[str, Show]]:
    """Headings, and what stands below them."""
    number = _number
    holds = [("hold deg", lambda row: number(row["hold_rotation"]))]
    return [
        ("scheme", lambda row: called(row["scheme"])),
        ("C^k", lambda row: f"C{row['continuity']:.0f}" if row["continuity"] >= 0 else "leaps"),
        ("torque/least", lambda row: number(row["torque_over_least"])),
        ("excursion deg", lambda row: number(row["excursion"])),
        *(holds if frame["hold_rotation"].notna().any() else []),
        ("peak deg/s", lambda row: number(row["peak_rate"] * second)),
        ("peak deg/s^2", lambda row: number(row["peak_acceleration"] * second**2)),
        ("lookahead", lambda row: str(row["lookahead"]).removesuffix(".0")),
        ("ns/sample", lambda row: number(row["seconds_per_sample"] * 1e9)),
    ]


def _number(value: float) -> str:
    if not np.isfinite(value):
        return "-" if np.isnan(value) else "inf"
    return significant(value) if value >= SMALL or not value else f"<{SMALL:g}"


# -- the others -----------------------------------------------------------------------------------


def _others(frame: pd.DataFrame, rows: list[Row], needs: Needs) -> Iterator[str]:
    """Why the other schemes do not stand in the table, in one line."""
    shown = {row["scheme"] for row in rows[:ROWS]}
    return more([_reason(row, needs) for row in records(frame[~frame["scheme"].isin(shown)])])


def more(reasons: Sequence[str]) -> Iterator[str]:
    """One line about schemes that only the page shows, by the reason of each; none where there are none."""
    if reasons:
        why = Counter(reasons)
        counts = ", ".join(f"{count} {reason}" for reason, count in why.most_common())
        every = f", {'all ' if len(reasons) > 1 else ''}{reasons[0]}"
        yield f"{len(reasons)} more on the page{f': {counts}' if len(why) > 1 else every}."


def _reason(row: Row, needs: Needs) -> str:
    """Why a scheme is not among the best: the first reason that applies."""
    smooth = 2 if needs.smooth is None else needs.smooth
    tests = (
        ("not measured", lambda: isinstance(row["failure"], str)),
        ("ruled out by your needs", lambda: bool(needs.broken(row))),
        ("missing the keyframes", lambda: row["misses"] > candidates.MET),
        ("with leaps", lambda: row["continuity"] < 0),
        ("with velocity jumps", lambda: row["continuity"] < min(smooth, 1)),
        ("with acceleration jumps", lambda: row["continuity"] < smooth),
        ("turning during holds", lambda: row["hold_rotation"] > candidates.STILL),
    )
    return next((reason for reason, applies in tests if applies()), "ranked lower")
