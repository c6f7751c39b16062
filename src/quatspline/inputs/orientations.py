"""Orientations as people hold them, as one float64 array of quaternions (n, ..., 4), scalar first."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from quatspline.inputs.arrays import (
    FloatArray,
    at,
    float_array,
    refuse_infinite,
    refuse_masked,
)

COMPONENTS = ("w", "x", "y", "z")
IMAGINARY = {"r": "w", "i": "x", "j": "y", "k": "z"}
NAMED = re.compile(
    r"(?:.*[\W_])?(?:q|quat|quaternion)?([wxyzrijk])(?:[\W_]+(?:q|quat|quaternion))?"
)
"""Names of columns that say their component: w, qw, quat_w, pose.orientation.w, q_i, x_q."""

NEARLY = 1e-3
"""Lengths and products of a matrix's rows this near 1 and 0 are those of a rotation."""


def orientations(given: Any, least: int) -> FloatArray:
    """Quaternions (n, ..., 4) of what a user gives, not yet checked for length.

    Parameters
    ----------
    given
        An array or lists of numbers, scalar first; a scipy ``Rotation`` or a list of them; an array
        or a list of numpy-quaternion's quaternions; a table of pandas, whose columns are put in
        order where their names tell it (``qx``, ``qy``, ``qz``, ``qw``).
    least
        Fewer keyframes are refused.

    Raises
    ------
    ValueError
        What is no such thing, by what it is.
    """
    q = float_array("quaternions", _numbers(given))
    if q.ndim < 2 or q.shape[-1] != 4:
        refuse_infinite("quaternions", q)
        raise ValueError(f"quaternions has shape {q.shape}: {_expected(q)}")
    if q.shape[0] < least:
        count = f"{q.shape[0]} keyframe{'' if q.shape[0] == 1 else 's'}"
        raise ValueError(f"quaternions has {count}: at least {least} are needed")
    if q.size == 0:
        raise ValueError(f"quaternions has shape {q.shape}: no track in it")
    if _homogeneous(q):
        raise ValueError(
            f"quaternions has shape {q.shape} and holds homogeneous matrices, not quaternions: "
            "give scipy's Rotation.from_matrix(m[..., :3, :3])"
        )
    return q


def directions(q: FloatArray) -> FloatArray:
    """q / |q| of any length; those that have none, 0 or not finite, stay for `explain_norms`."""
    largest = np.abs(q).max(axis=-1, keepdims=True)
    good = (largest > 0.0) & np.isfinite(largest)
    scaled = q / np.where(
        good, largest, 1.0
    )  # squares of very small or large numbers leave float64
    lengths = np.linalg.norm(np.where(good, scaled, 1.0), axis=-1, keepdims=True)
    return np.where(good, scaled / lengths, q)


def explain_norms(q: FloatArray, tolerance: float) -> None:
    """Refuse quaternions of which one is not finite or not of unit length."""
    refuse_infinite("quaternions", q)
    with np.errstate(over="ignore", under="ignore"):
        norms = np.linalg.norm(q, axis=-1)
    off = tuple(np.argwhere(~(np.abs(norms - 1.0) <= tolerance))[0])
    hint = "; normalise=True divides by it" if norms[off] > 0.0 else ""
    raise ValueError(
        f"{at('quaternions', off)} = {q[off].tolist()} has norm {norms[off]:.6g}: "
        f"not a unit quaternion (off by more than {tolerance:g}{hint})"
    )


def _numbers(given: Any) -> Any:
    """Rotations, quaternions of other packages and named columns as plain numbers."""
    if type(given) is np.ndarray and given.dtype == np.float64:
        return given
    refuse_masked("quaternions", given)
    if hasattr(given, "as_quat"):
        return given.as_quat(scalar_first=True)
    if isinstance(given, list | tuple) and given and hasattr(given[0], "as_quat"):
        return _listed(given)
    if hasattr(given, "columns"):
        return _ordered(given)
    try:
        array = np.asarray(given)
    except ValueError:
        return given
    if array.dtype.name == "quaternion":  # of numpy-quaternion: four float64, scalar first
        return np.ascontiguousarray(array).view(np.float64).reshape(*array.shape, 4)
    return array


def _listed(given: Any) -> list[Any]:
    """The quaternions of a list of Rotations, one per keyframe (or one per track)."""
    for i, item in enumerate(given):
        if not hasattr(item, "as_quat"):
            raise ValueError(f"quaternions[{i}] = {item!r}: not a Rotation like quaternions[0]")
    return [item.as_quat(scalar_first=True) for item in given]


def _ordered(table: Any) -> Any:
    """A table's numbers, scalar first by the names of its columns; numbered columns as they stand."""
    names = [name[-1] if isinstance(name, tuple) else name for name in table.columns]
    numbers = table.to_numpy(dtype=np.float64, na_value=np.nan)
    if not any(isinstance(name, str) for name in names):
        return numbers
    letters = [_letter(str(name)) for name in names]
    if sorted(letters) != sorted(COMPONENTS):
        quoted = ", ".join(map(repr, names))
        raise ValueError(
            f"quaternions: columns {quoted} do not say which is w, x, y and z; name them so, or give "
            "an array, scalar first"
        )
    return numbers[:, [letters.index(name) for name in COMPONENTS]]


def _letter(name: str) -> str:
    """w, x, y or z of a column's name; "" where it does not say."""
    found = NAMED.fullmatch(name.strip().lower())
    return IMAGINARY.get(found[1], found[1]) if found else ""


def _expected(q: FloatArray) -> str:
    if q.shape[-2:] == (3, 3):
        return "matrices go through scipy's Rotation.from_matrix"
    return "expected (n, 4) or (n, ..., 4)"


def _homogeneous(q: FloatArray) -> bool:
    """Whether (..., 4, 4) holds rigid motions as matrices, whose rows are no four quaternions.

    The last row is (0, 0, 0, 1), and some row is not of unit length or the rotations are orthogonal.
    """
    if q.ndim < 3 or q.shape[-2:] != (4, 4) or not (q[..., 3, :] == (0.0, 0.0, 0.0, 1.0)).all():
        return False
    with np.errstate(all="ignore"):
        norms = np.linalg.norm(q, axis=-1)
        turn = q[..., :3, :3]
        grams = turn @ np.swapaxes(turn, -1, -2)
    unit = np.abs(norms - 1.0) <= NEARLY
    return not unit.all() or bool((np.abs(grams - np.eye(3)) <= NEARLY).all())
