"""First calls of several threads at once, forks beside them: whole results, no deadlock.

Threads meet at events, so that the moment tried is the one in question.  What could wait forever runs
in a process of its own, which has an end.
"""

import os
import subprocess
import sys
import threading
import warnings
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import quatspline as qs
from processes import STUCK, environment, python
from quatspline import catalogue
from quatspline.system import loading
from quatspline.system.quiet import quiet

TRIAL = Path(__file__).parents[1] / "robustness" / "threads.py"
LATE = 1.0
"""Seconds given to a thread to do what it must not do."""

SCHEME = """
import numpy as np
from quatspline.curve import Curve

class Held(Curve):
    title = reference = "-"
    continuity, order, support, constant_rate = 0, 1, 2, "no"
    interpolates = False

    def _fit(self, keyframes):
        pass

    def _orientation(self, t):
        return np.tile(self.keyframes.quaternions[0], (len(t), 1))
"""

GATE = """
import threading
entered, go, reached = threading.Event(), threading.Event(), threading.Event()
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder of schemes; modules beside it can be imported."""
    place = tmp_path / "schemes"
    place.mkdir()
    monkeypatch.setenv(catalogue.FOLDERS, str(place))
    return place


@pytest.fixture
def gate(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Events that a module under import shares with the test."""
    events = SimpleNamespace(entered=threading.Event(), go=threading.Event())
    monkeypatch.setitem(sys.modules, "gate", events)
    return events


def started(call: Callable[[], Any]) -> tuple[threading.Thread, list[Any]]:
    """A thread and what its call returned or raised, in a list."""
    results: list[Any] = []

    def run() -> None:
        try:
            results.append(call())
        except Exception as error:
            results.append(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    return thread, results


# -- discovery ----------------------------------------------------------------------------------


def test_eight_threads_at_once_list_every_scheme() -> None:
    """A small part of the trial; the whole of it is run by hand."""
    command = [sys.executable, str(TRIAL), "--processes", "2", "--threads", "8", "--cold", "0"]
    done = subprocess.run(
        command, capture_output=True, text=True, env=environment(), timeout=5 * STUCK, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2 of 2 processes without a fault" in done.stdout
    assert f"schemes: {' '.join([str(len(qs.schemes()))] * 8)} " in done.stdout


def test_a_thread_waits_for_what_another_imports(folder: Path, gate: SimpleNamespace) -> None:
    held = "import gate\ngate.entered.set()\nassert gate.go.wait(60)\n"
    (folder / "held.py").write_text(held + SCHEME)
    (folder / "broken.py").write_text("1 / 0")
    first, one = started(qs.schemes)
    assert gate.entered.wait(60)
    others = [started(call) for call in (qs.schemes, lambda: qs.scheme("held"), catalogue.found)]
    for thread, _ in others:
        thread.join(LATE)  # one that does not wait has ended by then, with less
    gate.go.set()
    for thread in (first, *(thread for thread, _ in others)):
        thread.join(60)
    (listed,), (cls,), (everything,) = (results for _, results in others)
    assert one == [listed]
    assert "held" in listed
    assert {"slerp", "quartic"} <= set(listed)
    assert cls is qs.scheme("held")
    assert everything is catalogue.found()
    assert everything["broken"].scheme is None
    assert everything["held"].scheme is not None


def test_threads_load_one_module_and_whole(tmp_path: Path, gate: SimpleNamespace) -> None:
    """Experiments are loaded alike; a file's name need not be one of Python's."""
    path = tmp_path / "an.odd-name.py"
    path.write_text("import gate\ngate.entered.set()\nassert gate.go.wait(60)\nTITLE = 'whole'\n")
    first, one = started(lambda: loading.load(path, "experiment"))
    assert gate.entered.wait(60)
    second, two = started(lambda: loading.load(path, "experiment").TITLE)
    second.join(LATE)
    gate.go.set()
    first.join(60)
    second.join(60)
    assert two == ["whole"]
    assert one == [loading.load(path, "experiment")]


def test_a_file_that_fails_is_tried_again_by_the_next(tmp_path: Path) -> None:
    path = tmp_path / "mended.py"
    path.write_text("raise OSError('not yet')")
    with pytest.raises(OSError, match="not yet"):
        loading.load(path, "experiment")
    path.write_text("VALUE = 'there, and longer'")  # another size: no bytecode of the first one
    assert loading.load(path, "experiment").VALUE == "there, and longer"


def test_a_scheme_may_list_schemes_as_it_is_imported(folder: Path) -> None:
    asks = "import quatspline as qs\nBEFORE = qs.schemes()\n"
    (folder / "held.py").write_text(asks + SCHEME)
    assert "held" in qs.schemes()
    module = sys.modules[qs.scheme("held").__module__]
    assert "held" not in module.BEFORE
    assert set(module.BEFORE) == set(qs.schemes()) - {"held"}


@pytest.mark.parametrize("wrapped", [False, True])
def test_what_fails_for_want_of_a_module_under_import_is_not_kept(
    folder: Path, wrapped: bool
) -> None:
    """A user's module lists schemes as it is imported, and one of them imports that module."""
    lab = "import quatspline as qs\nBEFORE = qs.schemes()\nSHARE = 0.5\n"
    (folder.parent / "lab.py").write_text(lab)
    needs = "from lab import SHARE\n"
    if wrapped:
        needs = f"try:\n    {needs}except ImportError as e:\n    raise OSError('no lab') from e\n"
    (folder / "held.py").write_text(needs + SCHEME)
    code = "import lab, quatspline as qs\nprint('held' in lab.BEFORE, 'held' in qs.schemes())"
    assert python(code, folder.parent) == "False True"


def test_two_threads_that_need_each_other_s_imports_end(folder: Path) -> None:
    """One imports a module that lists schemes, the other a scheme that imports the module."""
    (folder.parent / "gate.py").write_text(GATE)
    lab = "import gate, quatspline as qs\ngate.entered.set()\nassert gate.go.wait(60)\n"
    lab += "qs.build('slerp', None, [[1, 0, 0, 0], [0, 1, 0, 0]])\nSHARE = 0.5\n"
    (folder.parent / "lab.py").write_text(lab)
    needs = "import gate\ngate.go.set()\nfrom lab import SHARE\n"
    (folder / "held.py").write_text(needs + SCHEME)
    code = """
import threading, gate, quatspline as qs
importing = threading.Thread(target=__import__, args=("lab",))
importing.start()
assert gate.entered.wait(60)
listing = threading.Thread(target=qs.schemes)
listing.start()
importing.join(60), listing.join(60)
print(importing.is_alive(), listing.is_alive(), "held" in qs.schemes(), "slerp" in qs.schemes())
"""
    assert python(code, folder.parent) == "False False True True"


# -- peers ----------------------------------------------------------------------


def test_peers_in_two_threads_leave_the_filters_of_warnings() -> None:
    inside, left = [threading.Event(), threading.Event()], threading.Event()

    def first() -> None:
        with quiet():
            inside[0].set()
            inside[1].wait(LATE)  # the other one must not come in
        left.set()

    def second() -> None:
        assert inside[0].wait(60)
        with quiet():
            inside[1].set()
            left.wait(60)

    with warnings.catch_warnings():
        before = list(warnings.filters)
        for thread, results in [started(call) for call in (first, second)]:
            thread.join(60)
            assert results == [None]
        assert list(warnings.filters) == before


PEER = """
import pathlib, time
from quatspline.peers.wrapping import PeerCurve
HERE = pathlib.Path(__file__).parent

class Library(PeerCurve):
    title = reference = "-"
    peer = "numpy"
    continuity, order, support, constant_rate = 0, 1, 2, "no"

    def _fit(self, keyframes):
        assert not (HERE / "inside").exists(), "two processes at once"
        (HERE / "inside").touch()
        until = time.monotonic() + 60.0
        while not (HERE / "asked").exists() and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep({late})
        (HERE / "inside").unlink()

    def _orientation(self, t):
        return self.keyframes.quaternions[:1].repeat(len(t), 0)
"""


def test_two_processes_import_a_peer_one_after_the_other(folder: Path) -> None:
    (folder / "library.py").write_text(PEER.format(late=LATE))
    (folder / "asked").touch()
    python("import quatspline as qs\nqs.scheme('library')")  # tried, with nobody to wait for
    for trace in ("asked", "inside"):
        (folder / trace).unlink(missing_ok=True)
    build = "qs.build('library', None, [[1, 0, 0, 0], [0, 1, 0, 0]])"
    both = "[[[1, 0, 0, 0]] * 2, [[0, 1, 0, 0]] * 2]"  # two tracks: a build within the build
    first = f"import quatspline as qs\nqs.build('library', None, {both})"
    second = f"""
import os, pathlib, time, quatspline as qs
here = pathlib.Path(os.environ["{catalogue.FOLDERS}"])
qs.scheme("library")
until = time.monotonic() + 60.0
while not (here / "inside").exists() and time.monotonic() < until:
    time.sleep(0.01)
(here / "asked").touch()
{build}
print("built")
"""
    other, results = started(lambda: python(first))
    assert python(second) == "built"
    other.join(STUCK)
    assert results == [""]


# -- forks --------------------------------------------------------------------------------------

FORKED = f"""
import os, signal, threading, warnings
import gate
warnings.simplefilter("ignore")  # newer Pythons warn of forks beside threads
{{prepared}}
threading.Timer({LATE}, gate.go.set).start()  # a fork that does not wait comes before
child = os.fork()
if not child:
    signal.alarm({STUCK // 2})
    {{asked}}
    os._exit(0)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
thread.join(60)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="nothing forks here")
@pytest.mark.parametrize(
    ("prepared", "asked"),
    [
        (
            "import quatspline as qs; thread = threading.Thread(target=qs.schemes)\n"
            "thread.start(); assert gate.entered.wait(60)",
            "os._exit(0 if 'held' in qs.schemes() and 'slerp' in qs.schemes() else 3)",
        ),
        (
            "from numba.core.compiler_lock import global_compiler_lock as lock\n"
            "import quatspline.engines.compiler\n"
            "def compiling():\n    with lock:\n        gate.entered.set(); gate.go.wait(60)\n"
            "thread = threading.Thread(target=compiling)\n"
            "thread.start(); assert gate.entered.wait(60)",
            "lock.acquire()",
        ),
        (
            "import sys, time, quatspline as qs\n"
            "keys = [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0, 0.6, 0.8, 0], [0, 0, 1, 0]]\n"
            "os.environ['QUATSPLINE_ENGINE'] = 'compiled'\n"
            "thread = threading.Thread(target=lambda: qs.build('slerp', None, keys))\n"
            "thread.start()\n"
            "while 'numba' not in sys.modules: time.sleep(0.001)\n"
            "gate.entered.set(); gate.go.set()",
            "os._exit(0 if qs.build('slerp', None, keys)(0.5).shape == (4,) else 3)",
        ),
        (
            "from quatspline.system.quiet import quiet\n"
            "def peer():\n    with quiet():\n        gate.entered.set(); gate.go.wait(60)\n"
            "thread = threading.Thread(target=peer)\n"
            "thread.start(); assert gate.entered.wait(60)",
            "with quiet(): pass",
        ),
    ],
    ids=["an import", "a compilation", "a first compilation", "a peer"],
)
def test_a_forked_child_waits_for_no_thread_it_lacks(
    folder: Path, prepared: str, asked: str
) -> None:
    (folder.parent / "gate.py").write_text(GATE)
    held = "import gate\ngate.entered.set()\nassert gate.go.wait(60)\n"
    (folder / "held.py").write_text(held + SCHEME)
    assert python(FORKED.format(prepared=prepared, asked=asked), folder.parent) == "0"


@pytest.mark.skipif(not hasattr(os, "fork"), reason="nothing forks here")
def test_a_fork_inside_an_import_does_not_wait_for_itself(folder: Path) -> None:
    forks = "import os, signal, warnings, quatspline as qs\n"
    forks += "warnings.simplefilter('ignore')  # newer Pythons warn of forks beside threads\n"
    forks += "child = os.fork()\n"
    forks += f"if not child: signal.alarm({STUCK // 2}); qs.schemes(); os._exit(0)\n"
    forks += "STATUS = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])\n"
    (folder / "held.py").write_text(forks + SCHEME)
    code = "import sys, quatspline as qs\nprint(sys.modules[qs.scheme('held').__module__].STATUS)"
    assert python(code) == "0"
