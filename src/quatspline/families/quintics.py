"""Quintic polynomials on [0, 1]: how segments are made of them and how kernels evaluate them.

In a sheet, six rows from p on hold the coefficients of one polynomial, from u^0 to u^5.
"""

from __future__ import annotations

from quatspline._jit import inlined


@inlined
def hermite(f0, d0, c0, f1, d1, c1):
    """Coefficients of the quintic with values f, slopes d, second derivatives c at u = 0 and 1."""
    rise = f1 - f0 - d0 - 0.5 * c0
    slope = d1 - d0 - c0
    bend = c1 - c0
    return (
        f0,
        d0,
        0.5 * c0,
        10.0 * rise - 4.0 * slope + 0.5 * bend,
        -15.0 * rise + 7.0 * slope - bend,
        6.0 * rise - 3.0 * slope + 0.5 * bend,
    )


@inlined
def bound(c0, c1, c2, c3, c4, c5):
    """A bound of |f| on [0, 1]: the largest Bernstein coefficient of degree 5."""
    b1 = c0 + c1 / 5
    b2 = c0 + 2 * c1 / 5 + c2 / 10
    b3 = c0 + 3 * c1 / 5 + 3 * c2 / 10 + c3 / 10
    b4 = c0 + 4 * c1 / 5 + 6 * c2 / 10 + 4 * c3 / 10 + c4 / 5
    b5 = c0 + c1 + c2 + c3 + c4 + c5
    return max(abs(c0), abs(b1), abs(b2), abs(b3), abs(b4), abs(b5))


@inlined
def quintic(s, p, j, u):
    """The polynomial at u."""
    return (
        (((s[p + 5, j] * u + s[p + 4, j]) * u + s[p + 3, j]) * u + s[p + 2, j]) * u + s[p + 1, j]
    ) * u + s[p, j]


@inlined
def quintic_jet(s, p, j, u):
    """The polynomial and its two derivatives at u: Horner's scheme, three levels at once."""
    a, b, c, d, e = s[p + 5, j], s[p + 4, j], s[p + 3, j], s[p + 2, j], s[p + 1, j]
    f1, f0 = a, a * u + b
    f2, f1, f0 = f1, f1 * u + f0, f0 * u + c
    f2, f1, f0 = f2 * u + f1, f1 * u + f0, f0 * u + d
    f2, f1, f0 = f2 * u + f1, f1 * u + f0, f0 * u + e
    f2, f1, f0 = f2 * u + f1, f1 * u + f0, f0 * u + s[p, j]
    return f0, f1, 2.0 * f2
