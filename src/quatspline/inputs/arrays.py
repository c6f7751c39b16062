"""What users hand over as numbers, taken as arrays or refused in one sentence that names the place."""

from __future__ import annotations

import operator
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

NUMBERS = "iuf"
"""Kinds of numpy's dtypes that are real numbers."""


def real_array(name: str, given: Any, kinds: str = NUMBERS) -> NDArray[Any]:
    """An ndarray of one of the kinds, as given; lists, pandas columns and the like are taken, too.

    Raises
    ------
    ValueError
        Rows of unequal length, masked entries, complex numbers, and what is no number.
    """
    if type(given) is np.ndarray and given.dtype.kind in kinds:
        return given
    refuse_masked(name, given)
    try:
        array = np.asarray(given)
    except ValueError:
        raise ValueError(f"{name}: rows of unequal length, or not numbers") from None
    if array.dtype.kind not in kinds:
        kind = "complex" if array.dtype.kind == "c" else "not real numbers"
        raise ValueError(f"{name}: {kind} (dtype {array.dtype})")
    return array


def float_array(name: str, given: Any) -> FloatArray:
    """The same as C-contiguous, aligned, writeable float64: one compiled signature serves all."""
    array = real_array(name, given)
    if array.dtype != np.float64 or not array.flags.c_contiguous:
        with np.errstate(over="ignore"):  # a longdouble that float64 does not hold is infinite
            array = array.astype(np.float64, order="C")
    return array if array.flags.carray else array.copy()


def refuse_masked(name: str, given: Any) -> None:
    """Refuse masked entries, of arrays and inside lists: what is masked was not measured."""
    place = _masked_place(given)
    if place is not None:
        raise ValueError(f"{at(name, place)} is masked: drop or fill it first")


def _masked_place(given: Any) -> tuple[int, ...] | None:
    """The index of the first masked entry."""
    if isinstance(given, list | tuple):
        places = ((i, _masked_place(item)) for i, item in enumerate(given))
        return next(((i, *place) for i, place in places if place is not None), None)
    if not isinstance(given, np.ma.MaskedArray):
        return None
    masked = np.argwhere(np.ma.getmaskarray(given))
    return tuple(int(i) for i in masked[0]) if len(masked) else None


def refuse_infinite(name: str, array: FloatArray) -> None:
    """Refuse NaN and infinity, naming the first."""
    if not np.isfinite(array).all():
        first = np.argwhere(~np.isfinite(array))[0]
        raise ValueError(f"{at(name, first)} = {array[tuple(first)]}: not a finite number")


def at(name: str, index: Any) -> str:
    """``name[i, j]``, or the name alone of a scalar."""
    places = ", ".join(str(int(i)) for i in np.atleast_1d(index))
    return f"{name}[{places}]" if places else name


def switch(name: str, value: Any) -> bool:
    """True, False, a numpy bool, 0 or 1 as a bool; anything else is refused."""
    if isinstance(value, bool | np.bool_):
        return bool(value)
    if isinstance(value, int | np.integer) and value in (0, 1):
        return bool(value)
    raise ValueError(f"{name}={value!r}: expected True or False")


def check_out(out: Any, shape: tuple[int, ...]) -> None:
    """Refuse what cannot be filled as it is: subclasses of ndarray index in ways of their own."""
    if type(out) is not np.ndarray or out.dtype != np.float64 or out.shape != shape:
        kind = type(out)
        found = (
            f"{out.dtype} {out.shape}"
            if kind is np.ndarray
            else f"{kind.__module__}.{kind.__name__}"
        )
        raise ValueError(f"out: expected a float64 array of shape {shape}, got {found}")
    if not out.flags.writeable:
        raise ValueError("out: the array is read-only")
    if not out.flags.c_contiguous and _overlaps_itself(out):
        raise ValueError(f"out: its elements share memory (strides {out.strides})")


def _overlaps_itself(array: FloatArray) -> bool:
    """Whether strides are too short for what lies within them."""
    within = array.itemsize
    for stride, size in sorted(
        (abs(k), n) for k, n in zip(array.strides, array.shape, strict=True)
    ):
        if size > 1 and stride < within:
            return True
        within += stride * (size - 1)
    return False


def checked_threads(threads: Any) -> int:
    """A number of threads."""
    try:
        count = operator.index(threads)
    except TypeError:
        raise ValueError(f"threads={threads!r}: expected a whole number, at least 1") from None
    if count < 1:
        raise ValueError(f"threads={count}: expected at least 1")
    return count
