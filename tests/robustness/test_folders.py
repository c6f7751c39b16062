"""Results folders whose files are not what their names say: told in a sentence, and read in bounded time."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from quatspline.cli.commands import main
from quatspline.findings.findings import findings, reader
from quatspline.runs.manifest import MANIFEST
from quatspline.system.sentence import MOST

ODD: dict[str, Callable[[Path], object]] = {
    "folder": Path.mkdir,
    "pipe": os.mkfifo,
    "device": lambda path: path.symlink_to("/dev/zero"),
    "loop": lambda path: path.symlink_to(path.name),
    "empty": Path.touch,
    "noise": lambda path: path.write_bytes(bytes(range(128, 256)) * 20),
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "fine.csv").write_text("scheme,value\nslerp,1.0\n")
    return tmp_path


def refused(folder: Path, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", "--out", str(folder)]) == 2
    said = capsys.readouterr().err.rstrip("\n")
    assert name in said
    assert len(said.splitlines()) == 1
    assert len(said) <= MOST
    assert not (folder / "report.html").exists()


@pytest.mark.parametrize("kind", ODD)
def test_a_table_that_is_none_is_told(
    folder: Path, capsys: pytest.CaptureFixture[str], kind: str
) -> None:
    ODD[kind](folder / "accuracy.csv")
    refused(folder, "accuracy.csv: not a table in CSV", capsys)


@pytest.mark.parametrize("kind", ["empty", "noise"])
def test_a_manifest_that_is_none_is_told(
    folder: Path, capsys: pytest.CaptureFixture[str], kind: str
) -> None:
    ODD[kind](folder / MANIFEST)
    refused(folder, f"{MANIFEST}: not a file in JSON", capsys)


@pytest.mark.parametrize("kind", ["folder", "pipe", "device"])
def test_recorded_motions_that_are_none_are_told(
    folder: Path, capsys: pytest.CaptureFixture[str], kind: str
) -> None:
    ODD[kind](folder / "fine.replay.json")
    refused(folder, "fine.replay.json: not a file in JSON: no plain file", capsys)


def test_json_nested_without_end_is_told(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "fine.replay.json").write_text("[" * 100_000)
    refused(folder, "fine.replay.json: not a file in JSON", capsys)


def test_a_table_cut_short_supports_fewer_findings(folder: Path) -> None:
    """One size of accuracy: no orders can be read, and nothing else fails."""
    row = {"scheme": "quartic", "knots": "uniform", "keyframes": 9, "slope": 2.0}
    pd.DataFrame([row]).to_csv(folder / "accuracy.csv", index=False)
    assert findings(reader(folder)) == []
