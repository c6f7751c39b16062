"""What the cache of compiled code is keyed by: every source that takes part."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from quatspline.discovery import PACKAGE, shipped
from quatspline.engines.compiler import compiled_from
from quatspline.kernels.jit import ROOMS

SOURCES = sorted(
    [path for room in ROOMS for path in (PACKAGE / room).glob("[!_]*.py")]
    + [PACKAGE / "timing" / "protocol_loops.py"]
    + [
        path
        for path in shipped("baselines").glob("[!_]*.py")
        if "quatspline.segments" in path.read_text()
    ]
)


def imported(source: Path) -> set[Path]:
    """The kernel sources that a file imports, by the syntax tree."""
    names = set()
    for node in ast.parse(source.read_text()).body:  # compiled code knows no late imports
        if isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    files = {PACKAGE.parent.joinpath(*name.split(".")).with_suffix(".py") for name in names}
    return {f for f in files if f.is_file() and f.parent.name in ROOMS}


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_every_source_that_takes_part_is_in_the_key(source: Path) -> None:
    seen, pending = {source}, [source]
    while pending:
        for path in imported(pending.pop()) - seen:
            seen.add(path)
            pending.append(path)
    assert seen <= compiled_from(source)


def test_a_scheme_takes_polynomials_and_families_with_it() -> None:
    stems = {path.stem for path in compiled_from(shipped("baselines") / "hermite.py")}
    assert {"scalars", "values", "family", "cumulative", "tangents", "polynomials"} <= stems
    assert not {"engine", "segments", "keyframes", "driver"} & stems


def test_the_driver_takes_what_it_inlines_with_it() -> None:
    stems = {path.stem for path in compiled_from(PACKAGE / "engines" / "driver.py")}
    assert {
        "locating",
        "sweeping",
        "blocks",
        "transposing",
        "intrinsics",
        "compiler",
        "values",
    } <= stems
