"""Words behind `--schemes`: names, and what only looks as if it were one."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from quatspline.cli import commands, running, words
from quatspline.cli import compare as compare_command
from quatspline.runs import experiment


@pytest.fixture
def asked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What a command was asked for, in a folder with files of keyframes."""
    seen: dict[str, Any] = {}

    def compare(motion: Any, **given: Any) -> int:
        out = given.pop("results").folder
        seen.update(given, keyframes=len(motion.quaternions), out=Path(out.name))
        return 0

    def run(experiments: Any, **given: Any) -> list[str]:
        seen.update(given, experiments=list(experiments))
        return []

    monkeypatch.setattr(compare_command, "command", compare)
    monkeypatch.setattr(running, "run", run)
    monkeypatch.chdir(tmp_path)
    rows = ("0,1,0,0,0\n", "1,0.8,0.6,0,0\n", "2,1,0,0,0\n")
    for name in ("k.csv", "slerp"):
        Path(name).write_text("".join(rows))
    return seen


@pytest.mark.parametrize(
    "given",
    [
        ["k.csv", "--schemes", "kim,nlerp"],
        ["k.csv", "--schemes", "kim", "nlerp"],
        ["--schemes", "kim,nlerp", "k.csv"],
        ["--schemes", "kim", "nlerp", "k.csv"],
        ["--schemes", "kim,", "nlerp", "k.csv"],
        ["--schemes", "kim", "k.csv", "nlerp"],
        ["--schemes", "kim,nlerp", "--closed", "k.csv"],
        ["--schemes", "kim,nlerp", "k.csv", "--closed"],
        ["--closed", "k.csv", "--schemes", "kim", "--schemes", "nlerp"],
        ["--schemes", "kim", "--schemes", "nlerp", "k.csv"],
        ["--schemes", "kim", "nlerp", "--", "k.csv"],
        ["--closed", "--schemes", "kim", "nlerp", "--", "k.csv"],
        ["--schemes", "kim", "nlerp", "--out", "d", "k.csv"],
        ["--schemes=kim,nlerp", "k.csv"],
    ],
)
def test_compare_finds_its_file(asked: dict[str, Any], given: list[str]) -> None:
    assert commands.main(["compare", *given]) == 0
    assert asked["schemes"] == ["kim", "nlerp"]
    assert asked["keyframes"] == (2 if "--closed" in given else 3)
    assert asked["out"] == Path("d" if "d" in given else "k-compared")


def test_a_schemes_name_is_no_file_beside_one(asked: dict[str, Any]) -> None:
    assert commands.main(["compare", "--schemes", "kim", "slerp", "k.csv"]) == 0
    assert asked["schemes"] == ["kim", "slerp"]
    assert words.of_compare("slerp", [["slerp"]]) == ("slerp", ["slerp"])


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ([], "the following arguments are required: KEYFRAMES"),
        (["--closed"], "the following arguments are required: KEYFRAMES"),
        (["--schemes", "kim,nlerp"], "the following arguments are required: KEYFRAMES"),
        (
            ["--schemes", "kim", "slerp"],
            "--schemes ... slerp: both a scheme and a file: if a file is meant, put it before --schemes",
        ),
        (["--schemes", "quartik", "k.csv"], "unknown scheme 'quartik': did you mean 'quartic'?"),
        (
            ["--schemes", "kim", "quartik"],
            "'quartik' is neither a file nor a scheme: did you mean 'quartic'?",
        ),
        (["--schemes", "kim", "no.csv"], "no.csv: cannot be read: No such file or directory"),
        (
            ["--schemes", "kim", "k.csv", "no.csv"],
            "one file of keyframes is expected, not 2: k.csv, no.csv",
        ),
        (["--schemes", "k.csv"], "--schemes: no name given"),
        (["--schemes", ",", "k.csv"], "--schemes: no name given"),
    ],
)
def test_compare_tells_what_it_cannot_place(
    asked: dict[str, Any], given: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert commands.main(["compare", *given]) == 2
    assert capsys.readouterr().err == f"quatspline: {sentence}\n"
    assert not asked


@pytest.mark.parametrize(
    ("given", "experiments"),
    [
        (["table1", "--schemes", "kim,nlerp"], ["table1"]),
        (["table1", "--schemes", "kim", "nlerp"], ["table1"]),
        (["--schemes", "kim", "nlerp"], []),
        (["--schemes", "kim,nlerp"], []),
        (["--schemes", "kim,nlerp", "table1"], ["table1"]),
        (["--schemes", "kim", "nlerp", "table1", "noise"], ["table1", "noise"]),
        (["--schemes", "kim,nlerp", "--quick", "table1"], ["table1"]),
    ],
)
def test_run_finds_its_experiments(
    asked: dict[str, Any], given: list[str], experiments: list[str]
) -> None:
    assert commands.main(["run", *given]) == 0
    assert asked["schemes"] == ["kim", "nlerp"]
    assert asked["experiments"] == experiments


def test_run_without_schemes_leaves_the_choice_open(asked: dict[str, Any]) -> None:
    assert commands.main(["run", "table1"]) == 0
    assert (asked["schemes"], asked["experiments"]) == (None, ["table1"])


def test_an_experiment_called_like_a_scheme_is_told(
    asked: dict[str, Any], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(experiment, "files", lambda: {"slerp": Path("slerp.py")})
    assert commands.main(["run", "--schemes", "kim", "slerp"]) == 2
    assert "--schemes ... slerp: both a scheme and an experiment" in capsys.readouterr().err
    assert commands.main(["run", "slerp", "--schemes", "kim", "slerp"]) == 0
    assert (asked["schemes"], asked["experiments"]) == (["kim", "slerp"], ["slerp"])
