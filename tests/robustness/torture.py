"""The trials that a run has to survive: kills, corruptions, full disks, plug-ins and files of strangers.

By hand, bounded in count and time (the share of every trial, minutes in all):

    python tests/robustness/torture.py --share 1 --minutes 120

After every trial the same command has to finish, and its tables must equal those of a run that nothing
happened to, in all columns but timings.  The table counts what was tried, what survived, cells lost,
processes left behind and tracebacks.  A small part is in ``test_torture.py``.
"""

from __future__ import annotations

import argparse
import math
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import hostile
import pandas as pd
import plugins
from tiny import TRIED, Tiny, same

KINDS = ["SIGINT", "SIGTERM", "SIGHUP", "SIGKILL", "writes", "corruptions", "together", "plug-ins"]
KINDS += ["files", "full", "large", "read-only"]
SIGNALS = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL]


@dataclass
class Tally:
    """What became of the trials of one kind."""

    kind: str
    counts_lost: bool = False
    tried: int = 0
    left: int = 0
    survived: int = 0
    lost: int = 0
    orphaned: int = 0
    tracebacks: int = 0
    notes: list[str] = field(default_factory=list)

    def count(
        self, well: bool, said: str, *, lost: int = 0, orphaned: int = 0, what: str = ""
    ) -> None:
        """Enter one trial; ``said``: all that its commands said."""
        traces = said.count("Traceback (most recent call last)")
        self.tried += 1
        self.survived += well
        self.lost += lost
        self.orphaned += orphaned
        self.tracebacks += traces
        if not well or lost or orphaned or traces:
            self.notes.append(f"{self.kind}: {what}: {said[-1500:]}")

    def line(self, columns: Sequence[str]) -> str:
        """Its row; lost cells are counted where a journal was read before the trial."""
        counts = [f"{getattr(self, name):12}" for name in columns]
        if not self.counts_lost:
            counts[columns.index("lost")] = f"{'-':>12}"
        return f"{self.kind:28}{''.join(counts)}"

    @property
    def clean(self) -> bool:
        """Whether nothing went wrong."""
        return self.tried == self.survived and not (
            self.left or self.lost or self.orphaned or self.tracebacks
        )


class Torture:
    """Trials in folders of their own below one, until a moment."""

    def __init__(self, folder: Path, seed: int = 0, until: float = math.inf) -> None:
        self.rng, self.until = random.Random(seed), until
        self.tiny = Tiny(folder / "tiny")
        began = time.monotonic()
        status, said = self.tiny.run()
        self.usual = time.monotonic() - began
        assert status == 0, said
        self.expected = self.tiny.tables()
        self.folder = folder

    def _times(self, tally: Tally, count: int) -> Iterator[int]:
        for i in range(count):
            if time.monotonic() > self.until:
                tally.left = count - i
                return
            yield i

    def _finish(self, *more: object) -> tuple[bool, str]:
        """Whether the same command finishes with the right tables."""
        status, said = self.tiny.run(*more)
        return status == 0 and same(self.tiny.tables(), self.expected), said

    # -- kills ----------------------------------------------------------------------------------

    def kills(self, number: signal.Signals, count: int) -> Tally:
        """A signal at random moments after the run has begun its manifest, jobs 1 to 3."""
        tally = Tally(f"{number.name} at random moments", counts_lost=True)
        for i in self._times(tally, count):
            self.tiny.clear()
            process = self.tiny.start(jobs=1 + i % 3)
            while not self.tiny.began() and process.poll() is None:
                time.sleep(0.005)
            time.sleep(self.rng.uniform(0.0, self.usual))
            before = self.tiny.kept()
            process.send_signal(number)
            said = process.communicate(timeout=60)[1]
            fine = process.returncode in (0, -number, 128 + number)
            self._after(tally, before, said, fine=fine, what=f"status {process.returncode}")
        return tally

    def writes(self, count: int) -> Tally:
        """SIGKILL before and after every write, sync and rename of the command's own process."""
        tally = Tally("SIGKILL at every write")
        hooks = self.folder / "hooks"
        hooks.mkdir(exist_ok=True)
        (hooks / "sitecustomize.py").write_text(HOOK, encoding="utf-8")
        own = dict(self.tiny.environment)
        paths = ":".join(filter(None, [str(hooks), own.get("PYTHONPATH", "")]))
        moments = [*range(10_000)] if count >= 200 else self.rng.sample(range(40), count)
        for i in self._times(tally, len(moments)):
            self.tiny.clear()
            at = {"PYTHONPATH": paths, "TORTURE_AT": str(moments[i])}
            with self.tiny.start(env={**own, **at}) as process:
                said = process.communicate(timeout=120)[1]
            if process.returncode == 0:  # there are no more moments
                break
            killed = process.returncode == -signal.SIGKILL
            self._after(tally, None, said, fine=killed, what=f"write {moments[i]}")
        return tally

    def _after(
        self,
        tally: Tally,
        before: set[tuple[str, str]] | None,
        said: str,
        *,
        fine: bool,
        what: str,
    ) -> None:
        """Count a trial that ended a run: what is left of it, and whether it goes on.

        ``before``: what its journals held, None where that cannot be known.
        """
        orphans, lost = self.tiny.orphans(), 0 if before is None else self.tiny.lost(before)
        well, more = self._finish()
        tally.count(fine and well, said + more, lost=lost, orphaned=len(orphans), what=what)

    # -- corruptions ----------------------------------------------------------------------------

    def corruptions(self, count: int) -> Tally:
        """Files of an interrupted run and of a finished one altered: healed, or refused in a sentence."""
        tally = Tally("corrupted files")
        states = [self._state(self._interrupted, "interrupted"), self._state(self._whole, "whole")]
        for i in self._times(tally, count):
            self._restore(states[i % 4 == 0])
            target = self._victim()
            what = f"{target.name}, {_damage(target, self.rng)}"
            status, said = self.tiny.run()
            fine = status == 0 or (status in (1, 2) and len(said.splitlines()) == 1)
            well, more = (True, "") if status == 0 else self._finish("--force")
            well &= same(self.tiny.tables(), self.expected)
            tally.count(fine and well, said + more, orphaned=len(self.tiny.orphans()), what=what)
        return tally

    def _state(self, make: Callable[[], None], name: str) -> Path:
        """A copy of the results and verdicts that a run has left."""
        self.tiny.clear()
        make()
        for place, kept in self._places(self.folder / name):
            shutil.copytree(place, kept, dirs_exist_ok=True)
        return self.folder / name

    def _restore(self, state: Path) -> None:
        for place, kept in self._places(state):
            shutil.rmtree(place, ignore_errors=True)
            shutil.copytree(kept, place)

    def _places(self, state: Path) -> list[tuple[Path, Path]]:
        tried = self.tiny.folder / "cache" / TRIED
        return [(self.tiny.out, state / "results"), (tried, state / TRIED)]

    def _whole(self) -> None:
        status, said = self.tiny.run()
        assert status == 0, said

    def _interrupted(self) -> None:
        """Stop a run that has cells in its journal."""
        with self.tiny.start() as process:
            while not self.tiny.kept() and process.poll() is None:
                time.sleep(0.005)
            process.kill()

    def _victim(self) -> Path:
        places = self._places(self.folder)
        found = [path for place, _ in places for path in sorted(place.rglob("*")) if path.is_file()]
        return self.rng.choice(found)

    # -- others ---------------------------------------------------------------------------------

    def together(self, count: int, runs: int) -> Tally:
        """Several runs into one folder: all but one are refused, or keep what the first has finished."""
        tally = Tally(f"{runs} runs at once")
        for _ in self._times(tally, count):
            self.tiny.clear()
            processes = [self.tiny.start(jobs=1) for _ in range(runs)]
            said = [process.communicate(timeout=180)[1] for process in processes]
            statuses = sorted(process.returncode for process in processes)
            refused = [s for s, p in zip(said, processes, strict=True) if p.returncode == 2]
            fine = set(statuses) <= {0, 2} and 0 in statuses
            fine &= all(len(text.splitlines()) == 1 for text in refused)
            well, more = self._finish()
            orphans = len(self.tiny.orphans())
            tally.count(fine and well, "".join(said) + more, orphaned=orphans, what=str(statuses))
        return tally

    def plug_ins(self, *groups: tuple[str, ...], limits: float = 20.0) -> Tally:
        """Bad plug-ins beside good ones: their rows, labelled, and nothing else."""
        tally = Tally("bad plug-ins")
        for i in self._times(tally, len(groups)):
            tiny = Tiny(self.folder / f"plug-in {i}", *groups[i], limits=limits)
            status, said = tiny.run(jobs=1 + i % 2)
            wrong = _wrong(tiny.tables(), self.expected, groups[i])
            orphans = tiny.orphans()
            what = f"{groups[i]}: status {status}: {wrong}"
            tally.count(status == 0 and not wrong, said, orphaned=len(orphans), what=what)
            shutil.rmtree(tiny.folder)
        return tally

    def files(self, made: Sequence[Path]) -> Tally:
        """Hostile files: one sentence and status 2, or what can be read of them."""
        tally = Tally("hostile files")
        for i in self._times(tally, len(made)):
            path = made[i]
            line = [sys.executable, "-m", "quatspline", "info", str(path)]
            try:
                done = subprocess.run(line, capture_output=True, text=True, timeout=30, check=False)
            except subprocess.TimeoutExpired:
                tally.count(False, "stuck", what=path.name)
                continue
            last = done.stderr.splitlines()[-1:] or [""]
            fine = done.returncode == 0 or (done.returncode == 2 and len(last[0]) < 500)
            tally.count(fine, done.stderr, what=f"{path.name}: status {done.returncode}")
        return tally

    def full_disks(self, count: int) -> Tally:
        """A disk with room for a few pages: told in a line, and finished when there is more."""
        tally = Tally("a full disk")
        with self._disk() as place:
            for _ in self._times(tally, count if place else 0):
                room = self.rng.randrange(12)
                ballast = place / "ballast"
                ballast.write_bytes(bytes(shutil.disk_usage(place).free - room * PAGE))
                status, said = self.tiny.run()
                ballast.unlink()
                self._refused(tally, status, said, f"{room} pages")
                self.tiny.clear()
        return tally

    def large_files(self, count: int) -> Tally:
        """No file may exceed a size: told in a line, and finished where it may."""
        tally = Tally("files limited in size")
        resource = __import__("resource")
        for _ in self._times(tally, count):
            self.tiny.clear()
            room = self.rng.randrange(0, 4000)
            limit = (resource.RLIMIT_FSIZE, (room, room))
            status, said = self.tiny.run(preexec_fn=lambda limit=limit: resource.setrlimit(*limit))
            self._refused(tally, status, said, f"{room} bytes")
        return tally

    def _refused(self, tally: Tally, status: int, said: str, what: str) -> None:
        """Count a run that could not write all: it said so, and goes on where it can."""
        last = said.splitlines()[-1:] or [""]
        fine = status == 0 or (status == 1 and "cannot be written" in last[0])
        self._after(tally, None, said, fine=fine, what=f"{what}: status {status}")

    def read_only(self, count: int) -> Tally:
        """A disk that cannot be written: told in a line, and finished where it can."""
        tally = Tally("a read-only disk")
        with self._disk() as place:
            for _ in self._times(tally, count if place else 0):
                _mount(place, "-o", "remount,ro")
                status, said = self.tiny.run()
                _mount(place, "-o", "remount,rw")
                fine = status in (1, 2) and len(said.splitlines()) == 1
                self._after(tally, None, said, fine=fine, what=f"status {status}")
                self.tiny.clear()
        return tally

    @contextmanager
    def _disk(self) -> Iterator[Path | None]:
        """A small file system that the results are put on; None where mounting is not allowed."""
        place = self.folder / "disk"
        place.mkdir(exist_ok=True)
        if not _mount(place, "-t", "tmpfs", "-o", "size=1m", "none"):
            yield None
            return
        usual, self.tiny.out = self.tiny.out, place / "results"
        try:
            yield place
        finally:
            self.tiny.out = usual
            subprocess.run(["umount", str(place)], check=False)


PAGE = 4096
"""Bytes that a file system gives to a file at once."""

HOOK = """
import os, signal, sys
from io import FileIO
at, so_far = int(os.environ["TORTURE_AT"]), 0
def counted(function):
    def call(*given, **more):
        global so_far
        for _ in (0, 1):
            if so_far == at:
                os.kill(os.getpid(), signal.SIGKILL)
            so_far += 1
            if _ == 0:
                result = function(*given, **more)
        return result
    return call
if "run" in sys.orig_argv and "-m" in sys.orig_argv:
    os.fsync, os.replace = counted(os.fsync), counted(os.replace)
    import io
    class Counted(FileIO):
        write = counted(FileIO.write)
    io.FileIO = Counted
"""
"""Makes a command kill itself before or after its n-th write to a journal, sync or rename."""


def _damage(path: Path, rng: random.Random) -> str:
    """Alter a file in one of eight ways, and say which."""
    content = bytearray(path.read_bytes())
    at = rng.randrange(len(content)) if content else 0
    how = rng.randrange(8)
    if how == 0:
        content = content[:at]
    elif how == 1 and content:
        content[at] ^= 1 << rng.randrange(8)
    elif how == 2:
        content = bytearray(len(content))
    elif how == 3:
        content = bytearray(rng.randbytes(len(content)))
    elif how == 4:
        content = bytearray()
    elif how == 5:
        content += rng.randbytes(100)
    elif how == 6:
        content += bytes(content)
    else:
        content[at:at] = b"\n"
    path.write_bytes(content)
    return f"damage {how} at {at}"


def _wrong(
    tables: dict[str, pd.DataFrame], expected: dict[str, pd.DataFrame], bad: tuple[str, ...]
) -> str:
    """What is wrong with tables that bad plug-ins are in; nothing where others' rows are as ever."""
    for name, whole in expected.items():
        if name not in tables:
            return f"no table {name}"
        table = tables[name]
        rest = table[table["scheme"].isin(set(whole["scheme"]))].reset_index(drop=True)
        if not rest[["scheme", "x", "value"]].equals(whole[["scheme", "x", "value"]]):
            return f"{name}: rows of others differ"
        for key in bad:
            rows = table[table["scheme"] == key.replace("_", "-")]
            reason = plugins.BAD[key].reason
            said = rows["failure"].dropna() if "failure" in rows else pd.Series(dtype=str)
            right = (
                said.str.contains(reason, regex=False).sum() if reason else len(rows) - len(said)
            )
            if len(rows) != 3 or right != 3:
                return f"{name}: {key}: {said.tolist()}"
    return ""


def _mount(place: Path, *options: str) -> bool:
    try:
        done = subprocess.run(["mount", *options, str(place)], capture_output=True, check=False)
    except OSError:
        return False
    return done.returncode == 0


def trials(torture: Torture, share: float) -> Iterator[tuple[str, Callable[[], Tally]]]:
    """All kinds of trial by what chooses them, each with its count times a share."""

    def times(count: int) -> int:
        return max(1, round(share * count))

    for number in SIGNALS:
        yield number.name, lambda number=number: torture.kills(number, times(100))
    yield "writes", lambda: torture.writes(times(200))
    yield "corruptions", lambda: torture.corruptions(times(200))
    for runs in (2, 4):
        yield "together", lambda runs=runs: torture.together(times(10), runs)
    bad = [(name,) for name in list(plugins.BAD)[: times(len(plugins.BAD))]]
    yield "plug-ins", lambda: torture.plug_ins(*bad, tuple(plugins.BAD))
    made = hostile.files(torture.folder / "hostile", torture.rng, times(150), times(10))
    yield "files", lambda: torture.files(list(made))
    yield "full", lambda: torture.full_disks(times(20))
    yield "large", lambda: torture.large_files(times(20))
    yield "read-only", lambda: torture.read_only(times(3))


def main() -> int:
    """Run the trials and print the table; status 1 where something did not survive."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--share", type=float, default=1.0, help="of the counts of all trials")
    parser.add_argument("--minutes", type=float, default=120.0, help="after which no trial begins")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", metavar="KIND,...", help=f"of {', '.join(KINDS)}")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="torture-") as folder:
        until = time.monotonic() + 60.0 * given.minutes
        torture = Torture(Path(folder), given.seed, until)
        columns = ("tried", "left", "survived", "lost", "orphaned", "tracebacks")
        print(f"{'trial':28}" + "".join(f"{name:>12}" for name in columns))
        tallies = []
        only = given.only.split(",") if given.only else KINDS
        for kind, trial in trials(torture, given.share):
            if kind not in only:
                continue
            tally = trial()
            tallies.append(tally)
            print(tally.line(columns), flush=True)
    for note in [note for tally in tallies for note in tally.notes]:
        print(f"\n{note}", file=sys.stderr)
    return 0 if all(tally.clean for tally in tallies) else 1


if __name__ == "__main__":
    sys.exit(main())
