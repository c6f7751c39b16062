"""Times as people hold them: numbers, integer stamps, datetimes.  Differences come before rounding.

At today's epoch float64 tells nanoseconds apart by 256 only: whoever rounds a stamp before the first
is subtracted moves every keyframe.  Stamps therefore stay as given until they are times since the
first one, which float64 holds.  Datetimes count in seconds.
"""

from __future__ import annotations

import datetime
import math
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quatspline.inputs.arrays import FloatArray, at, real_array, refuse_masked

EXACT = 2**53
"""Integers up to this are float64 numbers, all of them."""

FAR = 2.0**62
"""Differences beyond this may leave int64."""

KINDS = "iufmM"

UNITS = {
    unit: Fraction(seconds)
    for unit, seconds in {
        "W": "604800", "D": "86400", "h": "3600", "m": "60", "s": "1", "ms": "1e-3", "us": "1e-6",
        "ns": "1e-9", "ps": "1e-12", "fs": "1e-15", "as": "1e-18",
    }.items()
}  # fmt: skip
"""Seconds in the units of numpy's datetimes that have a length."""


def stamps(name: str, given: Any) -> NDArray[Any]:
    """Times (any shape) as an array that loses nothing of them.

    Floating-point numbers as given; integers as float64 where that holds them all, otherwise as int64;
    datetime64 and timedelta64 as given, and Python's and pandas' as these, in UTC where they have a zone.

    Raises
    ------
    ValueError
        What is no time, a datetime that is none (NaT), integers beyond int64.
    """
    if type(given) is np.ndarray and given.dtype == np.float64:
        return given
    array = real_array(name, _of_objects(name, given), KINDS)
    if array.dtype.kind in "mM":
        return _counted(name, array)
    return _integers(name, array) if array.dtype.kind in "iu" else array


def elapsed(t: NDArray[Any], start: Any) -> FloatArray:
    """t - start in time units (seconds, of datetimes), rounded once; ``start`` a scalar of `stamps`.

    Raises
    ------
    ValueError
        Numbers and datetimes do not mix, nor do datetimes and timedeltas.
    """
    start = np.asarray(start)
    kinds = {start.dtype.kind, t.dtype.kind}
    if kinds & set("mM"):
        if len(kinds) > 1:
            raise ValueError(f"t: {_called(t)}, but the keyframes' times are {_called(start)}")
        return _between(t, start)
    if kinds == {"i"}:
        return _difference(t, int(start))
    if start.dtype.kind == "i":
        high = float(start)
        return np.asarray((t.astype(np.float64) - high) - float(int(start) - int(high)))
    with np.errstate(over="ignore"):  # what float64 does not hold is infinite, and refused as such
        return np.asarray(t - start).astype(np.float64)


def resolution(start: Any, end: Any, kind: np.dtype[Any]) -> float:
    """An ulp of the larger end, in time units, of samples with this dtype; 0 of exact ones."""
    if kind.kind != "f" or np.asarray(start).dtype.kind in "mM":
        return 0.0
    coarse = kind if kind.itemsize < 8 else np.dtype(np.float64)
    largest = min(max(abs(float(start)), abs(float(end))), float(np.finfo(coarse).max) / 2)
    return float(np.spacing(coarse.type(largest)))


def tick(times: NDArray[Any]) -> float:
    """The step of integer stamps and datetimes, in time units; 0 of numbers."""
    if times.dtype.kind in "mM":
        return float(_seconds(times.dtype))
    return 1.0 if times.dtype.kind == "i" else 0.0


# -- differences ----------------------------------------------------------------------------------


def _difference(t: NDArray[Any], start: int) -> FloatArray:
    """Integers t - start as float64; beyond int64 rounded before, where no digit is at stake."""
    rough = t.astype(np.float64) - float(start)
    return np.where(np.abs(rough) < FAR, (t - np.int64(start)).astype(np.float64), rough)


def _between(t: NDArray[Any], start: NDArray[Any]) -> FloatArray:
    """Seconds from one datetime to others, of any units."""
    own, other = _seconds(t.dtype), _seconds(start.dtype)
    first = int(start.astype(np.int64))
    if own == other:
        return _scaled(_difference(t.astype(np.int64), first), own)
    fine = min(own, other)
    counts = t.astype(np.int64).astype(object) * int(own / fine) - first * int(other / fine)
    return _scaled(np.asarray(counts).astype(np.float64), fine)


def _scaled(counts: FloatArray, unit: Fraction) -> FloatArray:
    """Counts of a unit as seconds, by one division or product of whole numbers."""
    return np.asarray(counts * float(unit.numerator) / float(unit.denominator))


def _seconds(kind: np.dtype[Any]) -> Fraction:
    unit, count = np.datetime_data(kind)
    return UNITS[unit] * count


# -- what they are --------------------------------------------------------------------------------


def _called(times: NDArray[Any]) -> str:
    return {"M": "datetimes", "m": "timedeltas"}.get(times.dtype.kind, "numbers")


def _of_objects(name: str, given: Any) -> Any:
    """Python's and pandas' datetimes and timedeltas as numpy's; anything else as it is."""
    refuse_masked(name, given)
    try:
        array = np.asarray(given)
    except ValueError:
        return given
    if array.dtype != object or not array.size:
        return given
    first = _numpy_time(array.flat[0])
    if first is None:
        return given
    moments = []
    for index, item in np.ndenumerate(array):
        moment = _numpy_time(item)
        if moment is None or moment.dtype.kind != first.dtype.kind:
            raise ValueError(f"{at(name, index)} = {item!r}: not a time like {array.flat[0]!r}")
        moments.append(moment)
    return np.array(moments).reshape(array.shape)


def _numpy_time(item: Any) -> Any:
    """A datetime or timedelta of numpy; None for anything else.  pandas' have digits that Python's lack."""
    if isinstance(item, np.datetime64 | np.timedelta64):
        return item
    if isinstance(item, datetime.timedelta):
        exact = getattr(item, "to_timedelta64", None)
        return exact() if exact else np.timedelta64(item, "us")
    if not isinstance(item, datetime.datetime):
        return None
    if item.tzinfo is not None:
        item = item.astimezone(datetime.UTC).replace(tzinfo=None)
    exact = getattr(item, "to_datetime64", None)
    return exact() if exact else np.datetime64(item, "us")


def _counted(name: str, array: NDArray[Any]) -> NDArray[Any]:
    """Datetimes or timedeltas of a unit that has a length, none of them missing."""
    if np.isnat(array).any():
        raise ValueError(f"{at(name, np.argwhere(np.isnat(array))[0])} is not a time (NaT)")
    if np.datetime_data(array.dtype)[0] not in UNITS:
        raise ValueError(f"{name}: {array.dtype} has no fixed length in seconds")
    return array


def _integers(name: str, array: NDArray[Any]) -> NDArray[Any]:
    if array.size == 0 or (array.max() <= EXACT and array.min() >= -EXACT):
        return array.astype(np.float64)
    if array.max() > np.iinfo(np.int64).max:
        where = np.argwhere(array > np.iinfo(np.int64).max)[0]
        raise ValueError(f"{at(name, where)} = {array[tuple(where)]}: beyond the range of int64")
    return array.astype(np.int64)


def shown(stamp: Any) -> str:
    """A time as Python writes it."""
    if np.asarray(stamp).dtype.kind in "mM":
        return str(stamp)
    value = stamp.item() if hasattr(stamp, "item") else stamp
    return repr(value if isinstance(value, int) else float(value))


def finite(stamp: Any) -> bool:
    """Whether a time is a number that float64 holds, or a datetime."""
    return np.asarray(stamp).dtype.kind in "mM" or math.isfinite(float(stamp))
