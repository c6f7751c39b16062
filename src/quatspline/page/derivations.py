"""Where a scheme is derived: links from a page into the documentation, where that lies beside it."""

from __future__ import annotations

import os
import re
from functools import cache
from pathlib import Path

from quatspline.discovery import shipped

INDEX = "schemes.md"
ROW = re.compile(r"^\| \[`([\w-]+)`\]\((\S+\.md)\) \|", re.MULTILINE)
"""A line of the documentation's table of schemes whose name leads somewhere."""


class Derivations:
    """Links from the page of a results folder.

    They are relative, so that a checkout can be moved; a folder elsewhere gets none, since a link from
    it would hold the way through somebody's disk.
    """

    def __init__(self, folder: Path) -> None:
        docs = shipped("docs")
        self._pages = _pages(docs) if docs.is_dir() else {}
        inside = folder.resolve().is_relative_to(docs.parent.resolve())
        self._prefix = os.path.relpath(docs, folder.resolve()) if inside else ""

    def of(self, scheme: str) -> str:
        """The address of a scheme's derivation, empty where there is none."""
        page = self._pages.get(scheme, "")
        return self.to(page) if page else ""

    def to(self, page: str) -> str:
        """The address of a page of the documentation."""
        return f"{Path(self._prefix).as_posix()}/{page}" if self._prefix else ""


@cache
def _pages(docs: Path) -> dict[str, str]:
    index = docs / INDEX
    return dict(ROW.findall(index.read_text(encoding="utf-8"))) if index.is_file() else {}
