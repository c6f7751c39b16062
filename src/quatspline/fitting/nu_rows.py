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

from quatspline.fitting.block_tridiagonal import (
    added,
    backward,
    forward,
    matmul,
    set_vector,
    vector,
)
from quatspline.fitting.bspline import (
    control,
    increment,
    set_control,
    set_phantoms,
    small_log,
    squared,
    turned,
)
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.scalars import between, mul, polar, sincos

# notation: a problem is (targets, a, mu, delta, f, cyclic): keyframes (4, N + 1) and the weights at
# every knot, those of the ends of open data such that d is the keyframe; x is (g, w, d), where
# g (3, N + 1) of open data is 0 at both ends, w (3, N + 2) and d (4, N + 1).


@inlined
def _spun(along, re, im, x, y, z):
    """The block that is `along` on the unit axis and the complex factor re + i im across it."""
    k = along - re
    return (
        re + k * x * x,
        k * x * y - im * z,
        k * x * z + im * y,
        k * x * y + im * z,
        re + k * y * y,
        k * y * z - im * x,
        k * x * z - im * y,
        k * y * z + im * x,
        re + k * z * z,
    )


@inlined
def _jacobian(f, v, side):
    """f Jl(2 f v) for side 1, f Jr(2 f v) for side -1: exp(+-i t) sin(t)/t across, t = |f v|."""
    t, x, y, z = polar(f * v[0], f * v[1], f * v[2])
    s, c = sincos(t)
    s0 = f * s / t if t > 0.0 else f
    return _spun(f, s0 * c, side * s0 * s, x, y, z)


@inlined
def _inverse_jacobian(f, v, side):
    """Jl(2 f v)^-1 for side 1, Jr(2 f v)^-1 for side -1: t exp(-+i t) / sin(t) across."""
    t, x, y, z = polar(f * v[0], f * v[1], f * v[2])
    re = t * math.cos(t) / math.sin(t) if t > 0.0 else 1.0
    return _spun(1.0, re, -side * t, x, y, z)


@inlined
def _turned_back(f, v):
    """R(exp(f v))^T."""
    t, x, y, z = polar(f * v[0], f * v[1], f * v[2])
    s, c = sincos(t)
    return _spun(1.0, c * c - s * s, -2.0 * s * c, x, y, z)


@inlined
def _divided(a, f):
    """A block over a number."""
    k = 1.0 / f
    return (
        k * a[0],
        k * a[1],
        k * a[2],
        k * a[3],
        k * a[4],
        k * a[5],
        k * a[6],
        k * a[7],
        k * a[8],
    )


@inlined
def leg_end(problem, g, k):
    """L_k of (1)."""
    return mul(*control(problem[0], k), *turned(-problem[3][k], increment(g, k)))


@inlined
def leg_start(problem, g, k):
    """R_k of (1)."""
    return mul(*control(problem[0], k), *turned(1.0 - problem[3][k], increment(g, k)))


@compiled
def _set_polygon(problem, x):
    """w of (2) and d; returns the largest |arc|^2 from a keyframe to the ends of its legs."""
    _, a, _, delta, f, cyclic = problem
    g, w, d = x
    n, longest = g.shape[1] - 1, 0.0
    if cyclic:
        g[0, n], g[1, n], g[2, n] = increment(g, 0)
    for k in range(1, n + 1):
        step = small_log(*between(*leg_start(problem, g, k - 1), *leg_end(problem, g, k)))
        share = 1.0 / f[k]
        w[0, k], w[1, k], w[2, k] = share * step[0], share * step[1], share * step[2]
    set_phantoms(w, cyclic, False)
    for k in range(n + 1):
        set_control(d, k, *mul(*leg_end(problem, g, k), *turned(a[k], increment(w, k))))
        share = max(delta[k], 1.0 - delta[k])
        longest = max(longest, share * share * squared(increment(g, k)))
    return longest


@compiled
def look(problem, x, misses):
    """What (3) misses at g, ln(exp(-g) exp(a w) exp(mu w)): (sum of squares, largest as an angle).

    Infinite where an arc from a keyframe to the end of a leg is half a turn of S^3 or more, which a
    segment cannot follow.
    """
    _, a, mu, _, _, cyclic = problem
    g, w, _ = x
    longest = _set_polygon(problem, x)
    total = worst = 0.0
    first = 0 if cyclic else 1
    for k in range(first, g.shape[1] - 1):
        before = mul(*turned(-1.0, increment(g, k)), *turned(a[k], increment(w, k)))
        miss = small_log(*mul(*before, *turned(mu[k], increment(w, k + 1))))
        set_vector(misses, k - first, miss)
        total += squared(miss)
        worst = max(worst, squared(miss))
    if not (longest < math.pi**2 and total < math.inf):
        return math.inf, math.inf
    return total, 2.0 * math.sqrt(worst)


@compiled
def _segment_blocks(problem, x, k):
    """V and U of dw_k = V dg_{k-1} + U dg_k, from (2)."""
    _, _, _, delta, f, _ = problem
    g, w, _ = x
    step = increment(w, k)
    start = _jacobian(1.0 - delta[k - 1], increment(g, k - 1), -1.0)
    end = _jacobian(delta[k], increment(g, k), 1.0)
    v = matmul(_inverse_jacobian(f[k], step, 1.0), start)
    u = matmul(_inverse_jacobian(f[k], step, -1.0), end)
    return _divided(v, -f[k]), _divided(u, -f[k])


@compiled
def assemble(problem, x, work):
    """Solve Newton's system for (3); work's x holds the misses and then the move.

    With A = R(exp(mu w_{k+1}))^T a Jr(2 a w_k) and B = mu Jr(2 mu w_{k+1}), row k is
    A V_k x_{k-1} + (A U_k + B V_{k+1} - Jr(2 g_k)) x_k + B U_{k+1} x_{k+1} = -miss_k.
    """
    _, a, mu, _, _, cyclic = problem
    g, w, _ = x
    n, first = g.shape[1] - 1, 0 if cyclic else 1
    v, u = _segment_blocks(problem, x, n if cyclic else 1)
    for k in range(first, n):
        step = increment(w, k + 1)
        back = _turned_back(mu[k], step)
        before = matmul(back, _jacobian(a[k], increment(w, k), -1.0))
        after = _jacobian(mu[k], step, -1.0)
        lower, own = matmul(before, v), matmul(before, u)
        v, u = _segment_blocks(problem, x, k + 1)
        own = added(own, 1.0, matmul(after, v))
        own = added(own, -1.0, _jacobian(1.0, increment(g, k), -1.0))
        m0, m1, m2 = vector(work[3], k - first)
        upper, rhs = matmul(after, u), (-m0, -m1, -m2)
        forward(k - first, n - first, cyclic, lower, own, upper, rhs, work)
    backward(n - first, cyclic, work)
