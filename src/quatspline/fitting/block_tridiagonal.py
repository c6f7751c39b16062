"""Block-tridiagonal systems of 3x3 blocks, open and cyclic, solved in O(n).

    L_k x_{k-1} + D_k x_k + U_k x_{k+1} = r_k,      k = 0 ... n-1                             (1)

Elimination is by blocks, each pivoted by rows.  It takes one row after the other (`forward`), so
that a Newton iteration assembles and eliminates in one sweep and never stores its matrix.  In the
cyclic system, where row 0 also holds x_{n-1} and row n-1 also x_0, every row carries a further
block for x_{n-1}, which a last 3x3 system then gives.  With n = 2 both neighbours are one unknown.
"""

from __future__ import annotations

import numpy as np

from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.values import Mat, Vec, mat_at, put_mat, put_vec, transposed, vec_at

# notation: work = (C, V, last, x): after `forward` x_k + C_k x_{k+1} + V_k x_{n-1} = rhs_k, where V
# is used by cyclic systems only; last holds L, D, U of the cyclic system's last row.  Arrays (n, 9)
# hold blocks column by column.


@inlined
def _less(a, f, b):
    """a - f b for two rows of the system D (X, x) = (U, v)."""
    return a[0] - f * b[0], a[1] - f * b[1], a[2] - f * b[2]


@inlined
def solve(d, u, v):
    """(D^-1 U, D^-1 v) by elimination with row pivoting; not finite where D is singular."""
    d, u = transposed(d), transposed(u)
    a, b, c = (d.a, u.a, v.x), (d.b, u.b, v.y), (d.c, u.c, v.z)
    if abs(b[0].x) > abs(a[0].x):
        a, b = b, a
    if abs(c[0].x) > abs(a[0].x):
        a, c = c, a
    first = 1.0 / a[0].x
    b = _less(b, b[0].x * first, a)
    c = _less(c, c[0].x * first, a)
    if abs(c[0].y) > abs(b[0].y):
        b, c = c, b
    second = 1.0 / b[0].y
    c = _less(c, c[0].y * second, b)
    third = 1.0 / c[0].z
    z, z1 = third * c[1], third * c[2]
    y, y1 = second * (b[1] - b[0].z * z), second * (b[2] - b[0].z * z1)
    x = first * (a[1] - a[0].y * y - a[0].z * z)
    x1 = first * (a[2] - a[0].y * y1 - a[0].z * z1)
    return transposed(Mat(x, y, z)), Vec(x1, y1, z1)


@inlined
def workspace(n, cyclic):
    """Arrays for a system of n blocks: (C, V, last, x)."""
    return np.empty((n, 9)), np.empty((n if cyclic else 1, 9)), np.empty((3, 9)), np.empty((n, 3))


@inlined
def forward(k, n, cyclic, lower, diagonal, upper, rhs, work):
    """Eliminate row k of (1); rows come in order.  lower of row 0 counts in cyclic systems only."""
    if cyclic:
        _forward_cyclic(k, n, lower, diagonal, upper, rhs, work)
        return
    over, _, _, x = work
    if k > 0:
        rhs = rhs - lower @ vec_at(x[k - 1], 0)
        diagonal = diagonal - lower * mat_at(over[k - 1], 0)
    upper, rhs = solve(diagonal, upper, rhs)
    put_mat(over[k], 0, upper)
    put_vec(x[k], 0, rhs)


@compiled
def _forward_cyclic(k, n, lower, diagonal, upper, rhs, work):
    """As `forward`, with a further block for x_{n-1}; the last row is kept for the end."""
    over, border, last, x = work
    if k == n - 1:
        put_mat(last[0], 0, lower)
        put_mat(last[1], 0, diagonal)
        put_mat(last[2], 0, upper)
        put_vec(x[k], 0, rhs)
        return
    side = lower
    if k > 0:
        rhs = rhs - lower @ vec_at(x[k - 1], 0)
        diagonal = diagonal - lower * mat_at(over[k - 1], 0)
        side = -(lower * mat_at(border[k - 1], 0))
    if k == n - 2:  # the upper neighbour is x_{n-1} itself
        side = side + upper
    put_mat(border[k], 0, solve(diagonal, side, rhs)[0])
    upper, rhs = solve(diagonal, upper, rhs)
    put_mat(over[k], 0, upper)
    put_vec(x[k], 0, rhs)


@inlined
def backward(n, cyclic, work):
    """Substitute back; work's x then holds the solution."""
    over, border, last, x = work
    if cyclic:
        _substitute_cyclic(n, over, border, last, x)
    else:
        for k in range(n - 2, -1, -1):
            put_vec(x[k], 0, vec_at(x[k], 0) - mat_at(over[k], 0) @ vec_at(x[k + 1], 0))


@compiled
def _substitute_cyclic(n, over, border, last, x):
    """First x_k = x_k - V_k x_{n-1} with the C of (1) gone, then the last row, then all."""
    for k in range(n - 3, -1, -1):
        c = mat_at(over[k], 0)
        put_vec(x[k], 0, vec_at(x[k], 0) - c @ vec_at(x[k + 1], 0))
        put_mat(border[k], 0, mat_at(border[k], 0) - c * mat_at(border[k + 1], 0))
    lower, diagonal, upper = mat_at(last[0], 0), mat_at(last[1], 0), mat_at(last[2], 0)
    rhs = vec_at(x[n - 1], 0) - lower @ vec_at(x[n - 2], 0) - upper @ vec_at(x[0], 0)
    diagonal = diagonal - lower * mat_at(border[n - 2], 0) - upper * mat_at(border[0], 0)
    final = solve(diagonal, upper, rhs)[1]
    for k in range(n - 1):
        put_vec(x[k], 0, vec_at(x[k], 0) - mat_at(border[k], 0) @ final)
    put_vec(x[n - 1], 0, final)
