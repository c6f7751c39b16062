"""A results folder: one writer at a time, and nobody's files replaced but its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from quatspline.runs import store
from quatspline.runs.results import Results
from quatspline.system.atomic import ASIDE
from quatspline.system.locking import LOCK, sole_writer


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """No schemes are loaded to tell their versions."""
    monkeypatch.setattr(store, "provenance", lambda: {"versions": {"quatspline": "0"}})


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with an experiment `a` and a page of its own."""
    run(tmp_path / "out", "a")
    return tmp_path / "out"


FILES = ["a.csv", "a.md", "report.html"]


def run(folder: Path, *names: str, force: bool = False, content: str = "1\n") -> Results:
    """Write some experiments and a page."""
    results = Results(folder, force=force)
    with results.writing():
        tables = [f"{name}{end}" for name in names for end in (".csv", ".md")]
        results.guard([*tables, FILES[-1], store.JOURNAL])
        results.begin(["quatspline", "run", *names])
        for name in names:
            results.text(f"{name}.csv", content)
            results.text(f"{name}.md", content)
            results.record(name, {"size": "quick"})
        results.text("report.html", content)
        results.finish()
    return results


def manifest(folder: Path) -> dict:
    return json.loads((folder / "manifest.json").read_text())


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.is_file()}


# -- whose files --------------------------------------------------------------------------------


def test_its_own_files_are_replaced_and_nothing_else_stays(folder: Path) -> None:
    run(folder, "a", content="2\n")
    assert (folder / "a.csv").read_text() == "2\n"
    assert sorted(os.listdir(folder)) == sorted([*FILES, "manifest.json"])
    assert sorted(manifest(folder)["files"]) == FILES
    assert "claims" not in manifest(folder)


@pytest.mark.parametrize("name", ["b.csv", "b.md", "report.html", "a.csv", "manifest.json"])
@pytest.mark.parametrize("text", ["precious", "{}", '{"files": {}, "experiments": {}}', ""])
def test_a_foreign_or_edited_file_is_replaced_by_force_only(
    folder: Path, name: str, text: str
) -> None:
    (folder / name).write_text(text)
    before = contents(folder)
    with pytest.raises(
        ValueError, match="not written by quatspline in this folder, or edited"
    ) as refusal:
        run(folder, "a", "b")
    # A manifest that is lost leaves the other files without an owner.
    more = " and 3 more" if name == "manifest.json" else ""
    assert str(refusal.value).startswith(f"{folder / name}{more}: ")
    assert contents(folder) == before
    run(folder, "a", "b", force=True)
    assert sorted(manifest(folder)["files"]) == ["a.csv", "a.md", "b.csv", "b.md", "report.html"]
    run(folder, "a", "b")


def test_a_journal_is_its_own_where_a_manifest_is(folder: Path) -> None:
    (folder / store.JOURNAL).write_text("damaged")
    run(folder, "a")
    for name in ("manifest.json", *FILES):
        (folder / name).unlink()
    with pytest.raises(ValueError, match=r"out/\.journal\.json: not written by quatspline"):
        run(folder, "a")


def test_files_of_other_names_are_no_obstacle_and_are_not_listed(folder: Path) -> None:
    (folder / "README.md").write_text("precious")
    for name in ("reference", "benchmarks"):
        (folder / name).mkdir()
        (folder / name / "a.csv").write_text("precious")
    run(folder, "a")
    assert (folder / "README.md").read_text() == "precious"
    assert sorted(manifest(folder)["files"]) == FILES


ASIDES = [f".a{ASIDE}", f".a.{16 * '0'}{ASIDE}"]


@pytest.mark.parametrize("ours", [False, True])
def test_files_aside_are_cleared_in_its_own_folder_alone(tmp_path: Path, ours: bool) -> None:
    out = tmp_path / "out"
    out.mkdir()
    if ours:
        run(out, "b")
    for name in ASIDES:
        (out / name).write_text("mine")
    with Results(out).writing():
        pass
    assert [(out / name).exists() for name in ASIDES] == [True, not ours]


LINKED = ["a.csv", "report.html", "manifest.json", ".journal.json"]


@pytest.mark.parametrize("name", LINKED)
@pytest.mark.parametrize("there", [False, True])
def test_a_link_is_a_foreign_file_and_nothing_is_written_through_it(
    folder: Path, name: str, there: bool
) -> None:
    outside = folder.parent / "outside"
    if there:
        outside.write_text("precious")
    (folder / name).unlink(missing_ok=True)
    (folder / name).symlink_to("../outside")
    with pytest.raises(ValueError, match="not written by quatspline in this folder"):
        run(folder, "a")
    assert (folder / name).is_symlink()
    run(folder, "a", force=True)
    assert (folder / name).is_symlink() == (name == ".journal.json")  # nothing is noted here
    assert (outside.read_text() if outside.exists() else None) == ("precious" if there else None)


def test_a_folder_where_a_file_is_to_be_written_is_refused(folder: Path) -> None:
    (folder / "b.csv").mkdir()
    with pytest.raises(ValueError, match=r"b\.csv: not a regular file"):
        run(folder, "a", "b", force=True)


def test_what_is_read_is_never_written_even_by_force(folder: Path) -> None:
    results = Results(folder, force=True)
    os.link(folder / "a.csv", folder / "hard.csv")
    (folder / "soft.csv").symlink_to("a.csv")
    for given in (
        folder / "a.csv",
        folder / ".." / "out" / "a.csv",
        folder / "hard.csv",
        folder / "soft.csv",
    ):
        with pytest.raises(ValueError, match="is also read here, so it is not overwritten"):
            results.guard(["a.csv"], inputs=[given])
    results.guard(["a.md"], inputs=[folder / "a.csv"])


def test_a_manifest_of_the_first_release_names_its_files(folder: Path) -> None:
    old = manifest(folder)
    del old["schema"]
    (folder / "manifest.json").write_text(json.dumps(old))
    run(folder, "a", content="2\n")
    assert (folder / "a.csv").read_text() == "2\n"


@pytest.mark.parametrize("part", ["files", "experiments", "claims"])
@pytest.mark.parametrize("value", [None, [], "x", {"a": 1}, {"a": {"files": 3}}])
def test_a_manifest_of_other_shapes_makes_no_file_its_own(
    folder: Path, part: str, value: object
) -> None:
    (folder / "manifest.json").write_text(json.dumps({"schema": store.SCHEMA, part: value}))
    with pytest.raises(ValueError, match=r"a\.csv and 2 more: not written by quatspline"):
        run(folder, "a")
    run(folder, "a", force=True)
    assert sorted(manifest(folder)["files"]) == FILES


def test_a_file_claimed_by_a_killed_run_stays_its_own_through_a_report(folder: Path) -> None:
    old = manifest(folder)
    old |= {"claims": {"a.csv": old["files"].pop("a.csv")}}
    del old["experiments"]["a"]
    (folder / "manifest.json").write_text(json.dumps(old))
    results = Results(folder)
    with results.writing():
        results.text("report.html", "2\n")
        assert sorted(manifest(folder)["files"]) == FILES
        results.refresh()
    assert "claims" not in manifest(folder)
    run(folder, "a")


def test_what_came_while_it_ran_stays_and_nothing_measured_is_lost(folder: Path) -> None:
    results = Results(folder)
    (folder / "b.csv.1").write_text("precious, too")
    with results.writing():
        results.begin(["x"])
        (folder / "b.csv").write_text("precious")
        with pytest.raises(ValueError, match=r"b\.csv: came or was edited.*; b\.csv\.2 holds"):
            results.text("b.csv", "measured")
    texts = [(folder / name).read_text() for name in ("b.csv", "b.csv.1", "b.csv.2")]
    assert texts == ["precious", "precious, too", "measured"]


KILLS = """
import itertools, os, shutil, signal, sys
import filelock  # once for all forks
from pathlib import Path
from quatspline.runs import store
from quatspline.runs.results import Results

store.provenance = lambda: {"versions": {"quatspline": "0"}}
os.fsync = lambda descriptor: None  # a kill leaves what was written; only a power cut does not
old, folder = Path(sys.argv[1]), Path(sys.argv[2])

def run(content):
    results = Results(folder)
    with results.writing():
        results.guard(["a.csv", "a.md", "b.csv", "report.html"])
        results.begin(["x"])
        results.text("a.csv", content)
        results.text("a.md", content)
        results.text("b.csv", content)
        results.record("a", {"size": "quick"})
        (folder / "a.md").unlink()
        results.text("report.html", content)
        results.finish()

def killed(step):
    "Whether a run was killed at a step: before its n-th deed with a file."
    pid = os.fork()
    if pid:
        return os.WIFSIGNALED(os.waitpid(pid, 0)[1])
    steps = itertools.count(1)
    def hook(event, arguments):
        if event.startswith(("open", "os.")) and str(folder) in str(arguments) and next(steps) == step:
            os.kill(os.getpid(), signal.SIGKILL)
    sys.addaudithook(hook)
    run("2")
    os._exit(0)

for step in itertools.count(1):
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(old, folder)
    if not killed(step):
        break
    run("3")
    assert sorted(os.listdir(folder)) == ["a.csv", "b.csv", "manifest.json", "report.html"], step
print(step)
"""


def test_a_run_killed_at_any_step_goes_on_without_force(folder: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-c", KILLS, str(folder), str(tmp_path / "work")]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) > 40


# -- one writer ---------------------------------------------------------------------------------


def test_a_second_writer_is_refused_with_the_first_ones_number(folder: Path) -> None:
    first = Results(folder)
    with first.writing():
        with pytest.raises(ValueError, match="is writing to this folder") as refusal:
            run(folder, "b")
        assert str(refusal.value).startswith(f"{folder}: process {os.getpid()} is")
        with first.writing():  # the page of a run
            first.guard()
    run(folder, "b")
    assert not (folder / LOCK).exists()


def test_a_lock_file_left_behind_locks_nothing(folder: Path) -> None:
    (folder / LOCK).write_text("1\n")
    run(folder, "a")
    assert not (folder / LOCK).exists()


def test_a_folder_that_cannot_be_written_is_told() -> None:
    sealed = Path("/proc/self")
    if not sealed.is_dir():
        pytest.skip("no folder here that nobody can write to")
    with pytest.raises(ValueError, match=r"^/proc/self: cannot be written: "), sole_writer(sealed):
        pass


HOLDER = """
import sys, time
from pathlib import Path
from quatspline.system.locking import sole_writer
with sole_writer(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600)
"""


def test_the_lock_dies_with_its_process(folder: Path) -> None:
    command = [sys.executable, "-c", HOLDER, str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "held\n"
        with pytest.raises(ValueError, match=f"process {process.pid} is writing"):
            run(folder, "b")
        process.kill()
        process.wait()
        assert (folder / LOCK).exists()
        run(folder, "b")


WRITER = """
import sys, time
from pathlib import Path
from quatspline.runs import store
from quatspline.runs.results import Results

store.provenance = lambda: {"versions": {"quatspline": "0"}}
folder, name, count = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
while len(list(folder.parent.glob("*.ready"))) < count:
    (folder.parent / f"{name}.ready").touch()
refused = 0
while True:
    results = Results(folder)
    try:
        with results.writing():
            results.guard([f"{name}.csv"])
            results.begin([name])
            for turn in range(5):
                results.text(f"{name}.csv", name)
                time.sleep(0.01)
            results.record(name, {"size": "quick"})
            results.finish()
        break
    except ValueError as error:
        assert "is writing to this folder" in str(error), error
        refused += 1
print(refused)
"""


@pytest.mark.parametrize("count", [2, 4])
def test_writers_at_once_lose_nothing_of_each_other(folder: Path, count: int) -> None:
    names = [f"n{k}" for k in range(count)]
    command = [sys.executable, "-c", WRITER, str(folder)]
    writers = [
        subprocess.Popen(
            [*command, name, str(count)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        for name in names
    ]
    said = [writer.communicate() for writer in writers]
    assert [writer.returncode for writer in writers] == [0] * count, said
    assert set(manifest(folder)["experiments"]) == {"a", *names}
    assert set(manifest(folder)["files"]) == {*FILES, *(f"{name}.csv" for name in names)}
    assert sorted(os.listdir(folder)) == sorted([*manifest(folder)["files"], "manifest.json"])
