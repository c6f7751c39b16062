"""Spherical averages: curves whose points are weighted means on S^3 of four control quaternions.

The mean of p_j with weights w_j (sum 1) is the Q that solves [buss2001]

    sum_j w_j l_j = 0,    l_j = ln(Q^-1 p_j),                                                       (1)

by Newton: Q <- Q exp(H^-1 g), g the left side of (1), H = sum_j w_j Jl(l_j)^-1 (`jacobians`).  At the
mean H is symmetric (its other part is [g]) and positive definite while all p_j lie within a quarter turn
of Q.  With weights B_j(t), v = omega/2 and K_j = Jl(l_j)^-1, derivatives of (1) give

    H v = sum_j B_j' l_j,                                                                           (2)
    H v' = sum_j B_j'' l_j - 2 B_j' K_j v - B_j dK_j v,    l_j' = -K_j v.                            (3)

Here B_j are the four basis functions of a cubic B-spline on a segment (`bspline`).
"""

from __future__ import annotations

from quatspline.kernels.family import family
from quatspline.kernels.jacobians import inverse_coefficient, spun
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.values import (
    cross,
    exp,
    log,
    norm,
    put_quat,
    quat_at,
    solve_symmetric,
    unit,
)

# notation: the constants of a segment are d_{i-1} ... d_{i+2} (16), m_i, the coefficients from u^0 to
# u^3 of B_{i+1} + B_{i+2} (4), and p_{i+1}: B_{i-1} = m_i (1 - u)^3, B_{i+2} = p_{i+1} u^3.
CONTROLS, WEIGHTS, SIZE = 0, 16, 22

STEPS = 50
"""Steps for one mean: Newton takes 2 or 3; points beyond a quarter turn need more."""
CLOSE = 1e-8
"""A Newton step this short squares to less than rounding: it is the last."""


@inlined
def mixed(w, a):
    """The weighted sum of four values."""
    return w[0] * a[0] + w[1] * a[1] + w[2] * a[2] + w[3] * a[3]


@inlined
def _symmetric(l):
    """The symmetric part of Jl(l)^-1: I + k [l]^2."""
    k, _ = inverse_coefficient(l @ l)
    return spun(1.0, 0.0, k, l)


@inlined
def _solved(l, w, g):
    """H^-1 g, or g itself (the gradient step) where H, of four points' logs, is not definite."""
    h = mixed(w, (_symmetric(l[0]), _symmetric(l[1]), _symmetric(l[2]), _symmetric(l[3])))
    x, definite = solve_symmetric(h, g)
    return x if definite else g


@inlined
def logs(q, p):
    """l_j of (1) for four points."""
    return log(~q * p[0]), log(~q * p[1]), log(~q * p[2]), log(~q * p[3])


@compiled
def newton_step(q, p, w):
    """H^-1 g of (1) at q."""
    l = logs(q, p)
    return _solved(l, w, mixed(w, l))


@compiled
def mean(p, w):
    """(1) from the normalised sum of w_j p_j; any weights that sum to one, some may be zero."""
    q = unit(mixed(w, p))
    if not q @ q > 0.0:
        q = p[1]
    for _ in range(STEPS):
        step = newton_step(q, p, w)
        q = q * exp(step)
        if norm(step) < CLOSE:
            break
    return unit(q)


@inlined
def basis(before, c, after, u):
    """B_{i-1} ... B_{i+2} at u from m_i, the coefficients of B_{i+1} + B_{i+2} and p_{i+1}; two derivatives."""
    v = 1.0 - u
    f, f1, f2 = before * v * v * v, -3.0 * before * v * v, 6.0 * before * v
    g, g1, g2 = after * u * u * u, 3.0 * after * u * u, 6.0 * after * u
    inner = ((c[3] * u + c[2]) * u + c[1]) * u + c[0]
    inner1, inner2 = (3.0 * c[3] * u + 2.0 * c[2]) * u + c[1], 6.0 * c[3] * u + 2.0 * c[2]
    return (
        (f, 1.0 - f - inner, inner - g, g),
        (f1, -f1 - inner1, inner1 - g1, g1),
        (f2, -f2 - inner2, inner2 - g2, g2),
    )


@inlined
def set_mean(c, p, before, coefficients, after):
    """Store four controls and their weights as the constants of a segment."""
    put_quat(c, CONTROLS, p[0])
    put_quat(c, CONTROLS + 4, p[1])
    put_quat(c, CONTROLS + 8, p[2])
    put_quat(c, CONTROLS + 12, p[3])
    c[WEIGHTS], c[SIZE - 1] = before, after
    c[WEIGHTS + 1], c[WEIGHTS + 2], c[WEIGHTS + 3], c[WEIGHTS + 4] = coefficients


@inlined
def _controls(c):
    return quat_at(c, 0), quat_at(c, 4), quat_at(c, 8), quat_at(c, 12)


@inlined
def _coefficients(c):
    """m_i, the coefficients and p_{i+1}."""
    k = WEIGHTS
    return c[k], (c[k + 1], c[k + 2], c[k + 3], c[k + 4]), c[k + 5]


@inlined
def point(c, u):
    """The mean of the segment's controls."""
    w, _, _ = basis(*_coefficients(c), u)
    return mean(_controls(c), w)


@inlined
def _moving(c, u):
    """The weights and their derivatives, the logarithms of (1), and v of (2)."""
    p, (w, w1, w2) = _controls(c), basis(*_coefficients(c), u)
    l = logs(mean(p, w), p)
    return w, w1, w2, l, _solved(l, w, mixed(w1, l))


@inlined
def velocity(c, u):
    """(2)."""
    _, _, _, _, v = _moving(c, u)
    return v


@inlined
def _bent(l, v):
    """K v and dK v of (3) for one point, K = I - [l] + k [l]^2 and l' = -K v."""
    k, slope = inverse_coefficient(l @ l)
    t = cross(l, v)
    u = cross(l, t)
    kv = v - t + k * u
    # dK v = -l' x v + k (l' x t + l x (l' x v)) + 2 k' (l . l') u
    a = cross(kv, v)
    return kv, a - k * (cross(kv, t) + cross(l, a)) - (2.0 * slope * (l @ kv)) * u


@inlined
def acceleration(c, u):
    """(3)."""
    w, w1, w2, l, v = _moving(c, u)
    k0, e0 = _bent(l[0], v)
    k1, e1 = _bent(l[1], v)
    k2, e2 = _bent(l[2], v)
    k3, e3 = _bent(l[3], v)
    right = mixed(w2, l) - 2.0 * mixed(w1, (k0, k1, k2, k3)) - mixed(w, (e0, e1, e2, e3))
    return _solved(l, w, right)


SPHERICAL_MEAN = family(SIZE, point, velocity=velocity, acceleration=acceleration)
"""Evaluates means with the weights of a cubic B-spline."""
