"""Questions: what qualifies, what is best, and sentences whose numbers are cells, on a table of three rows."""

from __future__ import annotations

import pandas as pd
import pytest

from quatspline.findings.questions import Question, Table, answered, by_name
from quatspline.findings.quotes import Quote

FRAME = pd.DataFrame(
    {"scheme": ["c", "a", "b"], "cost": [2.0, 3.0, 2.0], "kind": ["x", "y", "x"]}, index=[7, 5, 3]
)
TABLE = Table("costs", FRAME, FRAME, {"hint": lambda table: (f"of {len(table.rows)}",)})


def told(*questions: Question) -> list[str]:
    return ["".join(map(str, parts)) for parts in answered(questions, TABLE)]


def cheapest(rows: pd.DataFrame, _: object) -> pd.Series:
    return rows["cost"] == rows["cost"].min()


def first_by_name(rows: pd.DataFrame, _: object) -> pd.Series:
    return rows["scheme"] == rows["scheme"].min()


def test_filters_see_what_those_before_them_leave() -> None:
    assert told(Question("{scheme}", (cheapest, first_by_name))) == ["b"]
    assert told(Question("{scheme}", (first_by_name, cheapest))) == ["a"]


def test_an_answer_for_all_rows_serves_as_a_filter() -> None:
    assert told(Question("{scheme}", (lambda rows, _: len(rows) > 2,))) == ["c"]
    assert told(Question("{scheme}", (lambda rows, _: len(rows) > 3, lambda rows, _: []))) == []


def test_rows_that_tie_stay_in_order() -> None:
    assert told(Question("{scheme}", (), lambda row: row["cost"])) == ["c"]
    assert told(Question("{scheme}", (), lambda row: -row["cost"])) == ["a"]


def test_kinds_of_rows_get_a_sentence_each_the_best_first() -> None:
    asked = Question("{kind}: {scheme} {hint}", (), by_name, lambda row: row["kind"])
    assert told(asked) == ["y: a of 1", "x: b of 2"]


@pytest.mark.parametrize(
    ("template", "said", "columns"),
    [
        ("{cost:.1f}", "2.0", [("c", "cost")]),
        ("{taken.cost:.0f}", "3", [("a", "cost")]),
        ("{taken.cost/cost:rounded}", "1.50", [("a", "cost"), ("c", "cost")]),
        ("{cost:rounded}", "2.00", [("c", "cost")]),
    ],
)
def test_columns_are_quoted(template: str, said: str, columns: list[tuple[str, str]]) -> None:
    table = Table("costs", FRAME, FRAME, taken={"scheme": "a", "cost": 3.0})
    (quote,) = table.said(template)
    assert isinstance(quote, Quote)
    assert str(quote) == said
    assert [(cell.row["scheme"], cell.column) for cell in quote.cells] == columns
    assert {cell.table for cell in quote.cells} == {"costs"}
