"""Products of exponentials about fixed axes, the cumulative form of Kim, Kim & Shin (1995).

On a segment, with u in [0, 1],

    Q(u) = Q_0 exp(theta_1(u) n_1) exp(theta_2(u) n_2) exp(theta_3(u) n_3)                    (1)

with unit axes n_k and polynomials theta_k of degree 5 at most (`polynomials`).  The paper's quartic, the quintic,
the cumulative cubic Hermite and B-spline curves all have this form.  Rates come from a scan over
the factors, each turning what stands to its left into its own frame [kim1995general].
"""

from __future__ import annotations

from quatspline.families.polynomials import bound, from_powers, quintic, quintic_jet
from quatspline.kernels.family import Family, family
from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import NEAR, SMALL, sincos_any, sincos_near, sincos_small
from quatspline.kernels.values import (
    cross,
    polar,
    polar_exp,
    pure,
    put_quat,
    put_vec,
    quat_at,
    unrotate,
    vec_at,
)

# notation: the constants of a segment are Q_0 (4), Q_0 n_1 (4), n_1, n_2, n_3 (9), and the six
# constants of theta_1, theta_2, theta_3 as `polynomials` has them (18).
Q0, Q0N1, AXES, ANGLES = 0, 4, 8, 17
SIZE = 35

N1, N2, N3 = AXES, AXES + 3, AXES + 6
F1, F2, F3 = ANGLES, ANGLES + 6, ANGLES + 12


@inlined
def set_base(c, q):
    """Q_0 of a segment's constants; set the factors afterwards."""
    put_quat(c, Q0, q)


@inlined
def set_factor(c, k, v, powers):
    """Factor k (0, 1, 2): exp(f(u) v), f by its coefficients from u^0 to u^5.

    Returns a bound of the half angle over u in [0, 1].
    """
    length, n = polar(v)
    f = from_powers(*powers)
    set_turn(c, k, length, n, f)
    return length * bound(*f)


@inlined
def set_turn(c, k, length, n, f):
    """Factor k from the length and the axis of v, f in the form of `polynomials`."""
    put_vec(c, AXES + 3 * k, n)
    p = ANGLES + 6 * k
    c[p], c[p + 1], c[p + 2] = length * f[0], length * f[1], length * f[2]
    c[p + 3], c[p + 4], c[p + 5] = length * f[3], length * f[4], length * f[5]
    if k == 0:
        put_quat(c, Q0N1, quat_at(c, Q0) * pure(n))


def _family(outer, middle, far: Family | None = None) -> Family:
    """The family with its sines: of the outer factors, and of the one between them."""

    @inlined
    def point(c, u):
        s1, c1 = outer(quintic(c, F1, u))
        s2, c2 = middle(quintic(c, F2, u))
        s3, c3 = outer(quintic(c, F3, u))
        q = c1 * quat_at(c, Q0) + s1 * quat_at(c, Q0N1)
        return q * polar_exp(s2, c2, vec_at(c, N2)) * polar_exp(s3, c3, vec_at(c, N3))

    @inlined
    def velocity(c, u):
        """omega <- R_k^T omega + theta_k' n_k, factor by factor."""
        _, r1, _ = quintic_jet(c, F1, u)
        t2, r2, _ = quintic_jet(c, F2, u)
        t3, r3, _ = quintic_jet(c, F3, u)
        s2, c2 = middle(t2)
        s3, c3 = outer(t3)
        n1, n2, n3 = vec_at(c, N1), vec_at(c, N2), vec_at(c, N3)
        v = unrotate(s2, c2, n2, r1 * n1) + r2 * n2
        return unrotate(s3, c3, n3, v) + r3 * n3

    @inlined
    def acceleration(c, u):
        """alpha <- R^T (alpha + omega x 2 theta' n) + theta'' n, for R leaves n in its place."""
        _, r1, e1 = quintic_jet(c, F1, u)
        t2, r2, e2 = quintic_jet(c, F2, u)
        t3, r3, e3 = quintic_jet(c, F3, u)
        s2, c2 = middle(t2)
        s3, c3 = outer(t3)
        n2, n3 = vec_at(c, N2), vec_at(c, N3)
        m = unrotate(s2, c2, n2, vec_at(c, N1))
        v = r1 * m + r2 * n2
        a = e1 * m + (2.0 * r1 * r2) * cross(m, n2) + e2 * n2
        return unrotate(s3, c3, n3, a + (2.0 * r3) * cross(v, n3)) + e3 * n3

    return family(SIZE, point, velocity=velocity, acceleration=acceleration, far=far)


_ANYWHERE = _family(sincos_any, sincos_any)

CUMULATIVE = _family(sincos_near, sincos_near, far=_ANYWHERE)
"""Evaluates (1) and its rates."""

MIDDLE = _family(sincos_small, sincos_near, far=_ANYWHERE)
"""The same where the outer factors are small: a fit kernel counts their angles SIDE times."""

SIDE = NEAR / SMALL
"""Half angles of the outer factors count so many times in the reach of `MIDDLE`."""
