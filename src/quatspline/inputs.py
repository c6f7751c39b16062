"""What users hand over as numbers, taken as arrays or refused in one sentence that names the place."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

NUMBERS = "iuf"
"""Kinds of numpy's dtypes that are real numbers."""


def real_array(name: str, given: Any, kinds: str = NUMBERS) -> NDArray[Any]:
    """An ndarray of one of the kinds, as given; lists, pandas columns and the like are taken, too.

    Raises
    ------
    ValueError
        Rows of unequal length, masked entries, complex numbers, and what is no number.
    """
    try:
        array = np.asanyarray(given)
    except ValueError:
        raise ValueError(f"{name}: rows of unequal length, or not numbers") from None
    if isinstance(array, np.ma.MaskedArray):
        array = _unmasked(name, array)
    array = np.asarray(array)
    if array.dtype.kind not in kinds:
        kind = "complex" if array.dtype.kind == "c" else "not real numbers"
        raise ValueError(f"{name}: {kind} (dtype {array.dtype})")
    return array


def float_array(name: str, given: Any) -> FloatArray:
    """The same as C-contiguous, aligned, writeable float64: one compiled signature serves all."""
    array = real_array(name, given).astype(np.float64, order="C", copy=False)
    return array if array.flags.carray else array.copy()


def _unmasked(name: str, array: np.ma.MaskedArray[Any, Any]) -> NDArray[Any]:
    """The data of a masked array that hides nothing: what is masked was not measured."""
    masked = np.ma.getmaskarray(array)
    if masked.dtype.kind == "b" and masked.any():
        raise ValueError(f"{at(name, np.argwhere(masked)[0])} is masked: drop or fill it first")
    return np.asarray(array.data)


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
