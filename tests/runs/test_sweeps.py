"""Sweeps: the same rows whoever measures them, and no finished cell lost or measured twice."""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from processes import command, environment
from quatspline import catalogue
from quatspline.cli import running
from quatspline.runs import cluster, experiment, staff, sweeps
from quatspline.runs.experiment import Run
from quatspline.runs.results import Results
from quatspline.runs.sweeps import Kept
from quatspline.system import limits, loading

COUNT = 8
SWEEP = """
import os, pathlib, signal, time
TITLE = "A sweep"
HERE = pathlib.Path(__file__).parent


def cells(run):
    return [{{"x": x, "name": f"n{{x}}"}} for x in reversed(range({count}))]


def hold(until):
    end = time.monotonic() + 60.0
    while not until():
        assert time.monotonic() < end, "held in vain"
        time.sleep(0.01)


def measure_cell(run, x, name):
    with open(HERE / "measured", "a") as log:
        log.write(f"{{x}} {{os.getpid()}}\\n")
    {note}
    values = run.rng(name).normal(size=2)
    return [{{"x": x, "k": k, "value": v}} for k, v in enumerate([*values, float("nan"), float("-inf")])]


def gather(run, table):
    return table.assign(total=table["x"].sum())
"""


class Bench:
    """A folder with one experiment, run in this process or as a command."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.out = folder, folder / "results"

    def experiment(self, note: str = "pass", serial: bool = False, count: int = COUNT) -> None:
        text = SWEEP.format(note=note, count=count) + f"\nSERIAL = {serial}\n"
        (self.folder / "swept.py").write_text(text, encoding="utf-8")

    def run(self, **options) -> list[str]:
        return running.run(["swept"], out=self.out, **options)

    def popen(self, *arguments: str) -> subprocess.Popen:
        line, pipe = command("run", "swept", *arguments), subprocess.PIPE
        return subprocess.Popen(line, cwd=self.folder, env=environment(), stderr=pipe, text=True)

    def table(self) -> bytes:
        return (self.out / "swept.csv").read_bytes()

    def measured(self) -> Counter[int]:
        """How often each cell was begun."""
        return Counter(int(line.split()[0]) for line in self.log())

    def workers(self) -> set[int]:
        return {int(line.split()[1]) for line in self.log()}

    def log(self) -> list[str]:
        path = self.folder / "measured"
        return path.read_text().splitlines() if path.exists() else []

    def kept(self) -> int:
        path = self.out / ".cells" / "swept.jsonl"
        return path.read_bytes().count(b"\n") if path.exists() else 0


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Bench:
    monkeypatch.setenv(experiment.FOLDERS, str(tmp_path))
    return Bench(tmp_path)


def wait_until(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


# -- the same rows ------------------------------------------------------------------------------


def test_rows_do_not_depend_on_the_number_of_workers(bench: Bench) -> None:
    tables = []
    for jobs in (1, 2):
        bench.experiment("time.sleep(0.02 * (x % 3))")
        assert bench.run(jobs=jobs) == []
        tables.append(bench.table())
    assert tables[0] == tables[1]
    assert bench.measured() == dict.fromkeys(range(COUNT), 2)
    assert len(bench.workers()) == 3  # one, then two others
    table = pd.read_csv(bench.out / "swept.csv")
    assert len(table) == 4 * COUNT
    assert (table["total"] == 4 * sum(range(COUNT))).all()
    assert not (bench.out / ".cells").exists()


def test_rows_keep_every_bit_and_the_order_of_the_cells(bench: Bench) -> None:
    bench.experiment()
    results, run = Results(bench.out), Run(quick=True, seed=3)
    module = loading.load(bench.folder / "swept.py", "experiment")
    with staff.workers(2):
        table = sweeps.sweep("swept", module, run, Kept(results, "swept", "print"))
    again = sweeps.sweep("swept", module, run, Kept(results, "swept", "print"))
    rows = [row for cell in module.cells(run) for row in module.measure_cell(run, **cell)]
    expected = module.gather(run, pd.DataFrame(rows))
    pd.testing.assert_frame_equal(table, expected, check_exact=True)
    pd.testing.assert_frame_equal(again, expected, check_exact=True)


def test_workers_find_folders_named_after_they_started(
    bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench.experiment()
    assert bench.run(jobs=2) == []
    later = tmp_path / "later"
    later.mkdir()
    monkeypatch.setenv(catalogue.FOLDERS, os.path.relpath(later))
    monkeypatch.setenv(experiment.FOLDERS, str(later))
    (later / "broken_scheme.py").write_text("raise RuntimeError('found')\n")
    text = "def cells(run): return [{'x': 1}, {'x': 2}]\ndef measure_cell(run, x):\n"
    text += "    from quatspline.catalogue import found\n"
    text += "    return {'x': x, 'problem': found()['broken-scheme'].problem}\n"
    (later / "seen.py").write_text(text)
    assert running.run(["seen"], out=bench.out, jobs=2) == []
    problems = pd.read_csv(bench.out / "seen.csv")["problem"]
    assert problems.tolist() == ["RuntimeError: found"] * 2


HERE_ALONE = """import os
if os.getpid() != {pid}:
    raise RuntimeError("only where it started")
from quatspline.catalogue import scheme
Scheme = type("Scheme", (scheme("slerp"),), {{"__module__": __name__}})
"""
"""A scheme that the process of the test can use, and no worker."""


@pytest.mark.parametrize(
    ("cell", "schemes", "lost"),
    [
        ("{'scheme': name}", None, {"here-alone"}),  # a cell that names what it needs
        ("{'x': name + '.'}", None, {"here-alone.", "squad.", "never."}),  # may need anything
        ("{'x': name + '.'}", ["squad"], set()),
    ],
)
def test_a_scheme_that_fails_on_a_worker_alone_makes_no_row(
    bench: Bench, monkeypatch: pytest.MonkeyPatch, cell: str, schemes: Any, lost: set[str]
) -> None:
    folder = bench.folder / "schemes"
    folder.mkdir()
    (folder / "here_alone.py").write_text(HERE_ALONE.format(pid=os.getpid()))
    (folder / "never.py").write_text("raise RuntimeError('nowhere')")
    monkeypatch.setenv(catalogue.FOLDERS, str(folder))
    (bench.folder / "swept.py").write_text(
        f"def cells(run): return [{cell} for name in ('squad', 'here-alone', 'never')]\n"
        "def measure_cell(run, **cell):\n"
        "    from quatspline.catalogue import found\n"
        "    name, = cell.values()\n"
        "    return cell | {'failure': found()[name.strip('.')].problem}\n"
    )
    assert bench.run(jobs=2, schemes=schemes) == (["swept"] if lost else [])
    if not lost:
        assert len(pd.read_csv(bench.out / "swept.csv")) == 3
        return
    failure = json.loads((bench.out / "manifest.json").read_text())["experiments"]["swept"][
        "failure"
    ]
    assert "scheme 'here-alone' can be used where the run started, not on this worker" in failure
    assert "RuntimeError: only where it started" in failure
    assert bench.kept() == 3 - len(lost)
    assert not (bench.out / "swept.csv").exists()


def test_the_command_ends_with_status_1_where_a_worker_lost_cells(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A scheme that no process can use is a row, and status 0."""
    bench.experiment("from quatspline.catalogue import scheme; scheme('slerp')")
    (bench.folder / "never.py").write_text("raise RuntimeError('nowhere')")
    monkeypatch.setenv(catalogue.FOLDERS, str(bench.folder))
    (bench.folder / "once.py").write_text(
        f"# {bench.folder}: tried for this test\n"
        "import os, pathlib\n"
        "count = pathlib.Path(__file__).with_name('asked')\n"
        "asked = count.read_text() if count.exists() else ''\n"
        "if len(asked) > 1: 1 / 0\n"  # once tried, once imported where the run starts
        "count.write_text(asked + '.')\n"
        "from quatspline.catalogue import scheme\n"
        "Scheme = type('Scheme', (scheme('slerp'),), {'__module__': __name__})\n"
    )
    for status in (1, 0):
        with bench.popen("--jobs", "2") as process:
            said = process.communicate()[1]
        assert process.returncode == status, said
        assert ("'once' can be used where the run started" in said) is bool(status)
    assert len(pd.read_csv(bench.out / "swept.csv")) == 4 * COUNT


# -- nothing lost -------------------------------------------------------------------------------

STOP = "if x == 3 and not (HERE / 'on').exists(): (HERE / 'on').touch(); {how}"
"""The cell that stops a run, the first time it is measured."""
INTERRUPT = "os.kill(os.getppid(), signal.SIGINT); time.sleep(60)"
"""What the cell does to the run."""
KEPT = "lambda: any(b'\\n' in path.read_bytes() for path in HERE.glob('results/.cells/*.jsonl'))"
"""Whether a cell is kept, as a cell sees it."""


@pytest.mark.parametrize("serial", [True, False])
def test_an_interrupted_sweep_goes_on_at_the_cell(bench: Bench, serial: bool) -> None:
    bench.experiment(STOP.format(how=f"hold({KEPT}); {INTERRUPT}"), serial)
    with pytest.raises(KeyboardInterrupt):
        bench.run(jobs=2)
    kept = bench.kept()
    assert (kept == 4) if serial else (1 <= kept < COUNT)
    before = bench.measured()
    assert bench.run(jobs=2) == []
    again = bench.measured() - before
    assert sum(again.values()) == COUNT - kept  # what was kept is not measured again
    assert len(pd.read_csv(bench.out / "swept.csv")) == 4 * COUNT
    if serial:
        assert len(bench.workers()) == 2  # one a run
        assert bench.measured() == {**dict.fromkeys(range(COUNT), 1), 3: 2}


def test_a_killed_run_goes_on_at_the_cell(bench: Bench) -> None:
    bench.experiment("while x == 3 and not (HERE / 'on').exists(): time.sleep(0.01)")
    with bench.popen("--jobs", "2") as process:
        wait_until(lambda: bench.kept() == COUNT - 1)
        process.kill()
    (bench.folder / "on").touch()
    with bench.popen("--jobs", "2") as process:
        said = process.communicate()[1]
    assert process.returncode == 0, said
    assert f"swept: {COUNT - 1} of {COUNT} cells kept" in said
    assert bench.measured() == {**dict.fromkeys(range(COUNT), 1), 3: 2}
    assert not (bench.out / ".cells").exists()


def test_a_worker_that_dies_once_costs_its_cell_alone(bench: Bench) -> None:
    bench.experiment(STOP.format(how="os.kill(os.getpid(), signal.SIGKILL)"))
    assert bench.run(jobs=2) == []
    assert len(pd.read_csv(bench.out / "swept.csv")) == 4 * COUNT
    assert max(bench.measured().values()) == 2


def failure(bench: Bench) -> str:
    """Why the sweep failed."""
    text = (bench.out / "manifest.json").read_text()
    return json.loads(text)["experiments"]["swept"]["failure"]


@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize(
    ("how", "told"),
    [
        ("os.kill(os.getpid(), signal.SIGKILL)", "a worker died twice at it: .*: SIGKILL"),
        ("os._exit(3)", "it ended its process: status 3"),
        ("sys.exit('enough')", "SystemExit: enough"),
    ],
)
def test_a_cell_that_kills_its_worker_is_told_and_the_others_are_kept(
    bench: Bench, jobs: int, how: str, told: str
) -> None:
    bench.experiment(f"import sys\n    if x == 3: {how}")
    assert bench.run(jobs=jobs) == ["swept"]
    assert re.fullmatch(
        rf'RuntimeError: cell {{"name": "n3", "x": 3}}: {told} \(.*', failure(bench)
    )
    assert bench.kept() == COUNT - 1
    again = 1 if how.startswith("sys") else 2  # a process that ends otherwise may have been unlucky
    assert bench.measured() == {**dict.fromkeys(range(COUNT), 1), 3: again}


def test_a_cell_that_does_not_end_is_cut_off(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(limits.CELL_SECONDS, "5")
    bench.experiment("while x == 3: pass")
    assert bench.run(jobs=2) == ["swept"]
    assert "it did not end within its limit of 5 s" in failure(bench)
    assert bench.measured() == dict.fromkeys(range(COUNT), 1)


def test_a_cell_that_goes_wrong_is_told_and_the_others_are_kept(bench: Bench) -> None:
    bench.experiment("assert x not in (2, 5) or (HERE / 'on').exists(), f'{x} is off'")
    for _ in range(2):
        assert bench.run(jobs=2) == ["swept"]
        text = (bench.out / "manifest.json").read_text()
        reason = json.loads(text)["experiments"]["swept"]["failure"]
        assert 'cell {"name": "n5", "x": 5}: AssertionError: 5 is off (swept.py:' in reason
        assert bench.kept() == COUNT - 2
    (bench.folder / "on").touch()
    assert bench.run(jobs=2) == []
    assert bench.measured() == {**dict.fromkeys(range(COUNT), 1), 2: 3, 5: 3}


def test_a_digit_changed_in_a_kept_cell_does_not_reach_the_table(
    bench: Bench, capsys: pytest.CaptureFixture[str]
) -> None:
    bench.experiment(STOP.format(how=INTERRUPT), serial=True)
    with pytest.raises(KeyboardInterrupt):
        bench.run()
    path = bench.out / ".cells" / "swept.jsonl"
    first, rest = path.read_text().split("\n", 1)
    path.write_text(first.replace('"x": 7', '"x": 6') + "\n" + rest)
    assert bench.run() == []
    said = capsys.readouterr().err
    assert "swept: 1 line is damaged in the journal of cells" in said
    assert f"swept: {COUNT - 5} of {COUNT} cells kept" in said
    assert bench.measured() == {**dict.fromkeys(range(COUNT), 1), 7: 2, 3: 2}
    table = bench.table()
    assert bench.run() == []
    assert bench.table() == table


def test_another_run_in_between_costs_no_cell(bench: Bench) -> None:
    bench.experiment("assert x != 3 or (HERE / 'on').exists()", serial=True)
    for seed in (0, 1):
        assert bench.run(seed=seed) == ["swept"]
    (bench.folder / "on").touch()
    before = bench.measured()
    assert bench.run(seed=0) == []
    assert bench.measured() - before == {3: 1}


def test_cells_that_cannot_be_told_apart_are_refused(bench: Bench) -> None:
    text = (
        "def cells(run): return [{'x': 1}, {'x': 1}]\ndef measure_cell(run, x): return {'x': x}\n"
    )
    (bench.folder / "swept.py").write_text(text)
    assert bench.run(jobs=1) == ["swept"]
    assert 'two cells are {"x": 1}' in (bench.out / "swept.error.txt").read_text()


# -- Dask ---------------------------------------------------------------------------------------


@pytest.fixture(name="local", scope="module")
def local_cluster() -> Iterator:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=":0"
    ) as local:
        yield local


def test_a_dask_cluster_gives_the_same_bytes(bench: Bench, local) -> None:
    bench.experiment()
    assert bench.run(jobs=2) == []
    table = bench.table()
    (bench.folder / "measured").unlink()
    assert bench.run(dask=local.scheduler_address) == []
    assert bench.table() == table
    assert bench.measured() == dict.fromkeys(range(COUNT), 1)
    own = {worker.pid for worker in local.workers.values()}
    assert bench.workers() <= own


def test_a_killed_dask_worker_loses_nothing(bench: Bench, local) -> None:
    bench.experiment(STOP.format(how="os.kill(os.getpid(), signal.SIGKILL)"))
    assert bench.run(dask=local.scheduler_address) == []
    assert len(pd.read_csv(bench.out / "swept.csv")) == 4 * COUNT
    assert bench.measured()[3] == 2


def test_a_worker_of_several_threads_measures_one_cell_at_a_time(bench: Bench) -> None:
    """Its threads ask for schemes first at once, and none is lost either."""
    distributed = pytest.importorskip("distributed")
    bench.experiment(
        """assert not (HERE / "inside").exists(), "two cells at once"
    (HERE / "inside").touch()
    from quatspline.catalogue import found, schemes
    assert len(schemes()) == """
        + str(len(catalogue.schemes()))
        + """
    time.sleep(0.1)  # in which another thread would come
    (HERE / "inside").unlink()"""
    )
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, dashboard_address=":0"
    ) as local:
        assert bench.run(dask=local.scheduler_address) == []
    assert bench.measured() == dict.fromkeys(range(COUNT), 1)
    assert len(bench.workers()) == 1


@pytest.mark.parametrize(
    ("address", "what"),
    [
        ("nonsense", "missing port"),
        ("tcp://127.0.0.1:port", "invalid literal"),
        ("post://a:1", "unknown address scheme"),
    ],
)
def test_a_malformed_address_is_told_and_leaves_nothing_open(
    bench: Bench, address: str, what: str
) -> None:
    pytest.importorskip("distributed")
    bench.experiment()
    with bench.popen("--dask", address) as process:  # what a client left open is told at the end
        said = process.communicate()[1]
    assert process.returncode == 2
    assert len(said.splitlines()) == 1, said
    assert f"--dask {address}: no Dask scheduler answers: {what}" in said


def test_a_cell_that_kills_every_dask_worker_is_told_and_the_others_are_kept(bench: Bench) -> None:
    distributed = pytest.importorskip("distributed")
    bench.experiment("if x == 3: os.kill(os.getpid(), signal.SIGKILL)")
    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as own,
        bench.popen("--dask", own.scheduler_address) as process,
    ):
        said = process.communicate()[1]
    assert process.returncode == 1
    assert "the Dask workers that were to measure it died" in said
    assert "Traceback" not in said
    bench.experiment()
    assert bench.run(jobs=1) == []


def test_a_cluster_whose_last_worker_leaves_is_told(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without a nanny nobody starts another: cells that are left are given up, status 1."""
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "LOOK", 0.2)
    monkeypatch.setattr(cluster, "ALONE", 1.0)
    bench.experiment("if x == 3: os.kill(os.getpid(), signal.SIGKILL)")
    with distributed.LocalCluster(n_workers=0, dashboard_address=":0") as own:
        line = [sys.executable, "-m", "distributed.cli.dask_worker", own.scheduler_address]
        with subprocess.Popen([*line, "--no-nanny", "--nthreads", "1"], stderr=subprocess.DEVNULL):
            assert bench.run(dask=own.scheduler_address) == ["swept"]
    assert cluster.NO_WORKER in (bench.out / "swept.error.txt").read_text(encoding="utf-8")


def test_a_scheduler_that_vanishes_is_told_without_a_trace(bench: Bench) -> None:
    """Cells that are left are given up, status 1; what was measured before is kept."""
    pytest.importorskip("distributed")
    kill = "os.kill(int((HERE / 'scheduler').read_text()), signal.SIGKILL)"
    bench.experiment(f"if x == 3: time.sleep(1.0); {kill}")  # the others' results have arrived
    file = bench.folder / "address.json"
    quiet = {"stderr": subprocess.DEVNULL, "stdout": subprocess.DEVNULL}
    with ExitStack() as stack:

        def started(module: str, *arguments: object) -> subprocess.Popen[bytes]:
            line = [sys.executable, "-m", f"distributed.cli.{module}", *map(str, arguments)]
            process = stack.enter_context(subprocess.Popen(line, **quiet))
            stack.callback(process.kill)
            return process

        asked = "--host", "127.0.0.1", "--port", 0, "--no-dashboard", "--scheduler-file", file
        own = started("dask_scheduler", *asked)
        (bench.folder / "scheduler").write_text(str(own.pid))
        wait_until(file.exists)
        address = json.loads(file.read_text(encoding="utf-8"))["address"]
        started("dask_worker", address, "--nthreads", 1, "--no-nanny")
        with bench.popen("--dask", address) as process:
            said = process.communicate()[1]
    assert process.returncode == 1
    assert re.search("failed: .*the Dask (scheduler|cluster)", said)
    assert "Traceback" not in said
    assert bench.kept() >= 1


@pytest.mark.parametrize("answer", [None, b"HTTP/1.1 400 Bad Request\r\n\r\n" + b" " * 100])
def test_what_is_no_scheduler_is_told_soon(
    bench: Bench, monkeypatch: pytest.MonkeyPatch, answer: bytes | None
) -> None:
    """Something else at the port, which says nothing or something else."""
    pytest.importorskip("distributed")
    bench.experiment()
    monkeypatch.setattr(cluster, "GREETING", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as server:

        def talk() -> None:
            with suppress(OSError):
                while True:
                    other = server.accept()[0]
                    held.append(other)
                    other.sendall(answer or b"")

        held: list[socket.socket] = []
        threading.Thread(target=talk, daemon=True).start()
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(ValueError, match=rf"--dask {address}: no Dask scheduler answers"):
            bench.run(dask=address)
        server.shutdown(socket.SHUT_RDWR)
    for other in held:
        other.close()
    assert not bench.out.exists()


def test_limits_of_a_cluster_keep_what_is_promised() -> None:
    assert cluster.GREETING + 1.0 < 5.0
    assert cluster.ALONE + 2.0 * cluster.LOOK + cluster.ANSWER <= 30.0


def test_without_a_scheduler_or_the_extra_nothing_starts(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    bench.experiment()
    monkeypatch.setattr(cluster, "GREETING", 0.2)
    with pytest.raises(ValueError, match=r"--dask tcp://127.0.0.1:9: no Dask scheduler answers"):
        bench.run(dask="tcp://127.0.0.1:9")
    monkeypatch.setattr(cluster.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ValueError, match=r"pip install 'quatspline\[dask\]'"):
        bench.run(dask="tcp://127.0.0.1:9")
    assert not bench.out.exists()
    assert not bench.log()
