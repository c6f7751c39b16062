"""Sines, cosines and arc tangents by polynomials, compiled and always inlined.

Branch-free, so that a loop over samples vectorises.
"""

from __future__ import annotations

import math

from quatspline.kernels.jit import inlined

# Near-minimax polynomials in z = r^2 for sin(r)/r and cos(r) on |r| <= pi/2 (Chebyshev nodes,
# computed in 40 digits): with rounded coefficients errors of 5e-17 there, and 2.4e-14 at |r| = NEAR.
S1, S2, S3, S4 = (
    -1.6666666666666666e-1,
    8.333333333333186e-3,
    -1.9841269841208676e-4,
    2.7557319211229606e-6,
)
S5, S6, S7, S8 = (
    -2.505210689056952e-8,
    1.605894087848656e-10,
    -7.643026557971632e-13,
    2.7215749422983443e-15,
)
C1, C2, C3, C4 = (
    -0.4999999999999997,
    4.166666666666388e-2,
    -1.388888888877299e-3,
    2.4801587277414926e-5,
)
C5, C6, C7, C8 = (
    -2.755731639102575e-7,
    2.0876561839933163e-9,
    -1.1462901901757276e-11,
    4.608977003001797e-14,
)

FITTED = 2.5
"""z up to which they are exact to rounding."""

NEAR = 1.79
"""Half angles up to this many radians need no range reduction."""

# The same on |r| <= SMALL: errors 9e-19 and 8e-18.
T1, T2, T3 = -0.16666666666666666, 0.00833333333333113, -1.984126982508686e-4
T4, T5 = 2.7557277609845513e-06, -2.500842446128362e-08
D1, D2, D3 = -0.49999999999999994, 0.041666666666638034, -0.0013888888867855
D4, D5 = 2.480153321245251e-05, -2.7500537483149654e-07

SMALL = 0.33
"""Half angles up to this many radians take half the terms."""

# Near-minimax polynomial in z = x^2 for atan(x)/x on |x| <= tan(pi/8): error 1.3e-18.
A1, A2, A3, A4 = -0.3333333333333312, 0.1999999999994035, -0.14285714279197312, 0.11111110742286896
A5, A6, A7, A8 = -0.0909089673297879, 0.0769204396500265, -0.06662936116136517, 0.058467627400560856
A9, A10, A11 = -0.05034575594522044, 0.03795171422296338, -0.017790395523288063
TAN_PI_8 = math.sqrt(2.0) - 1.0

ROUND = 6755399441055744.0  # 1.5 * 2^52: adding and subtracting it rounds to an integer
INVERSE_PI = 1.0 / math.pi
PI_HIGH = math.pi
PI_LOW = 1.2246467991473532e-16

LOST = 6e15
"""An angle in rad that float64 does not tell from one a quarter of a turn away."""

ANTIPODAL_SINE = 1e-18
"""Antipodes have a smaller sine than this: less than one rounding of their components."""

TINY = 1e-300
"""Added where a length may vanish, so that 0/0 becomes the limit."""


@inlined
def series(z):
    """((sin(r)/r - 1)/z, (cos r - 1)/z) of z = r^2 for r <= NEAR: entire in z."""
    s = ((((((S8 * z + S7) * z + S6) * z + S5) * z + S4) * z + S3) * z + S2) * z + S1
    c = ((((((C8 * z + C7) * z + C6) * z + C5) * z + C4) * z + C3) * z + C2) * z + C1
    return s, c


@inlined
def series_slopes(z):
    """The derivatives of `series` by z."""
    s = (((((7 * S8 * z + 6 * S7) * z + 5 * S6) * z + 4 * S5) * z + 3 * S4) * z + 2 * S3) * z + S2
    c = (((((7 * C8 * z + 6 * C7) * z + 5 * C6) * z + 4 * C5) * z + 3 * C4) * z + 2 * C3) * z + C2
    return s, c


@inlined
def series_bend(z):
    """The second derivative of the first of `series`."""
    s = ((42 * S8 * z + 30 * S7) * z + 20 * S6) * z + 12 * S5
    return (s * z + 6 * S4) * z + 2 * S3


@inlined
def sinc_near(z):
    """(sin(r)/r, cos r) of z = r^2 for r <= NEAR: entire in z, no root and no division."""
    s, c = series(z)
    return s * z + 1.0, c * z + 1.0


@inlined
def sincos_near(r):
    """(sin r, cos r) for |r| <= NEAR, to rounding."""
    z = r * r
    s, c = series(z)
    return (s * z) * r + r, c * z + 1.0


@inlined
def sincos_small(r):
    """(sin r, cos r) for |r| <= SMALL, to rounding."""
    z = r * r
    s = ((((T5 * z + T4) * z + T3) * z + T2) * z + T1) * z
    c = ((((D5 * z + D4) * z + D3) * z + D2) * z + D1) * z
    return s * r + r, c + 1.0


@inlined
def sincos(x):
    """(sin x, cos x) to rounding for |x| up to 1e5, branch-free: x = k pi + r with |r| <= pi/2.

    Beyond, as accurate as x, and on the unit circle up to LOST; `sincos_any` serves where x may exceed it.
    """
    k = (x * INVERSE_PI + ROUND) - ROUND
    s, c = sincos_near((x - k * PI_HIGH) - k * PI_LOW)
    half = 0.5 * k
    odd = half - ((half + ROUND) - ROUND)  # 0 for even k, +-1/2 for odd k
    sign = 1.0 - 8.0 * odd * odd
    return sign * s, sign * c


@inlined
def sincos_any(x):
    """(sin x, cos x) of any x; beyond LOST of one angle."""
    return sincos(min(max(x, -LOST), LOST))


@inlined
def sinc(z):
    """(sin(r)/r, cos r) of z = r^2 for any r."""
    r = math.sqrt(z) + TINY
    s, c = sincos_any(r)
    return s / r, c


@inlined
def arctan_series(z):
    """atan(x)/x - 1 of z = x^2 for |x| <= tan(pi/8)."""
    r = (((((A11 * z + A10) * z + A9) * z + A8) * z + A7) * z + A6) * z + A5
    return ((((r * z + A4) * z + A3) * z + A2) * z + A1) * z


@inlined
def arctan(y, x):
    """atan(y/x) for 0 <= y <= x, branch-free."""
    wide = y > TAN_PI_8 * x
    t = (y - x if wide else y) / (y + x if wide else x)
    return (t + t * arctan_series(t * t)) + (0.25 * math.pi if wide else 0.0)
