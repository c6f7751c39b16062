"""Commands that write: what was read, what is somebody else's and what another run writes stays."""

from __future__ import annotations

import errno
import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

import processes
from quatspline.cli import commands, compare
from quatspline.runs import experiment
from quatspline.runs.results import Results
from quatspline.system.atomic import ASIDE, naming

KEYS = "t,qw,qx,qy,qz\n0,1,0,0,0\n1,0.8,0.6,0,0\n2,0.6,0.8,0,0\n3,0,1,0,0\n"
EXPERIMENT = """
import os, pathlib, time
import pandas as pd
TITLE, PAPER = "Told", False
def measure(run):
    with open("measured", "a") as log:
        log.write(".")
    while os.path.exists("hold"):
        time.sleep(0.01)
    return pd.DataFrame({"x": [1]})
"""

Refused = Callable[..., str]


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with keyframes and experiments."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "experiments").mkdir()
    for name in ("told", "else"):
        (tmp_path / "experiments" / f"{name}.py").write_text(EXPERIMENT)
    monkeypatch.setenv(experiment.FOLDERS, str(tmp_path / "experiments"))
    (tmp_path / "compare.csv").write_text(KEYS)
    return tmp_path


@pytest.fixture
def refused(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Refused:
    """The one line with which a command is refused, nothing measured."""

    def measured(*_: object) -> None:
        raise AssertionError("measured before it was refused")

    def call(*arguments: str) -> str:
        with monkeypatch.context() as patch:
            patch.setattr(compare, "command", measured)
            assert commands.main(arguments) == 2
        told = capsys.readouterr().err
        assert told.count("\n") == 1, told
        return told.removeprefix("quatspline: ").removesuffix("\n")

    return call


# -- compare and sample -------------------------------------------------------------------------


@pytest.mark.parametrize("force", [[], ["--force"]])
@pytest.mark.parametrize("way", ["compare.csv", "out/../compare.csv", "soft.csv", "hard.csv"])
def test_compare_never_writes_over_its_keyframes(
    desk: Path, refused: Refused, way: str, force: list[str]
) -> None:
    (desk / "out").mkdir()
    (desk / "soft.csv").symlink_to("compare.csv")
    os.link("compare.csv", "hard.csv")
    for out in (".", "out/.."):
        told = refused("compare", way, "--schemes", "slerp", "--out", out, *force)
        assert told.startswith(f"{way}: is also read here, so it is not overwritten")
    assert (desk / "compare.csv").read_text() == KEYS


def test_compare_replaces_foreign_files_by_force_only(
    desk: Path, refused: Refused, capsys: pytest.CaptureFixture[str]
) -> None:
    out = desk / "out"
    out.mkdir()
    (out / "rates.svg").write_text("precious")
    (out / "notes.md").write_text("precious")
    command = ["compare", "compare.csv", "--schemes", "slerp", "--out", "out"]
    assert refused(*command).startswith("out/rates.svg: not written by quatspline in this folder")
    assert sorted(os.listdir(out)) == ["notes.md", "rates.svg"]
    for force in (["--force"], []):  # and then they are its own
        assert commands.main([*command, *force]) == 0
    written = {*compare.FILES} & set(os.listdir(out))
    assert set(json.loads((out / "manifest.json").read_text())["files"]) == written
    assert (out / "notes.md").read_text() == "precious"
    assert "precious" not in (out / "rates.svg").read_text()
    with (out / "recommendation.md").open("a") as advice:
        advice.write("A note of mine.\n")
    capsys.readouterr()
    assert refused(*command).startswith("out/recommendation.md: not written by quatspline")


def test_a_manifest_of_something_else_stays(desk: Path, refused: Refused) -> None:
    web = '{"name": "an app", "icons": []}'
    (desk / "manifest.json").write_text(web)
    commands = (["run", "told"], ["compare", "compare.csv", "--schemes", "slerp"], ["report"])
    for command in commands[::2]:
        told = refused(*command, "--out", ".")
        assert told.startswith("manifest.json: ") or command == ["report"]
    (desk / "compare.csv").rename(desk / "keys.csv")
    told = refused("compare", "keys.csv", "--schemes", "slerp", "--out", ".")
    assert told.startswith("manifest.json: not written by quatspline")
    assert (desk / "manifest.json").read_text() == web
    assert not (desk / "measured").exists()


@pytest.mark.parametrize(
    "way", ["compare.csv", "experiments/../compare.csv", "soft.csv", "hard.csv"]
)
def test_sample_never_writes_over_its_keyframes(desk: Path, refused: Refused, way: str) -> None:
    (desk / "soft.csv").symlink_to("compare.csv")
    os.link("compare.csv", "hard.csv")
    told = refused("sample", "compare.csv", "--scheme", "slerp", "--count", "2", "-o", way)
    assert told == f"{way}: is also read here, so it is not overwritten"
    assert (desk / "compare.csv").read_text() == KEYS


def test_sample_writes_over_the_file_that_it_is_told_to(desk: Path) -> None:
    (desk / "old.csv").write_text("old")
    assert (
        commands.main(
            ["sample", "compare.csv", "--scheme", "slerp", "--count", "2", "-o", "old.csv"]
        )
        == 0
    )
    assert (desk / "old.csv").read_text().startswith("t,qw")


# -- run ----------------------------------------------------------------------------------------


def process(*arguments: str, **options: object) -> subprocess.Popen[str]:
    return subprocess.Popen(
        processes.command(*arguments),
        env=processes.environment(),
        stderr=subprocess.PIPE,
        text=True,
        **options,  # type: ignore[call-overload]
    )


@pytest.mark.parametrize("name", ["told.csv", "told.md", "told.error.txt", ".journal.json"])
def test_run_replaces_foreign_files_by_force_only(desk: Path, refused: Refused, name: str) -> None:
    out = desk / "results"
    out.mkdir()
    (out / "README.md").write_text("of the clone")
    (out / "reference").mkdir()
    (out / name).write_text("precious")
    assert refused("run", "told").startswith(f"results/{name}: not written by quatspline")
    assert not (desk / "measured").exists()
    assert commands.main(["run", "told", "--force"]) == 0
    assert commands.main(["run", "told"]) == 0
    assert (out / "README.md").read_text() == "of the clone"


def test_runs_at_once_in_one_folder_are_refused_and_lose_nothing(desk: Path) -> None:
    (desk / "hold").touch()
    with process("run", "told") as first:
        while not (desk / "measured").exists() and first.poll() is None:
            pass
        others = [process("run", "else"), process("run", "told"), process("report")]
        told = [other.communicate()[1] for other in others]
        (desk / "hold").unlink()
        said = first.communicate()[1]
    line = f"quatspline: results: process {first.pid} is writing to this folder: "
    for other, text in zip(others, told, strict=True):
        assert other.returncode == 2
        assert text.startswith(line)
        assert text.count("\n") == 1
    assert first.returncode == 0, said
    assert (desk / "measured").read_text() == "."
    assert commands.main(["run", "else"]) == 0
    manifest = json.loads((desk / "results" / "manifest.json").read_text())
    assert set(manifest["experiments"]) == {"told", "else"}
    assert len(os.listdir(desk / "results")) == 1 + len(manifest["files"])


def test_a_full_disk_is_told_in_a_line(desk: Path) -> None:
    resource = pytest.importorskip("resource")

    def little_room() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

    assert commands.main(["run", "told"]) == 0
    before = (desk / "results" / "told.csv").read_bytes()
    with process("run", "told", "else", preexec_fn=little_room) as full:
        said = full.communicate()[1]
    assert full.returncode == 1
    assert said.splitlines()[-1].startswith("quatspline: results/")
    assert said.endswith(": cannot be written: File too large\n")
    assert "Traceback" not in said
    assert (desk / "results" / "told.csv").read_bytes() == before
    assert "told" in json.loads((desk / "results" / "manifest.json").read_text())["experiments"]
    assert commands.main(["run", "told", "else"]) == 0


# -- streams ------------------------------------------------------------------------------------

COMMANDS = [
    ["list"],
    ["compare", "compare.csv", "--schemes", "slerp", "--out", "out"],
    ["sample", "compare.csv", "--scheme", "slerp", "--count", "2"],
    ["sample", "compare.csv", "--scheme", "slerp", "--count", "2", "-o", "new.csv"],
    ["run", "told"],
    ["report"],
]


def shell(redirected: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The command as a shell runs it, with its streams redirected."""
    line = ["sh", "-c", f'exec "$@" {redirected}', "sh", *processes.command(*arguments)]
    return subprocess.run(line, env=processes.environment(), capture_output=True, text=True)


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_a_closed_stdout_is_told_before_any_work(desk: Path, command: list[str]) -> None:
    before = sorted(os.listdir(desk))
    done = shell(">&-", *command)
    told = "quatspline: standard output is closed: point it to a file or to /dev/null\n"
    assert (done.returncode, done.stderr) == (2, told)
    assert sorted(os.listdir(desk)) == before


def test_what_is_said_on_a_closed_stderr_does_not_go_to_stdout(desk: Path) -> None:
    done = shell("2>&-", "sample", "compare.csv", "--scheme", "slerp", "--count", "x")
    assert (done.returncode, done.stdout) == (2, "")
    done = shell("2>&-", "sample", "none.csv", "--scheme", "slerp", "--count", "2")
    assert (done.returncode, done.stdout) == (2, "")


@pytest.mark.parametrize("command", [COMMANDS[0], COMMANDS[2]], ids=" ".join)
@pytest.mark.parametrize(
    ("redirected", "why"),
    [(">/dev/full", "No space left on device"), ("1</dev/null", "Bad file descriptor")],
)
def test_a_stdout_that_takes_nothing_is_told_in_a_line(
    desk: Path, command: list[str], redirected: str, why: str
) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no device here that is always full")
    done = shell(redirected, *command)
    told = f"quatspline: standard output: cannot be written: {why}\n"
    assert (done.returncode, done.stderr) == (1, told)


@pytest.mark.parametrize("asked", ["--help", "--version"])
def test_help_that_nobody_gets_is_told(asked: str) -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no device here that is always full")
    done = shell(">/dev/full", asked)
    told = "quatspline: standard output: cannot be written: No space left on device\n"
    assert (done.returncode, done.stderr) == (1, told)


def test_a_hidden_file_in_a_folder_that_is_not_ours_outlives_a_refused_run(
    desk: Path, refused: Refused
) -> None:
    (desk / "fo").mkdir()
    hidden = [f".a{ASIDE}", f".a.{16 * '0'}{ASIDE}"]
    for name in ("compare.md", *hidden):
        (desk / "fo" / name).write_text("mine")
    refused("compare", "compare.csv", "--schemes", "slerp", "--out", "fo")
    assert sorted(os.listdir(desk / "fo")) == sorted(["compare.md", *hidden])


def test_compare_writes_nothing_through_a_link_that_leads_nowhere(
    desk: Path, refused: Refused
) -> None:
    (desk / "out").mkdir()
    (desk / "out" / "compare.md").symlink_to("../missing.txt")
    command = ["compare", "compare.csv", "--schemes", "slerp", "--out", "out"]
    assert refused(*command).startswith("out/compare.md: not written by quatspline")
    assert commands.main([*command, "--force"]) == 0
    assert not (desk / "missing.txt").exists()
    assert not (desk / "out" / "compare.md").is_symlink()


def test_the_recommendation_is_said_before_the_page_fails(
    desk: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(self: Results, name: str, figure: object) -> None:
        with naming(self.folder / name):
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Results, "figure", full)
    assert commands.main(["compare", "compare.csv", "--schemes", "kim", "--out", "out"]) == 1
    told = capsys.readouterr()
    assert "Take kim: " in told.out
    last = told.err.splitlines()[-1]  # on a slow machine a bar of progress comes before
    assert last == "quatspline: out/compare: cannot be written: No space left on device"
