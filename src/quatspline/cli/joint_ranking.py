"""What ``compare`` says in a terminal of schemes on many tracks: needs that they break, and the five best rows."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf, isnan
from typing import TYPE_CHECKING

import numpy as np

from quatspline.catalogue import called
from quatspline.cli.asked import OF_JOINTS
from quatspline.cli.ranking import ROWS, more
from quatspline.findings.findings import Finding
from quatspline.findings.needs import Needs, breaches, unmet
from quatspline.findings.recommendation import ADVICE
from quatspline.instruments.trials import Row, records

if TYPE_CHECKING:
    import pandas as pd

UNJUDGED: Row = dict.fromkeys(OF_JOINTS, inf)
"""What nobody measured is held to meet no need."""

ERRORS = ("rms_median", "rms_worst", "largest")
HEAD = "median    worst     largest   excursion (degrees; the first three at frames left out)"


def answer(table: pd.DataFrame, needs: Needs) -> list[Finding]:
    """That no scheme meets the needs, where it is so, and which schemes break which."""
    measured = table[table["failure"].isna()]
    judged = [_judged(row, needs) for row in records(measured)]
    known = measured[judged]
    if not needs.limits or measured.empty:
        return []
    first = _ranked(measured, needs)[0]
    said = [unmet(needs, first, called)] if _judged(first, needs) and needs.broken(first) else []
    said += breaches(needs, known, called)
    if not all(judged):
        slow = ", ".join(map(called, measured["scheme"][~np.array(judged)]))
        said.append(
            [f"Not held against your needs, because measuring would take too long: {slow}."]
        )
    return [Finding(ADVICE, tuple(parts)) for parts in said]


def meeting(table: pd.DataFrame, needs: Needs) -> pd.DataFrame:
    """The schemes that meet the needs; the whole table where none does."""
    met = needs.met(table, {})
    return table[met] if any(met) else table


def spoken(found: list[Finding], table: pd.DataFrame, needs: Needs) -> list[str]:
    """What the terminal shows: the answer, the best schemes, a line each, and one line about the others."""
    rows = _ranked(table[table["failure"].isna()], needs)
    names = [called(str(row["scheme"])) for row in rows[:ROWS]]
    width = max(map(len, [*names, "scheme"]))
    lines = [f"{name:{width}}  {_shown(row)}" for name, row in zip(names, rows, strict=False)]
    head = [*([""] if found else []), f"{'scheme':{width}}  {HEAD}"] if lines else []
    best = {row["scheme"] for row in rows[:ROWS]}
    return [
        *(finding.text for finding in found),
        *head,
        *lines,
        *_others(table[~table["scheme"].isin(best)], needs),
    ]


def _ranked(measured: pd.DataFrame, needs: Needs) -> list[Row]:
    """Those that meet the needs in the table's order, then the others, the nearest first."""
    rows = records(measured)
    return sorted(rows, key=lambda row: needs.distance(row if _judged(row, needs) else UNJUDGED))


def _judged(row: Row, needs: Needs) -> bool:
    """Whether all that is needed was measured."""
    return not any(isnan(limit.has(row)) for limit in needs.limits)


def _shown(row: Row) -> str:
    off = "-" if isnan(row["excursion"]) else f"{row['excursion']:.4g}"
    angles = (f"{np.degrees(row[column]):.4g}" for column in ERRORS)
    cells = "  ".join(f"{cell:<8}" for cell in (*angles, off))
    return f"{cells} {row['worst_joint']}, {row['largest_joint']}"


def _others(left: pd.DataFrame, needs: Needs) -> Iterator[str]:
    """Why the other schemes are not among the best, in one line."""
    return more([_reason(row, needs) for row in records(left)])


def _reason(row: Row, needs: Needs) -> str:
    if isinstance(row["failure"], str):
        return "not measured"
    if not _judged(row, needs):
        return "too slow for its excursion to be measured"
    return "ruled out by your needs" if needs.broken(row) else "ranked lower"
