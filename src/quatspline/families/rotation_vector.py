"""One exponential per segment: quintic rotation vectors in the chart of a base orientation.

On a segment, with u in [0, 1],

    Q(u) = Q_0 exp(phi(u))                                                                       (1)

with phi a polynomial in R^3 of degree 5 at most, in log units (half rotation vectors).  Rates come
from the right Jacobian and its coefficients a, b of z = |phi|^2 (`jacobians`),

    omega/2 = phi' - a phi x phi' + b phi x (phi x phi')                                         (2)
    alpha/2 = phi'' - a phi x phi'' + b phi x (phi x phi'') + b phi' x (phi x phi')
              + k (-a1 phi x phi' + b1 phi x (phi x phi')),  k = phi . phi'                      (3)

where a1 = 2 da/dz and b1 = 2 db/dz.
"""

from __future__ import annotations

from quatspline.families.polynomials import hermite, quintic, quintic_jet
from quatspline.kernels.family import Family, family
from quatspline.kernels.jacobians import coefficients, coefficients_near, inverse_right_jacobian
from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import sinc, sinc_near
from quatspline.kernels.values import Quat, Vec, cross, norm, put_quat, quat_at

# notation: the constants of a segment are Q_0 (4), then for each component of phi the six constants
# of `polynomials` (18).
Q0, PHI = 0, 4
SIZE = 22


@inlined
def set_end_rates(c, q, step, v0, a0, v1, a1):
    """q exp(phi(u)), phi from 0 to the step with given rates at both ends; returns a bound of |phi|.

    The rates are half the body velocity and acceleration by u.  (2) and (3) are solved for the
    derivatives at u = 1; those at 0 are the rates.
    """
    d = inverse_right_jacobian(step, v1)
    bent = half_acceleration(coefficients(step @ step), step, d, Vec(0.0, 0.0, 0.0))
    e = inverse_right_jacobian(step, a1 - bent)
    put_quat(c, Q0, q)
    _put_component(c, PHI, hermite(0.0, v0.x, a0.x, step.x, d.x, e.x))
    _put_component(c, PHI + 6, hermite(0.0, v0.y, a0.y, step.y, d.y, e.y))
    _put_component(c, PHI + 12, hermite(0.0, v0.z, a0.z, step.z, d.z, e.z))
    return max(
        0.2 * norm(v0),  # Bernstein coefficients
        norm(0.4 * v0 + 0.05 * a0),
        norm(step - 0.4 * d + 0.05 * e),
        norm(step - 0.2 * d),
        norm(step),
    )


@inlined
def set_cubic(c, q, step, c1, c2):
    """q exp(phi(u)), phi the cubic from 0 to the step with coefficients c1 of u, c2 of u^2; a bound of |phi|."""
    c3 = step - c1 - c2
    g = -c2 - c3
    put_quat(c, Q0, q)
    _put_component(c, PHI, (0.0, step.x, g.x, -c3.x, 0.0, 0.0))
    _put_component(c, PHI + 6, (0.0, step.y, g.y, -c3.y, 0.0, 0.0))
    _put_component(c, PHI + 12, (0.0, step.z, g.z, -c3.z, 0.0, 0.0))
    return max(norm(step), norm(c1) / 3.0, norm(2.0 * c1 + c2) / 3.0)  # Bernstein coefficients


@inlined
def _put_component(c, p, f):
    c[p], c[p + 1], c[p + 2], c[p + 3], c[p + 4], c[p + 5] = f


@inlined
def half_acceleration(jacobian, phi, d, e):
    """(3) of phi, its slope d and second derivative e; the Jacobian is a, b, a1, b1."""
    a, b, a1, b1 = jacobian
    t, p = cross(phi, d), cross(phi, e)
    u, r, g = cross(phi, t), cross(phi, p), cross(d, t)
    k = phi @ d
    return e - a * p + b * (r + g) - (k * a1) * t + (k * b1) * u


@inlined
def jet(c, u):
    """phi, phi', phi'' at u."""
    x, x1, x2 = quintic_jet(c, PHI, u)
    y, y1, y2 = quintic_jet(c, PHI + 6, u)
    z, z1, z2 = quintic_jet(c, PHI + 12, u)
    return Vec(x, y, z), Vec(x1, y1, z1), Vec(x2, y2, z2)


def _family(sinc, coefficients, far: Family | None = None) -> Family:
    """The family with its functions of |phi|^2."""

    @inlined
    def point(c, u):
        """(1)."""
        phi = Vec(quintic(c, PHI, u), quintic(c, PHI + 6, u), quintic(c, PHI + 12, u))
        s, k = sinc(phi @ phi)
        return quat_at(c, Q0) * Quat(k, s * phi.x, s * phi.y, s * phi.z)

    @inlined
    def velocity(c, u):
        """(2)."""
        phi, d, _ = jet(c, u)
        a, b, _, _ = coefficients(phi @ phi)
        t = cross(phi, d)
        return d - a * t + b * cross(phi, t)

    @inlined
    def acceleration(c, u):
        """(3)."""
        phi, d, e = jet(c, u)
        return half_acceleration(coefficients(phi @ phi), phi, d, e)

    return family(SIZE, point, velocity=velocity, acceleration=acceleration, far=far)


ROTATION_VECTOR = _family(sinc_near, coefficients_near, far=_family(sinc, coefficients))
"""Evaluates (1) and its rates (2), (3)."""
