"""The chooser at the top of the page: six questions over one table with a row per scheme, nine columns.

What is measured comes from the folder's tables `choosing` and `excursion`, what is claimed (how far ahead a
segment looks, whether a scheme iterates) from the catalogue.
"""

from __future__ import annotations

import re
from typing import Any

import pandas as pd

from quatspline.catalogue import PAPERS, PLUG_IN, found, ours
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
    ("scheme", "scheme", "linked to its derivation if the documentation is next to the page"),
    ("smooth", "Cᵏ", "continuity measured at steps of 60 degrees, and the worst measured anywhere"),
    ("local", "local", "keyframes that shape a segment, and how many of them come after it"),
    ("order", "order", "order of the error on a smooth motion; more is better"),
    ("torque", "torque", "median torque energy over the least possible; less is better"),
    ("failure", "worst failure", "the most serious failure found"),
    (
        "time",
        "ns per sample",
        "time per sample, of 10,000 samples or the most measured; less is better",
    ),
    ("closes", "closes", "whether the scheme has closed curves"),
    (
        "origin",
        "origin",
        "ours, published by others and implemented here, a library with its version, or a plug-in",
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
    table = reference(folder, TABLE)
    told = {} if table is None else {str(row["scheme"]): row for row in records(_known(table))}
    derivations = Derivations(folder.path)
    return {
        "questions": [_question(choice, rows) for choice in CHOICES],
        "columns": COLUMNS,
        "rows": [_row(row, told.get(str(row["scheme"])), derivations) for row in records(rows)],
    }


def facts(folder: Folder) -> pd.DataFrame:
    """The table `choosing`, with the columns that conditions and cells ask besides."""
    rows = _known(folder.frame(TABLE))
    least, worst = rows["smooth_k"], rows["smooth_k_worst"]
    keeps = (worst >= least).map({True: YES, False: NO})
    rows["keeps_smooth"] = keeps.where(least.notna() & worst.notna())
    rows["faults"] = rows["worst_failure"].notna().map({True: YES, False: NO})
    rows["iterates"] = rows["found"].map(_iterates).astype(object)
    rows = rows.join(_excursions(folder), on="scheme")
    return rows.sort_values("torque", kind="stable")


def _known(table: pd.DataFrame) -> pd.DataFrame:
    """The table with all columns that cells are made of, and what the catalogue has under the schemes' names."""
    known = ["smooth_k", "smooth_k_worst", "worst_failure", "torque", "support"]
    rows = table.reindex(columns=list(dict.fromkeys([*table.columns, *known])))
    return rows.assign(found=rows["scheme"].map(lambda name: found().get(str(name))))


def _iterates(item: Any) -> str | None:
    if not isinstance(item, Found) or item.scheme is None:
        return None
    return YES if item.scheme.iterative else NO


def _excursions(folder: Folder) -> pd.DataFrame:
    """By scheme: degrees that it wanders at most during long holds, and the largest share of steps that it overshoots.

    Nothing where that was not measured.
    """
    if "excursion" not in folder.tables:
        return pd.DataFrame({"wander": [], "overshot": []}, dtype=float)
    table = folder.frame("excursion")
    holds = table[table["data"].eq(HOLD)].set_index("scheme")["wander_worst"]
    return pd.DataFrame({"wander": holds, "overshot": table.groupby("scheme")["overshot"].max()})


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


def _row(row: Row, told: Row | None, derivations: Derivations) -> dict[str, Any]:
    name, cells = str(row["scheme"]), _cells(row)
    asked = {c.column for choice in CHOICES for a in choice.answers for c in a.conditions}
    for key, other in {} if told is None else _cells(told).items():
        cells[key]["told"] = "" if other["text"] in (cells[key]["text"], NONE) else other["text"]
    return {
        "scheme": name,
        "link": derivations.of(name),
        "facts": {column: _json(row.get(column)) for column in sorted(asked)},
        "cells": cells,
    }


def _cells(row: Row) -> dict[str, dict[str, Any]]:
    """What is shown of a scheme, by column."""
    closes = row.get("closes")
    return {
        "smooth": _smooth(row),
        "local": _local(row),
        **{key: _number(row, *where) for key, where in NUMBERS.items()},
        "failure": _cell(failure(row), 0.0 if pd.isna(row["worst_failure"]) else 1.0),
        "closes": _cell(_text(closes), {YES: 0.0, NO: 1.0}.get(str(closes))),
        "origin": _cell(*_origin(str(row["scheme"]), row["found"])),
    }


def _json(value: Any) -> Any:
    """A cell as JSON takes it; what is missing is null."""
    if value is None or pd.isna(value):
        return None
    return value.item() if hasattr(value, "item") else value


def _cell(text: str, order: float | None) -> dict[str, Any]:
    """What is shown, what it is sorted by, and room for the reference's text beside a quick run's."""
    return {"text": text, "order": "" if order is None else f"{order:.12g}", "told": ""}


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


def _local(row: Row) -> dict[str, Any]:
    """How many keyframes shape a segment, as measured, and how many it looks ahead, as claimed."""
    support, item = row["support"], row["found"]
    if pd.isna(support):
        return _cell(NONE, None)
    if support == "all":
        return _cell("no: all", 1e9)
    scheme = item.scheme if isinstance(item, Found) else None
    ahead = "" if scheme is None or scheme.lookahead is None else f", {scheme.lookahead} ahead"
    return _cell(f"{support} keyframes{ahead}", float(support))


def _number(row: Row, column: str, spec: str) -> dict[str, Any]:
    value = row.get(column)
    if value is None or pd.isna(value):
        return _cell(NONE, None)
    return _cell(_written(value, spec), float(value) * (-1.0 if column == "order" else 1.0))


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
    """Whose a scheme is, and its place in the order: what a user added first, then ours."""
    if not isinstance(item, Found) or item.scheme is None:
        return "not installed here", 3.0
    if item.scheme.peer:
        return f"library: {item.scheme.peer}", 2.0
    if not item.shipped:
        return PLUG_IN, -1.0
    if name == PAPERS:
        return "the paper's", 0.5
    return ("ours", 0.0) if ours(name) else ("published", 1.0)
