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

from quatspline import quaternion
from quatspline.kernels.family import Family, family
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.values import (
    Mat,
    Quat,
    Vec,
    cross,
    quat_at,
    rotate,
    solve_symmetric,
    transposed,
    unit,
    vec_at,
)
from quatspline.keyframes import Keyframes
from quatspline.operations import Operations, Per
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve
from quatspline.system.quiet import quiet

# notation: the constants of a segment are a base quaternion (4), the middle of its arc, then those of
# B seen from there (`frame`), nine for each of f, r, g_0 ..., column by column: B[row, j] is entry
# 3 j + row.
COEFFICIENTS = 4

LIMIT = 60
"""Steps of the iteration: Newton takes 3 to 8, bisection beside a pole the rest."""
CLOSE = 1e-14
"""A step of g (about 3) that moves the orientation by rounding only."""


@compiled
def nearest(b):
    """(2): the unit quaternion of the rotation nearest to a matrix.

    Newton's iteration from g = 3, kept between a point below the root and the bound
    g <= sqrt(3) |B|; what leaves that bracket, or makes A indefinite, is bisected.
    """
    tau, z = trace(b), vee(b)
    both = b + transposed(b)
    high = math.sqrt(3.0 * (b.a @ b.a + b.b @ b.b + b.c @ b.c))
    low = -high
    g = min(3.0, high)
    d = Vec(0.0, 0.0, 0.0)
    for _ in range(LIMIT):
        x, definite = solve_symmetric(scalar(tau + g) - both, z)
        step = 0.0
        if definite:
            d = x
            step = -(g - tau - z @ d) / (1.0 + d @ d)
            if abs(step) < CLOSE:
                break
        if definite and step < 0.0:
            high = g
        else:
            low = g
        g = g + step if definite and low < g + step < high else 0.5 * (low + high)
    return unit(Quat(1.0, d.x, d.y, d.z))


@inlined
def trace(m):
    """The trace."""
    return m.a.x + m.b.y + m.c.z


@inlined
def vee(m):
    """(M_32 - M_23, M_13 - M_31, M_21 - M_12)."""
    return Vec(m.b.z - m.c.y, m.c.x - m.a.z, m.a.y - m.b.x)


@inlined
def scalar(f):
    """f I."""
    return Mat(Vec(f, 0.0, 0.0), Vec(0.0, f, 0.0), Vec(0.0, 0.0, f))


@inlined
def _seen(q, m):
    """C^T M, C the rotation of a unit quaternion."""
    return Mat(rotate(~q, m.a), rotate(~q, m.b), rotate(~q, m.c))


@inlined
def _rate(p, v):
    """M^-1 v of (3); zero where no rotation is nearest alone."""
    x, _ = solve_symmetric(scalar(trace(p)) - p, v)
    return x


@inlined
def _crossed(v, m):
    """[v] M."""
    return Mat(cross(v, m.a), cross(v, m.b), cross(v, m.c))


def _family(degree: int) -> Family:
    """The family of splines of a degree; its functions hold plain values only."""
    quintic = degree == 5

    @inlined
    def frame(c, u, order):
        """B at u, or its derivative of an order: f + r u + u (1 - u) g(u), exact at both ends."""
        a, b = block(c, 2), block(c, 3)
        d, e = (block(c, 4), block(c, 5)) if quintic else (scalar(0.0), scalar(0.0))
        g = u * (u * (u * e + d) + b) + a
        w, w1 = u - u * u, 1.0 - 2.0 * u
        if order == 0:
            return w * g + (u * block(c, 1) + block(c, 0))
        g1 = u * ((3.0 * u) * e + 2.0 * d) + b
        if order == 1:
            return w * g1 + (w1 * g + block(c, 1))
        return w * ((6.0 * u) * e + 2.0 * d) + 2.0 * (w1 * g1 - g)

    @inlined
    def point(c, u):
        return quat_at(c, 0) * nearest(frame(c, u, 0))

    @inlined
    def velocity(c, u):
        b = frame(c, u, 0)
        q = nearest(b)
        return 0.5 * _rate(_seen(q, b), vee(_seen(q, frame(c, u, 1))))

    @inlined
    def acceleration(c, u):
        b = frame(c, u, 0)
        q = nearest(b)
        p, s, t = _seen(q, b), _seen(q, frame(c, u, 1)), _seen(q, frame(c, u, 2))
        v = _rate(p, vee(s))
        turned = vee(t - _crossed(v, s))
        return 0.5 * _rate(p, turned - trace(s) * v + s @ v - cross(v, p @ v))

    constants = COEFFICIENTS + 9 * (degree + 1)
    return family(constants, point, velocity=velocity, acceleration=acceleration)


@inlined
def block(c, k):
    """The k-th nine of B's constants, column by column."""
    p = COEFFICIENTS + 9 * k
    return Mat(vec_at(c, p), vec_at(c, p + 3), vec_at(c, p + 6))


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
