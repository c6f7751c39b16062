"""The third way to run kernels: as plain Python, on numbers that count what is done with them.

Functions are copied with what they call: a copy's numbers, arrays and primitives count, the original is left alone.
What a family or a fit executes is thereby measured, and stated nowhere.

Counted are ``multiplications``, ``additions`` (subtractions too), ``divisions``, ``roots``, calls of other functions
of `math` by name, and ``fused``: additions that take up a product, one instruction together with it.  Of the
primitives in `KINDS`, each call is one exponential, logarithm or slerp whatever it calls in turn.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from types import CellType, FunctionType, ModuleType
from typing import Any

import numpy as np

from quatspline.inputs.arrays import FloatArray
from quatspline.kernels.jit import BLOCK, CONSTANTS, ROWS, Compiled, Kernel

KINDS = {
    "values.slerp": "slerps",
    "arcs.near_point": "slerps",
    "arcs.point": "slerps",
    "nested._arc": "slerps",
    "nested._arc_jet": "slerps",
    "nested.slerp_jet": "slerps",
    "values.log": "logs",
    "local_rates.log_scale": "logs",
    "values.turn": "logs",
    "quick.log": "logs",
    "values.exp": "exps",
    "quick.exp": "exps",
    "bspline_rows.put_jet": "exps",
    "bspline_rows.put_far_jets": "far jets",
    "scalars.sinc": "exps",
    "scalars.sinc_near": "exps",
    "scalars.sincos": "exps",
    "scalars.sincos_any": "exps",
    "scalars.sincos_near": "exps",
    "scalars.sincos_small": "exps",
}
"""Functions that are one operation each, by module: a sine with its cosine is what an exponential costs, and the
point of an arc whose constants are stored is a slerp.  Jets of large angles are made again after those of all
knots in one loop: the same exponentials, so that they count apart."""

TOGETHER = 8
"""Samples evaluated at once, all the same: loops of rates take no fewer."""


class Tally(Counter[str]):
    """Counts by operation, while a copy runs; ``inside`` tells whether a primitive is running."""

    inside = False


class Number(float):
    """A float that enters what is done with it into a tally."""

    __slots__ = ("product", "tally")
    tally: Tally
    product: bool
    """Whether it is a product that no addition has taken up."""

    def __add__(self, other: Any) -> Any:
        return self._sum(other, float.__add__(self, other))

    def __radd__(self, other: Any) -> Any:
        return self._sum(other, float.__radd__(self, other))

    def __sub__(self, other: Any) -> Any:
        return self._sum(other, float.__sub__(self, other))

    def __rsub__(self, other: Any) -> Any:
        return self._sum(other, float.__rsub__(self, other))

    def __mul__(self, other: Any) -> Any:
        return self._made("multiplications", float.__mul__(self, other), product=True)

    def __rmul__(self, other: Any) -> Any:
        return self._made("multiplications", float.__rmul__(self, other), product=True)

    def __truediv__(self, other: Any) -> Any:
        return self._made("divisions", float.__truediv__(self, other))

    def __rtruediv__(self, other: Any) -> Any:
        return self._made("divisions", float.__rtruediv__(self, other))

    def __neg__(self) -> Number:
        negative = number(-float(self), self.tally, self.product)
        self.product = False
        return negative

    def __abs__(self) -> Number:
        return number(abs(float(self)), self.tally)

    def _sum(self, other: Any, value: Any) -> Any:
        for term in (self, other):
            if isinstance(term, Number) and term.product:
                term.product = False
                self.tally["fused"] += value is not NotImplemented
                break
        return self._made("additions", value)

    def _made(self, kind: str, value: Any, product: bool = False) -> Any:
        if value is NotImplemented:  # a vector, which asks its own methods
            return value
        self.tally[kind] += 1
        return number(value, self.tally, product)


def number(value: float, tally: Tally, product: bool = False) -> Number:
    """A number that counts in a tally."""
    made = Number(value)
    made.tally, made.product = tally, product
    return made


def numbers(values: Any, tally: Tally) -> Any:
    """An array of numbers that count."""
    array = np.empty(np.shape(values), object)
    array[...] = np.vectorize(lambda x: number(x, tally), otypes=[object])(values)
    return array


class _Math:
    """The module `math`: square roots count as such, other functions by their name."""

    def __init__(self, tally: Tally) -> None:
        self.tally = tally

    def __getattr__(self, name: str) -> Any:
        function = getattr(math, name)
        if not callable(function):
            return function
        kind = "roots" if name == "sqrt" else name

        def counted(*arguments: float) -> Any:
            self.tally[kind] += any(isinstance(a, Number) for a in arguments)
            value = function(*arguments)
            return number(value, self.tally) if isinstance(value, float) else value

        return counted


class _Numpy:
    """The module `numpy`: arrays of floats hold numbers that count."""

    def __getattr__(self, name: str) -> Any:
        return getattr(np, name)

    def empty(self, shape: Any, dtype: Any = float) -> Any:
        return np.empty(shape, object if dtype is float else dtype)

    def zeros(self, shape: Any, dtype: Any = float) -> Any:
        return np.full(shape, 0.0, object) if dtype is float else np.zeros(shape, dtype)


class Copies:
    """Copies of functions that count in one tally."""

    def __init__(self, tally: Tally) -> None:
        self.tally = tally
        self.made: dict[int, tuple[Any, Any]] = {}
        """By identity, with the original, which is thereby kept alive."""

    def of(self, value: Any) -> Any:
        """What stands in a copy in the place of a function, a module, or anything else."""
        value = getattr(value, "python", value) if isinstance(value, Compiled) else value
        if isinstance(value, ModuleType) and value in (math, np):
            return _Math(self.tally) if value is math else _Numpy()
        if not isinstance(value, FunctionType):
            return value
        if id(value) not in self.made:
            self._copy(value)
        return self.made[id(value)][1]

    def _copy(self, function: FunctionType) -> None:
        cells = tuple(CellType() for _ in function.__closure__ or ())
        found: dict[str, Any] = dict(function.__globals__)
        copy = FunctionType(
            function.__code__, found, function.__name__, function.__defaults__, cells
        )
        self.made[id(function)] = function, self._entering(function, copy)
        for name in function.__code__.co_names:
            if name in found:
                found[name] = self.of(found[name])
        for cell, own in zip(function.__closure__ or (), cells, strict=True):
            own.cell_contents = self.of(cell.cell_contents)

    def _entering(self, function: FunctionType, copy: Callable[..., Any]) -> Callable[..., Any]:
        """The copy, which enters itself where its calls are operations."""
        kind = KINDS.get(f"{function.__module__.rpartition('.')[2]}.{function.__name__}")
        if kind is None:
            return copy

        def entered(*arguments: Any) -> Any:
            if self.tally.inside:
                return copy(*arguments)
            self.tally[kind] += 1
            self.tally.inside = True
            try:
                return copy(*arguments)
            finally:
                self.tally.inside = False

        return entered


def of_a_fit(
    kernel: Kernel,
    track: FloatArray,
    h: FloatArray,
    closed: bool,
    sign: float,
    parameters: FloatArray,
    shape: tuple[int, int],
) -> Tally:
    """What a fit kernel executes on one track (n, 4) that is to have ``shape`` (segments, constants)."""
    tally = Tally()
    fitted(kernel, track, h, closed, sign, parameters, shape, tally)
    return tally


def fitted(
    kernel: Kernel,
    track: FloatArray,
    h: FloatArray,
    closed: bool,
    sign: float,
    parameters: FloatArray,
    shape: tuple[int, int],
    tally: Tally,
) -> Any:
    """The constants (segments, constants) that a fit kernel writes, made of numbers that count."""
    segments, report = np.full(shape, 0.0, object), np.full(4, 0.0, object)
    q, spacings, options = (numbers(array, tally) for array in (track, h, parameters))
    Copies(tally).of(kernel.python)(q, spacings, closed, sign, options, segments, report)
    return segments


def of_a_sample(kernel: Kernel, constants: FloatArray, u: float, rate: float) -> Tally:
    """What a sample kernel executes for TOGETHER samples at u of a segment with these constants."""
    tally = Tally()
    Copies(tally).of(kernel.python)(sheet_of(constants, u, rate, tally), TOGETHER)
    return tally


def sheet_of(constants: FloatArray, u: float, rate: float, tally: Tally) -> Any:
    """A sheet of numbers that count, all of its TOGETHER samples the same."""
    sheet = np.full((ROWS, BLOCK), 0.0, object)
    given = [0, 1, *range(CONSTANTS, CONSTANTS + len(constants))]
    for j in range(TOGETHER):
        sheet[given, j] = numbers([u, rate, *constants], tally)
    return sheet
