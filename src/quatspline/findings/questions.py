"""Questions over a table with one row per scheme: which rows qualify, which of them is best, and how that is said.

`recommendation` asks them of a comparison on a user's keyframes, `decisions` of a folder of results.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pandas as pd

from quatspline.findings.quotes import Cell, Part, Quote, filled, multiple
from quatspline.instruments.trials import Row, records

ROUNDED = "rounded"
"""The format specification of a number to three digits."""


@dataclass(frozen=True)
class Table:
    """A table with one row per scheme, and those of its rows that answer a question.

    Attributes
    ----------
    name, frame : what its cells are quoted under, and the whole of it
    rows : those that answer, the best first; before anything is asked, all
    phrases : what sentences name beside columns
    taken : the row that others are held against, if any
    """

    name: str
    frame: pd.DataFrame
    rows: pd.DataFrame
    phrases: Mapping[str, Words] = field(default_factory=dict)
    taken: Row = field(default_factory=dict)

    @property
    def best(self) -> Row:
        """The first row."""
        return records(self.rows.head(1))[0]

    def asked(self, filters: Iterable[Filter], criterion: Criterion = lambda row: 0) -> Table:
        """The rows that pass all filters in turn, the best first; those that tie stay in order."""
        rows = self.rows
        for qualify in filters:
            rows = rows[np.broadcast_to(qualify(rows, self.taken), len(rows)).astype(bool)]
        keys = list(map(criterion, records(rows)))
        return replace(self, rows=rows.iloc[sorted(range(len(keys)), key=keys.__getitem__)])

    def said(self, template: str) -> tuple[Part, ...]:
        """A sentence about the best row.

        Fields of the template are phrases or columns, quoted: ``{length:.3g}``, of the row taken ``{taken.length}``,
        one over another, to three digits, ``{length/taken.length:rounded}``.
        """

        def written(name: str, spec: str) -> Sequence[Part]:
            return self.phrases[name](self) if name in self.phrases else (self.quote(name, spec),)

        return filled(template, written)

    def quote(self, columns: str, spec: str = "") -> Quote:
        """What `said` puts in the place of columns."""
        cells = tuple(map(self.cell, columns.split("/")))
        return multiple(*cells) if spec == ROUNDED else Quote(cells, spec=spec)

    def cell(self, column: str, row: Row | None = None) -> Cell:
        """A cell of some row, by default of the best; of a column ``taken.x`` of the row taken."""
        owner, _, column = column.rpartition(".")
        row = row or (self.taken if owner else self.best)
        return Cell(self.name, {"scheme": row["scheme"]}, column, row[column])


Words = Callable[[Table], Sequence[Part]]
"""What is said of the rows that answer."""
Filter = Callable[[pd.DataFrame, Row], Any]
"""Which rows qualify, or whether all do, beside the row that they are held against."""
Criterion = Callable[[Row], Any]
"""What rows are ordered by; the less, the better."""


@dataclass(frozen=True)
class Question:
    """What is asked of a table.

    Attributes
    ----------
    words : the sentence, as a template of `Table.said` or as what makes it
    filters : which rows qualify, each filter seeing what those before it leave
    criterion : which is best, by default the first
    apart : what tells rows apart that get a sentence each
    """

    words: str | Words
    filters: tuple[Filter, ...]
    criterion: Criterion = lambda row: 0
    apart: Criterion = lambda row: 0


def answered(questions: Iterable[Question], table: Table) -> Iterator[tuple[Part, ...]]:
    """The sentences that a table supports, in the order of the questions."""
    for question in questions:
        rows = table.asked(question.filters, question.criterion).rows
        kinds = [question.apart(row) for row in records(rows)]
        for kind in dict.fromkeys(kinds):
            answer = replace(table, rows=rows[[other == kind for other in kinds]])
            words = question.words
            yield answer.said(words) if isinstance(words, str) else tuple(words(answer))


def by_name(row: Row) -> str:
    """The order of names."""
    return str(row["scheme"])
