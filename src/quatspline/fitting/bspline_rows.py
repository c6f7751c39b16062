"""Rows of the interpolating cumulative B-spline in its increments: what Newton's method solves.

With K_i = exp(-m_i w_i) exp(p_i w_{i+1}) the curve at knot i is d_i K_i, so that increments w
interpolate where

    K_i^-1 exp(w_{i+1}) K_{i+1} = q_i^-1 q_{i+1}.                                              (1)

A problem is (targets, m, p, sign, clamped), x is (w, d, jets), see `newton`.  Increments and
controls are stored component first, so that the loops over knots vectorise.
"""

from __future__ import annotations

import math

import numpy as np

from quatspline.fitting.block_tridiagonal import backward, forward
from quatspline.fitting.bspline import increments, set_phantoms
from quatspline.fitting.newton import ROUNDING, STAGE, copy, newton
from quatspline.kernels.jacobians import coefficients, spun
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.quick import log
from quatspline.kernels.scalars import FITTED, series, sinc
from quatspline.kernels.values import (
    Vec,
    mat_at,
    polar_exp,
    put_mat,
    put_quat_column,
    put_vec,
    quat_column,
    vec_at,
    vec_column,
)

BEFORE, AFTER, WHOLE = 0, 3, 6
"""Rows of the jets (s, c, b) of m_k w_k, p_k w_{k+1} and w_{k+1}."""

LOWER, OWN, UPPER, COLUMNS = 0, 9, 18, 64
"""Rows of a sheet of Newton's blocks, so many columns at a time."""

FIRST = 0.25
"""Share of the data's steps with which the homotopy begins."""


@inlined
def put_jet(jets, first, k, z):
    """s, c and b of `jacobians` for |v|^2 = z below FITTED."""
    s, c = series(z)
    jets[first, k], jets[first + 1, k] = 1.0 + z * s, 1.0 + z * c
    jets[first + 2, k] = -(s + c + z * s * c)


@compiled
def put_far_jets(jets, m, p, j, size):
    """`put_jet` of the three multiples of w_j for any size = |w_j|^2."""
    for first in range(BEFORE, WHOLE + 1, 3):
        k = j if first == BEFORE else j - 1
        if k >= 0 and k < m.size:
            factor = m[k] if first == BEFORE else p[k] if first == AFTER else 1.0
            z = factor * factor * size
            jets[first, k], jets[first + 1, k] = sinc(z)
            _, jets[first + 2, k], _, _ = coefficients(z)


@compiled
def set_jets(m, p, w, jets):
    """The jets of m_k w_k, p_k w_{k+1} and w_{k+1} for every knot k.

    Loops of few constants and no branch, which vectorise.
    """
    n = m.size
    size = np.empty(n + 1)
    for j in range(n + 1):
        size[j] = vec_column(w, j) @ vec_column(w, j)
    for k in range(n):
        put_jet(jets, BEFORE, k, m[k] * m[k] * size[k])
    for k in range(n):
        put_jet(jets, AFTER, k, p[k] * p[k] * size[k + 1])
    for k in range(n):
        put_jet(jets, WHOLE, k, size[k + 1])
    for j in range(n + 1):
        if not size[j] < FITTED:
            put_far_jets(jets, m, p, j, size[j])


@inlined
def _exp(jets, first, k, v):
    """exp(v) from its jet."""
    return polar_exp(jets[first, k], jets[first + 1, k], v)


@compiled
def set_controls(m, p, w, jets, targets, d):
    """(1): d_k = q_k K_k^-1 with K_k^-1 = exp(-p_k w_{k+1}) exp(m_k w_k)."""
    for k in range(m.size):
        after = _exp(jets, AFTER, k, -(p[k] * vec_column(w, k + 1)))
        before = _exp(jets, BEFORE, k, m[k] * vec_column(w, k))
        put_quat_column(d, k, quat_column(targets, k) * (after * before))


@compiled
def look(problem, x, misses):
    """Misses of (2) at w: (sum of squares, largest as a rotation angle).

    In the frame of d_{k+1} they are ln(exp(-w_{k+1}) d_k^-1 d_{k+1}) with the controls (1).
    """
    targets, m, p, sign, clamped = problem
    w, d, jets = x
    set_phantoms(w, sign != 0.0, clamped)
    set_jets(m, p, w, jets)
    set_controls(m, p, w, jets, targets, d)
    gaps = np.empty((4, misses.shape[0]))
    set_gaps(w, jets, d, gaps)
    total = worst = 0.0
    for k in range(misses.shape[0]):
        miss = log(quat_column(gaps, k))
        put_vec(misses[k], 0, miss)
        total += miss @ miss
        worst = max(worst, miss @ miss)
    return total, 2.0 * math.sqrt(worst)


@compiled
def set_gaps(w, jets, d, gaps):
    """exp(-w_{k+1}) d_k^-1 d_{k+1}."""
    for k in range(gaps.shape[1]):
        step = ~quat_column(d, k) * quat_column(d, k + 1)
        put_quat_column(gaps, k, ~_exp(jets, WHOLE, k, vec_column(w, k + 1)) * step)


@inlined
def _rows(a, first, start):
    """Three rows from a column on.

    An index that starts at 0 there cannot be negative, which keeps loops free of checks.
    """
    return a[first, start:], a[first + 1, start:], a[first + 2, start:]


@inlined
def _column(rows, k):
    x, y, z = rows
    return Vec(x[k], y[k], z[k])


@inlined
def _jacobian(jet, k, f, v):
    """f Jr(f v) from the jets of f v."""
    s, _, b = jet
    return spun(f, -s[k] * s[k], b[k], f * v)


@inlined
def _turn_back(jet, k, v):
    """R(exp(v))^T from the jets of v."""
    s, c, _ = jet
    return spun(1.0, -2.0 * s[k] * c[k], 2.0 * s[k] * s[k], v)


@inlined
def set_knot_blocks(start, count, m, p, w, jets, sheet):
    """How K_k changes in its own left frame: dK = (P_k d(w_{k+1}) - M_k d(w_k)) K; here

    P_k = p R(exp(-m w_k)) Jl(p w_{k+1}), and M_k = m Jr(m w_k) where it is needed.
    """
    w, m, p = _rows(w, 0, start), m[start:], p[start:]
    before, after = _rows(jets, BEFORE, start), _rows(jets, AFTER, start)
    for k in range(count):
        turn = _turn_back(before, k, m[k] * _column(w, k))
        left = _jacobian(after, k, p[k], -_column(w, k + 1))
        put_mat(sheet[UPPER:, k], 0, turn * left)


@inlined
def set_row_blocks(start, count, m, w, jets, sheet):
    """Blocks of rows k = start ... of Newton's system, see `assemble`."""
    w, m = _rows(w, 0, start), m[start:]
    before, whole = _rows(jets, BEFORE, start), _rows(jets, WHOLE, start)
    for k in range(count):
        step = _column(w, k + 1)
        back = _turn_back(whole, k, step)
        own = _jacobian(whole, k, 1.0, step) - _jacobian(before, k + 1, m[k + 1], step)
        # read before anything is written, to vectorise
        own = own - back * mat_at(sheet[UPPER:, k], 0)
        lower = back * _jacobian(before, k, m[k], _column(w, k))
        put_mat(sheet[LOWER:, k], 0, lower)
        put_mat(sheet[OWN:, k], 0, own)


@compiled
def assemble(problem, x, work):
    """Solve Newton's system for (2); work's x holds the misses and then the move.

    Row k, in the frame of d_{k+1}, with R = R(exp(w_{k+1}))^T:
    R M_k x_k + (Jr(w_{k+1}) - M_{k+1} - R P_k) x_{k+1} + P_{k+1} x_{k+2} = miss_k.
    """
    _, m, p, sign, _ = problem
    w, _, jets = x
    n, misses = w.shape[1] - 2, work[3]
    sheet = np.empty((27, COLUMNS))
    for start in range(0, n, COLUMNS - 1):
        count = min(COLUMNS - 1, n - start)
        set_knot_blocks(start, count + 1, m, p, w, jets, sheet)
        set_row_blocks(start, count, m, w, jets, sheet)
        for j in range(count):
            lower, own = mat_at(sheet[LOWER:, j], 0), mat_at(sheet[OWN:, j], 0)
            upper, rhs = mat_at(sheet[UPPER:, j + 1], 0), vec_at(misses[start + j], 0)
            forward(start + j, n, sign != 0.0, lower, own, upper, rhs, work)
    backward(n, sign != 0.0, work)


_DESCEND, _SOLVE = newton(look, assemble)


@inlined
def _free(problem, w):
    """Whether the problem is cyclic, and what moves: see `newton`."""
    n, cyclic = w.shape[1] - 2, problem[3] != 0.0
    return cyclic, (1, n + 1, n if cyclic else n + 1, math.inf)


@compiled
def descend(problem, x, tolerance, by_change, limit):
    """Newton's method from the increments in x: (updates, residual, change, met)."""
    return _DESCEND(problem, x, *_free(problem, x[0]), tolerance, by_change, limit)


@compiled
def solve(problem, x, tolerance, by_change, limit):
    """Newton from the steps' logarithms, then by homotopy: (updates, change, met).

    Gives the keyframes themselves as controls where it fails.
    """
    w, d, _ = x
    increments(problem[0], w)
    start = w[:, 1:-1].copy()
    updates, worst, change, met = descend(problem, x, tolerance, by_change, min(STAGE, limit))
    if not met and worst > ROUNDING and updates < limit:
        given = *_free(problem, w), tolerance, by_change, limit - updates
        more, worst, change, met = _SOLVE(problem, x, start, FIRST, *given)
        updates += more
        if not met and worst > ROUNDING:
            copy(problem[0], d, 1.0)
            change = 0.0
    return updates, change, met
