"""Block-tridiagonal systems of 3x3 blocks, open and cyclic, solved in O(n).

    L_k x_{k-1} + D_k x_k + U_k x_{k+1} = r_k,      k = 0 ... n-1                             (1)

Elimination is by blocks, each pivoted by rows.  It takes one row after the other (`forward`), so
that a Newton iteration assembles and eliminates in one sweep and never stores its matrix.  In the
cyclic system, where row 0 also holds x_{n-1} and row n-1 also x_0, every row carries a further
block for x_{n-1}, which a last 3x3 system then gives.  With n = 2 both neighbours are one unknown.

Blocks travel as tuples of nine numbers, row by row, so that they stay in registers.
"""

from __future__ import annotations

import numpy as np

from quatspline.kernels.jit import compiled, inlined
from quatspline.quaternion import FloatArray

# notation: work = (C, V, last, x): after `forward` x_k + C_k x_{k+1} + V_k x_{n-1} = rhs_k, where V
# is used by cyclic systems only; last holds L, D, U of the cyclic system's last row.

ZERO = (0.0,) * 9


@inlined
def matmul(a, b):
    """The product of two blocks."""
    return (
        a[0] * b[0] + a[1] * b[3] + a[2] * b[6],
        a[0] * b[1] + a[1] * b[4] + a[2] * b[7],
        a[0] * b[2] + a[1] * b[5] + a[2] * b[8],
        a[3] * b[0] + a[4] * b[3] + a[5] * b[6],
        a[3] * b[1] + a[4] * b[4] + a[5] * b[7],
        a[3] * b[2] + a[4] * b[5] + a[5] * b[8],
        a[6] * b[0] + a[7] * b[3] + a[8] * b[6],
        a[6] * b[1] + a[7] * b[4] + a[8] * b[7],
        a[6] * b[2] + a[7] * b[5] + a[8] * b[8],
    )


@inlined
def matvec(a, v):
    """A block times a vector."""
    return (
        a[0] * v[0] + a[1] * v[1] + a[2] * v[2],
        a[3] * v[0] + a[4] * v[1] + a[5] * v[2],
        a[6] * v[0] + a[7] * v[1] + a[8] * v[2],
    )


@inlined
def added(a, f, b):
    """a + f b for two blocks."""
    return (
        a[0] + f * b[0],
        a[1] + f * b[1],
        a[2] + f * b[2],
        a[3] + f * b[3],
        a[4] + f * b[4],
        a[5] + f * b[5],
        a[6] + f * b[6],
        a[7] + f * b[7],
        a[8] + f * b[8],
    )


@inlined
def _minus(a, v):
    return a[0] - v[0], a[1] - v[1], a[2] - v[2]


@inlined
def _combined(a, f, b):
    """a - f b for two rows of a block with its four right-hand sides."""
    return (
        a[0] - f * b[0],
        a[1] - f * b[1],
        a[2] - f * b[2],
        a[3] - f * b[3],
        a[4] - f * b[4],
        a[5] - f * b[5],
        a[6] - f * b[6],
    )


@inlined
def solve(d, u, v):
    """(D^-1 U, D^-1 v) by elimination with row pivoting; not finite where D is singular."""
    a = (d[0], d[1], d[2], u[0], u[1], u[2], v[0])
    b = (d[3], d[4], d[5], u[3], u[4], u[5], v[1])
    c = (d[6], d[7], d[8], u[6], u[7], u[8], v[2])
    if abs(b[0]) > abs(a[0]):
        a, b = b, a
    if abs(c[0]) > abs(a[0]):
        a, c = c, a
    first = 1.0 / a[0]
    b = _combined(b, b[0] * first, a)
    c = _combined(c, c[0] * first, a)
    if abs(c[1]) > abs(b[1]):
        b, c = c, b
    second = 1.0 / b[1]
    c = _combined(c, c[1] * second, b)
    third = 1.0 / c[2]
    z = (c[3] * third, c[4] * third, c[5] * third, c[6] * third)
    y = _back(b, second, b[2], z)
    x = _back(_combined(a, a[1], (0.0, 0.0, 0.0, *y)), first, a[2], z)
    return (*x[:3], *y[:3], *z[:3]), (x[3], y[3], z[3])


@inlined
def _back(row, inverse, f, z):
    """The right-hand sides of a row less f times those below, over the pivot."""
    return (
        (row[3] - f * z[0]) * inverse,
        (row[4] - f * z[1]) * inverse,
        (row[5] - f * z[2]) * inverse,
        (row[6] - f * z[3]) * inverse,
    )


@inlined
def block(array, k):
    """Block k of an (n, 9) array."""
    return (
        array[k, 0],
        array[k, 1],
        array[k, 2],
        array[k, 3],
        array[k, 4],
        array[k, 5],
        array[k, 6],
        array[k, 7],
        array[k, 8],
    )


@inlined
def vector(array, k):
    """Vector k of an (n, 3) array."""
    return array[k, 0], array[k, 1], array[k, 2]


@inlined
def set_block(array, k, a):
    """Write block k of an (n, 9) array."""
    array[k, 0], array[k, 1], array[k, 2] = a[0], a[1], a[2]
    array[k, 3], array[k, 4], array[k, 5] = a[3], a[4], a[5]
    array[k, 6], array[k, 7], array[k, 8] = a[6], a[7], a[8]


@inlined
def set_vector(array, k, v):
    """Write vector k of an (n, 3) array."""
    array[k, 0], array[k, 1], array[k, 2] = v[0], v[1], v[2]


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
        rhs = _minus(rhs, matvec(lower, vector(x, k - 1)))
        diagonal = added(diagonal, -1.0, matmul(lower, block(over, k - 1)))
    upper, rhs = solve(diagonal, upper, rhs)
    set_block(over, k, upper)
    set_vector(x, k, rhs)


@compiled
def _forward_cyclic(k, n, lower, diagonal, upper, rhs, work):
    """As `forward`, with a further block for x_{n-1}; the last row is kept for the end."""
    over, border, last, x = work
    if k == n - 1:
        set_block(last, 0, lower)
        set_block(last, 1, diagonal)
        set_block(last, 2, upper)
        set_vector(x, k, rhs)
        return
    side = lower
    if k > 0:
        rhs = _minus(rhs, matvec(lower, vector(x, k - 1)))
        diagonal = added(diagonal, -1.0, matmul(lower, block(over, k - 1)))
        side = added(ZERO, -1.0, matmul(lower, block(border, k - 1)))
    if k == n - 2:  # the upper neighbour is x_{n-1} itself
        side = added(side, 1.0, upper)
    set_block(border, k, solve(diagonal, side, rhs)[0])
    upper, rhs = solve(diagonal, upper, rhs)
    set_block(over, k, upper)
    set_vector(x, k, rhs)


@inlined
def backward(n, cyclic, work):
    """Substitute back; work's x then holds the solution."""
    over, border, last, x = work
    if cyclic:
        _substitute_cyclic(n, over, border, last, x)
    else:
        for k in range(n - 2, -1, -1):
            set_vector(x, k, _minus(vector(x, k), matvec(block(over, k), vector(x, k + 1))))


@compiled
def _substitute_cyclic(n, over, border, last, x):
    """First x_k = x_k - V_k x_{n-1} with the C of (1) gone, then the last row, then all."""
    for k in range(n - 3, -1, -1):
        c = block(over, k)
        set_vector(x, k, _minus(vector(x, k), matvec(c, vector(x, k + 1))))
        set_block(border, k, added(block(border, k), -1.0, matmul(c, block(border, k + 1))))
    lower, diagonal, upper = block(last, 0), block(last, 1), block(last, 2)
    rhs = _minus(vector(x, n - 1), matvec(lower, vector(x, n - 2)))
    rhs = _minus(rhs, matvec(upper, vector(x, 0)))
    diagonal = added(diagonal, -1.0, matmul(lower, block(border, n - 2)))
    diagonal = added(diagonal, -1.0, matmul(upper, block(border, 0)))
    final = solve(diagonal, upper, rhs)[1]
    for k in range(n - 1):
        set_vector(x, k, _minus(vector(x, k), matvec(block(border, k), final)))
    set_vector(x, n - 1, final)


@compiled
def _solve_system(lower, diagonal, upper, rhs, cyclic):
    n = rhs.shape[0]
    work = workspace(n, cyclic)
    for k in range(n):
        forward(
            k, n, cyclic, block(lower, k), block(diagonal, k), block(upper, k), vector(rhs, k), work
        )
    backward(n, cyclic, work)
    return work[3]


def solve_block_tridiagonal(
    lower: FloatArray,
    diagonal: FloatArray,
    upper: FloatArray,
    rhs: FloatArray,
    *,
    cyclic: bool = False,
) -> FloatArray:
    """Solve (1) for x (n, 3).

    Parameters
    ----------
    lower, diagonal, upper
        (n, 3, 3).  Row k couples x_{k-1}, x_k, x_{k+1}; ``lower[0]`` and ``upper[n - 1]`` do not
        count in an open system and couple x_{n-1} and x_0 in a cyclic one, which needs n >= 2.
    rhs
        (n, 3).
    """
    n = rhs.shape[0]
    if cyclic and n < 2:
        raise ValueError(f"rhs has {n} blocks: a cyclic system needs at least 2")
    flat = [np.ascontiguousarray(a, dtype=float).reshape(n, 9) for a in (lower, diagonal, upper)]
    solution: FloatArray = _solve_system(*flat, np.ascontiguousarray(rhs, dtype=float), cyclic)
    return solution
