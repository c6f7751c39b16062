"""A results folder with its page, for tests: parsed, or opened in a browser."""

from __future__ import annotations

import importlib
import json
import os
import shutil
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from quatspline.motion import Motion
from quatspline.motion.replay import replay
from quatspline.page import Scene, paper_scenes
from quatspline.quaternion import exp
from quatspline.runs.results import Results
from quatspline.trajectories.figure_walk import figure_walk
from tools.readme import REFERENCE

EVIL = '</script><script>alert(1)</script><img src=x onerror="alert(2)">&amp;'

CONVERGENCE = pd.DataFrame(
    [
        {"scheme": name, "method": way, "keyframes": 5, "step_degrees": a, "unevenness": r}
        | ({} if name == "hermite" else {"share_converged": 1.0 / (a + r), "rate": 0.01**a})
        for name, way in (("hermite", None), ("kim", "newton"), ("min-torque", None))
        for a in (1, 4)
        for r in (1, 10)
    ]
)
"""A table that is drawn as a map, of a scheme first of which nothing was measured."""

EXCURSION = pd.DataFrame(
    {
        "data": "hold 10 : 1",
        "scheme": ["slerp", "quartic", "kim"],
        "wander_worst": [0.0, 41.0, 90.0],
        "overshot": [0.0, 0.2, 0.3],
    }
)
"""What wanders where a body holds still."""

SCHEMES = ("quartic", "slerp")
"""Schemes of the player in these tests: two kernels to compile, not thirty."""


REQUIRED = "QUATSPLINE_BROWSER"
"""Set where a missing browser is a failure: in continuous integration."""

DESKTOP = {"width": 1280, "height": 900}

REBUILT, EVERY = ("slerp", "quartic", "squad"), 16
"""Of the walk in these pages."""


def needed(module: str) -> Any:
    """A module of the extra 'test', without which a test is skipped or, where required, fails."""
    required = os.environ.get(REQUIRED)
    return importlib.import_module(module) if required else pytest.importorskip(module)


def replays() -> list[dict[str, Any]]:
    """The walk, and a body that flies a loop."""
    walk = replay(figure_walk(), REBUILT, EVERY, title="figure-walk", source="Made.")
    return [walk, replay(loop(), REBUILT[:2], EVERY, title="loop")]


def loop(frames: int = 400) -> Motion:
    """A body that looks where it flies."""
    t = np.arange(frames) / 100.0
    turn = 0.25 * np.pi * t
    places = np.stack([np.cos(2 * turn), np.sin(2 * turn), 0.3 * np.sin(turn)], axis=1)
    half = np.stack([0.1 * np.sin(5 * turn), 0.1 * np.cos(3 * turn), turn], axis=1)
    return Motion(t, exp(half), places, unit="m")


class Elements(HTMLParser):
    """Elements with attributes and text, and scripts by id."""

    VOID = ("meta", "link", "input", "img", "br")

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.items: list[tuple[str, dict[str, str], list[str]]] = []
        self.open: list[tuple[str, dict[str, str], list[str]]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.items.append((tag, {k: v or "" for k, v in attrs}, []))
        if tag not in self.VOID:
            self.open.append(self.items[-1])

    def handle_endtag(self, tag: str) -> None:
        while self.open and self.open.pop()[0] != tag:
            pass

    def handle_data(self, data: str) -> None:
        if self.open:
            self.open[-1][2].append(data)

    def with_class(self, name: str) -> list[tuple[dict[str, str], str]]:
        return [(a, "".join(t)) for _, a, t in self.items if name in a.get("class", "").split()]

    def data(self, name: str) -> Any:
        return next(json.loads("".join(t)) for _, a, t in self.items if a.get("id") == name)


def results(folder: Path) -> Path:
    """A results folder: the reference tables, one that no section knows, and figures."""
    shutil.copytree(REFERENCE, folder)
    rows = {"scheme": ["quartic", "slerp", EVIL], "score": [2.0, np.inf, np.nan]}
    frame = pd.DataFrame({**rows, "comment, quoted": ['a "b"', "c\nd", "e"]})
    made = Results(folder)
    made.begin(["quatspline", "run"], seed=0)
    made.table("unheard-of", frame, title=f"Unheard {EVIL}", note="Nobody knows.", keys=[])
    figure = Figure(figsize=(3.0, 2.0))
    figure.subplots().plot([0, 1])
    for name in ("unheard-of", "figure1"):
        made.figure(name, figure)
    made.table("convergence", CONVERGENCE)
    made.table("excursion", EXCURSION)
    made.table("figure1", pd.DataFrame({"u": [0.0, 1.0]}))
    made.text("unheard-of.caption.txt", "A <b>line</b>.\n")
    made.replays("reconstruct", replays())
    entry = {"size": "quick", "seed": 0, "seconds": 1.0, "failure": None}
    made.record("unheard-of", entry)
    made.record("broken", entry | {"failure": "ValueError: <none>"})
    made.finish()
    return folder


def scenes() -> list[Scene]:
    pair = ("quartic", "slerp")
    return [replace(scene, schemes=SCHEMES, pair=pair) for scene in paper_scenes()]


class Opened:
    """The page in a browser, with what it said and asked for."""

    def __init__(self, browser: Any, path: Path, **context: Any) -> None:
        self.context = browser.new_context(accept_downloads=True, **context)
        self.page = self.context.new_page()
        self.said: list[str] = []
        self.asked: list[str] = []
        self.page.on("console", lambda m: m.type == "error" and self.said.append(m.text))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(path.as_uri())

    def __call__(self, script: str, *arguments: Any) -> Any:
        return self.page.evaluate(script, *arguments)

    def check(self) -> None:
        """It said nothing wrong and asked for nothing from elsewhere."""
        assert self.said == []
        assert all(url.startswith(("file:", "data:", "blob:")) for url in self.asked), self.asked
