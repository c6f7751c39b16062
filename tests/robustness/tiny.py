"""A folder with two tiny experiments over plug-ins alone, whose run ends within a second or two."""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import pandas as pd
import plugins

from quatspline import discovery
from quatspline.admission import TRIED
from quatspline.runs.store import MANIFEST
from quatspline.system.caching import cache_base

STUCK = 900.0
"""Seconds after which a command counts as stuck."""
TOKEN = "QUATSPLINE_TORTURE"
"""The variable by which a command's processes are known."""
TIMINGS = ["seconds"]

SHARED = """
import time
from quatspline.catalogue import found
from quatspline.instruments.trials import attempted, builder
PAPER, NOTE = False, "As ever."
KEYFRAMES = [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.64, 0.48, 0.6, 0], [0.512, 0.384, 0.48, 0.6]]

def names(run):
    return run.schemes or [name for name, item in found().items() if not item.shipped]

def rows(scheme, x):
    began = time.perf_counter()
    def measure():
        value = builder(scheme)([0.0, 1.0, 2.0, 3.0], KEYFRAMES)(0.5 + x)
        return [{"value": float(value @ [1, 2, 3, 4]) + x / 3, "seconds": time.perf_counter() - began}]
    return attempted(measure, scheme=scheme, x=x)
"""
SIDE = """
TITLE = "Side by side"
def cells(run):
    return [{"scheme": name, "x": x} for x in range(3) for name in names(run)]
def measure_cell(run, scheme, x):
    time.sleep(0.02)
    return rows(scheme, x)
"""
TIMED = """
TITLE, SERIAL = "One after the other", True
def cells(run):
    return [{"x": x} for x in range(3)]
def measure_cell(run, x):
    time.sleep(0.02)
    return [row for name in names(run) for row in rows(name, x)]
"""
EXPERIMENTS = {"side": SIDE, "timed": TIMED}


class Tiny:
    """The folder; ``limits``: seconds of a trial and of a cell."""

    def __init__(self, folder: Path, *bad: str, limits: float = 120.0) -> None:
        self.folder, self.out = folder, folder / "results"
        for name in ("schemes", "experiments"):
            (folder / name).mkdir(parents=True)
        for name, text in EXPERIMENTS.items():
            (folder / "experiments" / f"{name}.py").write_text(SHARED + text, encoding="utf-8")
        for name in ("left", "right"):
            (folder / "schemes" / f"{name}.py").write_text(plugins.GOOD.text, encoding="utf-8")
        plugins.write(folder / "schemes", *bad)
        (folder / "cache" / TRIED).mkdir(parents=True)
        for path in cache_base().glob("*"):  # what is compiled serves here, too
            if path.name != TRIED:
                (folder / "cache" / path.name).symlink_to(path)
        paths = [_package(folder.parent / "package"), *os.environ.get("PYTHONPATH", "").split(":")]
        self.environment = {
            **os.environ,
            "PYTHONPATH": ":".join(filter(None, map(str, paths))),
            "QUATSPLINE_BASELINES": str(folder / "schemes"),
            "QUATSPLINE_EXPERIMENTS": str(folder / "experiments"),
            "QUATSPLINE_CACHE": str(folder / "cache"),
            "QUATSPLINE_TRIAL_SECONDS": str(limits),
            "QUATSPLINE_CELL_SECONDS": str(limits),
            TOKEN: f"{random.getrandbits(64):x}",
        }

    def start(self, *more: object, jobs: int = 2, **options: Any) -> subprocess.Popen[str]:
        """Begin the command: both experiments into the folder."""
        line = [sys.executable, "-m", "quatspline", "run", *EXPERIMENTS]
        line += ["--jobs", str(jobs), "--out", str(self.out), *map(str, more)]
        given = {"env": self.environment, "cwd": self.folder, "start_new_session": True} | options
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        return subprocess.Popen(line, **pipes, **given)

    def run(self, *more: object, **options: Any) -> tuple[int, str]:
        """The command's status and what it said; what plug-ins print on stdout makes it -1000."""
        with self.start(*more, **options) as process:
            try:
                out, said = process.communicate(timeout=STUCK)
            except subprocess.TimeoutExpired:
                process.kill()
                raise
        return (-1000, out) if "noise" in out else (process.returncode, said)

    def tables(self) -> dict[str, pd.DataFrame]:
        """The tables without their timings."""
        paths = {name: self.out / f"{name}.csv" for name in EXPERIMENTS}
        blank = {"keep_default_na": False, "na_values": [""]}  # a scheme may be called null
        read = {name: pd.read_csv(p, **blank) for name, p in paths.items() if p.exists()}
        return {name: table.drop(columns=TIMINGS) for name, table in read.items()}

    def began(self) -> bool:
        """Whether a run has written the manifest."""
        return (self.out / MANIFEST).exists()

    def kept(self) -> set[tuple[str, str]]:
        """The whole lines of the journals, each with the experiment that it is of."""
        lines: set[tuple[str, str]] = set()
        for name in EXPERIMENTS:
            with suppress(FileNotFoundError):  # not begun, or finished while one looks
                content = (self.out / ".cells" / f"{name}.jsonl").read_bytes()
                text = content.decode("utf-8", errors="replace").splitlines(keepends=True)
                lines |= {(name, line) for line in text if line.endswith('"}\n')}
        return lines

    def lost(self, before: set[tuple[str, str]]) -> int:
        """How many lines are gone whose experiment has no table."""
        gone = before - self.kept()
        return sum(not (self.out / f"{name}.csv").exists() for name, _ in gone)

    def orphans(self, patience: float = 3.0) -> list[int]:
        """Processes of this folder's commands that still run, given a while to end."""
        end = time.monotonic() + patience
        while (left := self._alive()) and time.monotonic() < end:
            time.sleep(0.05)
        return left

    def _alive(self) -> list[int]:
        mark = f"{TOKEN}={self.environment[TOKEN]}".encode()
        return [int(p.name) for p in Path("/proc").glob("[0-9]*") if _bears(p, mark)]

    def clear(self) -> None:
        """Remove the results."""
        shutil.rmtree(self.out, ignore_errors=True)


def _package(copy: Path) -> Path:
    """A folder with a copy of the package without its schemes and experiments, made where there is none.

    Most of a tiny run's time went into importing them; and no edit to the sources reaches runs on the way.
    """
    if not copy.exists():
        left_out = shutil.ignore_patterns("__pycache__", "node_modules")
        shutil.copytree(discovery.PACKAGE, copy / "quatspline", ignore=left_out)
        for path in (copy / "quatspline" / "proposed").glob("[!_]*.py"):
            path.unlink()
        for name in ("baselines", "experiments"):  # as in an installed package
            shutil.rmtree(copy / "quatspline" / name, ignore_errors=True)
            (copy / "quatspline" / name).mkdir()
    return copy


def _bears(process: Path, mark: bytes) -> bool:
    try:
        state = (process / "stat").read_text().rpartition(")")[2].split()[0]
        return state not in "ZX" and mark in (process / "environ").read_bytes().split(b"\0")
    except OSError:
        return False


def same(one: dict[str, pd.DataFrame], other: dict[str, pd.DataFrame]) -> bool:
    """Whether tables agree in all columns but timings."""
    return one.keys() == other.keys() and all(one[name].equals(other[name]) for name in one)
