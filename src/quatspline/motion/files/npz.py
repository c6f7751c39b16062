"""Keyframes as arrays in an NPZ file; what it declares is checked before anything is unpacked."""

from __future__ import annotations

import math
import warnings
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from quatspline.inputs.stamps import stamps
from quatspline.motion.files import checks
from quatspline.motion.files.checks import Faults
from quatspline.motion.files.columns import CSV_COLUMNS, POSITION_COLUMNS
from quatspline.motion.files.motion import KeyframeFileError, Motion, Times
from quatspline.options import nearest
from quatspline.quaternion import FloatArray

REQUIRED = ("times", "quaternions")

LARGEST = 10**8
"""More numbers than this in an array (0.8 GB of float64, a week at 40 Hz) are no keyframes."""

HEADER = 2**16
"""Bytes that the header of an array may take; numpy itself reads no longer ones."""

Array = NDArray[Any]


def read_npz(path: Path) -> Motion:
    """Read arrays ``times`` (n,) or, closed, (n + 1,), ``quaternions`` (n, 4) and ``positions``."""
    arrays, unread = _arrays(path)
    t, q, x = (arrays.get(name) for name in (*REQUIRED, "positions"))
    assert t is not None
    assert q is not None
    _check_shapes(path, t, q, x)
    if not len(q):
        raise KeyframeFileError(f"{path}: no keyframes in it")
    times = _times(path, t)
    return _checked(path, times, q.astype(float), None if x is None else x.astype(float), unread)


def _checked(
    path: Path, t: Times, q: FloatArray, x: FloatArray | None, unread: tuple[str, ...]
) -> Motion:
    # A closed motion has one time more: the last keyframe stands in for the one that returns.
    padded = np.concatenate([q, q[-1:]]) if len(t) > len(q) else q
    table = np.column_stack([t.astype(float), padded, *([] if x is None else [x])])
    faults = Faults(path, lambda row: f"row {row}")
    good = checks.check_numbers(faults, (*CSV_COLUMNS, *POSITION_COLUMNS), table, {})
    rows = np.flatnonzero(good)
    checks.check_norms(faults, rows[rows < len(q)], q[rows[rows < len(q)]])
    checks.check_times(faults, rows, t[good])
    faults.refuse()
    return Motion(t, q, x, unread)


def _times(path: Path, t: Array) -> Times:
    if t.dtype.kind == "f":
        return t.astype(float)
    try:
        return stamps("times", t)
    except ValueError as error:
        raise KeyframeFileError(f"{path}: {error}") from None


def _check_shapes(path: Path, t: Array, q: Array, x: Array | None) -> None:
    given = {"times": t, "quaternions": q} | ({} if x is None else {"positions": x})
    if any(array.dtype.kind not in "iuf" for array in given.values()):
        kinds = ", ".join(f"{name} ({array.dtype})" for name, array in given.items())
        raise KeyframeFileError(f"{path}: {kinds}: not numbers")
    shapes = ", ".join(f"{name} {array.shape}" for name, array in given.items())
    if q.shape[1:] != (4,) or t.ndim != 1 or len(t) - len(q) not in (0, 1):
        raise KeyframeFileError(f"{path}: {shapes}: expected (n,) and (n, 4)")
    if x is not None and x.shape != (len(t), 3):
        raise KeyframeFileError(f"{path}: {shapes}: expected positions ({len(t)}, 3)")


# -- unpacking ------------------------------------------------------------------------------------


def _arrays(path: Path) -> tuple[dict[str, Array], tuple[str, ...]]:
    """The arrays that count, and the names of the others."""
    with path.open("rb") as stream:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # a damaged header warns before it fails
                return _unpacked(path, zipfile.ZipFile(stream))
        except KeyframeFileError:
            raise
        except MemoryError:
            raise KeyframeFileError(f"{path}: its arrays do not fit into memory") from None
        except OSError as error:
            if error.errno is not None:
                raise
            raise _foreign(path, error) from None  # bz2 tells damaged data so
        except Exception as error:  # whatever bytes can do to a zip file and its codecs
            raise _foreign(path, error) from None


def _foreign(path: Path, error: Exception) -> KeyframeFileError:
    if isinstance(error, NotImplementedError):
        why = ": its compression is not known here"
    elif isinstance(error, RuntimeError) and not isinstance(error, RecursionError):
        why = ": it is encrypted, or its compression is not known here"
    else:
        why = ""
    return KeyframeFileError(f"{path}: not an NPZ file of plain arrays{why}")


def _unpacked(path: Path, file: zipfile.ZipFile) -> tuple[dict[str, Array], tuple[str, ...]]:
    members = {info.filename.removesuffix(".npy"): info for info in file.infolist()}
    missing = [name for name in REQUIRED if name not in members]
    if missing:
        hint = nearest(missing[0], members)
        raise KeyframeFileError(f"{path}: no array {missing[0]!r}: {hint}")
    wanted = [name for name in (*REQUIRED, "positions") if name in members]
    unread = tuple(name for name in members if name not in wanted)
    return {name: _array(path, file, name, members[name]) for name in wanted}, unread


def _array(path: Path, file: zipfile.ZipFile, name: str, info: zipfile.ZipInfo) -> Array:
    with file.open(info) as stream:
        version = npy.read_magic(stream)
        read_header = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, _, dtype = read_header(stream)
        if min(shape, default=0) < 0:
            raise ValueError("a negative length")
        if math.prod(shape) > LARGEST or info.file_size > LARGEST * 16 + HEADER:
            size = "×".join(map(str, shape))
            what = f"{name} declares {size} numbers, {info.file_size:,} bytes"
            raise KeyframeFileError(f"{path}: {what}: more than {LARGEST:,} numbers are not read")
        if stream.tell() + math.prod(shape) * dtype.itemsize > info.file_size:
            raise ValueError("less in it than declared")
    with file.open(info) as stream:
        return npy.read_array(stream, allow_pickle=False)
