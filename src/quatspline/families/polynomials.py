"""Quintic polynomials on [0, 1]: how segments are made of them and how kernels evaluate them.

In a sheet, six rows from p on hold one polynomial as f_0, r = f_1 - f_0 and g_0 ... g_3 of

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
def quintic(s, p, j, u):
    """(1) at u."""
    g = ((s[p + 5, j] * u + s[p + 4, j]) * u + s[p + 3, j]) * u + s[p + 2, j]
    return (u - u * u) * g + (s[p + 1, j] * u + s[p, j])


@inlined
def quintic_jet(s, p, j, u):
    """(1) and its two derivatives at u."""
    d, c, b, a = s[p + 2, j], s[p + 3, j], s[p + 4, j], s[p + 5, j]
    g, g1, g2 = (
        ((a * u + b) * u + c) * u + d,
        (3.0 * a * u + 2.0 * b) * u + c,
        6.0 * a * u + 2.0 * b,
    )
    w, w1, rise = u - u * u, 1.0 - 2.0 * u, s[p + 1, j]
    return (
        w * g + (rise * u + s[p, j]),
        w * g1 + (w1 * g + rise),
        w * g2 + 2.0 * (w1 * g1 - g),
    )
