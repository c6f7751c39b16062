"""Rows of the interpolating cumulative B-spline in its increments: what Newton's method solves.

With K_i = exp(-m_i w_i) exp(p_i w_{i+1}) the curve at knot i is d_i K_i, so that increments w
interpolate where

    K_i^-1 exp(w_{i+1}) K_{i+1} = q_i^-1 q_{i+1}.                                              (1)

Increments and controls are stored component first, so that the loops over knots vectorise.
"""

from __future__ import annotations

import math

import numpy as np

from quatspline.fitting.block_tridiagonal import (
    added,
    backward,
    forward,
    matmul,
    set_vector,
    vector,
)
from quatspline.fitting.bspline import control, set_phantoms, small_log, squared
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.scalars import between, mul, sinc, sinc_near

FAR = 3.2
"""Squared half angle from which `sinc_near` no longer serves."""

BEFORE, AFTER, WHOLE = 0, 3, 6
"""Rows of the jets (s, c, b) of m_k w_k, p_k w_{k+1} and w_{k+1}."""

LOWER, OWN, UPPER, COLUMNS = 0, 9, 18, 64
"""Rows of a sheet of Newton's blocks, so many columns at a time."""


@inlined
def set_jet(s, c, b, k, z):
    """sin|v|/|v|, cos|v| and (1 - s c)/|v|^2, of which Jr(2 v) is made, for |v|^2 = z below FAR."""
    s[k], c[k] = sinc_near(z)
    # The difference cancels where z is small; its series is exact to 1e-12 there.
    series = 2.0 / 3.0 - z * (2.0 / 15.0 - z * (4.0 / 315.0))
    b[k] = series if z < 1e-3 else (1.0 - s[k] * c[k]) / max(z, 1e-3)


@compiled
def set_far_jets(jets, m, p, j, size):
    """`set_jet` of the three multiples of w_j for any size = |w_j|^2."""
    for first in range(BEFORE, WHOLE + 1, 3):
        k = j if first == BEFORE else j - 1
        if k >= 0 and k < m.size:
            factor = m[k] if first == BEFORE else p[k] if first == AFTER else 1.0
            z = factor * factor * size
            s, c = sinc(z)
            jets[first, k], jets[first + 1, k] = s, c
            jets[first + 2, k] = 2.0 / 3.0 if z < 1e-6 else (1.0 - s * c) / z


@compiled
def set_jets(m, p, w, jets):
    """The jets (s, c, b) of m_k w_k, p_k w_{k+1} and w_{k+1} for every knot k, in rows BEFORE,
    AFTER and WHOLE; loops of few constants and no branch, which vectorise."""
    n = m.size
    x, y, z = w[0], w[1], w[2]
    size = np.empty(n + 1)
    for j in range(n + 1):
        size[j] = x[j] * x[j] + y[j] * y[j] + z[j] * z[j]
    s, c, b = jets[BEFORE], jets[BEFORE + 1], jets[BEFORE + 2]
    for k in range(n):
        set_jet(s, c, b, k, m[k] * m[k] * size[k])
    s, c, b = jets[AFTER], jets[AFTER + 1], jets[AFTER + 2]
    for k in range(n):
        set_jet(s, c, b, k, p[k] * p[k] * size[k + 1])
    s, c, b = jets[WHOLE], jets[WHOLE + 1], jets[WHOLE + 2]
    for k in range(n):
        set_jet(s, c, b, k, size[k + 1])
    for j in range(n + 1):
        if not size[j] < FAR:
            set_far_jets(jets, m, p, j, size[j])


@compiled
def set_controls(m, p, w, jets, targets, d):
    """(1): d_k = q_k K_k^-1 with K_k^-1 = exp(-p_k w_{k+1}) exp(m_k w_k)."""
    x, y, z = w[0], w[1], w[2]
    s, c, t, e = jets[BEFORE], jets[BEFORE + 1], jets[AFTER], jets[AFTER + 1]
    q0, q1, q2, q3 = targets[0], targets[1], targets[2], targets[3]
    d0, d1, d2, d3 = d[0], d[1], d[2], d[3]
    for k in range(m.size):
        f, g = m[k] * s[k], -p[k] * t[k]
        after = (e[k], g * x[k + 1], g * y[k + 1], g * z[k + 1])
        turn = mul(*after, c[k], f * x[k], f * y[k], f * z[k])
        d0[k], d1[k], d2[k], d3[k] = mul(q0[k], q1[k], q2[k], q3[k], *turn)


@compiled
def look(problem, w, d, jets, misses):
    """Misses of (2) at w: (sum of squares, largest as a rotation angle).

    In the frame of d_{k+1} they are ln(exp(-w_{k+1}) d_k^-1 d_{k+1}) with the controls (1).
    """
    targets, m, p, sign, clamped = problem
    n = misses.shape[0]
    set_phantoms(w, sign != 0.0, clamped)
    set_jets(m, p, w, jets)
    set_controls(m, p, w, jets, targets, d)
    gaps = np.empty((4, n))
    set_gaps(w, jets, d, gaps)
    total = worst = 0.0
    for k in range(n):
        miss = small_log(*control(gaps, k))
        set_vector(misses, k, miss)
        total += squared(miss)
        worst = max(worst, squared(miss))
    return total, 2.0 * math.sqrt(worst)


@compiled
def set_gaps(w, jets, d, gaps):
    """exp(-w_{k+1}) d_k^-1 d_{k+1}."""
    x, y, z = w[0], w[1], w[2]
    s, c = jets[WHOLE], jets[WHOLE + 1]
    d0, d1, d2, d3 = d[0], d[1], d[2], d[3]
    g0, g1, g2, g3 = gaps[0], gaps[1], gaps[2], gaps[3]
    for k in range(gaps.shape[1]):
        step = between(d0[k], d1[k], d2[k], d3[k], d0[k + 1], d1[k + 1], d2[k + 1], d3[k + 1])
        whole = (c[k], s[k] * x[k + 1], s[k] * y[k + 1], s[k] * z[k + 1])
        g0[k], g1[k], g2[k], g3[k] = between(*whole, *step)


@inlined
def spun(f, a, b, x, y, z):
    """f (I + a [v] + b [v]^2) of v = f (x, y, z), from the jet of v:

    a = -s^2 and b give f Jr(2 v); a = -2 s c and 2 s^2 in place of b give f R(exp v)^T.
    """
    x, y, z = f * x, f * y, f * z
    n = x * x + y * y + z * z
    return (
        f * (1.0 + b * (x * x - n)),
        f * (b * x * y - a * z),
        f * (b * x * z + a * y),
        f * (b * x * y + a * z),
        f * (1.0 + b * (y * y - n)),
        f * (b * y * z - a * x),
        f * (b * x * z - a * y),
        f * (b * y * z + a * x),
        f * (1.0 + b * (z * z - n)),
    )


@inlined
def scattered(sheet, first, j, a):
    """Write a block down column j of the sheet."""
    sheet[(first + 0) * COLUMNS + j] = a[0]
    sheet[(first + 1) * COLUMNS + j] = a[1]
    sheet[(first + 2) * COLUMNS + j] = a[2]
    sheet[(first + 3) * COLUMNS + j] = a[3]
    sheet[(first + 4) * COLUMNS + j] = a[4]
    sheet[(first + 5) * COLUMNS + j] = a[5]
    sheet[(first + 6) * COLUMNS + j] = a[6]
    sheet[(first + 7) * COLUMNS + j] = a[7]
    sheet[(first + 8) * COLUMNS + j] = a[8]


@inlined
def gathered(sheet, first, j):
    """Read a block from column j of the sheet."""
    return (
        sheet[(first + 0) * COLUMNS + j],
        sheet[(first + 1) * COLUMNS + j],
        sheet[(first + 2) * COLUMNS + j],
        sheet[(first + 3) * COLUMNS + j],
        sheet[(first + 4) * COLUMNS + j],
        sheet[(first + 5) * COLUMNS + j],
        sheet[(first + 6) * COLUMNS + j],
        sheet[(first + 7) * COLUMNS + j],
        sheet[(first + 8) * COLUMNS + j],
    )


@compiled
def set_knot_blocks(start, count, m, p, w, jets, sheet):
    """How K_k changes in its own left frame: dK = (P_k d(w_{k+1}) - M_k d(w_k)) K; here

    P_k = p R(exp(-m w_k)) Jl(2 p w_{k+1}), and M_k = m Jr(2 m w_k) where it is needed.
    """
    # slices: an index that starts at 0 cannot be negative, which keeps the loop free of checks
    x, y, z, m, p = w[0, start:], w[1, start:], w[2, start:], m[start:], p[start:]
    s, c = jets[BEFORE, start:], jets[BEFORE + 1, start:]
    t, g = jets[AFTER, start:], jets[AFTER + 2, start:]
    for k in range(count):
        f = 2.0 * s[k] * m[k]
        turn = spun(1.0, -c[k] * f, m[k] * s[k] * f, x[k], y[k], z[k])
        left = spun(p[k], t[k] * t[k], g[k], x[k + 1], y[k + 1], z[k + 1])
        scattered(sheet, UPPER, k, matmul(turn, left))


@compiled
def set_row_blocks(start, count, m, w, jets, sheet):
    """Blocks of rows k = start ... of Newton's system, see `assemble`."""
    x, y, z, m = w[0, start:], w[1, start:], w[2, start:], m[start:]
    s, b = jets[BEFORE, start:], jets[BEFORE + 2, start:]
    t, e, g = jets[WHOLE, start:], jets[WHOLE + 1, start:], jets[WHOLE + 2, start:]
    for k in range(count):
        u, v, t2 = k + 1, m[k + 1], t[k] * t[k]
        back = spun(1.0, -2.0 * t[k] * e[k], 2.0 * t2, x[u], y[u], z[u])
        own = added(
            spun(1.0, -t2, g[k], x[u], y[u], z[u]),
            -1.0,
            spun(v, -s[u] * s[u], b[u], x[u], y[u], z[u]),
        )
        own = added(own, -1.0, matmul(back, gathered(sheet, UPPER, k)))
        lower = matmul(back, spun(m[k], -s[k] * s[k], b[k], x[k], y[k], z[k]))
        scattered(sheet, LOWER, k, lower)
        scattered(sheet, OWN, k, own)


@compiled
def assemble(problem, w, jets, work):
    """Solve Newton's system for (2); work's x holds the misses and then the move.

    Row k, in the frame of d_{k+1}, with R = R(exp(w_{k+1}))^T:
    R M_k x_k + (Jr(2 w_{k+1}) - M_{k+1} - R P_k) x_{k+1} + P_{k+1} x_{k+2} = miss_k.
    """
    _, m, p, sign, _ = problem
    n, misses = w.shape[1] - 2, work[3]
    sheet = np.empty(27 * COLUMNS)
    for start in range(0, n, COLUMNS - 1):
        count = min(COLUMNS - 1, n - start)
        set_knot_blocks(start, count + 1, m, p, w, jets, sheet)
        set_row_blocks(start, count, m, w, jets, sheet)
        for j in range(count):
            lower, own = gathered(sheet, LOWER, j), gathered(sheet, OWN, j)
            upper, rhs = gathered(sheet, UPPER, j + 1), vector(misses, start + j)
            forward(start + j, n, sign != 0.0, lower, own, upper, rhs, work)
    backward(n, sign != 0.0, work)
