"""Splines of frames: the rotation nearest to a matrix whose entries are polynomials.

On a segment B(u), u in [0, 1], is a polynomial of degree k, and the curve is the rotation C(u) nearest to it
(`nearest_rotation`).  With S = C^T B', P = C^T B (symmetric) and M = tr(P) I - P, derivatives of
C^T B = P give

    M omega = vee(S),   M alpha = vee(C^T B'' - [omega] S) - (tr(S) I - S + [omega] P) omega.       (1)
"""

from __future__ import annotations

from quatspline.families.nearest_rotation import nearest, scalar, trace, vee
from quatspline.kernels.family import Family, family
from quatspline.kernels.jit import inlined
from quatspline.kernels.values import Mat, cross, quat_at, rotate, solve_symmetric, vec_at

# notation: the constants of a segment are a base quaternion (4), the middle of its arc, then those of
# B seen from there, nine for each of f, r, g_0 ... g_{k-2}, column by column:
# B[row, j] is entry 3 j + row.
COEFFICIENTS = 4
BLOCK = 9

DEGREES = (3, 5, 7, 9)


@inlined
def block(c, k):
    """The k-th nine of B's constants, column by column."""
    p = COEFFICIENTS + BLOCK * k
    return Mat(vec_at(c, p), vec_at(c, p + 3), vec_at(c, p + 6))


@inlined
def _seen(q, m):
    """C^T M, C the rotation of a unit quaternion."""
    return Mat(rotate(~q, m.a), rotate(~q, m.b), rotate(~q, m.c))


@inlined
def _rate(p, v):
    """M^-1 v of (1); zero where no rotation is nearest alone."""
    x, _ = solve_symmetric(scalar(trace(p)) - p, v)
    return x


@inlined
def _crossed(v, m):
    """[v] M."""
    return Mat(cross(v, m.a), cross(v, m.b), cross(v, m.c))


def _family(degree: int) -> Family:
    """The family of splines of a degree; its functions hold plain values only."""

    @inlined
    def jet(c, u):
        """B = f + r u + u (1 - u) g(u), exact at both ends, and its two derivatives; g by Horner's rule."""
        g, g1, g2 = block(c, degree), scalar(0.0), scalar(0.0)
        for j in range(degree - 1, 1, -1):
            g2 = u * g2 + 2.0 * g1
            g1 = u * g1 + g
            g = u * g + block(c, j)
        w, w1, rise = u - u * u, 1.0 - 2.0 * u, block(c, 1)
        b = w * g + (u * rise + block(c, 0))
        return b, w * g1 + (w1 * g + rise), w * g2 + 2.0 * (w1 * g1 - g)

    @inlined
    def point(c, u):
        b, _, _ = jet(c, u)
        return quat_at(c, 0) * nearest(b)

    @inlined
    def velocity(c, u):
        b, b1, _ = jet(c, u)
        q = nearest(b)
        return 0.5 * _rate(_seen(q, b), vee(_seen(q, b1)))

    @inlined
    def acceleration(c, u):
        b, b1, b2 = jet(c, u)
        q = nearest(b)
        p, s, t = _seen(q, b), _seen(q, b1), _seen(q, b2)
        v = _rate(p, vee(s))
        turned = vee(t - _crossed(v, s))
        return 0.5 * _rate(p, turned - trace(s) * v + s @ v - cross(v, p @ v))

    constants = COEFFICIENTS + BLOCK * (degree + 1)
    return family(constants, point, velocity=velocity, acceleration=acceleration)


FRAMES = {degree: _family(degree) for degree in DEGREES}
"""By the degree of B."""
