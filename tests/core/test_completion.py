"""Tab completion: what shells are answered, as they ask."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from quatspline import catalogue
from quatspline.options import declared_by
from quatspline.runs.experiment import files

BREAKS = " \t\n\"'><=;|&(:"


def completed(folder: Path, line: str, **more: str) -> set[str]:
    """What may follow a line, as argcomplete's protocol asks for it."""
    answer = folder / "answer"
    asked = {"_ARGCOMPLETE": "1", "_ARGCOMPLETE_IFS": "\n", "_ARGCOMPLETE_COMP_WORDBREAKS": BREAKS}
    asked |= {"COMP_LINE": line, "COMP_POINT": str(len(line)), "COMP_TYPE": "9"}
    asked |= {"_ARGCOMPLETE_STDOUT_FILENAME": str(answer), "_ARGCOMPLETE_SUPPRESS_SPACE": "1"}
    command = [sys.executable, "-m", "quatspline"]
    done = subprocess.run(
        command, env=os.environ | asked | more, cwd=folder, capture_output=True, check=True
    )
    assert not done.stdout
    return set(answer.read_text(encoding="utf-8").split("\n")) - {""}


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("quatspline com", {"compare"}),
        ("quatspline compare --sm", {"--smooth"}),
        ("quatspline options monotone", {"monotone-quintic"}),
        ("quatspline compare --schemes slerp squa", {"squad"}),
        ("quatspline compare --schemes slerp,squa", {"slerp,squad"}),
        ("quatspline sample x.csv --scheme log-cubic --option ", {"ends=", "reference="}),
        ("quatspline compare --schemes kim,slerp --option me", {"method="}),
    ],
)
def test_what_a_shell_is_offered(tmp_path: Path, line: str, expected: set[str]) -> None:
    assert completed(tmp_path, line) == expected


def test_all_experiments_and_files(tmp_path: Path) -> None:
    (tmp_path / "robot.csv").touch()
    assert completed(tmp_path, "quatspline run ") >= set(files())
    assert completed(tmp_path, "quatspline compare rob") == {"robot.csv"}


def test_no_plug_in_is_imported_for_its_name(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "import pathlib\npathlib.Path(__file__).with_suffix('.ran').touch()\n", encoding="utf-8"
    )
    own = {"QUATSPLINE_BASELINES": str(tmp_path)}
    assert completed(tmp_path, "quatspline options min", **own) == {"min-torque", "mine"}
    assert not (tmp_path / "mine.ran").exists()


def test_names_are_those_of_what_is_found() -> None:
    assert catalogue.names() == list(catalogue.found())
    assert {"ends", "reference"} == set(declared_by(catalogue.scheme("log-cubic")))
