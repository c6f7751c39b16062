"""The columns of every table, behind its section of docs/results.md, from the page's glossary."""

from __future__ import annotations

import html
import re
from pathlib import Path
from typing import Any

from quatspline.page.glossary import Column, column

REFERENCE = Path(__file__).resolve().parents[2] / "results" / "reference"
PAGE = "results.md"
SECTION = re.compile(r"^## .*?(?=^## |\Z)", re.M | re.S)
NAME = re.compile(r"`([\w-]+)`")
WAYS = {"less": "less is better", "more": "more is better", "": ""}


def on_page_markdown(text: str, page: Any, **_: Any) -> str:
    """Append to every section the columns of the tables that its heading names."""
    return SECTION.sub(_with_columns, text) if page.file.src_uri == PAGE else text


def _with_columns(m: re.Match[str]) -> str:
    names = NAME.findall(m[0].partition("\n")[0])
    return m[0].rstrip() + "\n\n" + "".join(map(columns, names)) + "\n"


def columns(name: str) -> str:
    """The columns of a table that the glossary explains, folded; nothing without a table in results/reference."""
    file = REFERENCE / f"{name}.csv"
    if not file.exists():
        return ""
    with file.open(encoding="utf-8") as lines:
        heads = next(lines).strip().split(",")
    known = [(head, column(name, head)) for head in heads]
    rows = [_row(head, what) for head, what in known if what.meaning != head.replace("_", " ")]
    table = f"<table><tr><th>column</th><th>meaning</th><th>unit</th><th></th></tr>{''.join(rows)}</table>"
    return (
        f"<details><summary>Columns of <code>{name}.csv</code></summary>{table}</details>\n\n"
        if rows
        else ""
    )


def _row(head: str, what: Column) -> str:
    cells = (html.escape(text) for text in (what.meaning, what.unit, WAYS[what.better]))
    return f"<tr><td><code>{head}</code></td>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"
