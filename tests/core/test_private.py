"""No test reaches into a private name of another module: what one needs is public there."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]

PUBLIC = {"_replace", "_asdict", "_fields", "_exit"}
"""Of named tuples, which must not take names from fields, and of the system."""

EXCEPTIONS = {
    ("schemes/test_spherical_average.py", "_slope"): "of a kernel, held against 40 digits",
    ("instruments/test_budget.py", "_work"): "of the forecast",
    ("instruments/test_cost.py", "_fit"): "watched, for how often it is called",
    ("instruments/test_cost.py", "_setup"): "of the forecast",
    ("instruments/test_cost.py", "_waiting"): "tells whether all of a curve is fitted",
    ("core/test_segments.py", "_waiting"): "tells what of a curve is fitted",
    ("schemes/test_monotone_quintic.py", "_waiting"): "tells whether all of a curve is fitted",
    ("report/test_compare.py", "_fit"): "replaced by one that fails",
    ("report/test_choosing.py", "_convergence"): "of the experiment",
    ("report/test_choosing.py", "_edge_cases"): "of the experiment",
    ("report/test_choosing.py", "_spread"): "of the experiment",
    ("report/test_plug_ins.py", "_of_class"): "of the experiment",
    ("figures/test_printable.py", "_left_title"): "of matplotlib, which has no other way to it",
    ("figures/test_printable.py", "_right_title"): "of matplotlib, which has no other way to it",
}


def private(name: object) -> bool:
    return isinstance(name, str) and name[:1] == "_" != name[1:2] and name not in PUBLIC


def own(node: ast.expr) -> bool:
    """Whether a name is looked up on a test's own object: ``self``, ``cls`` or ``super()``."""
    if isinstance(node, ast.Call):
        return isinstance(node.func, ast.Name) and node.func.id == "super"
    return isinstance(node, ast.Name) and node.id in ("self", "cls")


def reached(tree: ast.AST) -> Iterator[str]:
    """Private names of others: as attributes, imported, or as words for getattr and setattr."""
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=value, attr=name) if private(name) and not own(value):
                yield name
            case ast.ImportFrom(names=names):
                yield from (alias.name for alias in names if private(alias.name))
            case ast.Call(
                func=ast.Name(id=call) | ast.Attribute(attr=call),
                args=[_, ast.Constant(value=str(name)), *_],
            ) if call in ("getattr", "setattr", "delattr") and private(name):
                yield name


@pytest.mark.parametrize(
    "path", sorted(TESTS.rglob("*.py")), ids=lambda path: path.relative_to(TESTS).as_posix()
)
def test_no_private_name_of_another_module(path: Path) -> None:
    here = path.relative_to(TESTS).as_posix()
    names = set(reached(ast.parse(path.read_text(encoding="utf-8"))))
    assert not {name for name in names if (here, name) not in EXCEPTIONS}


@pytest.mark.parametrize(
    "text",
    [
        "curve._fit",
        "curve._fit = 3",
        "type(self)._fit",
        "self.curve._fit()",
        "from quatspline.options import _declared",
        "monkeypatch.setattr(cls, '_fit', 3)",
        "getattr(curve, '_fit')",
    ],
)
def test_reaching_is_seen(text: str) -> None:
    assert len(list(reached(ast.parse(text)))) == 1


@pytest.mark.parametrize(
    "text", ["self._fit", "super()._fit(q)", "os._exit(0)", "row._replace(x=1)", "x.__dict__"]
)
def test_ones_own_is_not(text: str) -> None:
    assert not list(reached(ast.parse(text)))
