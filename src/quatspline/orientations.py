"""Orientations as people hold them, as one float64 array of quaternions (n, ..., 4), scalar first."""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline.inputs import FloatArray, at, float_array, refuse_infinite

COMPONENTS = ("w", "x", "y", "z")


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
        raise ValueError(f"quaternions has {q.shape[0]} keyframes: at least {least} are needed")
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
    if hasattr(given, "as_quat"):
        return given.as_quat(scalar_first=True)
    if isinstance(given, list | tuple) and given and hasattr(given[0], "as_quat"):
        return _listed(given)
    if hasattr(given, "columns"):
        return _ordered(given)
    try:
        array = np.asanyarray(given)
    except ValueError:
        return given
    if array.dtype.name == "quaternion":  # of numpy-quaternion: four float64, scalar first
        return np.ascontiguousarray(array).view(np.float64).reshape(*array.shape, 4)
    return array


def _listed(given: Any) -> list[Any]:
    """The quaternions of a list of Rotations, one a keyframe (or one a track)."""
    for i, item in enumerate(given):
        if not hasattr(item, "as_quat"):
            raise ValueError(f"quaternions[{i}] is no Rotation, as quaternions[0] is: {item!r}")
    return [item.as_quat(scalar_first=True) for item in given]


def _ordered(table: Any) -> Any:
    """A table's columns, scalar first where their names end in w, x, y and z."""
    ends = [str(name).strip().lower()[-1:] for name in table.columns]
    if sorted(ends) == sorted(COMPONENTS):
        return table.iloc[:, [ends.index(name) for name in COMPONENTS]].to_numpy()
    return table.to_numpy()


def _expected(q: FloatArray) -> str:
    if q.shape[-2:] == (3, 3):
        return "matrices go through scipy's Rotation.from_matrix"
    return "expected (n, 4) or (n, ..., 4)"


def _homogeneous(q: FloatArray) -> bool:
    """Whether (..., 4, 4) holds rigid motions as matrices, whose rows are no four quaternions.

    The last row is (0, 0, 0, 1); besides, some row is not of unit length, or without translation all
    are orthogonal to each other.
    """
    if q.ndim < 3 or q.shape[-2:] != (4, 4) or not (q[..., 3, :] == (0.0, 0.0, 0.0, 1.0)).all():
        return False
    with np.errstate(all="ignore"):
        norms = np.linalg.norm(q, axis=-1)
        grams = q @ np.swapaxes(q, -1, -2)
    unit = np.abs(norms - 1.0) <= 1e-3
    return not unit.all() or bool((np.abs(grams - np.eye(4)) <= 1e-6).all())
