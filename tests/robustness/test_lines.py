"""What files say does not reach a terminal as it stands, and work on one line of a file is bounded."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from quatspline.cli.commands import main
from quatspline.system.sentence import MOST

ROWS = "0,1,0,0,0,7\n1,0.8,0.6,0,0,7\n2,0.6,0.8,0,0,7\n"
VERBS = {
    "info": [],
    "sample": ["--scheme", "slerp", "--count", "3"],
    "reduce": ["--error", "1deg"],
    "compare": ["--schemes", "slerp", "--out", "out"],
}


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path / "motion.csv"


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("t,q\0w,qx,qy,qz,n\n" + ROWS, "line 1: a NUL character"),
        ("t,qw,qx,qy,qz,n\n" + ROWS + "\0" * 5000, "line 5: a NUL character"),
        ("t,qw,qx,qy,qz" + ",n" * 20_000 + "\n" + ROWS, "20,005 columns: 10,000 at most are read"),
        ("t,qw,qx,qy,qz,n\n" + ROWS + "x" * 2**21, "line 5: longer than 1,048,576 characters"),
        ("t,qw,qx,qy,qz,n\n" + ROWS + "\x1b[31m,1,0,0,0,7\n", r"t = '\x1b[31m' is not a number"),
        ("t,qw,qx,qy,qz,n\n" + ROWS + "\u0663,1,0,0,0,7\n", "is not a number"),
    ],
    ids=["nul-header", "nul-row", "columns", "long", "escape", "digits"],
)
def test_a_line_is_refused_in_a_sentence(
    file: Path, capsys: pytest.CaptureFixture[str], verb: str, content: str, reason: str
) -> None:
    file.write_text(content, encoding="utf-8")
    assert main([verb, file.name, *VERBS[verb]]) == 2
    said = capsys.readouterr().err.rstrip("\n")
    assert reason in said
    assert len(said) <= MOST
    assert said.isprintable()


def test_names_in_a_file_are_listed_briefly_and_escaped(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = ",".join(["\x1b[31mred", *(f"c{i}" for i in range(99))])
    row = ",7" * 99
    text = ROWS.replace(",7\n", f",7{row}\n")
    file.write_text(f"t,qw,qx,qy,qz,{names}\n{text}", encoding="utf-8")
    assert main(["info", file.name]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert any(
        line.endswith(r"\x1b[31mred, c0, c1, c2, c3, c4, c5, c6 and 92 more") for line in lines
    )
    assert all(line.isprintable() for line in lines)


def test_names_of_files_need_not_be_utf_8(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given, out = (os.fsdecode(name) for name in (b"n\xff.csv", b"o\xff"))
    Path(given).write_text("t,qw,qx,qy,qz,n\n" + ROWS, encoding="utf-8")
    assert main(["compare", given, "--schemes", "slerp", "quartic", "--out", out]) == 0
    assert (Path(out) / "report.html").is_file()
    assert main(["sample", given, "--scheme", "slerp", "--count", "3", "-o", f"{out}.csv"]) == 0
    assert Path(f"{out}.csv").is_file()


@pytest.mark.parametrize("value", ["9" * 400, "x" * 5000, "1" * 5000, "\x1b[31m"])
@pytest.mark.parametrize("option", ["ends", "max_iterations", "tolerance", "start_velocity"])
def test_an_option_is_refused_in_a_sentence(
    file: Path, capsys: pytest.CaptureFixture[str], option: str, value: str
) -> None:
    file.write_text("t,qw,qx,qy,qz,n\n" + ROWS, encoding="utf-8")
    asked = ["--scheme", "kim", "--count", "3", "--option", f"{option}={value}"]
    assert main(["sample", file.name, *asked]) == 2
    said = capsys.readouterr().err.rstrip("\n")
    assert option in said
    assert len(said) <= MOST
    assert said.isprintable()
