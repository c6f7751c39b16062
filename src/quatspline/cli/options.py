"""Options of schemes on the command line: ``--option name=value``, and the command ``options``."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterable, Sequence
from types import UnionType
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, get_args, get_origin

from quatspline import catalogue
from quatspline.options import EXACT, checked, declared_by
from quatspline.system.stdout import say

if TYPE_CHECKING:
    from quatspline.curve import Curve

KINDS = {int: "a whole number", float: "a number", bool: "True or False", type(None): "None"}


def given(pairs: Iterable[str]) -> dict[str, Any]:
    """Options by name of ``name=value``: numbers, lists of numbers by commas, None, or words.

    Raises
    ------
    ValueError
        Without "=", or for a name that comes twice.
    """
    found: dict[str, Any] = {}
    for pair in pairs:
        name, equals, text = pair.partition("=")
        if not (equals and name.strip()):
            raise ValueError(f"--option {pair}: name=value is expected")
        if name.strip() in found:
            raise ValueError(f"--option {pair}: {name.strip()} is given twice")
        found[name.strip()] = _value(text.strip())
    return found


def _value(text: str) -> Any:
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError, MemoryError, RecursionError):
        return text  # a word, as in ends=clamped


def of_scheme(name: str, pairs: Iterable[str]) -> dict[str, Any]:
    """The options of one scheme, refused in one sentence where it has no such name or value."""
    return checked(catalogue.scheme(name), given(pairs))


def of_schemes(names: Sequence[str] | None, pairs: Iterable[str]) -> dict[str, Any]:
    """Options of several schemes (None: all), each of which at least one of them has."""
    from quatspline.comparing import check_options

    found = given(pairs)
    if found:
        check_options(found, catalogue.schemes() if names is None else names)
    return found


def command(name: str) -> int:
    """Serve ``quatspline options``: what a scheme takes, by default what, and its own words on it."""
    cls = catalogue.scheme(name)
    rows = [(f"{option}={default}", kind) for option, default, kind in told(cls)]
    width = max((len(default) for default, _ in rows), default=0)
    say([f"{name}: {cls.title}", ""])
    say(f"  --option {default:{width}}  {kind}" for default, kind in rows)
    say(["", *inspect.cleandoc(cls.__doc__ or "").splitlines()] if rows else ["  no options"])
    return 0


def told(scheme: type[Curve]) -> list[tuple[str, Any, str]]:
    """The options of a scheme: name, default, and what values it takes, in words."""
    return [(name, p.default, _kind(p.annotation)) for name, p in declared_by(scheme).items()]


def _kind(kind: Any) -> str:
    """What values an annotation takes, in words."""
    origin = get_origin(kind)
    if origin is Literal:
        return " | ".join(map(str, get_args(kind)))
    if origin is Annotated:
        base, *bounds = get_args(kind)
        told = [str(bound) for bound in bounds if abs(bound.bound) < EXACT]
        return ", ".join([_kind(base), *told])
    parts = get_args(kind) if origin in (Union, UnionType) else (kind,)
    if all(part in KINDS or get_origin(part) in (Literal, Annotated) for part in parts):
        return " | ".join(KINDS.get(part) or _kind(part) for part in parts)
    return "a number, or several by commas"
