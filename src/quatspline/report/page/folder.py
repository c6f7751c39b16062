"""What a results folder holds: tables with their titles and notes, figures with their captions, the manifest."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd

from quatspline.report.results import MANIFEST, Results, read_json

OWN_WORDS = {"table1": "Table 1", "edge-cases": "Edge cases"}
"""Names of tables that are not their name capitalised."""


@dataclass(frozen=True)
class Table:
    """A table as it lies in the folder.

    Attributes
    ----------
    name : the file's stem
    title, note : from the Markdown copy; the name and nothing where there is none
    text : the CSV itself
    """

    name: str
    title: str
    note: str
    text: str

    @property
    def columns(self) -> list[str]:
        """Names of its columns."""
        return next(csv.reader(self.text.splitlines()[:1]), [])


@dataclass(frozen=True)
class Picture:
    """A vector figure with its caption."""

    name: str
    svg: str
    caption: str


class Folder:
    """A results folder, read."""

    def __init__(self, path: Path) -> None:
        self.path = path
        if not path.is_dir():
            raise ValueError(f"{path}: no such folder; quatspline run makes it")
        if not self.tables:
            raise ValueError(f"{path}: no table in this folder; quatspline run writes them")

    @cached_property
    def tables(self) -> dict[str, Table]:
        """All tables by name."""
        return {path.stem: self._table(path) for path in sorted(self.path.glob("*.csv"))}

    @cached_property
    def pictures(self) -> dict[str, Picture]:
        """All figures by name."""
        found = sorted(self.path.glob("*.svg"))
        return {
            path.stem: Picture(path.stem, _read(path), _read(path.with_suffix(".caption.txt")))
            for path in found
        }

    @cached_property
    def manifest(self) -> dict[str, Any]:
        """What the manifest holds; {} where there is none."""
        return read_json(self.path / MANIFEST)

    @property
    def failures(self) -> dict[str, str]:
        """Experiments that failed, with the reason."""
        entries = self.manifest.get("experiments", {}).items()
        return {name: entry["failure"] for name, entry in entries if entry.get("failure")}

    def frame(self, name: str) -> pd.DataFrame:
        """A table as a frame."""
        return Results(self.path).read_table(name)

    def _table(self, path: Path) -> Table:
        title, note = _heading(_read(path.with_suffix(".md")))
        fallback = OWN_WORDS.get(path.stem, path.stem.replace("-", " ").capitalize())
        text = path.read_bytes().decode("utf-8")  # as it is, for downloading
        return Table(path.stem, title or fallback, note, text)


def _read(path: Path) -> str:
    return path.read_text(encoding="utf-8").strip() if path.is_file() else ""


def _heading(markdown: str) -> tuple[str, str]:
    """The title and the paragraphs before the table of a Markdown copy."""
    found = re.match(r"# (.*)\n", markdown)
    rest = markdown[found.end() :] if found else markdown
    note = re.split(r"^\|", rest, maxsplit=1, flags=re.MULTILINE)[0]
    return (found[1].strip() if found else ""), " ".join(note.split())
