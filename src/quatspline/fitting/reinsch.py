"""The equations of a smoothing spline on rotations: Reinsch's, lifted to SO(3).

With smoothed keyframes r_i, turns S_i = 2 ln(r_i^-1 r_{i+1}), rates s_i = S_i / h_i and misses
e_i = 2 ln(r_i^-1 q_i), the spline minimises

    F = sum_i w_i |e_i|^2 + lambda sum d^T R^-1 d,    d_j = s_j - s_{j-1},                      (1)

where R is tridiagonal with (h_{j-1} + h_j)/3 and h_j/6: R^-1 d is the acceleration gamma of the
piecewise linear second derivative that those rates ask for.  A turn of r_i by delta_i changes

    s_i by A_i delta_{i+1} - B_i delta_i,   A_i = Jr^-1(S_i)/h_i,   B_i = A_i^T,
    e_i by -M_i^-1 delta_i,                 M_i = Jl(e_i),                                      (2)

so that d changes by D M^-1 delta, and the minimum of the linearised (1) is at

    (R + lambda D W^-1 D^T) gamma = d + D e,    delta = M (e - lambda W^-1 D^T gamma).          (3)

Row j of D holds B_{j-1} M_{j-1}, -(A_{j-1} + B_j) M_j, A_j M_{j+1}.  Closed curves have a row for
every keyframe: body rates do not see the sign with which the curve closes, so that (3) is cyclic.
Taken in the order 0, n-1, 1, n-2, ... (`places`), cyclic rows make a band twice as wide.
"""

from __future__ import annotations

import numpy as np

from quatspline.families.rotation_vector import set_end_rates
from quatspline.inputs.arrays import IntArray
from quatspline.kernels.jacobians import inverse_jacobian_matrix, jacobian_matrix
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.values import (
    Mat,
    exp,
    keyframe,
    log,
    put_quat,
    put_vec,
    quat_at,
    transposed,
    unit,
    vec_at,
)

# notation: bands hold the lower half, entry (i + k, i) at [i, k]; place[i] is the row of keyframe i
# in them, -1 at the ends of an open curve, which have none; iw is 1/w.  A column c of D has blocks in
# the rows of keyframes c - 1, c, c + 1, kept in columns[c] (27).

OPEN, CLOSED = 2, 4
"""Rows of (3) that a row reaches to, in the order of `places`."""


def places(n: int, closed: bool) -> IntArray:
    """The row of every keyframe (n,)."""
    if not closed:
        inner = np.arange(-1, n - 1)
        inner[-1] = -1
        return inner
    i = np.arange(n)
    return np.minimum(2 * i, 2 * (n - 1 - i) + 1)


@inlined
def _before(i, n, closed):
    """The keyframe before i; -1, too, where an open curve has none."""
    return (i + n - 1) % n if closed else i - 1


@inlined
def _rows(place, c, closed):
    """The rows of keyframes c - 1, c, c + 1, -1 where there are none."""
    n = place.size
    before = place[(c + n - 1) % n] if closed or c > 0 else -1
    after = place[(c + 1) % n] if closed or c < n - 1 else -1
    return before, place[c], after


@inlined
def _add(band, i, j, value):
    """Add to entries (i, j) and (j, i)."""
    band[min(i, j), abs(i - j)] += value


@compiled
def flat(h, iw, place, r, k):
    """Add R and D W^-1 D^T of one dimension to bands r and k, where A = B = 1/h and M = 1."""
    n = place.size
    closed = h.size == n
    for c in range(n):
        before = _before(c, n, closed)
        a = 1.0 / h[before] if before >= 0 else 0.0
        b = 1.0 / h[c] if c < h.size else 0.0
        rows = _rows(place, c, closed)
        entries = (a, -(a + b), b)
        for x in range(3):
            for y in range(x + 1):
                if rows[x] >= 0 and rows[y] >= 0:
                    _add(k, rows[x], rows[y], iw[c] * entries[x] * entries[y])
        if rows[1] >= 0:
            _add(r, rows[1], rows[1], (h[before] + h[c]) / 3.0)
            if rows[2] >= 0:
                _add(r, rows[1], rows[2], h[c] / 6.0)


@compiled
def measure(q, r, h, sign, w, place, steps, d, e):
    """Fill in the steps S/2 (segments, 3), d (rows, 3) and e (n, 3); returns sum w |e|^2."""
    n = place.size
    closed = h.size == n
    rss = 0.0
    for i in range(h.size):
        put_vec(steps[i], 0, log(~quat_at(r[i], 0) * keyframe(r, i + 1, sign)))
    for i in range(n):
        miss = 2.0 * log(~quat_at(r[i], 0) * quat_at(q[i], 0))
        put_vec(e[i], 0, miss)
        rss += w[i] * (miss @ miss)
        if place[i] >= 0:
            before = _before(i, n, closed)
            left = (2.0 / h[before]) * vec_at(steps[before], 0)
            put_vec(d[place[i]], 0, (2.0 / h[i]) * vec_at(steps[i], 0) - left)
    return rss


@inlined
def _put_block(columns, k, m):
    put_vec(columns, k, m.a)
    put_vec(columns, k + 3, m.b)
    put_vec(columns, k + 6, m.c)


@inlined
def _block(columns, k):
    return Mat(vec_at(columns, k), vec_at(columns, k + 3), vec_at(columns, k + 6))


@compiled
def linearise(steps, h, e, place, columns):
    """Fill in the columns (n, 27) of D."""
    n = place.size
    closed = h.size == n
    zero = 0.0 * jacobian_matrix(vec_at(e[0], 0))
    for c in range(n):
        before = _before(c, n, closed)
        m = jacobian_matrix(-0.5 * vec_at(e[c], 0))
        a, b = zero, zero
        if before >= 0:
            a = (1.0 / h[before]) * inverse_jacobian_matrix(vec_at(steps[before], 0))
        if c < h.size:
            b = (1.0 / h[c]) * transposed(inverse_jacobian_matrix(vec_at(steps[c], 0)))
        _put_block(columns[c], 0, a * m)
        _put_block(columns[c], 9, -(a + b) * m)
        _put_block(columns[c], 18, b * m)


@compiled
def normal(columns, e, d, iw, place, closed, flat_r, share, factor, band, rhs):
    """Fill in the band (3 rows, .) of share R + factor D W^-1 D^T and the right side d + D e of (3)."""
    n = place.size
    band[...] = 0.0
    for p in range(flat_r.shape[0]):
        put_vec(rhs[p], 0, vec_at(d[p], 0))
        for k in range(flat_r.shape[1]):
            if p + k < flat_r.shape[0]:
                for x in range(3):
                    band[3 * p + x, 3 * k] = share * flat_r[p, k]
    for c in range(n):
        rows = _rows(place, c, closed)
        miss = vec_at(e[c], 0)
        for x in range(3):
            if rows[x] < 0:
                continue
            one = _block(columns[c], 9 * x)
            put_vec(rhs[rows[x]], 0, vec_at(rhs[rows[x]], 0) + one @ miss)
            for y in range(x + 1):
                if rows[y] >= 0:
                    other = transposed(_block(columns[c], 9 * y))
                    add_block(band, rows[x], rows[y], (factor * iw[c]) * (one * other))


@inlined
def add_block(band, i, j, m):
    """Add the 3x3 block of rows i and columns j, and its transpose."""
    if i < j:
        i, j, m = j, i, transposed(m)
    for y in range(3):
        column = (m.a, m.b, m.c)[y]
        for x in range(3):
            if i > j or x >= y:
                band[3 * j + y, 3 * (i - j) + x - y] += column[x]


@compiled
def turns(columns, e, z, iw, place, closed, delta):
    """Fill in delta (n, 3) of (3) from z = lambda gamma (rows, 3); returns the largest angle."""
    n = place.size
    largest = 0.0
    for c in range(n):
        rows = _rows(place, c, closed)
        miss = vec_at(e[c], 0)
        left = miss
        for x in range(3):
            if rows[x] >= 0:
                pull = transposed(_block(columns[c], 9 * x)) @ vec_at(z[rows[x]], 0)
                left = left - iw[c] * pull
        turn = jacobian_matrix(-0.5 * miss) @ left
        put_vec(delta[c], 0, turn)
        largest = max(largest, turn @ turn)
    return np.sqrt(largest)


@compiled
def turned(r, delta, share, fresh):
    """Fill in r exp(share delta / 2); returns the relative change of all, |fresh - r| / |r|."""
    total = 0.0
    for i in range(r.shape[0]):
        old = quat_at(r[i], 0)
        new = unit(old * exp((0.5 * share) * vec_at(delta[i], 0)))
        put_quat(fresh[i], 0, new)
        total += (new - old) @ (new - old)
    return np.sqrt(total / r.shape[0])


@compiled
def trace(r, k, share, factor):
    """Trace of (R + lambda K)^-1 R for bands: factorise, then the inverse within the band; share as in `normal`."""
    m, width = r.shape
    l, s, total = np.empty((m, width)), np.empty((m, width)), 0.0
    for i in range(m):
        for j in range(width):
            x = share * r[i, j] + factor * k[i, j]
            for b in range(1, width - j):
                if i - b >= 0:
                    x -= l[i - b, b] * l[i - b, b + j] * l[i - b, 0]
            l[i, j] = x if j == 0 else x / l[i, 0]
    for i in range(m - 1, -1, -1):
        for j in range(min(width, m - i) - 1, -1, -1):
            x = 1.0 / l[i, 0] if j == 0 else 0.0
            for b in range(1, min(width, m - i)):
                x -= l[i, b] * s[i + min(j, b), abs(j - b)]
            s[i, j] = x
            total += (1.0 if j == 0 else 2.0) * share * r[i, j] * x
    return total


@compiled
def write(r, steps, h, gamma, place, segments):
    """Quintic segments that join the smoothed keyframes at the spline's rates; returns their reach.

    From (1) follow accelerations gamma, 0 at open ends, and velocities s_i - h_i (2 gamma_i + gamma_{i+1})/6.
    """
    n, reach = place.size, 0.0
    for i in range(h.size):
        here, there = place[i], place[(i + 1) % n]
        a0 = 0.5 * vec_at(gamma[max(here, 0)], 0) if here >= 0 else 0.0 * vec_at(gamma[0], 0)
        a1 = 0.5 * vec_at(gamma[max(there, 0)], 0) if there >= 0 else 0.0 * vec_at(gamma[0], 0)
        step, k = vec_at(steps[i], 0), h[i] * h[i] / 6.0
        v0, v1 = step - k * (2.0 * a0 + a1), step + k * (a0 + 2.0 * a1)
        ends = step, v0, (6.0 * k) * a0, v1, (6.0 * k) * a1
        reach = max(reach, set_end_rates(segments[i], quat_at(r[i], 0), *ends))
    return reach
