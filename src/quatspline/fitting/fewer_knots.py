"""The equations of a cumulative cubic B-spline on fewer knots than keyframes, fitted by least squares.

With N segments, clamped knots and controls d_0 ... d_{N+2}, the curve on segment k is

    X = d_k exp(c_1 w_{k+1}) exp(c_2 w_{k+2}) exp(c_3 w_{k+3}),    d_j = d_{j-1} exp(w_j),            (1)

c_1, c_2, c_3 being the cumulative basis functions of `bspline` [kim1995general].  Increments w_j may be
longer than half a turn of S^3, as a logarithm never is: knots far apart may see whole turns.  A turn of
d_j by exp(delta_j) changes, to first order,

    w_j by eta_j = Jr^-1(w_j) delta_j - Jl^-1(w_j) delta_{j-1},                                       (2)
    X by xi = Ad(~t_0) delta_k + sum_l Ad(~t_l) c_l Jr(c_l w_{k+l}) eta_{k+l}, t_l what follows factor l,    (3)
    a miss e = ln(X^-1 q) by -Jl^-1(e) xi                                                             (4)

[sommer2020], so that the normal equations of sum w |e|^2 have a band of 12.
"""

from __future__ import annotations

import math

from quatspline.fitting.bspline import middle, set_segment, spacing, weight_after, weight_before
from quatspline.fitting.reinsch import add_block
from quatspline.kernels.jacobians import inverse_jacobian_matrix, jacobian_matrix
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.values import (
    Mat,
    Vec,
    exp,
    log,
    norm,
    polar,
    put_quat,
    put_vec,
    quat_at,
    rotate,
    transposed,
    unit,
    vec,
    vec_at,
)

# notation: row i of cover (n, 3) holds c_1, c_2, c_3 of keyframe i, which lies on segment at[i]; row j of
# w (N + 3, 3) holds w_j, row 0 nothing.

BAND = 12
"""Entries of a row of the normal equations' lower half: four controls of three components."""

FLAT = 1e-6
"""Sine of a half angle below which a logarithm's direction is rounding."""

SINGULAR = 1e-3
"""Sine of a half angle, of a whole turn or more, where (2) is taken a little beside."""


@inlined
def _ends(h, k):
    """m and p of (2) and (3) in `bspline` as segment k needs them, and the middle function's coefficients."""
    h1, h2, h3 = spacing(h, k - 1, False, True), h[k], spacing(h, k + 1, False, True)
    before = weight_before(spacing(h, k - 2, False, True), h1, h2)
    after = weight_before(h1, h2, h3)
    last = weight_after(h2, h3, spacing(h, k + 2, False, True))
    return before, middle(h1, h2, h3, after), last


@compiled
def basis(h, at, u, cover):
    """Fill in cover at local parameters u (n,) of segments at (n,), of spacings h (N,)."""
    for i in range(u.size):
        before, f, last = _ends(h, at[i])
        x, y = u[i], 1.0 - u[i]
        cover[i, 0] = 1.0 - before * y * y * y
        cover[i, 1] = f[0] + x * (f[1] + x * (f[2] + x * f[3]))
        cover[i, 2] = last * x * x * x


@compiled
def write(h, d, w, segments):
    """Constants of `cumulative` for every segment; returns their reach."""
    reach = 0.0
    for k in range(h.size):
        before, f, last = _ends(h, k)
        x, y, z = vec_at(w[k + 1], 0), vec_at(w[k + 2], 0), vec_at(w[k + 3], 0)
        reach = max(reach, set_segment(segments[k], quat_at(d[k], 0), x, y, z, before, f, last))
    return reach


# -- increments -----------------------------------------------------------------------------------


@inlined
def _branch(q, guess):
    """The logarithm of q nearest to a guess: where q is 1 or -1, which have many, along the guess."""
    v = log(q)
    sine = norm(vec(q))
    length, along = polar(guess)
    halves = math.floor(length / math.pi + 0.5)
    if sine < FLAT:
        if halves == 0.0:
            return v
        left = (vec(q) @ along) * (1.0 if q.w > 0.0 else -1.0)
        return (math.pi * halves + left) * along
    length, along = polar(v)
    turns = math.floor((guess @ along - length) / (2.0 * math.pi) + 0.5)
    return (length + 2.0 * math.pi * turns) * along


@compiled
def settle(d, w):
    """Take increments of the branch that w is near, and the controls that they lead to exactly."""
    for j in range(1, d.shape[0]):
        step = _branch(~quat_at(d[j - 1], 0) * quat_at(d[j], 0), vec_at(w[j], 0))
        put_vec(w[j], 0, step)
        put_quat(d[j], 0, unit(quat_at(d[j - 1], 0) * exp(step)))


@inlined
def _beside(w):
    """An increment where (2) exists: beside whole turns, at which it does not."""
    length, along = polar(w)
    if length > 1.0 and abs(math.sin(length)) < SINGULAR:
        return (length + SINGULAR) * along
    return w


@compiled
def stepped(d, w, delta, fresh, increments):
    """Fill in controls d exp(delta) and their increments; returns the relative change of all."""
    total = 0.0
    for j in range(d.shape[0]):
        turned = unit(quat_at(d[j], 0) * exp(vec_at(delta[j], 0)))
        put_quat(fresh[j], 0, turned)
        gap = turned - quat_at(d[j], 0)
        total += gap @ gap
        if j > 0:
            inverse = inverse_jacobian_matrix(_beside(vec_at(w[j], 0)))
            eta = inverse @ vec_at(delta[j], 0) - transposed(inverse) @ vec_at(delta[j - 1], 0)
            put_vec(increments[j], 0, vec_at(w[j], 0) + eta)
    return math.sqrt(total / d.shape[0])


# -- misses and their normal equations ------------------------------------------------------------


@compiled
def misses(q, at, cover, d, w, e):
    """Fill in e (n, 3) of (4), in log units."""
    for i in range(q.shape[0]):
        k = at[i]
        x = quat_at(d[k], 0) * exp(cover[i, 0] * vec_at(w[k + 1], 0))
        x = x * exp(cover[i, 1] * vec_at(w[k + 2], 0)) * exp(cover[i, 2] * vec_at(w[k + 3], 0))
        put_vec(e[i], 0, log(~x * quat_at(q[i], 0)))


@inlined
def _adjoint(q):
    """Ad(q): the matrix of the turn q."""
    return Mat(
        rotate(q, Vec(1.0, 0.0, 0.0)), rotate(q, Vec(0.0, 1.0, 0.0)), rotate(q, Vec(0.0, 0.0, 1.0))
    )


@inlined
def _pair(share, w, tail):
    """What a factor exp(share w) adds to (3) per turn of the control before it and of that after it."""
    inverse = inverse_jacobian_matrix(_beside(w))
    outer = _adjoint(~tail) * (share * jacobian_matrix(share * w))
    return -(outer * transposed(inverse)), outer * inverse


@compiled
def normal(at, cover, w, weights, e, band, rhs):
    """Fill in the band (3 (N + 3), BAND) and the right side (N + 3, 3) of the normal equations."""
    band[...] = 0.0
    rhs[...] = 0.0
    for i in range(at.size):
        k = at[i]
        c1, c2, c3 = cover[i, 0], cover[i, 1], cover[i, 2]
        w1, w2, w3 = vec_at(w[k + 1], 0), vec_at(w[k + 2], 0), vec_at(w[k + 3], 0)
        t2 = exp(c3 * w3)
        t1 = exp(c2 * w2) * t2
        x0, y1 = _pair(c1, w1, t1)
        x1, y2 = _pair(c2, w2, t2)
        x2, y3 = _pair(c3, w3, exp(0.0 * w3))
        miss = vec_at(e[i], 0)
        slope = inverse_jacobian_matrix(-miss)
        blocks = (
            slope * (_adjoint(~(exp(c1 * w1) * t1)) + x0),
            slope * (y1 + x1),
            slope * (y2 + x2),
            slope * y3,
        )
        for a in range(4):
            pull = transposed(blocks[a])
            put_vec(rhs[k + a], 0, vec_at(rhs[k + a], 0) + weights[i] * (pull @ miss))
            for b in range(a + 1):
                add_block(band, k + a, k + b, (weights[i] * pull) * blocks[b])
