"""Keyframes as arrays in an NPZ file; what it declares is checked before anything is unpacked."""

from __future__ import annotations

import math
import warnings
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from quatspline.inputs.stamps import stamps
from quatspline.motion.errors import MotionFileError
from quatspline.motion.files import checks
from quatspline.motion.files.checks import Faults
from quatspline.motion.files.columns import CSV_COLUMNS, POSITION_COLUMNS
from quatspline.motion.files.reading import Reading
from quatspline.motion.motion import Motion, Times
from quatspline.motion.skeleton import Mounts, Skeleton
from quatspline.options import nearest
from quatspline.quaternion import FloatArray

REQUIRED = ("times", "quaternions")
OF_SKELETON = ("parents", "offsets", "orders", "end_joints", "ends")
MOUNTS = ("mount_turns", "mount_places")
TANGENTS = ("in_tangents", "out_tangents")
MORE = (
    *("positions", "tracks", "unit", "per_second", "interpolation"),
    *(*OF_SKELETON, *MOUNTS, *TANGENTS),
)
"""What `write_npz` writes, besides."""

TEXTS = ("tracks", "unit", "orders", "interpolation")

LARGEST = 10**8
"""More numbers than this in an array (0.8 GB of float64, a week at 40 Hz) are no keyframes."""

HEADER = 2**16
"""Bytes that the header of an array may take; numpy itself reads no longer ones."""

Array = NDArray[Any]


def read_npz(path: Path, reading: Reading) -> Motion:
    """Read arrays ``times`` (n,) or, closed, (n + 1,), ``quaternions`` (n, 4) or (n, J, 4) and more."""
    arrays, unread = _arrays(path)
    given = {name: arrays[name] for name in (*REQUIRED, "positions") if name in arrays}
    _check_shapes(path, **given)
    if not len(arrays["quaternions"]):
        raise MotionFileError(f"{path}: no keyframes in it")
    t = _times(path, arrays["times"])
    q, x = (_by_track(arrays.get(name)) for name in ("quaternions", "positions"))
    assert q is not None
    t, q, x = _checked(path, reading, t, q, x)
    try:
        return Motion(t, q, x, unread=unread, **_more(arrays, q.shape[1]))
    except (ValueError, IndexError) as error:
        raise MotionFileError(f"{path}: {error}") from None


def _by_track(array: Array | None) -> FloatArray | None:
    """Numbers (n, J, 3 or 4), of one track where they are (n, 3 or 4)."""
    if array is None:
        return None
    values = array.astype(float)
    return values[:, np.newaxis] if values.ndim == 2 else values


def _checked(
    path: Path, reading: Reading, t: Times, q: FloatArray, x: FloatArray | None
) -> tuple[Times, FloatArray, FloatArray | None]:
    # A closed motion has one time more: the last keyframe stands in for the one that returns.
    closed = len(t) > len(q)
    padded = np.concatenate([q, q[-1:]]) if closed else q
    table = np.column_stack([t, *(a.reshape(len(t), -1) for a in (padded, x) if a is not None)])
    faults = Faults(path, lambda row: f"row {row}")
    good = checks.check_numbers(faults, _names(q, x), table, {}, reading.missing)
    rows = np.flatnonzero(good)
    turns = rows[rows < len(q)]
    for k in range(q.shape[1]):
        checks.check_norms(faults, turns, q[turns, k])
    first = checks.distinct(reading.duplicates, t[good])
    checks.check_times(faults, rows[first], t[good][first])
    faults.refuse()
    if closed and not (good.all() and len(first) == len(t)):
        raise MotionFileError(f"{path}: rows of a closed motion cannot be left out")
    if closed:
        return t, q, x
    how = reading.duplicates
    x = None if x is None else checks.combined(how, x[good], first)
    return t[good][first], checks.combined(how, q[good], first), x


def _names(q: FloatArray, x: FloatArray | None) -> tuple[str, ...]:
    """What numbers of a row are called: with the index of the track where there are several."""
    tracks = [""] if q.shape[1] == 1 else [f" of track {k}" for k in range(q.shape[1])]
    named = [f"{part}{track}" for track in tracks for part in CSV_COLUMNS[1:]]
    placed = [f"{part}{track}" for track in tracks for part in POSITION_COLUMNS]
    return ("t", *named, *(placed if x is not None else ()))


def _more(arrays: dict[str, Array], tracks: int) -> dict[str, Any]:
    """Names of tracks, units and the skeleton."""
    found: dict[str, Any] = {}
    for name, array in arrays.items():
        kinds = "U" if name in TEXTS else "iuf"
        if array.dtype.kind not in kinds and array.size:
            raise ValueError(
                f"{name} ({array.dtype}): {'text' if kinds == 'U' else 'numbers'} expected"
            )
    if "tracks" in arrays:
        found["tracks"] = arrays["tracks"].tolist()
    elif tracks > 1:
        found["tracks"] = [f"track {k}" for k in range(tracks)]
    if "unit" in arrays:
        found["unit"] = str(arrays["unit"])
    if "per_second" in arrays:
        found["per_second"] = int(arrays["per_second"])
    if "interpolation" in arrays:
        found["interpolation"] = str(arrays["interpolation"])
    for name in TANGENTS:
        if name in arrays:
            found[name] = arrays[name].astype(float)
    if all(name in arrays for name in OF_SKELETON):
        found["skeleton"] = _skeleton(arrays, tracks)
        if all(name in arrays for name in MOUNTS):
            mounts = Mounts(*(arrays[name].astype(float) for name in MOUNTS))
            if (mounts.turns.shape, mounts.places.shape) != ((tracks, 4), (tracks, 3)):
                raise ValueError("mount_turns and mount_places do not belong to the tracks")
            found["skeleton"] = replace(found["skeleton"], mounts=mounts)
    return found


def _skeleton(arrays: dict[str, Array], tracks: int) -> Skeleton:
    parents, offsets, orders, joints, ends = (arrays[name] for name in OF_SKELETON)
    if parents.shape != (tracks,):
        raise ValueError(f"parents has shape {parents.shape}: expected {(tracks,)}")
    if ends.shape != (len(joints), 3) or not set(joints.tolist()) <= set(range(tracks)):
        raise ValueError("end_joints and ends do not belong to the tracks")
    tips = dict(zip(map(int, joints), ends.astype(float), strict=True))
    return Skeleton(parents.astype(np.int64), offsets.astype(float), tuple(orders.tolist()), tips)


def _times(path: Path, t: Array) -> Times:
    if t.dtype.kind == "f":
        return t.astype(float)
    try:
        return stamps("times", t)
    except ValueError as error:
        raise MotionFileError(f"{path}: {error}") from None


def _check_shapes(
    path: Path, times: Array, quaternions: Array, positions: Array | None = None
) -> None:
    t, q, x = times, quaternions, positions
    given = {"times": t, "quaternions": q} | ({} if x is None else {"positions": x})
    if any(array.dtype.kind not in "iuf" for array in given.values()):
        kinds = ", ".join(f"{name} ({array.dtype})" for name, array in given.items())
        raise MotionFileError(f"{path}: {kinds}: not numbers")
    shapes = ", ".join(f"{name} {array.shape}" for name, array in given.items())
    tracks = q.shape[1:-1]
    if q.ndim not in (2, 3) or q.shape[-1] != 4 or 0 in tracks or t.ndim != 1:
        raise MotionFileError(f"{path}: {shapes}: expected (n,) and (n, 4)")
    if len(t) - len(q) not in (0, 1):
        raise MotionFileError(f"{path}: {shapes}: expected (n,) and (n, 4)")
    if x is not None and x.shape != (len(t), *tracks, 3):
        wanted = ", ".join(map(str, (len(t), *tracks, 3)))
        raise MotionFileError(f"{path}: {shapes}: expected positions ({wanted})")


# -- unpacking ------------------------------------------------------------------------------------


def _arrays(path: Path) -> tuple[dict[str, Array], tuple[str, ...]]:
    """The arrays that count, and the names of the others."""
    with path.open("rb") as stream:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # a damaged header warns before it fails
                return _unpacked(path, zipfile.ZipFile(stream))
        except MotionFileError:
            raise
        except MemoryError:
            raise MotionFileError(f"{path}: its arrays do not fit into memory") from None
        except OSError as error:
            if error.errno is not None:
                raise
            raise _foreign(path, error) from None  # bz2 tells damaged data so
        except Exception as error:  # whatever bytes can do to a zip file and its codecs
            raise _foreign(path, error) from None


def _foreign(path: Path, error: Exception) -> MotionFileError:
    if isinstance(error, NotImplementedError):
        why = ": its compression is not known here"
    elif isinstance(error, RuntimeError) and not isinstance(error, RecursionError):
        why = ": it is encrypted, or its compression is not known here"
    else:
        why = ""
    return MotionFileError(f"{path}: not an NPZ file of plain arrays{why}")


def _unpacked(path: Path, file: zipfile.ZipFile) -> tuple[dict[str, Array], tuple[str, ...]]:
    members = {info.filename.removesuffix(".npy"): info for info in file.infolist()}
    missing = [name for name in REQUIRED if name not in members]
    if missing:
        hint = nearest(missing[0], members)
        raise MotionFileError(f"{path}: no array {missing[0]!r}: {hint}")
    wanted = [name for name in (*REQUIRED, *MORE) if name in members]
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
            raise MotionFileError(f"{path}: {what}: more than {LARGEST:,} numbers are not read")
        if stream.tell() + math.prod(shape) * dtype.itemsize > info.file_size:
            raise ValueError("less in it than declared")
    with file.open(info) as stream:
        return npy.read_array(stream, allow_pickle=False)
