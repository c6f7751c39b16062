"""Unit-quaternion algebra on arrays that end in an axis of 4, scalar first (w, x, y, z).

All functions broadcast their leading axes and return float64.  Logarithms are half rotation
vectors: ``log(q) = theta n`` for ``q = cos theta + n sin theta`` with 0 <= theta <= pi.  Angles come
from atan2, never from acos, so that small rotations keep their relative accuracy (see
docs/mathematics/notation.md).

Quaternions are unit quaternions, but for `inverse`, `slerp_modulus` and `to_matrix`, which take any length
but zero; `slerp_vectors` and `lerp_vectors` go between vectors of any length; `to_matrix`, `from_matrix`
and `rotation_matrix_between` are the matrix forms.  Other forms of rotations, Euler angles above all, are
scipy's business: ``scipy.spatial.transform.Rotation.from_quat(q, scalar_first=True)``.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quatspline.engines import engine
from quatspline.inputs.arrays import FloatArray
from quatspline.kernels import jacobians, values
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.scalars import TINY
from quatspline.kernels.values import (
    Quat,
    Vec,
    cross,
    norm,
    pure,
    put_quat,
    put_vec,
    quat_at,
    vec,
    vec_at,
)
from quatspline.lengths import ANTIPODAL as ANTIPODAL
from quatspline.lengths import inverse as inverse
from quatspline.lengths import lerp_vectors as lerp_vectors
from quatspline.lengths import slerp_modulus as slerp_modulus
from quatspline.lengths import slerp_vectors as slerp_vectors
from quatspline.lengths import split
from quatspline.matrices import from_matrix as from_matrix
from quatspline.matrices import rotation_matrix_between as rotation_matrix_between
from quatspline.matrices import to_matrix as to_matrix

OPPOSITE = 1e-12
"""A vector part shorter than this, before -1, has no direction of its own."""

FLIP = -4 * float(np.finfo(float).eps)
"""Neighbours with a dot product below this lie on opposite hemispheres.  Half a turn apart it is 0 but
for rounding, which must not decide: there the sign stays as given, from whatever frame one looks."""


def mul(a: ArrayLike, b: ArrayLike) -> FloatArray:
    """Hamilton product ab of (..., 4) and (..., 4)."""
    return _apply(_mul, (a, 4), (b, 4), width=4)


def conj(q: ArrayLike) -> FloatArray:
    """Conjugate (w, -v) of (..., 4): the inverse of a unit quaternion."""
    return np.asarray(q, dtype=float) * (1.0, -1.0, -1.0, -1.0)


def exp(v: ArrayLike) -> FloatArray:
    """exp(v) = (cos |v|, v sin |v|/|v|) of half rotation vectors (..., 3) -> (..., 4)."""
    return _apply(_exp, (v, 3), width=4)


def log(q: ArrayLike) -> FloatArray:
    """Principal logarithm (..., 4) -> (..., 3), |log| <= pi; log(-1) is (pi, 0, 0) by convention."""
    return _apply(_log, (q, 4), width=3)


def log_towards(q: ArrayLike, hint: ArrayLike) -> FloatArray:
    """`log` of (..., 4), but of -1, which has no direction of its own, along ``hint`` (..., 3)."""
    q = np.asarray(q, dtype=float)
    hint = np.asarray(hint, dtype=float)
    opposite = (q[..., 0] < 0.0) & (np.linalg.norm(q[..., 1:], axis=-1) < OPPOSITE)
    length = np.linalg.norm(hint, axis=-1)
    along = opposite & (length > 0.0)
    scale = np.pi / np.where(along, length, 1.0)
    return np.where(along[..., None], scale[..., None] * hint, log(q))


def chart(q: ArrayLike) -> FloatArray:
    """ln(q_0^-1 q_j) for j >= 1 of neighbours (m, ..., 4): (m - 1, ..., 3), carried on past pi.

    Each point is taken on the branch nearer to the one before it plus the step between them.
    """
    q = np.asarray(q, dtype=float)
    points = [np.zeros((*q.shape[1:-1], 3))]
    for before, here in itertools.pairwise(q):
        expected = points[-1] + log(mul(conj(before), here))
        x = log_towards(mul(conj(q[0]), here), expected)
        length = np.linalg.norm(x, axis=-1, keepdims=True)
        far = x - 2.0 * np.pi * x / np.where(length > 0.0, length, 1.0)
        nearer = np.linalg.norm(far - expected, axis=-1) < np.linalg.norm(x - expected, axis=-1)
        points.append(np.where(nearer[..., None], far, x))
    return np.array(points[1:])


def power(q: ArrayLike, t: ArrayLike) -> FloatArray:
    """q^t = exp(t log q) of (..., 4) with exponents broadcast against the leading axes."""
    return exp(log(q) * np.asarray(t, dtype=float)[..., None])


def slerp(a: ArrayLike, b: ArrayLike, t: ArrayLike) -> FloatArray:
    """Spherical linear interpolation a (a^-1 b)^t along the great arc from a to b, any real t.

    No sign is flipped: give neighbours on one hemisphere (`align`) for the short way round.

    Raises
    ------
    ValueError
        Where a = -b, which no single arc joins.
    """
    _refuse_antipodes(a, b)
    return mul(a, power(mul(conj(a), b), t))


def nlerp(a: ArrayLike, b: ArrayLike, t: ArrayLike) -> FloatArray:
    """Normalised linear interpolation of a and b (..., 4): the arc of `slerp`, at uneven speed.

    Raises
    ------
    ValueError
        Where a = -b.
    """
    _refuse_antipodes(a, b)
    u = np.asarray(t, dtype=float)[..., None]
    q = (1.0 - u) * np.asarray(a, dtype=float) + u * np.asarray(b, dtype=float)
    return normalise(q)


def normalise(q: ArrayLike) -> FloatArray:
    """q / |q| of (..., 4)."""
    q = np.asarray(q, dtype=float)
    return q / np.sqrt(np.einsum("...i,...i->...", q, q))[..., None]


def align(q: ArrayLike) -> FloatArray:
    """Signs flipped along axis 0 of (n, ..., 4) so that neighbours share a hemisphere.

    The first keeps its sign; orthogonal neighbours (dot product 0 to rounding) stay as given.
    """
    q = np.asarray(q, dtype=float)
    dots = np.einsum("n...i,n...i->n...", q[1:], q[:-1])
    signs = np.cumprod(np.where(dots < FLIP, -1.0, 1.0), axis=0)
    return np.concatenate([q[:1], q[1:] * signs[..., None]])


def distance(a: ArrayLike, b: ArrayLike) -> FloatArray:
    """Angle in rad, 0 to pi, of the rotation between the orientations a and b (q and -q are one)."""
    return _apply(_distance, (a, 4), (b, 4), width=0)


def rotate(q: ArrayLike, v: ArrayLike) -> FloatArray:
    """The vectors v (..., 3) turned by the unit quaternions q (..., 4): q v q^-1."""
    return _apply(_rotate, (q, 4), (v, 3), width=3)


def shortest_rotation(u: ArrayLike, v: ArrayLike) -> FloatArray:
    """The least rotation (..., 4) that turns direction u (..., 3) into direction v (..., 3).

    Stable for nearly parallel directions.  Opposite directions turn half a turn about an axis
    orthogonal to u: the cross product with the coordinate axis that is farthest from u.

    Raises
    ------
    ValueError
        Where a direction has no length.
    """
    directions = [split(name, given, 3)[0] for name, given in (("u", u), ("v", v))]
    return _apply(_shortest_rotation, (directions[0], 3), (directions[1], 3), width=4)


def right_jacobian(r: ArrayLike) -> FloatArray:
    """Right Jacobian Jr (..., 3, 3) of SO(3) at rotation vectors r (..., 3), full angles in rad.

    exp(r + dr) = exp(r) exp(Jr(r) dr) to first order.
    """
    return _columns(_right_jacobian, r)


def right_jacobian_inverse(r: ArrayLike) -> FloatArray:
    """Inverse of `right_jacobian`; (..., 3) -> (..., 3, 3).

    Raises
    ------
    ValueError
        At full turns, |r| = 2 pi k with k >= 1, where Jr is singular.
    """
    angle = np.linalg.norm(np.asarray(r, dtype=float), axis=-1)
    turns = np.rint(angle / (2 * math.pi))
    if np.any((turns > 0) & (np.abs(angle - 2 * math.pi * turns) <= 4 * np.spacing(angle))):
        raise ValueError("the right Jacobian is singular at a full turn, |r| = 2 pi k")
    return _columns(_inverse_right_jacobian, r)


def _refuse_antipodes(a: ArrayLike, b: ArrayLike) -> None:
    total = np.asarray(a, dtype=float) + np.asarray(b, dtype=float)
    antipodal = np.linalg.norm(total, axis=-1) < ANTIPODAL
    if np.any(antipodal):
        first = tuple(int(i) for i in np.argwhere(antipodal)[0])
        raise ValueError(f"a and b are antipodes{list(first) or ''}: no single arc joins q and -q")


def _apply(loop: Any, *arguments: tuple[ArrayLike, int], width: int) -> FloatArray:
    """Broadcast the leading axes of (array, width) arguments and run a loop over rows."""
    arrays = []
    for given, size in arguments:
        array = np.asarray(given, dtype=float)
        if array.ndim == 0 or array.shape[-1] != size:
            raise ValueError(f"expected an array that ends in an axis of {size}, got {array.shape}")
        arrays.append(array)
    lead = np.broadcast_shapes(*(array.shape[:-1] for array in arrays))
    rows = [
        np.ascontiguousarray(np.broadcast_to(a, (*lead, a.shape[-1])).reshape(-1, a.shape[-1]))
        for a in arrays
    ]
    out = np.empty((rows[0].shape[0], max(width, 1)))
    engine.run(loop, out.shape[0], *rows, out)
    return out.reshape((*lead, width) if width else lead)


def _columns(loop: Any, r: ArrayLike) -> FloatArray:
    """A 3x3 matrix from a loop that multiplies it to a vector: one call for all unit vectors."""
    r = np.asarray(r, dtype=float)
    columns = _apply(loop, (r[..., None, :], 3), (np.eye(3), 3), width=3)
    return np.swapaxes(columns, -1, -2)


@compiled
def _mul(a, b, out):
    for i in range(out.shape[0]):
        put_quat(out[i], 0, quat_at(a[i], 0) * quat_at(b[i], 0))


@compiled
def _exp(v, out):
    for i in range(out.shape[0]):
        put_quat(out[i], 0, values.exp(vec_at(v[i], 0)))


@compiled
def _log(q, out):
    for i in range(out.shape[0]):
        put_vec(out[i], 0, values.log(quat_at(q[i], 0)))


@compiled
def _distance(a, b, out):
    for i in range(out.shape[0]):
        q = ~quat_at(a[i], 0) * quat_at(b[i], 0)
        out[i, 0] = 2.0 * math.atan2(norm(vec(q)), abs(q.w))


@compiled
def _rotate(q, v, out):
    for i in range(out.shape[0]):
        put_vec(out[i], 0, values.rotate(quat_at(q[i], 0), vec_at(v[i], 0)))


@compiled
def _shortest_rotation(u, v, out):
    for i in range(out.shape[0]):
        a, b = vec_at(u[i], 0), vec_at(v[i], 0)
        # half-angle form: |a + b| = 2 cos(angle/2), |b - a| = 2 sin(angle/2)
        c, s = 0.5 * norm(a + b), 0.5 * norm(b - a)
        axis = cross(a + b, b - a)
        if norm(axis) < TINY:
            if s < 0.5:
                put_quat(out[i], 0, Quat(1.0, 0.0, 0.0, 0.0))
                continue
            axis = cross(a, _least(a))
        turn = pure((s / norm(axis)) * axis)
        put_quat(out[i], 0, (1.0 / math.sqrt(c * c + s * s)) * Quat(c, turn.x, turn.y, turn.z))


@inlined
def _least(a):
    """The coordinate axis on which a vector has least."""
    x, y, z = abs(a.x), abs(a.y), abs(a.z)
    if x <= min(y, z):
        return Vec(1.0, 0.0, 0.0)
    return Vec(0.0, 1.0, 0.0) if y <= z else Vec(0.0, 0.0, 1.0)


@compiled
def _right_jacobian(r, v, out):
    for i in range(out.shape[0]):
        put_vec(out[i], 0, jacobians.right_jacobian(0.5 * vec_at(r[i], 0), vec_at(v[i], 0)))


@compiled
def _inverse_right_jacobian(r, v, out):
    for i in range(out.shape[0]):
        put_vec(out[i], 0, jacobians.inverse_right_jacobian(0.5 * vec_at(r[i], 0), vec_at(v[i], 0)))
