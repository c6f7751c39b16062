"""Signals: a run and its workers end together, with one line and the status that a shell expects."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from desk import Desk
from processes import STUCK, command, environment, python

HELD = """
import os, time
from pathlib import Path
HERE = Path({here!r})
TITLE, PAPER, NOTE = "Held", False, "As ever."
def cells(run): return [{{"x": i}} for i in range(4)]
def measure_cell(run, x):
    if not (HERE / "free").exists():
        (HERE / f"{{os.getpid()}}.pid").touch()
        while True:
            {wait}
    return {{"x": x}}
"""

WAITS = {
    "asleep": "time.sleep(600)",
    "busy": "sum(range(1000))",
    "deaf": """try:
                time.sleep(600)
            except BaseException:
                pass""",
}
"""What a cell is at; one that swallows interrupts has to be cut off."""

RUN = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL]
LINE = "quatspline: interrupted: the same command resumes where it stopped"


@pytest.fixture(autouse=True)
def heeded() -> Iterator[None]:
    """Under nohup, or in the background of a script, signals are ignored, and a run leaves them so."""
    ignored = [n for n in RUN if signal.getsignal(n) is signal.SIG_IGN]
    for n in ignored:
        signal.signal(n, signal.SIG_DFL)
    yield
    for n in ignored:
        signal.signal(n, signal.SIG_IGN)


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(tmp_path)


def until(condition: Callable[[], object]) -> None:
    end = time.monotonic() + STUCK
    while not condition():
        assert time.monotonic() < end, "waited too long"
        time.sleep(0.01)


def lives(pid: int) -> bool:
    """Whether a process runs: one that ended and that nobody waits for does not."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state not in "ZX"


def stopped(
    desk: Desk, number: signal.Signals, jobs: int, group: bool
) -> tuple[int, str, list[int]]:
    """The status of a run that a signal ends within a cell, what it said, and who measured."""
    with subprocess.Popen(
        command("run", "held", "--jobs", jobs),
        cwd=desk.folder,
        env=environment(**desk.environment),
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        until(lambda: len(list(desk.folder.glob("*.pid"))) == jobs or process.poll() is not None)
        (os.killpg if group else os.kill)(process.pid, number)
        said = process.communicate(timeout=STUCK)[1]
    return process.returncode, said, [int(path.stem) for path in desk.folder.glob("*.pid")]


@pytest.mark.parametrize("number", RUN, ids=lambda number: number.name)
@pytest.mark.parametrize(("jobs", "wait"), [(1, "asleep"), (2, "busy"), (2, "deaf")])
def test_a_run_ends_with_its_workers(
    desk: Desk, number: signal.Signals, jobs: int, wait: str
) -> None:
    text = HELD.format(here=str(desk.folder), wait=WAITS[wait])
    (desk.folder / "experiments" / "held.py").write_text(text)
    status, said, pids = stopped(desk, number, jobs, group=wait == "busy")
    if number == signal.SIGKILL:
        assert status == -number
    else:
        assert status == 128 + number
        assert said.count(LINE) == 1
        assert said.rstrip().endswith(LINE)
        assert "Traceback" not in said
    until(lambda: not any(lives(pid) for pid in pids))
    (desk.folder / "free").touch()
    done = desk("run", "held")
    assert done.returncode == 0, done.stderr
    assert (desk.folder / "results" / "held.csv").read_text().split() == ["x", *"0123"]


def test_a_cell_that_is_deaf_alone_is_cut_off(desk: Desk) -> None:
    text = HELD.format(here=str(desk.folder), wait=WAITS["deaf"])
    (desk.folder / "experiments" / "held.py").write_text(text)
    status, said, _ = stopped(desk, signal.SIGTERM, 1, group=False)
    assert status == 128 + signal.SIGTERM
    assert said.rstrip().endswith(LINE)


def test_workers_of_a_pool_end() -> None:
    assert python(POOL) == "TerminatedWorkerError"


POOL = """
import time
from joblib.externals.loky import get_reusable_executor
from quatspline.system.ending import end_workers
pool = get_reusable_executor(2)
pool.submit(abs, -1).result()
held = pool.submit(time.sleep, 600)
end_workers()
print(type(held.exception(60)).__name__)
"""
