"""Newton's method on the end velocities of Nielson's nu-spline (`nu_rows`), with its safeguards.

It starts from the solution of the flat equations.  Steps are capped and halved while the misses do
not fall (Armijo).  The equations have other solutions than the one that grows out of small steps
between keyframes, with turns to and fro, so that a descent begins only where the misses are small;
elsewhere, and where it stalls, the steps between keyframes are eased in.
"""

from __future__ import annotations

import math

import numpy as np

from quatspline.fitting.block_tridiagonal import workspace
from quatspline.fitting.bspline_newton import (
    ARMIJO,
    CAP,
    LEAST_GROWTH,
    LOOSE,
    ROUNDING,
    SHORTEST,
    STAGE,
    copy,
    ease,
    keep,
    moved,
    shift,
)
from quatspline.fitting.nu_rows import assemble, leg_end, leg_start, look
from quatspline.kernels.jit import CHANGE, ITERATIONS, RESIDUAL, compiled
from quatspline.kernels.quick import exp
from quatspline.kernels.values import (
    keyframe,
    put_quat,
    put_quat_column,
    put_vec,
    quat_at,
    vec_at,
    vec_column,
)

ASTRAY = 0.5 * math.pi
"""Misses in rad from which a descent might end at another solution than the nearest."""

FLAT = 2.0**-20
"""Share of the data's steps at which the equations are linear to 1e-6."""


@compiled
def _set_flat(problem, x, move):
    """The solution of the flat equations as a move from g = 0, (unknowns, 3)."""
    targets, a, mu, delta, f, cyclic = problem
    w, eased = x[1], np.empty(targets.shape)
    ease(targets, FLAT, eased, w)
    flat = (eased, a, mu, delta, f, cyclic)
    work = workspace(max(move.shape[0], 1), cyclic)
    look(flat, x, work[3])
    if move.shape[0] > 0:
        assemble(flat, x, work)
    for k in range(move.shape[0]):
        put_vec(move[k], 0, (1.0 / FLAT) * vec_at(work[3][k], 0))


@compiled
def _descend(problem, x, old, tolerance, by_change, limit):
    """Newton's method with capped, halved steps from g: (updates, residual, change, met)."""
    g, _, d = x
    cyclic = problem[5]
    first, n = (0, g.shape[1] - 1) if cyclic else (1, g.shape[1] - 2)
    work, move = workspace(max(n, 1), cyclic), np.empty((n, 3))
    total, worst = look(problem, x, work[3])
    updates, change = 0, 0.0
    met = n == 0 or (not by_change and worst <= tolerance)
    while worst <= ASTRAY and updates < limit and not met:
        assemble(problem, x, work)
        longest = keep(work[3], move)
        if not longest < math.inf:
            break
        copy(d, old, 1.0)
        length, before, known = CAP / max(longest, CAP), total, worst
        shift(g, move, length, first)
        while True:
            total, worst = look(problem, x, work[3])
            if total <= (1.0 - 2.0 * ARMIJO * length) * before or worst <= ROUNDING:
                break
            length *= 0.5
            shift(g, move, -length, first)
            if not length >= SHORTEST:
                shift(g, move, -length, first)
                return updates, known, change, False
        updates, change = updates + 1, moved(d, old, n + 1)
        met = change <= tolerance if by_change else worst <= tolerance
        if not (met or total < before):
            break
    return updates, worst, change, met


@compiled
def _solve(problem, x, tolerance, by_change, limit):
    """Newton's method for the whole data's steps or, where that fails, for a growing share of them.

    Gives (updates, residual, change); x is what it ended with.
    """
    targets, a, mu, delta, f, cyclic = problem
    g, w, d = x
    unknowns = g.shape[1] - (1 if cyclic else 2)
    eased, best, old = np.empty(targets.shape), np.zeros(g.shape), np.empty(d.shape)
    flat = np.empty((unknowns, 3))
    _set_flat(problem, x, flat)
    shift(best, flat, 1.0, 0 if cyclic else 1)
    done, growth, updates, worst, change = 0.0, 1.0, 0, math.inf, 0.0
    while growth > LEAST_GROWTH and updates < limit:
        step = min(growth, 1.0 - done)
        share, last = done + step, step == 1.0 - done
        ease(targets, share, eased, w)
        copy(best, g, share / done if done > 0.0 else share)
        more, worst, change, met = _descend(
            problem if last else (eased, a, mu, delta, f, cyclic),
            x,
            old,
            tolerance if last else LOOSE,
            by_change and last,
            min(STAGE, limit - updates),
        )
        updates += more
        if last and (met or worst <= ROUNDING):
            return updates, worst, change
        if met:
            copy(g, best, 1.0)
            done, growth = share, 2.0 * step
        else:
            growth = 0.5 * step
    copy(best, g, 1.0 / done if done > 0.0 else 1.0)
    _, worst = look(problem, x, np.empty((max(unknowns, 1), 3)))
    return updates, worst, change


@compiled
def _pose(q, weights, closed, sign):
    """The problem of `nu_rows` for weights (lambda, mu, delta) of every keyframe, (n, 3)."""
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

    Any g gives legs that meet in keyframes with one velocity; the residual is by how much the
    control quaternions differ that the legs on both sides of a keyframe ask for.
    """
    count = legs.shape[0]
    x = np.zeros((3, count + 1)), np.empty((3, count + 2)), np.empty((4, count + 1))
    problem = _pose(q, weights, closed, sign)
    report[ITERATIONS], report[RESIDUAL], report[CHANGE] = _solve(
        problem, x, tolerance, by_change, limit
    )
    g, w, _ = x
    for i in range(count):
        right, left = leg_start(problem, g, i), leg_end(problem, g, i + 1)
        if not closed and i == 0:
            right = quat_at(q[0], 0) * exp(weights[0, 1] * vec_column(w, 1))
        if not closed and i == count - 1:
            left = quat_at(q[count], 0) * exp((weights[count, 0] - 1.0) * vec_column(w, count))
        put_quat(legs[i, 0], 0, right)
        put_quat(legs[i, 1], 0, left)
