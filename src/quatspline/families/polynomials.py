"""Quintic polynomials on [0, 1]: how segments are made of them and how kernels evaluate them.

Six constants hold one polynomial as f_0, r = f_1 - f_0 and g_0 ... g_3 of

    f(u) = f_0 + r u + u (1 - u) g(u),    g(u) = g_0 + g_1 u + g_2 u^2 + g_3 u^3                   (1)

which is f_0 at u = 0 and f_0 + r at u = 1 to the last digit, however large g is: where one spacing is a
million times the next, coefficients of powers of u are large, and their sum at u = 1 is rounding.
"""

from __future__ import annotations

from quatspline.kernels.jit import inlined


@inlined
def hermite(f0, d0, c0, f1, d1, c1):
    """(1) with values f, slopes d, second derivatives c at u = 0 and 1."""
    rise = f1 - f0
    g0, end = d0 - rise, rise - d1
    g1, slope = g0 + 0.5 * c0, -end - 0.5 * c1
    return f0, rise, g0, g1, 3.0 * (end - g0) - 2.0 * g1 - slope, 2.0 * (g0 - end) + g1 + slope


@inlined
def from_powers(c0, c1, c2, c3, c4, c5):
    """(1) from coefficients of u^0 to u^5, by u^k - u = -u (1 - u) (1 + ... + u^(k - 2))."""
    g2 = -c5 - c4
    g1 = g2 - c3
    return c0, c1 + c2 + c3 + c4 + c5, g1 - c2, g1, g2, -c5


@inlined
def bound(f0, rise, g0, g1, g2, g3):
    """A bound of |f| on [0, 1]: the largest Bernstein coefficient of degree 5."""
    c1, c2, c3, c4 = rise + g0, g1 - g0, g2 - g1, g3 - g2  # of powers of u
    b1 = f0 + c1 / 5
    b2 = f0 + 2 * c1 / 5 + c2 / 10
    b3 = f0 + 3 * c1 / 5 + 3 * c2 / 10 + c3 / 10
    b4 = f0 + 4 * c1 / 5 + 6 * c2 / 10 + 4 * c3 / 10 + c4 / 5
    return max(abs(f0), abs(b1), abs(b2), abs(b3), abs(b4), abs(f0 + rise))


@inlined
def quintic(c, p, u):
    """(1) at u, its constants at places p ... p + 5."""
    g = ((c[p + 5] * u + c[p + 4]) * u + c[p + 3]) * u + c[p + 2]
    return (u - u * u) * g + (c[p + 1] * u + c[p])


@inlined
def quintic_jet(c, p, u):
    """(1) and its two derivatives at u."""
    a, b, d, e = c[p + 2], c[p + 3], c[p + 4], c[p + 5]
    g, g1 = ((e * u + d) * u + b) * u + a, (3.0 * e * u + 2.0 * d) * u + b
    g2 = 6.0 * e * u + 2.0 * d
    w, w1, rise = u - u * u, 1.0 - 2.0 * u, c[p + 1]
    return w * g + (rise * u + c[p]), w * g1 + (w1 * g + rise), w * g2 + 2.0 * (w1 * g1 - g)
