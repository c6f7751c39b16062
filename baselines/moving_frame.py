"""Moving frames of Jiang & Ma: a spline through the frames' axes, then the nearest rotation.

The columns of the keyframes' matrices R_i are interpolated, entry by entry, by a spline B(t) of odd
degree k.  The curve is the rotation C(t) nearest to B(t), the one that maximises tr(C^T B)
[jiang2000, (3.4)].  With Cayley parameters d, the vector part of its quaternion over the scalar part,

    C(d) = ((1 - |d|^2) I + 2 d d^T + 2 [d]) / (1 + |d|^2)                                         (1)

and with tau = tr B, z = vee(B) = (B_32 - B_23, B_13 - B_31, B_21 - B_12), g = tr(C^T B), the maximum has

    A(g) d = z,   A(g) = (tau + g) I - (B + B^T),   f(g) = g - tau - z . d = 0.                    (2)

f increases and is concave beyond the largest pole, where A is positive definite; its root there is the
maximum.  Newton's step, f / (1 + |d|^2), makes g the Rayleigh quotient of d.  The published text
available to us ends before its own iteration.

Rates: with S = C^T B', P = C^T B (symmetric) and M = tr(P) I - P, derivatives of C^T B = P give

    M omega = vee(S),   M alpha = vee(C^T B'' - [omega] S) - (tr(S) I - S + [omega] P) omega.       (3)
"""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any, Literal

import numpy as np
from numba import carray

from quatspline import quaternion
from quatspline.kernels.jit import (
    BLOCK,
    CONSTANTS,
    RESULT,
    ROWS,
    Kernel,
    compiled,
    inlined,
    sample_kernel,
)
from quatspline.kernels.operations import Operations, Per
from quatspline.kernels.scalars import cross, mul
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.segments import Family, SegmentCurve
from quatspline.system.quiet import quiet

# notation: the constants of a segment are a base quaternion (4), the middle of its arc, then those of
# B seen from there (`_entry`), nine for each of f, r, g_0 ..., column by column: B[row, j] is entry
# 3 j + row.
COEFFICIENTS = 4
_B = CONSTANTS + COEFFICIENTS

LIMIT = 60
"""Steps of the iteration: Newton takes 3 to 8, bisection beside a pole the rest."""
CLOSE = 1e-14
"""A step of g (about 3) that moves the orientation by rounding only."""


@inlined
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def _symmetric_solve(a00, a01, a02, a11, a12, a22, x, y, z):
    """Solution of a symmetric 3x3 system by cofactors, its determinant and whether it is definite."""
    c00, c01, c02 = a11 * a22 - a12 * a12, a02 * a12 - a01 * a22, a01 * a12 - a02 * a11
    c11, c12, c22 = a00 * a22 - a02 * a02, a01 * a02 - a00 * a12, a00 * a11 - a01 * a01
    det = a00 * c00 + a01 * c01 + a02 * c02
    k = 1.0 / det if det != 0.0 else 0.0
    return (
        k * (c00 * x + c01 * y + c02 * z),
        k * (c01 * x + c11 * y + c12 * z),
        k * (c02 * x + c12 * y + c22 * z),
        a00 > 0.0 and c22 > 0.0 and det > 0.0,
    )


@compiled
def nearest(a, b, c):
    """(2) for the matrix with columns a, b, c: the Cayley parameters d of the nearest rotation.

    Newton's iteration from g = 3, kept between a point below the root and the bound
    g <= sqrt(3) |B|; what leaves that bracket, or makes A indefinite, is bisected.
    """
    tau = a[0] + b[1] + c[2]
    x, y, z = b[2] - c[1], c[0] - a[2], a[1] - b[0]
    s01, s02, s12 = a[1] + b[0], a[2] + c[0], b[2] + c[1]
    high = math.sqrt(3.0 * (_dot(a, a) + _dot(b, b) + _dot(c, c)))
    low = -high
    g = min(3.0, high)
    d = (0.0, 0.0, 0.0)
    for _ in range(LIMIT):
        k = tau + g
        dx, dy, dz, definite = _symmetric_solve(
            k - 2.0 * a[0], -s01, -s02, k - 2.0 * b[1], -s12, k - 2.0 * c[2], x, y, z
        )
        step = 0.0
        if definite:
            d = (dx, dy, dz)
            step = -(g - tau - (x * dx + y * dy + z * dz)) / (1.0 + _dot(d, d))
            if abs(step) < CLOSE:
                break
        if definite and step < 0.0:
            high = g
        else:
            low = g
        g = g + step if definite and low < g + step < high else 0.5 * (low + high)
    return d


@inlined
def _unit(d):
    k = 1.0 / math.sqrt(1.0 + _dot(d, d))
    return k, k * d[0], k * d[1], k * d[2]


@inlined
def _columns(w, x, y, z):
    """The columns of the rotation matrix of a unit quaternion."""
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
        (2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
        (2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


@inlined
def _seen(f, v):
    """C^T v for C with columns f."""
    return _dot(f[0], v), _dot(f[1], v), _dot(f[2], v)


@inlined
def _vee(a, b, c):
    """vee of the matrix with columns a, b, c."""
    return b[2] - c[1], c[0] - a[2], a[1] - b[0]


@inlined
def _rate(p, v):
    """M^-1 v with M = tr(P) I - P, P with columns p; zero where no rotation is nearest alone."""
    p0, p1, p2 = p
    x, y, z, _ = _symmetric_solve(
        p1[1] + p2[2], -p0[1], -p0[2], p0[0] + p2[2], -p1[2], p0[0] + p1[1], v[0], v[1], v[2]
    )
    return x, y, z


@inlined
def _entry(s, p, j, u, quintic, m):
    """Derivative m of an entry of B at u: f + r u + u (1 - u) g(u), exact at both ends."""
    a, b = s[p + 18, j], s[p + 27, j]
    c, d = (s[p + 36, j], s[p + 45, j]) if quintic else (0.0, 0.0)
    g, w = ((d * u + c) * u + b) * u + a, u - u * u
    if m == 0:
        return w * g + (s[p + 9, j] * u + s[p, j])
    g1, w1 = (3.0 * d * u + 2.0 * c) * u + b, 1.0 - 2.0 * u
    if m == 1:
        return w * g1 + (w1 * g + s[p + 9, j])
    return w * (6.0 * d * u + 2.0 * c) + 2.0 * (w1 * g1 - g)


@inlined
def _frame(s, j, quintic, m):
    """The columns of derivative m of B at a sample's u."""
    u, p = s[0, j], _B
    return (
        (
            _entry(s, p, j, u, quintic, m),
            _entry(s, p + 1, j, u, quintic, m),
            _entry(s, p + 2, j, u, quintic, m),
        ),
        (
            _entry(s, p + 3, j, u, quintic, m),
            _entry(s, p + 4, j, u, quintic, m),
            _entry(s, p + 5, j, u, quintic, m),
        ),
        (
            _entry(s, p + 6, j, u, quintic, m),
            _entry(s, p + 7, j, u, quintic, m),
            _entry(s, p + 8, j, u, quintic, m),
        ),
    )


def _kernel(degree: int, order: int) -> Kernel:
    """The sample kernel of an order for splines of a degree.

    Closures hold plain values only: numba's cache does not recognise one that holds functions.
    """
    quintic = degree == 5

    def orientation(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            b = _frame(s, j, quintic, 0)
            w, x, y, z = _unit(nearest(b[0], b[1], b[2]))
            c = CONSTANTS
            w, x, y, z = mul(s[c, j], s[c + 1, j], s[c + 2, j], s[c + 3, j], w, x, y, z)
            s[RESULT, j] = w
            s[RESULT + 1, j] = x
            s[RESULT + 2, j] = y
            s[RESULT + 3, j] = z

    def rates(sheet, n):
        s = carray(sheet, (ROWS, BLOCK))
        for j in range(n):
            b, b1 = _frame(s, j, quintic, 0), _frame(s, j, quintic, 1)
            w, x, y, z = _unit(nearest(b[0], b[1], b[2]))
            f = _columns(w, x, y, z)
            p = (_seen(f, b[0]), _seen(f, b[1]), _seen(f, b[2]))
            q = (_seen(f, b1[0]), _seen(f, b1[1]), _seen(f, b1[2]))
            v = _rate(p, _vee(q[0], q[1], q[2]))
            k = s[1, j]
            if order == 2:
                b2 = _frame(s, j, quintic, 2)
                t0, t1, t2 = _seen(f, b2[0]), _seen(f, b2[1]), _seen(f, b2[2])
                o0, o1, o2 = _turned(v, q[0], t0), _turned(v, q[1], t1), _turned(v, q[2], t2)
                trace = q[0][0] + q[1][1] + q[2][2]
                pv, qv = _applied(p, v), _applied(q, v)
                cx, cy, cz = cross(v[0], v[1], v[2], pv[0], pv[1], pv[2])
                rx, ry, rz = _vee(o0, o1, o2)
                v = _rate(
                    p,
                    (
                        rx - trace * v[0] + qv[0] - cx,
                        ry - trace * v[1] + qv[1] - cy,
                        rz - trace * v[2] + qv[2] - cz,
                    ),
                )
                k = k * k
            s[RESULT, j] = k * v[0]
            s[RESULT + 1, j] = k * v[1]
            s[RESULT + 2, j] = k * v[2]

    return sample_kernel(rates if order else orientation)


@inlined
def _turned(v, a, b):
    """b - v x a."""
    x, y, z = cross(v[0], v[1], v[2], a[0], a[1], a[2])
    return b[0] - x, b[1] - y, b[2] - z


@inlined
def _applied(m, v):
    """The matrix with columns m times v."""
    return (
        m[0][0] * v[0] + m[1][0] * v[1] + m[2][0] * v[2],
        m[0][1] * v[0] + m[1][1] * v[1] + m[2][1] * v[2],
        m[0][2] * v[0] + m[1][2] * v[1] + m[2][2] * v[2],
    )


def _family(degree: int) -> Family:
    kernels = (_kernel(degree, 0), _kernel(degree, 1), _kernel(degree, 2))
    return Family(COEFFICIENTS + 9 * (degree + 1), near=kernels, far=kernels)


FAMILIES = {degree: _family(degree) for degree in (3, 5)}


class MovingFrame(SegmentCurve):
    """Moving frames of Jiang & Ma (2000): spline of the frames' axes, then the nearest rotation.

    C^(k-1) for degree k, interpolating, global, order k + 1.  Nothing is solved but a banded linear
    system; each sample finds a nearest rotation by an iteration of its own (see the module).  A frame
    carries no sign: every step goes the short way, with ``align=False`` too.  The axes shorten and
    their spline cuts corners where steps are large: beyond about 120 degrees it is of little use.

    Options
    -------
    degree
        k = 3 or 5.
    ends
        "natural": derivatives (k + 1)/2 ... k - 1 vanish at the ends.  "not-a-knot": needs k + 1
        keyframes.  "complete": end velocities, and accelerations for degree 5, estimated from the
        polynomial through k + 1 keyframes in the chart of the end.  Closed curves are periodic.
    """

    title = "Moving frames of Jiang & Ma"
    reference = "jiang2000"
    continuity = 2
    order = 4
    support = None
    constant_rate = "no"
    family = FAMILIES[3]
    operations = Operations(others={"nearest rotations": Per(sample=1)})
    departs = {"test_keeps_given_signs": "a frame carries no sign"}

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        degree: Literal[3, 5] = 3,
        ends: Literal["natural", "not-a-knot", "complete"] = "natural",
    ) -> None:
        self.continuity, self.order = degree - 1, degree + 1
        self.family = FAMILIES[degree]
        least = {"natural": (degree + 1) // 2, "not-a-knot": degree + 1, "complete": 2}[ends]
        if keyframes.count < least and not keyframes.closed:
            raise ValueError(
                f"quaternions has {keyframes.count} keyframes: degree={degree} with ends={ends!r} "
                f"needs {least}"
            )
        t, q = keyframes.knots / keyframes.unit, np.moveaxis(keyframes.tracks, 0, 1)
        if keyframes.closed:
            q = np.concatenate([q, keyframes.signs[:, None] * q[:1]])
        q = quaternion.align(q)
        axes = quaternion.rotate(q[..., None, :], np.eye(3))  # (n, K, column, component)
        if keyframes.closed:
            axes[-1] = axes[0]
        conditions = "periodic" if keyframes.closed else _conditions(t, degree, ends, q, axes)
        spline = _interpolated(t, axes, degree, conditions)
        self._set_segments(_constants(spline, degree, t, q, axes), 0.0)


def _interpolated(t: FloatArray, axes: FloatArray, degree: int, conditions: Any) -> Any:
    """scipy's spline; refused where its linear system is singular.

    An ill-conditioned one, of very uneven spacings, is no matter: a spline is smooth whatever its
    coefficients are, and the segments take their ends from the axes themselves.
    """
    from scipy.interpolate import make_interp_spline

    spline = None
    with quiet(), suppress(np.linalg.LinAlgError):
        spline = make_interp_spline(t, axes, degree, bc_type=conditions)
    if spline is None or not np.isfinite(spline.c).all():
        h = np.diff(t)
        raise ValueError(
            f"times: spacings in the ratio {h.max() / h.min():.3g} are too uneven for degree={degree}: "
            "the spline's linear system is singular"
        )
    return spline


def _conditions(t: FloatArray, k: int, ends: str, q: FloatArray, axes: FloatArray) -> Any:
    """The end conditions as scipy takes them: (derivative, values) at either end."""
    if ends == "not-a-knot":
        return None
    if ends == "natural":
        natural = [(m, np.zeros(axes.shape[1:])) for m in range((k + 1) // 2, k)]
        return natural, natural
    start = _clamped(t[: k + 1], q[: k + 1], axes[0])
    end = _clamped(t[: -k - 2 : -1], q[: -k - 2 : -1], axes[-1])
    return start[: (k - 1) // 2], end[: (k - 1) // 2]


def _clamped(t: FloatArray, q: FloatArray, axes: FloatArray) -> list[tuple[int, FloatArray]]:
    """(1, R [omega]) and (2, R ([omega]^2 + [alpha])) at the first of some keyframes (m, K, 4).

    In the chart x_j = ln(q_0^-1 q_j) omega = 2 x' and alpha = 2 x'' at its centre.
    """
    since = t[1:] - t[0]
    ratios = since / np.where(np.eye(len(since)) > 0, 1.0, since - since[:, None])  # (j, k), k != j
    slopes = np.prod(np.where(np.eye(len(since)) > 0, 1.0, ratios), axis=1) / since
    others = (1.0 / since).sum() - 1.0 / since
    x = quaternion.chart(q)
    velocity = 2.0 * np.tensordot(slopes, x, 1)
    acceleration = 2.0 * np.tensordot(-2.0 * slopes * others, x, 1)
    spin = -np.cross(np.eye(3), velocity[:, None])  # [omega] e_j = omega x e_j
    turn = -np.cross(np.eye(3), acceleration[:, None])
    return [(1, spin @ axes), (2, (spin @ spin + turn) @ axes)]


def _constants(spline: Any, k: int, t: FloatArray, q: FloatArray, axes: FloatArray) -> FloatArray:
    """Constants (K, segments, ...): the middle of each arc and B's constants seen from there."""
    h = np.diff(t)[:, None, None, None]
    middle = quaternion.normalise(q[:-1] + q[1:])
    powers = [spline(t[:-1], m) * h**m / math.factorial(m) for m in range(2, k + 1)]
    bends = -np.cumsum(powers[::-1], axis=0)[::-1]  # u^k - u = -u (1 - u) (1 + ... + u^(k - 2))
    rows = np.stack([axes[:-1], axes[1:] - axes[:-1], *bends], axis=2)
    seen = quaternion.rotate(quaternion.conj(middle)[:, :, None, None], rows)
    flat = seen.reshape(*seen.shape[:2], -1)
    return np.ascontiguousarray(np.moveaxis(np.concatenate([middle, flat], axis=-1), 1, 0))
