"""From component first to sample first: shuffles of whole vectors, stored as whole vectors.

LLVM's own interleaved stores of the same values take twice the time (measured: 1.0 ns per quaternion against 0.5).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from llvmlite import ir
from numba.core import types

from quatspline.engines.compiler import SHEET
from quatspline.engines.intrinsics import intrinsic
from quatspline.kernels.jit import BLOCK, RESULT

TOGETHER = 8
"""Samples that are transposed together; narrower machines take two or four vectors for one of ours."""

Place = tuple[int, int]
"""Component and sample of a number."""

Lanes = tuple[Any, list[Place]]
"""A vector, and what each of its lanes holds."""


@intrinsic(prefer_literal=True)
def put_together(typing: Any, sheet: Any, at: Any, width: Any, out: Any, to: Any) -> Any:
    """Store TOGETHER results of a sheet, from sample ``at`` on, one after the other from place ``to`` of out.

    ``width``, a constant: 4 components, or 3.
    """

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        pointer, first, _, result, place = values
        for k, vector in enumerate(_transposed(builder, pointer, first, width.literal_value)):
            start = builder.add(place, place.type(TOGETHER * k))
            _store(builder, vector, builder.gep(result, [start]))
        return context.get_dummy_value()

    return types.void(SHEET, types.intp, width, SHEET, types.intp), generate


def _transposed(builder: Any, sheet: Any, first: Any, width: int) -> Iterator[Any]:
    """Vectors of TOGETHER results, sample first, in their order."""
    rows = [_row(builder, sheet, first, c) for c in range(width)]
    wanted = [divmod(i, width)[::-1] for i in range(TOGETHER * width)]
    # As many numbers as have at most TOGETHER of two rows: those are picked at once.
    size = TOGETHER * (width - 2)
    for start in range(0, len(wanted), size):
        group = wanted[start : start + size]
        left = _picked(builder, rows[0], rows[1], [place for place in group if place[0] < 2])
        right = rows[2]
        if width > 3:
            right = _picked(builder, rows[2], rows[3], [place for place in group if place[0] > 1])
        for k in range(0, size, TOGETHER):
            yield _picked(builder, left, right, group[k : k + TOGETHER])[0]


def _row(builder: Any, sheet: Any, first: Any, component: int) -> Lanes:
    """A component of the results."""
    start = builder.add(first, first.type(BLOCK * (RESULT + component)))
    vector = ir.VectorType(ir.DoubleType(), TOGETHER).as_pointer()
    pointer = builder.bitcast(builder.gep(sheet, [start]), vector)
    return builder.load(pointer, align=8), [(component, j) for j in range(TOGETHER)]


def _picked(builder: Any, a: Lanes, b: Lanes, places: list[Place]) -> Lanes:
    """What is asked for, of two vectors; lanes that nothing is asked for repeat the first place."""
    (left, held), (right, further) = a, b
    places = places + places[:1] * (TOGETHER - len(places))
    return _shuffled(builder, left, right, [(held + further).index(x) for x in places]), places


def _shuffled(builder: Any, a: Any, b: Any, lanes: list[int]) -> Any:
    number = ir.IntType(32)
    return builder.shuffle_vector(a, b, ir.Constant(ir.VectorType(number, len(lanes)), lanes))


def _store(builder: Any, vector: Any, place: Any) -> None:
    builder.store(vector, builder.bitcast(place, vector.type.as_pointer()), align=8)
