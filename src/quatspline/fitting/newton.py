"""Newton's method for vectors at keyframes whose equations couple neighbours, with its safeguards.

Steps are capped and halved while the misses do not fall (Armijo); where that stalls, or would begin
far astray, the data are eased in: the steps between keyframes grow from a share of themselves.

A problem is a tuple whose first entry are the targets (4, N + 1): the keyframes, of which only the
steps count.  x is (the unknowns (3, columns), controls (4, N + 1), what else the functions keep).
`newton` makes the method of a problem's two functions:

    look(problem, x, misses)       the misses (n, 3) at x: (sum of squares, largest as a rotation angle)
    assemble(problem, x, work)     Newton's system solved; work's x holds the misses, and then the move
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from quatspline.fitting.block_tridiagonal import workspace
from quatspline.kernels.jit import bound, compiled, inlined
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
"""Largest half angle by which one Newton update may turn an unknown."""

ARMIJO = 1e-4

SHORTEST = 1e-3
"""A step length below this means that Newton's direction no longer descends."""

STAGE = 40
"""Updates after which a descent counts as stalled: those that succeed need 4 to 10."""

LEAST_GROWTH = 1.0 / 256.0

LOOSE = 1e-5
"""Tolerance of the homotopy's inner stages."""

STALLED = 4 * np.finfo(float).eps
"""A relative change of controls this small moves nothing any more."""

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


@inlined
def _keep(x, move):
    """Copy Newton's move; returns its longest vector, infinite where one is not finite."""
    longest, doubt = 0.0, 0.0
    for k in range(x.shape[0]):
        step = vec_at(x[k], 0)
        put_vec(move[k], 0, step)
        longest = max(longest, step @ step)
        doubt += 0.0 * (step @ step)
    return math.sqrt(longest) if doubt == 0.0 else math.inf


@inlined
def _shift(w, move, length):
    """Columns of w moved by a length of the move."""
    for k in range(move.shape[0]):
        put_vec_column(w, k, vec_column(w, k) + length * vec_at(move[k], 0))


@compiled
def ease(targets, share, eased):
    """Targets whose steps are a share of the given ones: a closed chain need not end at its start."""
    put_quat_column(eased, 0, quat_column(targets, 0))
    for k in range(targets.shape[1] - 1):
        step = share * log(~quat_column(targets, k) * quat_column(targets, k + 1))
        put_quat_column(eased, k + 1, quat_column(eased, k) * exp(step))


LOOK: Any = None
ASSEMBLE: Any = None
DESCEND: Any = None
"""What copies of the templates below find in their place."""


def _descend(problem, x, cyclic, free, tolerance, by_change, limit):
    """Newton's method with capped, halved steps, which change x: (updates, residual, change, met).

    ``free`` says which columns of the unknowns move, from a first to before a stop, how many controls
    count in a change, and the largest miss from which a step is taken.
    """
    first, stop, controls, astray = free
    n, v, d = stop - first, x[0][:, first:stop], x[1]
    work, move, old = workspace(max(n, 1), cyclic), np.empty((n, 3)), np.empty(d.shape)
    total, worst = LOOK(problem, x, work[3])
    updates, change = 0, 0.0
    met = n == 0 or (not by_change and worst <= tolerance)
    while worst <= astray and updates < limit and not met:
        ASSEMBLE(problem, x, work)
        longest = _keep(work[3], move)
        if not longest < math.inf:
            break
        copy(d, old, 1.0)
        length, before, known = CAP / max(longest, CAP), total, worst
        _shift(v, move, length)
        while True:
            total, worst = LOOK(problem, x, work[3])
            if total <= (1.0 - 2.0 * ARMIJO * length) * before or worst <= ROUNDING:
                break
            length *= 0.5
            _shift(v, move, -length)
            if not length >= SHORTEST:
                _shift(v, move, -length)
                copy(old, d, 1.0)
                return updates, known, change, False
        updates, change = updates + 1, moved(d, old, controls)
        met = change <= tolerance if by_change else worst <= tolerance
        if not (met or total < before):
            break
    return updates, worst, change, met


def _solve(problem, x, start, growth, cyclic, free, tolerance, by_change, limit):
    """Descend for a share of the data's steps, at first ``growth``, which grows to 1.

    Begins with ``start``, the unknowns of the whole data were the equations linear, and goes on with what an
    eased problem's solution says about the next share.  Gives (updates, residual, change, met);
    where it fails, x is the last solution, stretched to the whole.
    """
    v, eased = x[0][:, free[0] : free[1]], np.empty(problem[0].shape)
    done, updates, worst, change = 0.0, 0, math.inf, 0.0
    while growth > LEAST_GROWTH and updates < limit:
        step = min(growth, 1.0 - done)
        share, last = done + step, step == 1.0 - done
        ease(problem[0], share, eased)
        copy(start, v, share / done if done > 0.0 else share)
        more, worst, change, met = DESCEND(
            problem if last else (eased, *problem[1:]),
            x,
            cyclic,
            free,
            tolerance if last else LOOSE,
            by_change and last,
            min(STAGE, limit - updates),
        )
        updates += more
        if last and (met or worst <= ROUNDING):
            return updates, worst, change, met
        if met:
            copy(v, start, 1.0)
            done, growth = share, 2.0 * step
        else:
            growth = 0.5 * step
    copy(start, v, 1.0 / done if done > 0.0 else 1.0)
    _, worst = LOOK(problem, x, np.empty((max(v.shape[1], 1), 3)))
    return updates, worst, change, False


def newton(look: Callable[..., Any], assemble: Callable[..., Any]) -> tuple[Any, Any]:
    """`_descend` and `_solve` for a problem's functions; to be called in the file of these."""
    descend = compiled(bound(_descend, LOOK=look, ASSEMBLE=assemble))
    return descend, compiled(bound(_solve, LOOK=look, DESCEND=descend))
