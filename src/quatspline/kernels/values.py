"""Quaternions, vectors and 3x3 matrices as values: what kernels are written in.

``Quat`` (w, x, y, z), ``Vec`` (x, y, z) and ``Mat`` (three columns) are named tuples with the operators
of mathematics.  Compiled code keeps them in registers, so that a loop over samples vectorises; plain
Python runs the same formulas.

==========  =============================================================================
``p * q``   Hamilton product of quaternions; product of matrices
``~q``      conjugate: the inverse of a unit quaternion
``a @ b``   inner product of quaternions (in R^4) and of vectors; matrix times vector
``f * a``   a number, on the left, times any of them
``a + b``, ``a - b``, ``-a``
==========  =============================================================================

It is longer than other modules because kernels are written in these words and no others.

Logarithms are half rotation vectors: ``exp(v) = (cos |v|, v sin |v| / |v|)``, and ``log`` is its
inverse on the ball |v| <= pi.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import ANTIPODAL_SINE, TINY, arctan, sinc, sincos

# The formulas of operators are methods; `compiler` tells compiled code of them.


class Quat(NamedTuple):
    """A quaternion w + x i + y j + z k."""

    w: float
    x: float
    y: float
    z: float

    def __mul__(self, q):
        return Quat(
            self.w * q.w - self.x * q.x - self.y * q.y - self.z * q.z,
            self.w * q.x + self.x * q.w + self.y * q.z - self.z * q.y,
            self.w * q.y - self.x * q.z + self.y * q.w + self.z * q.x,
            self.w * q.z + self.x * q.y - self.y * q.x + self.z * q.w,
        )

    def __rmul__(self, f):
        return Quat(f * self.w, f * self.x, f * self.y, f * self.z)

    def __add__(self, q):
        return Quat(self.w + q.w, self.x + q.x, self.y + q.y, self.z + q.z)

    def __sub__(self, q):
        return Quat(self.w - q.w, self.x - q.x, self.y - q.y, self.z - q.z)

    def __matmul__(self, q):
        return self.w * q.w + self.x * q.x + self.y * q.y + self.z * q.z

    def __neg__(self):
        return Quat(-self.w, -self.x, -self.y, -self.z)

    def __invert__(self):
        return Quat(self.w, -self.x, -self.y, -self.z)


class Vec(NamedTuple):
    """A vector of R^3."""

    x: float
    y: float
    z: float

    def __rmul__(self, f):
        return Vec(f * self.x, f * self.y, f * self.z)

    def __add__(self, v):
        return Vec(self.x + v.x, self.y + v.y, self.z + v.z)

    def __sub__(self, v):
        return Vec(self.x - v.x, self.y - v.y, self.z - v.z)

    def __matmul__(self, v):
        return self.x * v.x + self.y * v.y + self.z * v.z

    def __neg__(self):
        return Vec(-self.x, -self.y, -self.z)


class Mat(NamedTuple):
    """A 3x3 matrix of columns a, b, c."""

    a: Vec
    b: Vec
    c: Vec

    def __mul__(self, m):
        return Mat(self @ m.a, self @ m.b, self @ m.c)

    def __rmul__(self, f):
        return Mat(f * self.a, f * self.b, f * self.c)

    def __add__(self, m):
        return Mat(self.a + m.a, self.b + m.b, self.c + m.c)

    def __sub__(self, m):
        return Mat(self.a - m.a, self.b - m.b, self.c - m.c)

    def __matmul__(self, v):
        return v.x * self.a + v.y * self.b + v.z * self.c

    def __neg__(self):
        return Mat(-self.a, -self.b, -self.c)


for _cls in (Quat, Vec, Mat):
    _cls.__array_ufunc__ = None  # type: ignore[union-attr]  # numpy's numbers, too, ask a for f * a

Vec.__mul__ = None  # type: ignore[assignment]  # a tuple times 2 is one twice as long


# -- parts and rows of arrays ---------------------------------------------------------------------


@inlined
def vec(q):
    """The vector part of a quaternion."""
    return Vec(q.x, q.y, q.z)


@inlined
def pure(v):
    """The quaternion of scalar part 0."""
    return Quat(0.0, v.x, v.y, v.z)


@inlined
def quat_at(c, k):
    """The quaternion at places k ... k + 3 of a row."""
    return Quat(c[k], c[k + 1], c[k + 2], c[k + 3])


@inlined
def vec_at(c, k):
    """The vector at places k ... k + 2 of a row."""
    return Vec(c[k], c[k + 1], c[k + 2])


@inlined
def mat_at(c, k):
    """The matrix at places k ... k + 8 of a row, column by column."""
    return Mat(vec_at(c, k), vec_at(c, k + 3), vec_at(c, k + 6))


@inlined
def put_quat(c, k, q):
    """Write a quaternion to places k ... k + 3 of a row."""
    c[k], c[k + 1], c[k + 2], c[k + 3] = q.w, q.x, q.y, q.z


@inlined
def put_vec(c, k, v):
    """Write a vector to places k ... k + 2 of a row."""
    c[k], c[k + 1], c[k + 2] = v.x, v.y, v.z


@inlined
def put_mat(c, k, m):
    """Write a matrix to places k ... k + 8 of a row."""
    put_vec(c, k, m.a)
    put_vec(c, k + 3, m.b)
    put_vec(c, k + 6, m.c)


@inlined
def quat_column(a, k):
    """Column k of quaternions (4, n), component first."""
    return Quat(a[0, k], a[1, k], a[2, k], a[3, k])


@inlined
def vec_column(a, k):
    """Column k of vectors (3, n), component first."""
    return Vec(a[0, k], a[1, k], a[2, k])


@inlined
def put_quat_column(a, k, q):
    """Write column k of quaternions (4, n)."""
    a[0, k], a[1, k], a[2, k], a[3, k] = q.w, q.x, q.y, q.z


@inlined
def put_vec_column(a, k, v):
    """Write column k of vectors (3, n)."""
    a[0, k], a[1, k], a[2, k] = v.x, v.y, v.z


@inlined
def keyframe(q, i, sign):
    """q_i for any i, closed data going on as q_{i+n} = sign q_i."""
    n = q.shape[0]
    s = 1.0
    if i < 0 or i >= n:
        s = sign if (i // n) % 2 else 1.0
        i %= n
    return Quat(s * q[i, 0], s * q[i, 1], s * q[i, 2], s * q[i, 3])


# -- functions ------------------------------------------------------------------------------------


@inlined
def cross(a, b):
    """The cross product."""
    return Vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)


@inlined
def transposed(m):
    """The transposed matrix."""
    a, b, c = m
    return Mat(Vec(a.x, b.x, c.x), Vec(a.y, b.y, c.y), Vec(a.z, b.z, c.z))


@inlined
def norm(a):
    """The length of a vector or quaternion."""
    return math.sqrt(a @ a)


@inlined
def unit(a):
    """a / |a|; zero stays zero."""
    length = norm(a)
    return (1.0 / length if length > 0.0 else 0.0) * a


@inlined
def exp(v):
    """The unit quaternion exp(v)."""
    s, c = sinc(v @ v)
    return polar_exp(s, c, v)


@inlined
def polar_exp(s, c, n):
    """exp(theta n) of a unit axis from s = sin(theta), c = cos(theta); s / theta serves for theta n."""
    return Quat(c, s * n.x, s * n.y, s * n.z)


@inlined
def log(q):
    """The principal logarithm, |log| <= pi; of -1, which has none, pi about the first axis."""
    length = norm(vec(q))
    if length < TINY:
        if q.w < 0.0:
            return Vec(math.pi, 0.0, 0.0)
        return Vec(q.x / q.w, q.y / q.w, q.z / q.w)
    return (math.atan2(length, q.w) / length) * vec(q)


@inlined
def polar(v):
    """(|v|, v/|v|); the axis of a vanishing vector is zero."""
    length = norm(v)
    return length, (1.0 / (length + TINY) if length > TINY else 0.0) * v


@inlined
def rotate(q, v):
    """The vector turned by the unit quaternion: q v q^-1."""
    t = cross(vec(q), v)
    return v + 2.0 * (q.w * t + cross(vec(q), t))


@inlined
def unrotate(s, c, n, v):
    """The vector seen after the turn exp(theta n), s = sin(theta), c = cos(theta): R^T v."""
    t = cross(n, v)
    return v - (2.0 * s * c) * t + (2.0 * s * s) * cross(n, t)


@inlined
def arc(p, q):
    """The angle between unit quaternions with its sine and cosine: (theta, sin, cos), branch-free.

    tan(theta/4) = |p - q| / (|p + q| + 2) loses nothing for small angles [0, pi].
    """
    minus = (p - q) @ (p - q)
    s, m = math.sqrt(minus), norm(p + q)
    return 4.0 * arctan(s, m + 2.0), 0.5 * s * m, 1.0 - 0.5 * minus


@inlined
def turn(p, q):
    """|v| and v/|v| of v = log(~p * q), |v| <= pi, branch-free; 0 for 0."""
    theta, _, _ = arc(p, q)
    v = vec(~p * q)
    return theta, (1.0 / math.sqrt(v @ v + TINY)) * v


@inlined
def slerp(p, q, u):
    """The point at u on the great arc from p to q, no sign flip.

    Near antipodes it loses digits, and length: `restored` gives that back.
    """
    theta, sine, cosine = arc(p, q)
    s, k = sincos(u * theta)
    f = s / max(sine, ANTIPODAL_SINE if cosine < 0.0 else TINY)
    return (k - cosine * f) * p + f * q


@inlined
def restored(p, other):
    """p / |p|: slerp between near-antipodes has digits to lose; the other where it has lost all."""
    size = p @ p
    if not size > TINY:
        return other
    return (1.0 / math.sqrt(size)) * p


@inlined
def solve_symmetric(m, v):
    """(m^-1 v by cofactors, 0 where m is singular; whether m is definite), m symmetric."""
    bc, ca, ab = cross(m.b, m.c), cross(m.c, m.a), cross(m.a, m.b)
    det = m.a @ bc
    k = 1.0 / det if det != 0.0 else 0.0
    return k * Vec(bc @ v, ca @ v, ab @ v), m.a.x > 0.0 and ab.z > 0.0 and det > 0.0
