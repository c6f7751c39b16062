"""The chooser at the top of the page: six questions over one table with a row per scheme, nine columns.

What is measured comes from the folder's tables `choosing` and `excursion`, what is claimed (how far ahead a
segment looks, whether a scheme iterates) from the catalogue.
"""

from __future__ import annotations

import re
from typing import Any

import pandas as pd

from quatspline.catalogue import PAPERS, found, ours
from quatspline.discovery import Found
from quatspline.findings.choices import CHOICES, NO, YES, Choice
from quatspline.findings.decisions import TABLE
from quatspline.instruments.trials import Row, records
from quatspline.page.derivations import Derivations
from quatspline.page.folder import Folder
from quatspline.page.reference import reference

HOLD = "hold 10 : 1"
"""The sets of `excursion` in which a hold lasts ten times as long as the moves beside it."""
NONE, INFINITE = "—", "∞"
LARGE = 1e3
"""Numbers from here on are written whole."""
SUPERSCRIPTS = {0: "C⁰", 1: "C¹", 2: "C²"}

COLUMNS = (
    ("scheme", "scheme", "linked to its derivation where the documentation lies beside the page"),
    ("smooth", "Cᵏ", "continuity measured at steps of 60 degrees, and at worst"),
    ("local", "local", "keyframes that shape a segment, and how many of them come after it"),
    ("order", "order", "order of the error on a smooth motion; more is better"),
    ("torque", "torque", "median torque energy over the least possible; less is better"),
    ("failure", "worst failure", "the gravest that was found"),
    ("time", "ns per sample", "of 10,000 samples or the most measured; less is better"),
    ("closes", "closes", "whether it runs closed"),
    (
        "origin",
        "whose",
        "ours, published by others and written here, or a library, with its version",
    ),
)
"""Key, heading and meaning of each column."""

NUMBERS = {"order": ("order", ".2f"), "torque": ("torque", ".3f")} | {
    "time": ("nanoseconds_per_sample", ".3g")
}
"""Columns of numbers: where they stand in the table `choosing`, and how they are written."""

WORDS = (
    (r"leaps: (\d+) degrees, (?:uniform)(.*)", r"leaps at steps of \1 degrees, even times\2"),
    (r"leaps: (\d+) degrees(.*)", r"leaps at steps of \1 degrees\2"),
    (
        r"solves (\S+) %: (\d+) keyframes, (\d+) degrees, unevenness (\S+)",
        r"solves \1 % of the sets of \2 keyframes with steps of \3 degrees, spacings up to \4 : 1",
    ),
    (r"NaN: (.*)", r"not a number: \1"),
    (r"error: (.*)", r"raises an error: \1"),
)
"""What `choosing` notes of failures, and how it is said."""


def chooser(folder: Folder) -> dict[str, Any]:
    """Questions and rows as the template takes them."""
    rows = facts(folder)
    told = reference(folder, TABLE)
    derivations = Derivations(folder.path)
    return {
        "questions": [_question(choice, rows) for choice in CHOICES],
        "columns": COLUMNS,
        "rows": [_row(row, told, derivations) for row in records(rows)],
    }


def facts(folder: Folder) -> pd.DataFrame:
    """The table `choosing`, with the columns that conditions and cells ask besides."""
    rows = folder.frame(TABLE).copy()
    known = ["smooth_k", "smooth_k_worst", "worst_failure", "torque", "support"]
    rows = rows.reindex(columns=list(dict.fromkeys([*rows.columns, *known])))
    least, worst = rows["smooth_k"], rows["smooth_k_worst"]
    keeps = (worst >= least).map({True: YES, False: NO})
    rows["keeps_smooth"] = keeps.where(least.notna() & worst.notna())
    rows["faults"] = rows["worst_failure"].notna().map({True: YES, False: NO})
    items = rows["scheme"].map(lambda name: found().get(str(name)))
    rows["iterates"] = items.map(_iterates).astype(object)
    rows["found"] = items
    rows["wander"] = rows["scheme"].map(_wandering(folder))
    return rows.sort_values("torque", kind="stable")


def _iterates(item: Any) -> str | None:
    if not isinstance(item, Found) or item.scheme is None:
        return None
    return YES if item.scheme.iterative else NO


def _wandering(folder: Folder) -> dict[str, float]:
    """Degrees that schemes wander at most during long holds; nothing where that was not measured."""
    if "excursion" not in folder.tables:
        return {}
    table = folder.frame("excursion")
    rows = table[table["data"].eq(HOLD)]
    return dict(zip(rows["scheme"], rows["wander_worst"], strict=True))


# -- questions ----------------------------------------------------------------------------------


def _question(choice: Choice, rows: pd.DataFrame) -> dict[str, Any]:
    """A question with its conditions as lists; told as not measured where no row knows a column."""
    asked = {each.column for answer in choice.answers for each in answer.conditions}
    answers = [
        {
            "key": answer.key,
            "text": answer.text,
            "conditions": [[c.column, c.relation, c.value] for c in answer.conditions],
        }
        for answer in choice.answers
    ]
    known = all(rows.reindex(columns=[name])[name].notna().any() for name in asked)
    return {"key": choice.key, "text": choice.text, "answers": answers, "known": known}


# -- rows ---------------------------------------------------------------------------------------


def _row(row: Row, told: pd.DataFrame | None, derivations: Derivations) -> dict[str, Any]:
    name, item = str(row["scheme"]), row["found"]
    asked = {c.column for choice in CHOICES for a in choice.answers for c in a.conditions}
    return {
        "scheme": name,
        "link": derivations.of(name),
        "facts": {column: _json(row.get(column)) for column in sorted(asked)},
        "cells": {
            "smooth": _smooth(row),
            "local": _local(row, item),
            **{key: _number(row, *where, told) for key, where in NUMBERS.items()},
            "failure": _cell(failure(row), 0.0 if pd.isna(row["worst_failure"]) else 1.0),
            "closes": _cell(
                _text(row.get("closes")), {YES: 0.0, NO: 1.0}.get(str(row.get("closes")))
            ),
            "origin": _cell(*_origin(name, item)),
        },
    }


def _json(value: Any) -> Any:
    """A cell as JSON takes it; what is missing is null."""
    if value is None or pd.isna(value):
        return None
    return value.item() if hasattr(value, "item") else value


def _cell(text: str, order: float | None, told: str = "") -> dict[str, Any]:
    """What is shown, what it is sorted by, and the reference's value where the run's is of quick size."""
    return {"text": text, "order": "" if order is None else f"{order:.12g}", "told": told}


def _text(value: Any) -> str:
    return NONE if value is None or pd.isna(value) else str(value)


def _smooth(row: Row) -> dict[str, Any]:
    easy, worst = row["smooth_k"], row["smooth_k_worst"]
    if pd.isna(easy):
        return _cell(NONE, None)
    text, least = _continuity(int(easy)), easy if pd.isna(worst) else worst
    if least < easy:
        text += f", at worst {_continuity(int(least))}"
    return _cell(text, -(10 * easy + least))


def _continuity(k: int) -> str:
    return "a leap" if k < 0 else SUPERSCRIPTS.get(k, f"C{k}")


def _local(row: Row, item: Found | None) -> dict[str, Any]:
    """How many keyframes shape a segment, as measured, and how many it looks ahead, as claimed."""
    support = row["support"]
    if pd.isna(support):
        return _cell(NONE, None)
    if support == "all":
        return _cell("no: all", 1e9)
    scheme = item.scheme if isinstance(item, Found) else None
    ahead = "" if scheme is None or scheme.lookahead is None else f", {scheme.lookahead} ahead"
    return _cell(f"{support} keyframes{ahead}", float(support))


def _number(row: Row, column: str, spec: str, told: pd.DataFrame | None) -> dict[str, Any]:
    value = row.get(column)
    if value is None or pd.isna(value):
        return _cell(NONE, None)
    text = _written(value, spec)
    return _cell(
        text,
        float(value) * (-1.0 if column == "order" else 1.0),
        _told(row, column, spec, text, told),
    )


def _told(row: Row, column: str, spec: str, text: str, told: pd.DataFrame | None) -> str:
    """The reference's value, where it is another."""
    if told is None or column not in told:
        return ""
    values = told.loc[told["scheme"] == row["scheme"], column].dropna()
    own = _written(values.iloc[0], spec) if len(values) else ""
    return "" if own == text else own


def _written(value: float, spec: str) -> str:
    if value == float("inf"):
        return INFINITE
    return format(value, ",.0f" if abs(value) >= LARGE else spec)


def failure(row: Row) -> str:
    """The gravest failure of a scheme in words."""
    if row.get("passes_keys") == NO:
        return "passes near its keyframes, not through them"
    if pd.isna(row["worst_failure"]):
        return "none found"
    first = str(row["worst_failure"]).split("; ")[0]
    for pattern, words in WORDS:
        if re.fullmatch(pattern, first):
            return re.sub(pattern, words, first)
    return first


def _origin(name: str, item: Found | None) -> tuple[str, float]:
    """Whose a scheme is, and its place in the order: ours first."""
    scheme = item.scheme if isinstance(item, Found) else None
    if scheme is None:
        return "not installed here", 3.0
    if scheme.peer:
        return f"library: {scheme.peer}", 2.0
    if name == PAPERS:
        return "the paper's", 0.5
    return ("ours", 0.0) if ours(name) else ("published", 1.0)
