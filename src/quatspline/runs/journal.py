"""What an interrupted run had finished: its experiments, and the cells of a sweep.

Cells are kept a line each, appended as they finish.  A line says of which run it is and bears a
checksum of itself.  So each stands or falls alone: what a kill tore, a full disk cut short or a disk
altered costs the cells of those lines and no other, and cells of other options or sources stay in the
file, unused, for the run that they belong to.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections.abc import Mapping
from contextlib import suppress
from io import FileIO
from typing import TYPE_CHECKING, Any

from quatspline.runs.manifest import read_json, write_json
from quatspline.runs.provenance import now
from quatspline.runs.store import JOURNAL
from quatspline.system.atomic import ASIDE, clear_asides, naming, replacing

if TYPE_CHECKING:
    from quatspline.runs.results import Results

FOLDER = ".cells"
SUM = ', "sum": "'
"""What stands between the content of a line and its checksum."""

Cell = dict[str, Any]


class Journal:
    """The experiments that an interrupted run had finished: valid for one of the same fingerprint only."""

    def __init__(self, results: Results, fingerprint: str) -> None:
        self.results, self.path = results, results.folder / JOURNAL
        found = read_json(self.path)
        same = found.get("fingerprint") == fingerprint and found.pop("sum", None) == _sum(found)
        fresh = {"fingerprint": fingerprint, "start": now(), "finished": {}}
        self.content: dict[str, Any] = found if same else fresh

    def finished(self, name: str) -> dict[str, Any] | None:
        """The entry of an experiment that need not run again: its files are there, unchanged."""
        entry = self.content["finished"].get(name)
        return entry if entry and self.results.intact(entry["files"]) else None

    def add(self, name: str, entry: Mapping[str, Any]) -> None:
        """Note that an experiment has finished."""
        self.content["finished"][name] = dict(entry)
        write_json(self.path, self.content | {"sum": _sum(self.content)})

    def close(self) -> None:
        """The run is complete: forget."""
        self.path.unlink(missing_ok=True)


def _sum(content: Mapping[str, Any]) -> str:
    """A checksum: an entry altered on the disk would enter the manifest."""
    return _checksum(key(content).encode())


class Kept:
    """The finished cells of one experiment that a run of this fingerprint may use.

    Attributes
    ----------
    path : the file; opening it only ever removes lines that are torn or damaged, and says so
    rows : the rows of each finished cell by its `key`
    """

    def __init__(self, results: Results, name: str, fingerprint: str) -> None:
        self.path = results.folder / FOLDER / f"{name}.jsonl"
        self.path.parent.mkdir(exist_ok=True)
        if self.path.is_symlink():
            raise ValueError(
                f"{self.path}: is a link, and finished cells are not written through links"
            )
        clear_asides(self.path.parent)
        self.fingerprint = fingerprint
        self.rows: dict[str, list[dict[str, Any]]] = {}
        for entry in self._entries(name):
            if entry["run"] == fingerprint:
                self.rows[key(entry["cell"])] = entry["rows"]

    def _entries(self, name: str) -> list[dict[str, Any]]:
        """What the lines say that are as they were written; others are dropped from the file."""
        content = self.path.read_bytes() if self.path.is_file() else b""
        lines = [line for line in content.split(b"\n") if line]
        sound = {line: entry for line in lines if (entry := _entry(line)) is not None}
        whole = b"".join(line + b"\n" for line in sound)
        if whole != content:
            with replacing(self.path, ASIDE) as aside:
                aside.write_bytes(whole)
        if lost := sum(line not in sound for line in lines):
            what = "1 line is" if lost == 1 else f"{lost} lines are"
            told = f"{name}: {what} damaged in the journal of cells: dropped, to be measured again"
            print(told, file=sys.stderr, flush=True)
        return list(sound.values())

    def add(self, cell: Cell, rows: str) -> None:
        """Keep a cell's rows: on the disk before anything else can go wrong."""
        body = f'{{"run": {json.dumps(self.fingerprint)}, "cell": {key(cell)}, "rows": {rows}'
        line = f'{body}{SUM}{_checksum(body.encode())}"}}\n'.encode()
        with naming(self.path), FileIO(self.path, "a") as stream:
            _append(stream, line)
        self.rows[key(cell)] = json.loads(rows)


def _append(stream: FileIO, line: bytes) -> None:
    """Append a line, or nothing of it where it does not fit."""
    before = os.fstat(stream.fileno()).st_size
    left = memoryview(line)
    try:
        while left:  # a disk that runs full takes a part before it fails
            left = left[stream.write(left) :]
        os.fsync(stream.fileno())
    except OSError:
        with suppress(OSError):
            stream.truncate(before)
        raise


def _entry(line: bytes) -> dict[str, Any] | None:
    """What a line says; None if it is not as it was written."""
    body, _, checksum = line.rpartition(SUM.encode())
    if checksum != f'{_checksum(body)}"}}'.encode():
        return None
    entry: dict[str, Any] = json.loads(body + b"}")
    return entry


def _checksum(body: bytes) -> str:
    return hashlib.sha256(body).hexdigest()[:16]


def forget(results: Results, name: str) -> None:
    """Remove an experiment's cells: its table is written."""
    (results.folder / FOLDER / f"{name}.jsonl").unlink(missing_ok=True)
    with suppress(OSError):  # other experiments' cells are in it, or it never was
        (results.folder / FOLDER).rmdir()


def key(cell: Mapping[str, Any]) -> str:
    """What tells a cell from others."""
    return json.dumps(cell, sort_keys=True)
