"""The journal of cells: what is kept stays kept, whatever happens to the process, the disk or the file."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from quatspline.runs.journal import Kept, forget, key
from quatspline.runs.results import Results

resource = pytest.importorskip("resource")

CELLS = [
    ({"x": x, "name": f"n{x}"}, f'[{{"x": {x}, "value": 0.{x}25, "k": NaN}}]') for x in range(4)
]
ROWS = {key(cell): rows for cell, rows in CELLS}


@pytest.fixture
def results(tmp_path: Path) -> Results:
    return Results(tmp_path)


@pytest.fixture
def path(results: Results) -> Path:
    """A journal of all cells."""
    kept = Kept(results, "swept", "print")
    for cell, rows in CELLS:
        kept.add(cell, rows)
    return kept.path


def found(results: Results) -> dict[str, str]:
    """The rows that a journal gives back, as text: NaN is not itself."""
    rows = Kept(results, "swept", "print").rows
    return {name: json.dumps(value) for name, value in rows.items()}


def test_cells_are_not_kept_through_a_link(results: Results, path: Path) -> None:
    path.unlink()
    path.symlink_to("../outside")
    with pytest.raises(ValueError, match=r"swept\.jsonl: is a link"):
        Kept(results, "swept", "print")
    assert not (results.folder / "outside").exists()


def test_what_is_kept_comes_back(results: Results, path: Path) -> None:
    before = path.read_bytes()
    assert found(results) == ROWS
    assert path.read_bytes() == before
    assert before.count(b"\n") == len(CELLS)


def test_every_flipped_byte_costs_its_own_line_alone(
    results: Results, path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    content = path.read_bytes()
    for place, byte in enumerate(content):
        for flipped in {byte ^ 1, byte ^ 0x20, byte ^ 0x80, ord("\n"), ord("5")} - {byte}:
            path.write_bytes(content[:place] + bytes([flipped]) + content[place + 1 :])
            left = found(results)
            assert left.items() <= ROWS.items()
            # A line end that is lost joins two lines.
            joined = byte == ord("\n") and place + 1 < len(content)
            assert len(left) == len(ROWS) - (2 if joined else 1), (place, flipped)
            assert "damaged in the journal of cells: dropped" in capsys.readouterr().err
            assert found(results) == left
            assert capsys.readouterr().err == ""


def test_lines_damaged_are_counted(
    results: Results, path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = path.read_text().splitlines(keepends=True)
    path.write_text(
        lines[0].replace("25", "26") + lines[1] + lines[2].replace("25", "2") + lines[3]
    )
    assert len(found(results)) == 2
    assert capsys.readouterr().err.startswith("swept: 2 lines are damaged in the journal of cells")


def test_a_kill_while_a_cell_is_written_costs_that_cell(results: Results, path: Path) -> None:
    content = path.read_bytes()
    for end in range(len(content)):
        path.write_bytes(content[:end])
        whole = content[: end + 1].count(b"\n")  # one that lacks nothing but its end is whole
        kept = Kept(results, "swept", "print")
        assert list(kept.rows) == list(ROWS)[:whole]
        kept.add({"x": "next"}, "[]")
        assert len(Kept(results, "swept", "print").rows) == whole + 1


@contextmanager
def room(size: int) -> Iterator[None]:
    """No file can grow beyond a size: writing takes what fits and then fails, as on a full disk."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_full_disk_costs_the_cell_that_does_not_fit(results: Results, path: Path) -> None:
    content = path.read_bytes()
    before = content[: content[:-1].rfind(b"\n") + 1]
    cell, rows = CELLS[-1]
    for size in range(len(before), len(content)):
        path.write_bytes(before)
        kept = Kept(results, "swept", "print")
        with room(size), pytest.raises(OSError, match="File too large"):
            kept.add(cell, rows)
        assert path.read_bytes() == before
        assert key(cell) not in kept.rows
        kept.add(cell, rows)
        assert path.read_bytes() == content


def test_a_full_disk_when_a_journal_is_mended_costs_nothing(results: Results, path: Path) -> None:
    torn = path.read_bytes() + b'{"run": "print", "ce'
    path.write_bytes(torn)
    with room(len(torn) // 2), pytest.raises(OSError, match="File too large"):
        Kept(results, "swept", "print")
    assert path.read_bytes() == torn
    assert os.listdir(path.parent) == [path.name]
    assert found(results) == ROWS


KILLED = """
import os, signal, sys
from quatspline.runs.journal import Kept
from quatspline.runs.results import Results

folder, left = sys.argv[1], int(sys.argv[2])

def killing(event, arguments):
    global left
    if event.startswith(("open", "os.")) and ".cells" in str(arguments):
        left -= 1
        if left == 0:
            os.kill(os.getpid(), signal.SIGKILL)

results = Results(folder)
sys.addaudithook(killing)
kept = Kept(results, "swept", "print")
kept.add({"x": "next"}, "[]")
"""


def test_a_kill_at_any_step_of_opening_and_keeping_costs_nothing(
    results: Results, path: Path
) -> None:
    torn, survived = path.read_bytes() + b'{"run": "print", "ce', 0
    for step in range(1, 50):
        path.write_bytes(torn)
        command = [sys.executable, "-c", KILLED, str(results.folder), str(step)]
        status = subprocess.run(command, stderr=subprocess.DEVNULL).returncode
        assert found(results).items() >= ROWS.items()
        if status == 0:
            break
        assert status == -signal.SIGKILL
        survived += 1
    assert survived >= 5  # opened, written aside, renamed, opened again
    assert '{"x": "next"}' in found(results)


def test_cells_of_other_sources_or_options_do_not_count_and_stay(
    results: Results, path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = Kept(results, "swept", "other")
    assert other.rows == {}
    other.add({"x": 0, "name": "n0"}, "[]")
    assert found(results) == ROWS
    assert Kept(results, "swept", "other").rows == {'{"name": "n0", "x": 0}': []}
    assert capsys.readouterr().err == ""


def test_a_journal_forgotten_leaves_nothing(results: Results, path: Path) -> None:
    Kept(results, "else", "print").add({}, "[]")
    forget(results, "swept")
    assert os.listdir(path.parent) == ["else.jsonl"]
    forget(results, "else")
    assert os.listdir(results.folder) == []
