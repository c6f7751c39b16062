"""What a results folder holds: tables with their titles and notes, figures with their captions, the manifest."""

from __future__ import annotations

import csv
import json
import re
import reprlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from quatspline.findings.findings import reader
from quatspline.motion.replay import PARTS
from quatspline.runs.manifest import MANIFEST, json_object
from quatspline.runs.results import REPLAYS
from quatspline.system.atomic import check_plain

OWN_WORDS = {"table1": "Table 1", "edge-cases": "Edge cases"}
"""Names of tables that are not their name capitalised."""

NAMES: dict[type, str] = {str: "text", list: "a list", dict: "an object"}
KINDS: dict[str, type] = {
    **dict.fromkeys(("start", "end", "platform"), str),
    "command": list,
    **dict.fromkeys(("cpu", "git", "seeds", "versions", "experiments", "sizes"), dict),
}
"""What the page reads of a manifest; null counts as empty: a run that was cut short has no end."""

KEYS = {"cpu": ("model", "cores", "usable"), "git": ("revision", "dirty")}
ENTRY = ("size", "seed", "seconds")
"""What an object of the manifest holds unless it is empty, and what every experiment's entry does."""


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

    @property
    def size(self) -> tuple[float, float]:
        """Width and height in the figure's own units, for which a page keeps room; a square where it tells none."""
        box = re.search(r'<svg[^>]*\sviewBox="0 0 ([\d.]+) ([\d.]+)"', self.svg)
        return (float(box[1]), float(box[2])) if box else (1.0, 1.0)


class Folder:
    """A results folder, read.

    Attributes
    ----------
    frame : gives a table by its name
    manifest : what the manifest holds, empty what it lacks; {} where there is none

    Raises ValueError for a folder that is not there or holds no table, and with the path for a file that
    is not what its name says.
    """

    def __init__(self, path: Path) -> None:
        self.path = existing(path)
        self.frame = reader(path)
        if not self.tables:
            raise ValueError(f"{path}: no table in this folder; quatspline run writes them")
        manifest = path / MANIFEST
        self.manifest = _manifest(manifest) if manifest.is_file() else {}

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
    def replays(self) -> list[dict[str, Any]]:
        """All recorded motions for the player, in the order of the files' names."""
        return [
            motion for path in sorted(self.path.glob(f"*{REPLAYS}")) for motion in _motions(path)
        ]

    @property
    def failures(self) -> dict[str, str]:
        """Experiments that failed, with the reason."""
        entries = self.manifest.get("experiments", {}).items()
        return {name: entry["failure"] for name, entry in entries if entry.get("failure")}

    def _table(self, path: Path) -> Table:
        self.frame(path.stem)  # refuses what is no table, before anything is written
        title, note = _heading(_read(path.with_suffix(".md")))
        fallback = OWN_WORDS.get(path.stem, path.stem.replace("-", " ").capitalize())
        text = path.read_bytes().decode("utf-8")  # as it is, for downloading
        return Table(path.stem, title or fallback, note, text)


def existing(path: str | Path) -> Path:
    """A folder that is there, or a ValueError."""
    if not Path(path).is_dir():
        raise ValueError(f"{path}: no such folder; quatspline run makes it")
    return Path(path)


def _read(path: Path) -> str:
    if not path.is_file():
        return ""
    try:
        return path.read_text(encoding="utf-8").strip()
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: not a text file: {error}") from error


def _manifest(path: Path) -> dict[str, Any]:
    """A manifest, refused if it is torn or its parts are not what a run writes."""
    manifest = json_object(path)
    for name, kind in KINDS.items():
        given = manifest.get(name)
        manifest[name] = kind() if given is None else given
        _expect(f"{path}: {name}", manifest[name], kind, KEYS.get(name, ()) if given else ())
    for name, entry in manifest["experiments"].items():
        _expect(f"{path}: experiments: {name}", entry, dict, ENTRY)
    return manifest


def _expect(where: str, value: Any, kind: type[Any], keys: tuple[str, ...]) -> None:
    """Refuse a value of another kind, and an object that lacks one of the keys."""
    if not isinstance(value, kind):
        raise ValueError(f"{where}: {NAMES[kind]} is expected, found {reprlib.repr(value)}")
    lacking = [key for key in keys if key not in value]
    if lacking:
        raise ValueError(f"{where}: {lacking[0]!r} is missing")


def _motions(path: Path) -> list[dict[str, Any]]:
    """Motions that `quatspline.motion.replay` made, refused if they are not."""
    try:
        check_plain(path)
        content = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{path}: not a file in JSON: {error}") from error
    _expect(str(path), content, list, ())
    for number, motion in enumerate(content):
        _expect(f"{path}: motion {number}", motion, dict, PARTS)
    return list(content)


def _heading(markdown: str) -> tuple[str, str]:
    """The title and the paragraphs before the table of a Markdown copy."""
    found = re.match(r"# (.*)\n", markdown)
    rest = markdown[found.end() :] if found else markdown
    note = re.split(r"^\|", rest, maxsplit=1, flags=re.MULTILINE)[0]
    return (found[1].strip() if found else ""), " ".join(note.split())
