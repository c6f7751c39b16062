"""The API reference: every public name with its docstring, and every option of every scheme, behind docs/api.md."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any

import quatspline
from quatspline import motion, quaternion
from quatspline.catalogue import found
from quatspline.cli.options import told
from quatspline.curve import Curve

PAGE = "api.md"
ALGEBRA = ("quatspline.quaternion", "quatspline.lengths", "quatspline.matrices")
SECTION = re.compile(r"^Options\n-+\n(?P<body>.*?)(?=^\S[^\n]*\n---|\Z)", re.M | re.S)
ENTRY = re.compile(r"^(?P<names>\S[^\n]*)(?P<text>(?:\n(?: [^\n]*)?)*)", re.M)
USUAL = "as for every iterative scheme"
ITERATION = {
    "stop": "what has to fall below the tolerance: the largest miss of a keyframe or the last update's change",
    "tolerance": "in rad",
    "max_iterations": "updates after which it gives up; None: the method's own limit",
    "on_failure": "raise `ConvergenceError`, or return the curve as it is with its `report`",
}
"""What a docstring leaves to this page where it says so."""


def public() -> dict[str, list[str]]:
    """The names that are documented, by the module that a user imports them from."""
    own = [name for name in quatspline.__all__ if name != "__version__"]
    moving = [name for name in motion.__all__ if name not in own]
    return {
        "quatspline": own,
        "quatspline.motion": moving,
        "quatspline.quaternion": sorted(_algebra()),
    }


def _algebra() -> Iterator[str]:
    """Functions of quaternion.py, wherever they are written; none of the kernels."""
    for name, value in vars(quaternion).items():
        home = getattr(value, "__module__", "")
        if inspect.isfunction(value) and home in ALGEBRA and not name.startswith("_"):
            yield name


def on_page_markdown(text: str, page: Any, **_: Any) -> str:
    """Append the reference to the page that introduces it."""
    return text + "\n".join(_reference()) if page.file.src_uri == PAGE else text


def _reference() -> Iterator[str]:
    for module, names in public().items():
        yield f"\n## {module}\n"
        yield from (f"::: {module}.{name}\n" for name in names)
    yield "\n## Options of schemes\n"
    yield "Keyword arguments of `build` and of the class, and `--option NAME=VALUE` on the command line.\n"
    for name, item in found().items():
        if item.scheme is not None:
            yield from _options(name, item.scheme)


def _options(name: str, scheme: type[Curve]) -> Iterator[str]:
    yield f'<h3 id="options-{name}">{name}</h3>\n'
    rows, meant = told(scheme), meanings(scheme)
    if not rows:
        yield f"{scheme.title}: no options.\n"
        return
    yield f"{scheme.title}.\n\n| option | default | values | meaning |\n| --- | --- | --- | --- |"
    for option, default, kind in rows:
        cells = (f"`{option}`", f"`{default}`", kind.replace("|", "or"), meant.get(option, ""))
        yield f"| {' | '.join(cells)} |"
    yield ""


def meanings(scheme: type[Curve]) -> dict[str, str]:
    """What a scheme's docstring says of each option, in one line."""
    section = SECTION.search(inspect.getdoc(scheme) or "")
    meant: dict[str, str] = {}
    for entry in ENTRY.finditer(section["body"]) if section else ():
        names, _, rest = entry["names"].partition(" : ")
        text = " ".join((rest + " " + entry["text"]).split()).replace("|", "\\|")
        for name in map(str.strip, names.split(",")):
            meant[name] = ITERATION.get(name, text) if text.startswith(USUAL) else text
    return meant
