"""Options of a scheme: the keyword-only parameters of its `_fit`, checked against annotations."""

from __future__ import annotations

import difflib
import inspect
import math
import numbers
import operator
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from types import UnionType
from typing import (
    TYPE_CHECKING,
    Annotated,
    Any,
    ClassVar,
    Literal,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np
from numpy.typing import ArrayLike

from quatspline.inputs.arrays import FloatArray, real_array, refuse_infinite

if TYPE_CHECKING:
    from quatspline.curve import Curve


@dataclass(frozen=True)
class Bound:
    """Marks a number that keeps to one side of a bound, or within it on both."""

    bound: float
    words: ClassVar[str]
    keeps: ClassVar[Callable[[float, float], bool]]

    def accepts(self, value: float) -> bool:
        """Whether a number keeps to it."""
        return type(self).keeps(value, self.bound)

    def __str__(self) -> str:
        return self.words.format(self.bound)


class Above(Bound):
    """Marks a number that must exceed a bound."""

    words, keeps = "above {:g}", operator.gt


class AtLeast(Bound):
    """Marks a number that must reach a bound."""

    words, keeps = "at least {:g}", operator.ge


class AtMost(Bound):
    """Marks a number that must not exceed a bound."""

    words, keeps = "at most {:g}", operator.le


class Within(Bound):
    """Marks a number whose magnitude must not exceed a bound."""

    words = "between -{0:g} and {0:g}"

    def accepts(self, value: float) -> bool:
        """Whether a number keeps to it."""
        return abs(value) <= self.bound


LONG = 60
"""Characters of a refused value that are shown."""

EXACT = 2**53
"""Integers up to it are float64 numbers."""

LARGEST = 1e6
"""Of factors of a turn: beyond, angles have no digits left that one could mean."""

Factor = Annotated[float, Within(LARGEST)]
Positive = Annotated[float, Above(0.0)]
Count = Annotated[int, AtLeast(1), AtMost(EXACT)]
Iterations = Annotated[Count, AtMost(10_000)]
"""Of a solver: those that converge need hundreds at most, and not every solver notices that it does not."""
Stop = Literal["residual", "change"]
OnFailure = Literal["raise", "return"]


def nearest(name: str, known: Iterable[str]) -> str:
    """'name' is unknown: the end of a sentence that offers the nearest known names."""
    known = sorted(known)
    close = difflib.get_close_matches(str(name), known, n=1, cutoff=0.5)
    return f"did you mean {close[0]!r}?" if close else f"known: {', '.join(known) or 'none'}"


def declared_by(scheme: type[Curve]) -> dict[str, inspect.Parameter]:
    """The options of a scheme by name, which its `_fit` declares, with their annotations resolved."""
    return _declared(scheme._fit)


@cache
def _declared(fit: Callable[..., Any]) -> dict[str, inspect.Parameter]:
    hints = get_type_hints(fit, include_extras=True)
    return {
        p.name: p.replace(annotation=hints.get(p.name, Any))
        for p in inspect.signature(fit).parameters.values()
        if p.kind is p.KEYWORD_ONLY
    }


def among(scheme: type[Curve], wanted: Mapping[str, Any]) -> dict[str, Any]:
    """Those of the wanted options that a scheme has."""
    known = declared_by(scheme)
    return {name: value for name, value in wanted.items() if name in known}


def checked(scheme: type[Curve], given: Mapping[str, Any]) -> dict[str, Any]:
    """The given options, refused with a ValueError where a name or a value is not declared."""
    known = declared_by(scheme)
    for name, value in given.items():
        if name not in known:
            raise ValueError(f"{scheme.name} has no option {name!r}: {nearest(name, known)}")
        _check(name, value, known[name].annotation)
    return dict(given)


def _check(name: str, value: Any, kind: Any) -> None:
    origin = get_origin(kind)
    if origin is Literal:
        if not (isinstance(value, str | numbers.Integral) and value in get_args(kind)):
            choices = ", ".join(repr(choice) for choice in get_args(kind))
            raise ValueError(f"{name}={_shown(value)}: expected one of {choices}")
    elif origin is Annotated:
        base, *bounds = get_args(kind)
        _check(name, value, base)
        for bound in bounds:
            if not bound.accepts(value):
                raise ValueError(f"{name}={_shown(value)}: must be {bound}")
    elif origin in (Union, UnionType):
        _check_any(name, value, get_args(kind))
    elif kind is bool:
        if not isinstance(value, bool | np.bool_):
            raise ValueError(f"{name}={_shown(value)}: expected True or False")
    elif kind is int:
        if isinstance(value, bool) or not isinstance(value, numbers.Integral):
            raise ValueError(f"{name}={_shown(value)}: expected an integer")
    elif kind is float and not (_is_number(value) and _is_finite(value)):
        raise ValueError(f"{name}={_shown(value)}: expected a finite number")


def _check_any(name: str, value: Any, kinds: tuple[Any, ...]) -> None:
    """One of several kinds has to fit; the refusal is that of the first, or for a word that of the words."""
    if value is None and type(None) in kinds:
        return
    refusals = []
    for kind in sorted(kinds, key=lambda kind: _takes_words(kind) != isinstance(value, str)):
        if kind is type(None):
            continue
        try:
            _check(name, value, kind)
        except ValueError as refusal:
            refusals.append(refusal)
        else:
            return
    raise refusals[0]


def _takes_words(kind: Any) -> bool:
    return get_origin(kind) is Literal and any(isinstance(x, str) for x in get_args(kind))


def _is_finite(value: Any) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer that float64 does not hold
        return False


def _shown(value: Any) -> str:
    """A value as Python writes it, cut where that is long."""
    text = repr(value)
    return text if len(text) <= LONG else f"{text[:LONG]}..."


def _is_number(value: Any) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def per_keyframe(name: str, value: ArrayLike, count: int, largest: float = LARGEST) -> FloatArray:
    """A scalar for every keyframe, or one number per keyframe -> (count,) float64."""
    array = real_array(name, value)
    if array.shape not in ((), (count,)):
        raise ValueError(f"{name} has shape {array.shape}: expected a number or {count} of them")
    array = np.array(np.broadcast_to(array, (count,)), dtype=float)
    refuse_infinite(name, array)
    if (np.abs(array) > largest).any():
        i = int(np.argmax(np.abs(array) > largest))
        raise ValueError(f"{name}[{i}] = {array[i]:g}: must be {Within(largest)}")
    return array
