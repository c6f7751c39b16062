"""Choosing: which schemes are on a Pareto front, and what follows for somebody who has to take one.

Works on a table with one row a scheme, from whichever measurements it was made; a column that is not there
or is empty leaves out what would rest on it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import pandas as pd

from quatspline.findings.quotes import Ledger, Part, said

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
    table : one row a scheme
    criteria : columns, with 1 where more is better and -1 where less is

    Returns
    -------
    Series of "yes", "no" or None, with the index of the table.
    """
    if set(criteria) - set(table):
        return pd.Series(None, index=table.index, dtype=object)
    values = table[list(criteria)].astype(float)
    values = values.assign(**{name: values[name].round() for name in WHOLE if name in criteria})
    known = (values * pd.Series(criteria)).dropna()
    marks = {}
    for index, own in known.iterrows():
        beaten = (known >= own).all(axis=1) & (known > own).any(axis=1)
        marks[index] = "no" if beaten.any() else "yes"
    return pd.Series(marks, dtype=object).reindex(table.index)


# -- decisions ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Question:
    """What somebody wants, and how the table answers it.

    Attributes
    ----------
    wish : how the sentence begins
    by : the column whose least value wins, among rows that meet all of
    equal, least : values that columns have to equal, or to reach
    unlike : values that columns must not have
    quoted : columns that the sentence gives, with their words as a template of ``value``
    """

    wish: str
    by: str
    equal: Mapping[str, Any] = field(default_factory=dict)
    least: Mapping[str, float] = field(default_factory=dict)
    unlike: Mapping[str, Any] = field(default_factory=dict)
    quoted: Mapping[str, str] = field(default_factory=dict)


TORQUE = "torque energy {torque:.4g} times the least"
MET = {"passes_keys": "yes"}
C2 = {"smooth_k": 2, "smooth_k_worst": 2}

QUESTIONS = (
    Question(
        "A curve that is C2 wherever measured, of which a keyframe shapes only a part, with the least torque",
        "torque",
        MET,
        C2,
        {"support": "all"},
        {
            "torque": TORQUE,
            "support": "{support} keyframes shape a segment",
            "order": "order {order:.2f}",
        },
    ),
    Question(
        "The least torque",
        "torque",
        MET,
        quoted={
            "torque": TORQUE,
            "smooth_k_worst": "C{smooth_k_worst:.0f} at worst",
            "microseconds_per_keyframe": "set-up {microseconds_per_keyframe:.3g} us a keyframe",
        },
    ),
    Question(
        "Closed and C2 wherever measured, with the least torque",
        "torque",
        {**MET, "closes": "yes"},
        C2,
        quoted={"torque": TORQUE, "support": "support {support}"},
    ),
    Question(
        "C2 wherever measured, with the fewest operations a sample (exponentials and logarithms)",
        "operations_sample",
        MET,
        C2,
        quoted={"operations_sample": "{operations_sample:.0f} of them", "torque": TORQUE},
    ),
    Question(
        "C2 wherever measured, with the quickest sample",
        "nanoseconds_per_sample",
        MET,
        C2,
        quoted={
            "nanoseconds_per_sample": "{nanoseconds_per_sample:.3g} ns",
            "torque": TORQUE,
        },
    ),
    Question(
        "The quickest sample, whatever the smoothness",
        "nanoseconds_per_sample",
        MET,
        quoted={
            "nanoseconds_per_sample": "{nanoseconds_per_sample:.3g} ns",
            "smooth_k": "C{smooth_k:.0f} at moderate steps",
        },
    ),
)


MARGINS = {"torque": 1.05, "nanoseconds_per_sample": 2.0}
"""Factors by which the best has to lead in a table of quick size: medians of few sets, and short rounds, tell no
less apart.  Counts are the same at any size."""


def decisions(
    table: pd.DataFrame, questions: tuple[Question, ...] = QUESTIONS
) -> Iterator[tuple[Part, ...]]:
    """A sentence for every question that the table answers; its names and numbers are its cells.

    Where a table of quick size does not tell the best from the next, the sentence says so.

    Parameters
    ----------
    table : columns scheme (unique) and those of the questions; see `QUESTIONS`
    questions : what is asked, in order
    """
    ledger = Ledger(lambda name: table)
    for question in questions:
        ranked = _ranked(question, table)
        if not len(ranked):
            continue
        best = str(ranked["scheme"].iloc[0])
        yield (
            _sentence(question, ledger, best)
            if _decided(question, ranked)
            else said(
                f"{question.wish}: not decided at {{size}} size.",
                size=ledger(TABLE, "run_size", scheme=best),
            )
        )


def _decided(question: Question, ranked: pd.DataFrame) -> bool:
    """Whether the size of the table tells the best from the next."""
    if "run_size" not in ranked or ranked["run_size"].iloc[0] != "quick" or len(ranked) < 2:
        return True
    first, second = ranked[question.by].iloc[:2]
    return bool(second >= MARGINS.get(question.by, 1.0) * first)


def _ranked(question: Question, table: pd.DataFrame) -> pd.DataFrame:
    """The schemes that answer a question, the best first; by name those that tie."""
    needed = {question.by, *question.equal, *question.least, *question.unlike}
    if needed - set(table):
        return table.iloc[:0]
    fit = table[list(needed)].notna().all(axis=1)
    for column, value in question.equal.items():
        fit &= table[column] == value
    for column, least in question.least.items():
        fit &= table[column].astype(float) >= least
    for column, value in question.unlike.items():
        fit &= table[column] != value
    return table[fit].sort_values([question.by, "scheme"])


def _sentence(question: Question, ledger: Ledger, best: str) -> tuple[Part, ...]:
    known = [column for column in question.quoted if column in ledger.columns(TABLE)]
    cells = {column: ledger(TABLE, column, scheme=best) for column in ("scheme", *known)}
    texts = [question.quoted[column] for column in known if not pd.isna(cells[column].value)]
    return said(f"{question.wish}: {{scheme}} ({', '.join(texts)}).", **cells)


def lines(table: pd.DataFrame) -> Iterator[str]:
    """The decisions as a Markdown list, each with the cells that it rests on."""
    for parts in decisions(table):
        where = [str(cell) for part in parts if not isinstance(part, str) for cell in part.cells]
        columns = ", ".join(f"`{cell.rsplit('.', 1)[1]}`" for cell in where[1:] or where)
        yield f"- {''.join(map(str, parts))} Cells: `{where[0].rsplit('.', 1)[0]}`, {columns}."
