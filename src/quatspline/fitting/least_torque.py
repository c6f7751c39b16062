"""The curve of least torque on a chain of rotation-vector segments, by Gauss-Newton.

The unknowns are velocity and acceleration at every node, and turns of nodes between keyframes.
With 8 Gauss points u_g a segment the sum

    E = sum_s sum_g w_g h_s |alpha_s(u_g)|^2                                                     (1)

is a sum of squares; its normal equations couple neighbouring nodes only: a band of 18 [barr1992].
Of their matrix, row by row, what is left of the diagonal is kept, from the node before on: 126 numbers
a node, in which Cholesky's factor takes the matrix's place.
"""

from __future__ import annotations

import math

import numpy as np

from quatspline.families.rotation_vector import SIZE, half_acceleration, jet, set_end_rates
from quatspline.kernels.jacobians import coefficients, inverse_jacobian_matrix
from quatspline.kernels.jit import CHANGE, ITERATIONS, REACH, compiled, inlined
from quatspline.kernels.values import Quat, exp, log, put_quat, put_vec, quat_at, unit, vec_at

# notation: log units; a node has q (4) and x = (v, a) (6), half the body velocity and acceleration;
# y (15) holds a segment's L, h v_0, h^2 a_0, h v_1, h^2 a_1

POINTS, WEIGHTS = (
    0.5 * (x + k) for x, k in zip(np.polynomial.legendre.leggauss(8), (1, 0), strict=True)
)
"""Gauss quadrature on [0, 1]."""

STEP = 2e-3
"""Of central differences of order 4 over y, whose entries are of order one: truncation 1e-12 and
rounding 1e-13."""

SHIFTS, SHARES = np.array([-2.0, -1.0, 1.0, 2.0]), np.array([1.0, -8.0, 8.0, -1.0]) / (12.0 * STEP)

ROUNDING = 1e-12
"""A relative rise of E that is no rise."""

NODE, BAND = 9, 18
"""Unknowns of a node, a turn, v and a, and of a segment, which has two nodes."""

PACKED = NODE * NODE + NODE * (NODE + 1) // 2
"""Numbers of the matrix that belong to a node: its block with the node before, and half of its own."""

STALL, FLAT = 8, 1e-15
"""Updates without a least change so far, and the share of E that the last of them would have gained by the gradient,
which are rounding of the gradient: smaller changes cannot be had."""

DAMPING, DAMPED, STUCK = 1e-4, 1e-3, 1e8
"""Levenberg's weight: the first, the largest of a step that may end it, the one to give up at."""


@compiled
def _copy(source, target):
    """Element by element: a slice assignment would compile numpy's broadcasting errors too."""
    for i in range(source.size):
        target[i] = source[i]


@compiled
def minimise(nodes, rates, h, m, tolerance, limit, segments, report):
    """Minimise (1) for every track; fills segments and report.

    Returns the energies, and which tracks came to rest at rounding, at a change above the tolerance.
    """
    energies, rest = np.empty(nodes.shape[0]), np.empty(nodes.shape[0], dtype=np.bool_)
    for k in range(nodes.shape[0]):
        energies[k], rest[k] = _minimise(nodes[k], rates[k], h, m, tolerance, limit, report[k])
        y, reach = np.empty(15), 0.0
        for i in range(h.size):
            _ends(nodes[k], rates[k], h, i, y)
            reach = max(reach, _set_segment(segments[k, i], quat_at(nodes[k, i], 0), y))
        report[k, REACH] = reach
    return energies, rest


@compiled
def _minimise(q, x, h, m, tolerance, limit, report):
    n = NODE * q.shape[0]
    matrix, gradient, step = np.empty(PACKED * q.shape[0]), np.empty(n), np.empty(n)
    trial_q, trial_x = q.copy(), x.copy()
    energy = _energy(q, x, h)
    damping, change, done = 0.0, np.inf, 0
    least, least_at, rest = np.inf, 0, False
    while done < limit:
        accepted = False
        while not accepted and damping < STUCK:
            # Factorised in place, and so made again after a refused step: a copy would double the memory.
            _normal_equations(q, x, h, m, matrix, gradient)
            for i in range(n):
                matrix[_row(i) + i] *= 1.0 + damping
            _copy(gradient, step)
            if _solve_band(matrix, step):
                change = _move(q, x, h, step, trial_q, trial_x)
                trial = _energy(trial_q, trial_x, h)
                accepted = trial <= (1.0 + ROUNDING) * energy or change <= tolerance
            if not accepted:
                damping = max(10.0 * damping, DAMPING)
        if not accepted:
            change = np.inf
            break
        q[:], x[:], energy, done = trial_q, trial_x, trial, done + 1
        if change <= tolerance and damping <= DAMPED:
            break
        if change < least:
            least, least_at = change, done
        rest = done - least_at >= STALL and abs(np.sum(gradient * step)) <= FLAT * energy
        if rest:
            break
        damping = 0.1 * damping if damping > DAMPING else 0.0
    report[ITERATIONS], report[CHANGE] = done, change
    return energy, rest


@inlined
def _ends(q, x, h, i, y):
    """y of segment i."""
    k = h[i]
    put_vec(y, 0, log(~quat_at(q[i], 0) * quat_at(q[i + 1], 0)))
    put_vec(y, 3, k * vec_at(x[i], 0))
    put_vec(y, 6, (k * k) * vec_at(x[i], 3))
    put_vec(y, 9, k * vec_at(x[i + 1], 0))
    put_vec(y, 12, (k * k) * vec_at(x[i + 1], 3))


@inlined
def _set_segment(c, q, y):
    step, v0, a0, v1, a1 = vec_at(y, 0), vec_at(y, 3), vec_at(y, 6), vec_at(y, 9), vec_at(y, 12)
    return set_end_rates(c, q, step, v0, a0, v1, a1)


@compiled
def _residuals(y, h, scratch, r):
    """sqrt(w_g h) alpha(u_g) of a segment, r (24,)."""
    _set_segment(scratch, Quat(1.0, 0.0, 0.0, 0.0), y)
    for g in range(POINTS.size):
        phi, d, e = jet(scratch, POINTS[g])
        k = 2.0 * math.sqrt(WEIGHTS[g] / (h * h * h))
        put_vec(r, 3 * g, k * half_acceleration(coefficients(phi @ phi), phi, d, e))


@compiled
def _energy(q, x, h):
    """(1)."""
    y, r, scratch = np.empty(15), np.empty(24), np.empty(SIZE)
    total = 0.0
    for i in range(h.size):
        _ends(q, x, h, i, y)
        _residuals(y, h[i], scratch, r)
        total += np.sum(r * r)
    return total


@inlined
def _first(i):
    """The first column of row i that is kept."""
    return max(0, NODE * (i // NODE - 1))


@inlined
def _row(i):
    """Where row i would begin in the packed matrix, were it kept from column 0 on."""
    node, a = i // NODE, i % NODE
    return PACKED * node + NODE * a + a * (a + 1) // 2 - NODE * (node - 1)


@compiled
def _normal_equations(q, x, h, m, matrix, gradient):
    """J^T J, row i and column j at _row(i) + j, and -J^T r; the turns of keyframes are fixed."""
    matrix.fill(0.0)
    gradient.fill(0.0)
    y, r, scratch = np.empty(15), np.empty(24), np.empty(SIZE)
    jacobian = np.empty((BAND, 24))
    for i in range(h.size):
        _ends(q, x, h, i, y)
        _residuals(y, h[i], scratch, r)
        _jacobian(y, h[i], scratch, jacobian)
        for a in range(BAND):
            row = NODE * i + a
            gradient[row] -= np.sum(jacobian[a] * r)
            for b in range(a + 1):
                matrix[_row(row) + NODE * i + b] += np.sum(jacobian[a] * jacobian[b])
    for i in range(0, q.shape[0], m):
        for row in range(NODE * i, NODE * i + 3):
            _fix(row, matrix, gradient)


@compiled
def _fix(row, matrix, gradient):
    """Make an unknown's equation say that it does not move."""
    gradient[row] = 0.0
    for j in range(_first(row), row):
        matrix[_row(row) + j] = 0.0
    for i in range(row + 1, min(NODE * (row // NODE) + BAND, gradient.size)):
        matrix[_row(i) + row] = 0.0
    matrix[_row(row) + row] = 1.0


@compiled
def _jacobian(y, h, scratch, jacobian):
    """Derivatives of the residuals by the turns, v and a of both nodes, (18, 24)."""
    r, by_y = np.empty(24), np.zeros((15, 24))
    for c in range(15):
        keep = y[c]
        for k in range(4):
            y[c] = keep + SHIFTS[k] * STEP
            _residuals(y, h, scratch, r)
            by_y[c] += SHARES[k] * r
        y[c] = keep
    # dL = Jr(L)^-1 d(turn of the second) - Jr(-L)^-1 d(turn of the first)
    first = inverse_jacobian_matrix(-vec_at(y, 0))
    second = inverse_jacobian_matrix(vec_at(y, 0))
    for c in range(3):
        a, b = first[c], second[c]
        jacobian[c] = -(a.x * by_y[0] + a.y * by_y[1] + a.z * by_y[2])
        jacobian[9 + c] = b.x * by_y[0] + b.y * by_y[1] + b.z * by_y[2]
        jacobian[3 + c], jacobian[6 + c] = h * by_y[3 + c], h * h * by_y[6 + c]
        jacobian[12 + c], jacobian[15 + c] = h * by_y[9 + c], h * h * by_y[12 + c]


@compiled
def _solve_band(a, b):
    """Cholesky's solution in place, a packed as by `_row`; False where a is not definite."""
    for i in range(b.size):
        first, row = _first(i), _row(i)
        for j in range(first, i):
            other = _row(j)
            for k in range(first, j):  # at or after what is kept of row j
                a[row + j] -= a[row + k] * a[other + k]
            a[row + j] /= a[other + j]
        for k in range(first, i):
            a[row + i] -= a[row + k] * a[row + k]
        if not a[row + i] > 0.0:
            return False
        a[row + i] = math.sqrt(a[row + i])
        for j in range(i - 1, first - 1, -1):
            b[i] -= a[row + j] * b[j]
        b[i] /= a[row + i]
    for i in range(b.size - 1, -1, -1):
        b[i] /= a[_row(i) + i]
        for j in range(i - 1, _first(i) - 1, -1):
            b[j] -= a[_row(i) + j] * b[i]
    return True


@compiled
def _move(q, x, h, step, new_q, new_x):
    """Nodes after a step; returns its relative change, rates counted per segment and q as 1."""
    moved, size = 0.0, float(q.shape[0])
    for i in range(q.shape[0]):
        k, s = h[min(i, h.size - 1)], step[9 * i : 9 * i + 9]
        turn, dv, da = vec_at(s, 0), vec_at(s, 3), vec_at(s, 6)
        v, a = vec_at(x[i], 0) + dv, vec_at(x[i], 3) + da
        put_quat(new_q[i], 0, unit(quat_at(q[i], 0) * exp(turn)))
        put_vec(new_x[i], 0, v)
        put_vec(new_x[i], 3, a)
        moved += turn @ turn + k * k * (dv @ dv + k * k * (da @ da))
        size += k * k * (v @ v + k * k * (a @ a))
    return math.sqrt(moved / size)
