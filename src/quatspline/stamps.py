"""Times as people hold them: numbers, integer stamps, datetimes.  Differences come before rounding.

At today's epoch float64 tells nanoseconds apart by 256 only: whoever rounds a stamp before the first
is subtracted moves every keyframe.  Stamps therefore stay as given until they are times since the
first one, which float64 holds.  Datetimes count in seconds.
"""

from __future__ import annotations

import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quatspline.inputs import FloatArray, at, float_array, real_array

EXACT = 2**53
"""Integers up to this are float64 numbers, all of them."""

FAR = 2.0**62
"""Differences beyond this may leave int64."""

SECOND = np.timedelta64(1, "s")

KINDS = "iufmM"


def stamps(name: str, given: Any) -> NDArray[Any]:
    """Times (any shape) as an array that loses nothing of them.

    float64 for numbers that it holds exactly; int64 for larger integers; longdouble, datetime64 and
    timedelta64 as given.

    Raises
    ------
    ValueError
        What is no time, a datetime that is none (NaT), integers beyond int64.
    """
    array = real_array(name, _datetimes(given), KINDS)
    if array.dtype.kind in "mM":
        return _counted(name, array)
    if array.dtype.kind in "iu":
        return _integers(name, array)
    return array if array.dtype.itemsize > 8 else float_array(name, array)


def elapsed(t: NDArray[Any], start: Any) -> FloatArray:
    """t - start in time units (seconds, of datetimes), rounded once; ``start`` a scalar of `stamps`.

    Raises
    ------
    ValueError
        Numbers and datetimes do not mix.
    """
    kinds = {np.asarray(start).dtype.kind, t.dtype.kind}
    if kinds & set("mM"):
        if len(kinds) > 1:
            raise ValueError(
                f"t has dtype {t.dtype}, the keyframes' times {start.dtype}: give one kind"
            )
        return np.asarray((t - start) / SECOND, dtype=np.float64)
    if kinds == {"i"}:
        rough = t.astype(np.float64) - float(start)
        return np.where(np.abs(rough) < FAR, (t - start).astype(np.float64), rough)
    if np.asarray(start).dtype.kind == "i":
        high = float(start)
        return np.asarray((t - high) - float(int(start) - int(high)), dtype=np.float64)
    return np.asarray(t - start, dtype=np.float64)


def resolution(start: Any, end: Any, kind: np.dtype[Any]) -> float:
    """An ulp of the larger end, in time units, of samples with this dtype; 0 of exact ones."""
    if kind.kind != "f" or np.asarray(start).dtype.kind in "mM":
        return 0.0
    largest = max(abs(float(start)), abs(float(end)))
    coarse = kind.type if kind.itemsize < 8 else np.float64
    return float(np.spacing(coarse(largest)))


def _datetimes(given: Any) -> Any:
    """Python's (and so pandas') datetimes and timedeltas as numpy's, in UTC where they have a zone."""
    try:
        array = np.asanyarray(given)
    except ValueError:
        return given
    first = array.flat[0] if array.dtype == object and array.size else None
    if isinstance(first, datetime.timedelta):
        return array.astype("timedelta64[ns]")
    if isinstance(first, datetime.datetime):
        return np.array([_zoneless(x) for x in array.flat], "datetime64[ns]").reshape(array.shape)
    return array


def _zoneless(moment: Any) -> Any:
    """A datetime in UTC without its zone; pandas' have digits that Python's lack."""
    if moment.tzinfo is not None:
        moment = moment.astimezone(datetime.UTC).replace(tzinfo=None)
    return moment.to_datetime64() if hasattr(moment, "to_datetime64") else moment


def _counted(name: str, array: NDArray[Any]) -> NDArray[Any]:
    """Datetimes or timedeltas of a unit that has a length, none of them missing."""
    if np.datetime_data(array.dtype)[0] in ("Y", "M", "generic"):
        raise ValueError(f"{name}: {array.dtype} has no fixed length in seconds")
    if np.isnat(array).any():
        raise ValueError(f"{at(name, np.argwhere(np.isnat(array))[0])} is not a time (NaT)")
    return array


def _integers(name: str, array: NDArray[Any]) -> NDArray[Any]:
    if array.size == 0 or (array.max() <= EXACT and array.min() >= -EXACT):
        return array.astype(np.float64)
    if array.max() > np.iinfo(np.int64).max:
        where = np.argwhere(array > np.iinfo(np.int64).max)[0]
        raise ValueError(f"{at(name, where)} = {array[tuple(where)]}: beyond the range of int64")
    return array.astype(np.int64)
