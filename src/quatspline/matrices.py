"""Rotation matrices: to and from quaternions, and the least rotation between two directions.

The formulas are those of Akenine-Moller, Haines & Hoffman, Real-Time Rendering, section 4.3, whose
numbers (4.45) to (4.58) stand beside them [akenine2018].  Matrices (..., 3, 3) turn columns: M x is the
vector x turned.  Public as part of `quatspline.quaternion`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from quatspline.inputs.arrays import FloatArray, at, float_array, refuse_infinite
from quatspline.inputs.orientations import NEARLY
from quatspline.lengths import ANTIPODAL, split


def to_matrix(q: ArrayLike) -> FloatArray:
    """The rotation matrix (..., 3, 3) of quaternions (..., 4) of any length but zero: (4.45).

    Raises
    ------
    ValueError
        What is no quaternion, not finite, or of length zero.
    """
    units, _ = split("q", q, 4)
    w, x, y, z = np.moveaxis(units, -1, 0)
    rows = (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )
    return _stacked(rows)


def from_matrix(matrices: ArrayLike) -> FloatArray:
    """The unit quaternions (..., 4), scalar first, of rotation matrices (..., 3, 3): (4.47) to (4.51).

    The largest component is had from the diagonal, the others from their products with it, so that
    nothing is divided by a small number, half turns included.  Of q and -q it is the one with w >= 0,
    and, of half a turn, the one whose largest component is positive.

    Raises
    ------
    ValueError
        Another shape, numbers that are not finite, rows whose lengths or products are off those of a
        rotation by more than 1e-3, reflections.
    """
    m = float_array("matrices", matrices)
    _refuse_no_rotation(m)
    products = _products(m)
    largest = np.argmax(np.einsum("...ii->...i", products), axis=-1)[..., None, None]
    row = np.take_along_axis(products, largest, axis=-2)[..., 0, :]
    q = row / np.linalg.norm(row, axis=-1, keepdims=True)
    return np.asarray(np.where(q[..., :1] < 0.0, -q, q))


def rotation_matrix_between(s: ArrayLike, t: ArrayLike) -> FloatArray:
    """The matrix (..., 3, 3) of the least rotation that turns direction s (..., 3) into t: (4.57).

    Without a square root or a sine of the angle: R = e I + h v v^T + [v], v = s x t, e = s . t,
    h = 1 / (1 + e).  Opposite directions turn half a turn about the cross product of s with the
    coordinate axis that is farthest from it, as in `shortest_rotation`.

    Raises
    ------
    ValueError
        What is no direction: another shape, not finite, of length zero; shapes that do not go together.
    """
    a, b = split("s", s, 3)[0], split("t", t, 3)[0]
    try:
        a, b = np.broadcast_arrays(a, b)
    except ValueError:
        raise ValueError(f"s and t do not go together: shapes {a.shape} and {b.shape}") from None
    total, apart = a + b, b - a
    opposite = np.linalg.norm(total, axis=-1, keepdims=True) < ANTIPODAL
    # (a + b) x (b - a) = 2 a x b loses nothing near parallel and opposite directions.
    v = 0.5 * np.cross(total, apart)
    # Near opposite directions h = (1 - e) / v^2 stays that of a rotation, as h v v^T is (1 - e) n n^T.
    e = 0.25 * (_squared(total) - _squared(apart))
    v = np.where(opposite, _across(a), v)
    bottom = np.where(e > 0.0, 1.0 + e, _squared(v))
    h = np.where(e > 0.0, 1.0, 1.0 - e) / bottom
    turn = _crossing(np.where(opposite, 0.0, v))
    return np.asarray(e[..., None, None] * np.eye(3) + h[..., None, None] * _outer(v) + turn)


def _products(m: FloatArray) -> FloatArray:
    """4 q q^T (..., 4, 4) of rotation matrices: differences (4.47), and the diagonal (4.51)."""
    x, y, z = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    wx, wy, wz = (m[..., k, j] - m[..., j, k] for j, k in ((1, 2), (2, 0), (0, 1)))
    yz, zx, xy = (m[..., k, j] + m[..., j, k] for j, k in ((1, 2), (2, 0), (0, 1)))
    rows = (
        (1.0 + x + y + z, wx, wy, wz),
        (wx, 1.0 + x - y - z, xy, zx),
        (wy, xy, 1.0 - x + y - z, yz),
        (wz, zx, yz, 1.0 - x - y + z),
    )
    return _stacked(rows)


def _refuse_no_rotation(m: FloatArray) -> None:
    if m.ndim < 2 or m.shape[-2:] != (3, 3):
        raise ValueError(f"matrices has shape {m.shape}: expected last axes of 3 and 3")
    refuse_infinite("matrices", m)
    off = np.abs(m @ np.swapaxes(m, -1, -2) - np.eye(3)).max(axis=(-2, -1))
    if (off > NEARLY).any():
        first = np.argwhere(off > NEARLY)[0]
        raise ValueError(
            f"{at('matrices', first)} is no rotation: its rows are off orthonormal by {off[tuple(first)]:.3g}"
        )
    mirrored = np.linalg.det(m) < 0.0
    if mirrored.any():
        place = at("matrices", np.argwhere(mirrored)[0])
        raise ValueError(f"{place} is a reflection, which no quaternion is: its determinant is -1")


def _across(a: FloatArray) -> FloatArray:
    """Unit vectors orthogonal to a (..., 3): across it and the coordinate axis on which it has least."""
    least = np.eye(3)[np.argmin(np.abs(a), axis=-1)]
    axis = np.cross(a, least)
    return np.asarray(axis / np.linalg.norm(axis, axis=-1, keepdims=True))


def _squared(v: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("...i,...i->...", v, v))


def _outer(v: FloatArray) -> FloatArray:
    return v[..., :, None] * v[..., None, :]


def _crossing(v: FloatArray) -> FloatArray:
    """The matrix of x -> v x x."""
    x, y, z = np.moveaxis(v, -1, 0)
    o = np.zeros_like(x)
    return _stacked(((o, -z, y), (z, o, -x), (-y, x, o)))


def _stacked(rows: tuple[tuple[FloatArray, ...], ...]) -> FloatArray:
    """Matrices of entries (...) given by rows."""
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
