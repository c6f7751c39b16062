"""Rows of Nielson's nu-spline in its end velocities: what Newton's method solves.

With a_i = 1 - lambda_i and f_i = lambda_i - mu_{i-1} the legs of the control polygon at a keyframe
lie on one arc through it, and the next leg's begins where this one's ends:

    L_i = q_i exp(-delta_i g_i),    R_i = q_i exp((1 - delta_i) g_i),                            (1)
    w_i = ln(R_{i-1}^-1 L_i) / f_i = ln(d_{i-1}^-1 d_i),                                         (2)

so that q_i = slerp(L_i, R_i, delta_i) for any g, and what is left to solve is that the control d_i is
one point, whether reached from L_i or from R_i:

    L_i^-1 R_i = exp(g_i) = exp(a_i w_i) exp(mu_i w_{i+1}).                                      (3)

The g are 1/3 (h_{i-1} + h_i) times half the angular velocity.  As free vectors they follow the curve
where |g| or |w| passes pi, and d_i from d_{i-1} or R_i from L_i goes the other way round by a slerp
from end to end; what must stay below pi are the arcs of which the segments are made.
"""

from __future__ import annotations

import math

import numpy as np

from quatspline.fitting.block_tridiagonal import backward, forward, workspace
from quatspline.fitting.bspline import set_phantoms
from quatspline.fitting.newton import ease, newton
from quatspline.kernels.jacobians import inverse_jacobian_matrix, jacobian_matrix, turn_matrix
from quatspline.kernels.jit import CHANGE, ITERATIONS, RESIDUAL, compiled, inlined
from quatspline.kernels.quick import exp, log
from quatspline.kernels.values import (
    keyframe,
    put_quat,
    put_quat_column,
    put_vec,
    put_vec_column,
    quat_at,
    quat_column,
    vec_at,
    vec_column,
)

# notation: a problem is (targets, a, mu, delta, f, cyclic): keyframes (4, N + 1) and the weights at
# every knot, those of the ends of open data such that d is the keyframe; x is (g, d, w), where
# g (3, N + 1) of open data is 0 at both ends, d (4, N + 1) and w (3, N + 2).

ASTRAY = 0.5 * math.pi
"""Misses in rad from which a descent might end at another solution than the nearest."""

FLAT = 2.0**-20
"""Share of the data's steps at which the equations are linear to 1e-6."""


@inlined
def leg_end(problem, g, k):
    """L_k of (1)."""
    targets, _, _, delta, _, _ = problem
    return quat_column(targets, k) * exp(-delta[k] * vec_column(g, k))


@inlined
def leg_start(problem, g, k):
    """R_k of (1)."""
    targets, _, _, delta, _, _ = problem
    return quat_column(targets, k) * exp((1.0 - delta[k]) * vec_column(g, k))


@compiled
def _set_polygon(problem, x):
    """w of (2) and d; returns the largest |arc|^2 from a keyframe to the ends of its legs."""
    _, a, _, delta, f, cyclic = problem
    g, d, w = x
    n, longest = g.shape[1] - 1, 0.0
    if cyclic:
        put_vec_column(g, n, vec_column(g, 0))
    for k in range(1, n + 1):
        step = log(~leg_start(problem, g, k - 1) * leg_end(problem, g, k))
        put_vec_column(w, k, (1.0 / f[k]) * step)
    set_phantoms(w, cyclic, False)
    for k in range(n + 1):
        put_quat_column(d, k, leg_end(problem, g, k) * exp(a[k] * vec_column(w, k)))
        arc = max(delta[k], 1.0 - delta[k]) * vec_column(g, k)
        longest = max(longest, arc @ arc)
    return longest


@compiled
def look(problem, x, misses):
    """What (3) misses at g, ln(exp(-g) exp(a w) exp(mu w)): (sum of squares, largest as an angle).

    Infinite where an arc from a keyframe to the end of a leg is half a turn of S^3 or more, which a
    segment cannot follow.
    """
    _, a, mu, _, _, cyclic = problem
    g, _, w = x
    longest = _set_polygon(problem, x)
    total = worst = 0.0
    first = 0 if cyclic else 1
    for k in range(first, g.shape[1] - 1):
        before, after = exp(a[k] * vec_column(w, k)), exp(mu[k] * vec_column(w, k + 1))
        miss = log(exp(-vec_column(g, k)) * before * after)
        put_vec(misses[k - first], 0, miss)
        total += miss @ miss
        worst = max(worst, miss @ miss)
    if not (longest < math.pi**2 and total < math.inf):
        return math.inf, math.inf
    return total, 2.0 * math.sqrt(worst)


@inlined
def _moving(f, v):
    """f Jr(f v): how exp(f v) moves with v."""
    return f * jacobian_matrix(f * v)


@compiled
def _segment_blocks(problem, x, k):
    """V and U of dw_k = V dg_{k-1} + U dg_k, from (2)."""
    _, _, _, delta, f, _ = problem
    g, _, w = x
    step = f[k] * vec_column(w, k)
    start = _moving(1.0 - delta[k - 1], vec_column(g, k - 1))
    end = -_moving(-delta[k], vec_column(g, k))
    share = -1.0 / f[k]
    v = share * (inverse_jacobian_matrix(-step) * start)
    return v, share * (inverse_jacobian_matrix(step) * end)


@compiled
def assemble(problem, x, work):
    """Solve Newton's system for (3); work's x holds the misses and then the move.

    With A = R(exp(mu w_{k+1}))^T a Jr(a w_k) and B = mu Jr(mu w_{k+1}), row k is
    A V_k x_{k-1} + (A U_k + B V_{k+1} - Jr(g_k)) x_k + B U_{k+1} x_{k+1} = -miss_k.
    """
    _, a, mu, _, _, cyclic = problem
    g, _, w = x
    n, first = g.shape[1] - 1, 0 if cyclic else 1
    v, u = _segment_blocks(problem, x, n if cyclic else 1)
    for k in range(first, n):
        step = vec_column(w, k + 1)
        before = turn_matrix(-mu[k] * step) * _moving(a[k], vec_column(w, k))
        after = _moving(mu[k], step)
        lower, own = before * v, before * u
        v, u = _segment_blocks(problem, x, k + 1)
        own = own + after * v - jacobian_matrix(vec_column(g, k))
        rhs = -vec_at(work[3][k - first], 0)
        forward(k - first, n - first, cyclic, lower, own, after * u, rhs, work)
    backward(n - first, cyclic, work)


_, _SOLVE = newton(look, assemble)


@compiled
def _set_flat(problem, x, start):
    """The solution g of the flat equations, by one step from 0."""
    eased = np.empty(problem[0].shape)
    ease(problem[0], FLAT, eased)
    flat, cyclic = (eased, *problem[1:]), problem[5]
    work = workspace(max(start.shape[1], 1), cyclic)
    look(flat, x, work[3])
    if start.shape[1] > 0:
        assemble(flat, x, work)
    for k in range(start.shape[1]):
        put_vec_column(start, k, (1.0 / FLAT) * vec_at(work[3][k], 0))


@compiled
def _pose(q, weights, closed, sign):
    """The problem for weights (lambda, mu, delta) of every keyframe, (n, 3)."""
    n, count = q.shape[0], q.shape[0] + (1 if closed else 0)
    targets, rows = np.empty((4, count)), np.zeros((4, count))
    for i in range(count):
        put_quat_column(targets, i, keyframe(q, i, sign))
        if closed or 0 < i < n - 1:
            k = i % n
            rows[0, i], rows[1, i], rows[2, i] = 1.0 - weights[k, 0], weights[k, 1], weights[k, 2]
        if i > 0:
            rows[3, i] = 1.0 - rows[0, i] - rows[1, i - 1]
    return targets, rows[0], rows[1], rows[2], rows[3], closed


@compiled
def newton_legs(q, weights, closed, sign, tolerance, by_change, limit, legs, report):
    """R_i and L_{i+1} of every segment i, legs (segments, 2, 4); fills a fit kernel's report.

    Newton's method starts from the solution of the flat equations: others than the one that grows out of
    small steps between keyframes have turns to and fro.  Any g gives legs that meet in keyframes with
    one velocity; the residual is by how much the control quaternions differ that the legs on both
    sides of a keyframe ask for.
    """
    count, first = legs.shape[0], 0 if closed else 1
    x = np.zeros((3, count + 1)), np.empty((4, count + 1)), np.empty((3, count + 2))
    problem, start = _pose(q, weights, closed, sign), np.empty((3, count - first))
    _set_flat(problem, x, start)
    free = first, count, count - first + 1, ASTRAY
    report[ITERATIONS], report[RESIDUAL], report[CHANGE], _ = _SOLVE(
        problem, x, start, 1.0, closed, free, tolerance, by_change, limit
    )
    g, _, w = x
    for i in range(count):
        right, left = leg_start(problem, g, i), leg_end(problem, g, i + 1)
        if not closed and i == 0:
            right = quat_at(q[0], 0) * exp(weights[0, 1] * vec_column(w, 1))
        if not closed and i == count - 1:
            left = quat_at(q[count], 0) * exp((weights[count, 0] - 1.0) * vec_column(w, count))
        put_quat(legs[i, 0], 0, right)
        put_quat(legs[i, 1], 0, left)
