"""Links from a page into the documentation, where that lies beside it: derivations, and how to read a table."""

from __future__ import annotations

import os
import re
from functools import cache
from pathlib import Path

from quatspline.discovery import shipped

INDEX = "schemes.md"
ROW = re.compile(r"^\| \[`([\w-]+)`\]\((\S+\.md)\) \|", re.MULTILINE)
"""A line of the documentation's table of schemes whose name leads somewhere."""

READING = "results.md"
HEADING = re.compile(r"^## (`.+`)$", re.MULTILINE)
"""A heading over what columns of one table or of several mean."""


class Derivations:
    """Links from the page of a results folder.

    They are relative, so that a checkout can be moved; a folder elsewhere gets none, since a link from
    it would hold the way through somebody's disk.
    """

    def __init__(self, folder: Path) -> None:
        docs = shipped("docs")
        self._pages, self._readings = (_pages(docs), _readings(docs)) if docs.is_dir() else ({}, {})
        inside = folder.resolve().is_relative_to(docs.parent.resolve())
        self._prefix = os.path.relpath(docs, folder.resolve()) if inside else ""

    def of(self, scheme: str) -> str:
        """The address of a scheme's derivation, empty where there is none."""
        page = self._pages.get(scheme, "")
        return self.to(page) if page else ""

    def reading(self, table: str) -> str:
        """The address of what a table's columns mean, empty where nothing is written of it."""
        anchor = self._readings.get(table, "")
        return self.to(f"{READING}#{anchor}") if anchor else ""

    def to(self, page: str) -> str:
        """The address of a page of the documentation."""
        return f"{Path(self._prefix).as_posix()}/{page}" if self._prefix else ""


@cache
def _pages(docs: Path) -> dict[str, str]:
    index = docs / INDEX
    return dict(ROW.findall(index.read_text(encoding="utf-8"))) if index.is_file() else {}


@cache
def _readings(docs: Path) -> dict[str, str]:
    """Anchors by the tables that their headings name."""
    file = docs / READING
    headings = HEADING.findall(file.read_text(encoding="utf-8")) if file.is_file() else []
    return {name: _anchor(text) for text in headings for name in re.findall(r"`([\w-]+)`", text)}


def _anchor(heading: str) -> str:
    """As GitHub makes it: letters, digits, hyphens, and a hyphen for every blank."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
