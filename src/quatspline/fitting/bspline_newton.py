"""Newton's method on the increments of the interpolating B-spline, with its safeguards.

Steps are capped and halved while the misses do not fall (Armijo); where that stalls, the data are
eased in: the steps between keyframes are scaled from a quarter to their full size.
"""

from __future__ import annotations

import math

import numpy as np

from quatspline.fitting.block_tridiagonal import workspace
from quatspline.fitting.bspline import increments, tie
from quatspline.fitting.bspline_rows import assemble, look
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.quick import exp, log
from quatspline.kernels.values import (
    put_quat_column,
    put_vec,
    put_vec_column,
    quat_column,
    vec_at,
    vec_column,
)

CAP = 0.8
"""Largest half angle by which one Newton update may turn an increment."""

ARMIJO = 1e-4

SHORTEST = 1e-3
"""A step length below this means that Newton's direction no longer descends."""

STAGE = 40
"""Updates after which a descent counts as stalled: those that succeed need 4 to 10."""

LEAST_GROWTH = 1.0 / 256.0

LOOSE = 1e-5
"""Tolerance of the homotopy's inner stages."""

TIES, QUADRATIC = 3, 1e-8
"""Corrections by `tie` at most; each squares the gap, and after one of 1e-8 nothing is left."""

ROUNDING = 1e-13
"""Misses below this are rounding: there the line search has nothing left to compare."""


@inlined
def copy(source, target, factor):
    """target = factor source, over the columns of source."""
    for c in range(source.shape[0]):
        for k in range(source.shape[1]):
            target[c, k] = factor * source[c, k]


@inlined
def moved(d, old, count):
    """Relative change of the first count controls."""
    total = 0.0
    for k in range(count):
        change = quat_column(d, k) - quat_column(old, k)
        total += change @ change
    return math.sqrt(total / count)


@compiled
def descend(problem, w, controls, tolerance, by_change, limit):
    """Newton's method with capped, halved steps: (updates, residual, change, met, side).

    Changes w in place; controls[side] then belongs to it.
    """
    n, cyclic, side = w.shape[1] - 2, problem[3] != 0.0, 0
    work, move, jets = workspace(n, cyclic), np.empty((n, 3)), np.empty((9, n + 1))
    total, worst = look(problem, w, controls[0], jets, work[3])
    updates, change, met = 0, 0.0, not by_change and worst <= tolerance
    while updates < limit and not met:
        assemble(problem, w, jets, work)
        longest = keep(work[3], move)
        if not longest < math.inf:
            break
        length, before, known = min(1.0, CAP / longest), total, worst
        shift(w, move, length, 1)
        while True:
            total, worst = look(problem, w, controls[1 - side], jets, work[3])
            if total <= (1.0 - 2.0 * ARMIJO * length) * before or worst <= ROUNDING:
                break
            length *= 0.5
            if not length >= SHORTEST:
                shift(w, move, -2.0 * length, 1)
                return updates, known, change, False, side
            shift(w, move, -length, 1)
        side, updates = 1 - side, updates + 1
        change = moved(controls[side], controls[1 - side], n if cyclic else n + 1)
        met = change <= tolerance if by_change else worst <= tolerance
        if not (met or total < before):
            break
    return updates, worst, change, met, side


@inlined
def keep(x, move):
    """Copy Newton's move; returns its longest vector, infinite where one is not finite."""
    longest, doubt = 0.0, 0.0
    for k in range(x.shape[0]):
        step = vec_at(x[k], 0)
        put_vec(move[k], 0, step)
        longest = max(longest, step @ step)
        doubt += 0.0 * (step @ step)
    return math.sqrt(longest) if doubt == 0.0 else math.inf


@inlined
def shift(w, move, length, first):
    """Columns of w from the first on, moved by a length of the move."""
    for k in range(move.shape[0]):
        put_vec_column(w, k + first, vec_column(w, k + first) + length * vec_at(move[k], 0))


@compiled
def continued(problem, w, controls, tolerance, by_change, limit):
    """Homotopy in the data: the steps are eased to a share of themselves, which then grows to 1.

    What an eased problem's solution says about the next share starts the next descent.  Gives
    the keyframes themselves as controls where it fails.
    """
    targets, m, p, sign, clamped = problem
    eased, best = np.empty(targets.shape), np.empty(w.shape)
    done, growth, updates = 0.0, 0.25, 0
    while growth > LEAST_GROWTH and updates < limit:
        share = min(1.0, done + growth)
        ease(targets, share, eased, w)
        if done > 0.0:  # the outer columns stay: they may be a clamped curve's ends
            copy(best[:, 1:-1], w[:, 1:-1], share / done)
        last = share == 1.0
        more, _, change, met, side = descend(
            problem if last else (eased, m, p, sign, clamped),
            w,
            controls,
            tolerance if last else LOOSE,
            by_change and last,
            min(STAGE, limit - updates),
        )
        updates += more
        if met and last:
            return updates, change, True, side
        if met:
            copy(w, best, 1.0)
            done, growth = share, 2.0 * growth
        else:
            growth *= 0.5
    copy(targets, controls[0], 1.0)
    return updates, 0.0, False, 0


@compiled
def ease(targets, share, eased, w):
    """Targets whose steps are a share of the given ones, and those steps' logarithms w.

    Only steps count in (2), so that the end of a closed chain need not be its start.
    """
    put_quat_column(eased, 0, quat_column(targets, 0))
    for k in range(targets.shape[1] - 1):
        step = share * log(~quat_column(targets, k) * quat_column(targets, k + 1))
        put_vec_column(w, k + 1, step)
        put_quat_column(eased, k + 1, quat_column(eased, k) * exp(step))


@compiled
def newton(problem, w, controls, tolerance, by_change, limit):
    """Newton from the steps' logarithms, then by homotopy: (updates, change, met, side)."""
    increments(problem[0], w)
    updates, worst, change, met, side = descend(
        problem, w, controls, tolerance, by_change, min(STAGE, limit)
    )
    if not met and worst > ROUNDING and updates < limit:
        more, change, met, side = continued(
            problem, w, controls, tolerance, by_change, limit - updates
        )
        updates += more
    return updates, change, met, side


@compiled
def settle(d, w, met):
    """Increments that lead exactly from control to control, d_{k+1} = d_k exp(w_{k+1})."""
    if not met:
        increments(d, w)
    else:
        for _ in range(TIES):
            if tie(d, w) <= QUADRATIC:
                break
