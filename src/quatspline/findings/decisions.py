"""Choosing: which schemes are on a Pareto front, and what follows for a user who has to choose one.

Works on a table with one row per scheme, from whichever measurements it was made; a column that is not there
or is empty leaves out what would rest on it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from math import inf

import pandas as pd

from quatspline.findings.choices import CLOSES, LOCAL, MEETS, SMOOTH, Condition
from quatspline.findings.questions import Filter, Question, Table, answered
from quatspline.findings.quotes import Part, fields
from quatspline.runs.experiment import QUICK

TABLE = "choosing"

COUNTED = {"torque": -1, "order": 1, "operations_sample": -1, "operations_keyframe": -1}
"""Criteria of the front that no machine changes: 1 where more is better, -1 where less is."""

TIMED = {"torque": -1, "order": 1, "nanoseconds_per_sample": -1, "microseconds_per_keyframe": -1}
"""The same by the clock, which also knows libraries."""

WHOLE = ("order",)
"""Criteria that are compared as whole numbers: an order of 4.1 is none better than one of 4.0."""


def pareto(table: pd.DataFrame, criteria: Mapping[str, int]) -> pd.Series:
    """Whether no other row is as good in all criteria and better in one; missing where one is unknown.

    Parameters
    ----------
    table : one row per scheme
    criteria : columns, with 1 where more is better and -1 where less is

    Returns
    -------
    Series of "yes", "no" or None, with the index of the table.
    """
    values = table.reindex(columns=list(criteria)).astype(float)
    whole = [name for name in WHOLE if name in criteria]
    known = values.round(dict.fromkeys(whole, 0)).mul(pd.Series(criteria)).dropna()
    every = known.to_numpy()
    beaten = [((every >= own).all(axis=1) & (every > own).any(axis=1)).any() for own in every]
    marks = ["no" if worse else "yes" for worse in beaten]
    return pd.Series(marks, known.index, dtype=object).reindex(table.index)


# -- decisions ----------------------------------------------------------------------------------

MARGINS = {"torque": 1.05, "nanoseconds_per_sample": 2.0}
"""Factors by which the best has to lead in a table of quick size: medians of few sets, and short rounds, tell no
less apart.  Counts are the same at any size."""


def decisions(frame: pd.DataFrame) -> Iterator[tuple[Part, ...]]:
    """A sentence for every question that a table answers; its names and numbers are its cells.

    Where a table of quick size does not tell the best from the next, the sentence says so.
    """
    return answered(QUESTIONS, Table(TABLE, frame, frame))


def lines(frame: pd.DataFrame) -> Iterator[str]:
    """The decisions as a Markdown list, each with the cells that it rests on."""
    for parts in decisions(frame):
        cited = [str(cell) for part in parts if not isinstance(part, str) for cell in part.cells]
        columns = ", ".join(f"`{cell.rsplit('.', 1)[1]}`" for cell in cited[1:] or cited)
        yield f"- {''.join(map(str, parts))} Cells: `{cited[0].rsplit('.', 1)[0]}`, {columns}."


def _least(wish: str, by: str, filters: tuple[Filter, ...], *reasons: str) -> Question:
    """Who has the least of a column: a wish, what qualifies, and reasons, each said where its cells are known."""
    return Question(
        partial(_words, wish, by, reasons),
        (Condition(by, ">=", -inf), *filters),  # what is known at all
        lambda row: (row[by], row["scheme"]),
    )


def _words(wish: str, by: str, reasons: tuple[str, ...], table: Table) -> tuple[Part, ...]:
    if not _decided(table.rows, by):
        return table.said(f"{wish}: not decided at {{run_size}} size.")
    best = table.best
    told = [text for text in reasons if all(pd.notna(best.get(name)) for name in fields(text))]
    return table.said(f"{wish}: {{scheme}} ({', '.join(told)}).")


def _decided(ranked: pd.DataFrame, by: str) -> bool:
    """Whether the size of the table tells the best from the next."""
    if "run_size" not in ranked or ranked["run_size"].iloc[0] != QUICK or len(ranked) < 2:
        return True
    first, second = ranked[by].iloc[:2]
    return bool(second >= MARGINS.get(by, 1.0) * first)


TORQUE = "torque energy {torque:.4g} times the least"
QUICKEST = "{nanoseconds_per_sample:.3g} ns"
MET = (MEETS,)
C2 = (*MET, SMOOTH[2], Condition("smooth_k_worst", ">=", 2))

QUESTIONS = (
    _least(
        "Local and C2 wherever measured, with the least torque",
        "torque",
        (*C2, LOCAL),
        *(TORQUE, "{support} keyframes shape a segment", "order {order:.2f}"),
    ),
    _least(
        "The least torque",
        "torque",
        MET,
        *(TORQUE, "C{smooth_k_worst:.0f} at worst"),
        "set-up {microseconds_per_keyframe:.3g} us per keyframe",
    ),
    _least(
        "Closed and C2 wherever measured, with the least torque",
        "torque",
        (*C2, CLOSES),
        *(TORQUE, "support {support}"),
    ),
    _least(
        "C2 wherever measured, with the fewest operations per sample (exponentials and logarithms)",
        "operations_sample",
        C2,
        *("{operations_sample:.0f} per sample", TORQUE),
    ),
    _least(
        "C2 wherever measured, with the fastest sample",
        "nanoseconds_per_sample",
        C2,
        *(QUICKEST, TORQUE),
    ),
    _least(
        "The fastest sample, whatever the smoothness",
        "nanoseconds_per_sample",
        MET,
        *(QUICKEST, "C{smooth_k:.0f} at moderate steps"),
    ),
)
