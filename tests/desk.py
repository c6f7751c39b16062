"""A folder to run the command line in, with schemes and experiments of its own."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import pytest

from quatspline import catalogue
from quatspline.cli import main
from quatspline.runs import experiment

Finished = subprocess.CompletedProcess[str]

SCHEME = '''
import numpy as np
from quatspline import ConvergenceError, SolveReport
from quatspline.curve import Curve

class Stairs(Curve):
    """The last keyframe before t: no compilation, no solve."""
    title, reference, continuity, order, support = "Stairs", "none", 0, 0, 1
    {claims}
    constant_rate = "no"
    def _fit(self, keyframes):
        {fit}
    def _orientation(self, t):
        knots = self.keyframes.knots[: self.keyframes.count]
        return self.keyframes.quaternions[np.searchsorted(knots, t, side="right") - 1]
'''

EXPERIMENT = """
import pandas as pd
from matplotlib.figure import Figure
TITLE, PAPER, NOTE = "{title}", {paper}, "As ever."
def measure(run):
    {before}
    names = run.schemes or ["b", "a"]
    return pd.DataFrame({{"scheme": names, "x": run.rng("x").random(len(names))}})
"""

FIGURE = """
def draw(table):
    figure = Figure()
    figure.subplots().plot(table["x"])
    return figure
def caption(table):
    return f"{len(table)} rows, from {table['scheme'][0]}."
"""


class Desk:
    """A folder with schemes, experiments and keyframes; calling it runs a command there."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in ("schemes", "experiments"):
            (folder / name).mkdir()
        self.environment = {
            experiment.FOLDERS: str(folder / "experiments"),
            catalogue.FOLDERS: str(folder / "schemes"),
        }

    def scheme(self, name: str, fit: str = "pass", claims: str = "pass") -> None:
        text = SCHEME.format(fit=fit, claims=claims)
        (self.folder / "schemes" / f"{name}.py").write_text(text)

    def experiment(self, name: str, before: str = "pass", **more: bool) -> None:
        """Write an experiment; more: paper=True, figure=False (which spares a slow import)."""
        paper, figure = more.get("paper", False), more.get("figure", True)
        text = EXPERIMENT.format(title=f"The {name}", paper=paper, before=before)
        path = self.folder / "experiments" / f"{name}.py"
        path.write_text(text + (FIGURE if figure else ""))

    def keyframes(self, name: str = "k.csv", text: str = "0,1,0,0,0\n1,0.8,0.6,0,0\n") -> Path:
        path = self.folder / name
        path.write_text(text)
        return path

    def __call__(self, *arguments: object) -> Finished:
        """A command in this process, which begins and ends as in one of its own."""
        given, (out, err) = [str(a) for a in arguments], (_stream(), _stream())
        with pytest.MonkeyPatch.context() as patch, redirect_stdout(out), redirect_stderr(err):
            patch.chdir(self.folder)
            for name, value in self.environment.items():
                patch.setenv(name, value)
            # Files are rewritten within a second, which is too soon for what Python keeps of them.
            patch.setattr(sys, "dont_write_bytecode", True)
            try:
                status = main(given)
            finally:
                self._forget()
        return Finished(given, status, *map(_written, (out, err)))

    def _forget(self) -> None:
        """Modules of this folder, which the next process would import anew."""
        files = {name: getattr(module, "__file__", None) for name, module in sys.modules.items()}
        for name, file in files.items():
            if file is not None and file.startswith(str(self.folder)):
                del sys.modules[name]

    def counted(self, name: str) -> int:
        path = self.folder / f"{name}.count"
        return len(path.read_text()) if path.exists() else 0

    def manifest(self) -> dict[str, Any]:
        loaded: dict[str, Any] = json.loads((self.folder / "results" / "manifest.json").read_text())
        return loaded


def count(name: str) -> str:
    """Source that notes in a file that the experiment was measured once more."""
    return f'with open("{name}.count", "a") as log: log.write(".")'


def refused(done: Finished, status: int = 2) -> str:
    """The one line with which a command ends."""
    assert done.returncode == status, done.stderr
    assert done.stderr.count("\n") == 1
    assert "Traceback" not in done.stderr
    return done.stderr.rstrip("\n")


def _stream() -> io.TextIOWrapper:
    """As a process has them: text on top of bytes."""
    return io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True)


def _written(stream: io.TextIOWrapper) -> str:
    assert isinstance(stream.buffer, io.BytesIO)
    return stream.buffer.getvalue().decode()
