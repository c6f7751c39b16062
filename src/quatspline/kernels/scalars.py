"""Scalar unit-quaternion primitives, compiled and always inlined.

Everything that the schemes' kernels are made of.  Quaternions travel as four scalars (w, x, y, z)
and vectors as three, so that a loop over samples vectorises.  Logarithms are half rotation
vectors: ``exp(v) = (cos |v|, v sin |v| / |v|)`` and ``log`` is its inverse on the ball |v| <= pi.
"""

from __future__ import annotations

import math

from quatspline.kernels.jit import inlined

# Near-minimax polynomials in z = r^2 for sin(r)/r and cos(r) on |r| <= pi/2 (Chebyshev nodes,
# computed in 40 digits): errors 2e-19 and 4e-18 there, still below 5e-17 at |r| = NEAR.
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

NEAR = 1.79
"""Half angles up to this many radians need no range reduction."""

# The same on |r| <= SMALL: errors 9e-19 and 8e-18.
T1, T2, T3 = -0.16666666666666666, 0.00833333333333113, -1.984126982508686e-4
T4, T5 = 2.7557277609845513e-06, -2.500842446128362e-08
D1, D2, D3 = -0.49999999999999994, 0.041666666666638034, -0.0013888888867855
D4, D5 = 2.480153321245251e-05, -2.7500537483149654e-07

SMALL = 0.33
"""Half angles up to this many radians take half the terms."""

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
def sincos_near(r):
    """(sin r, cos r) for |r| <= NEAR, to rounding."""
    z = r * r
    s = (((((((S8 * z + S7) * z + S6) * z + S5) * z + S4) * z + S3) * z + S2) * z + S1) * z
    c = (((((((C8 * z + C7) * z + C6) * z + C5) * z + C4) * z + C3) * z + C2) * z + C1) * z
    return s * r + r, c + 1.0


@inlined
def sincos_small(r):
    """(sin r, cos r) for |r| <= SMALL, to rounding."""
    z = r * r
    s = ((((T5 * z + T4) * z + T3) * z + T2) * z + T1) * z
    c = ((((D5 * z + D4) * z + D3) * z + D2) * z + D1) * z
    return s * r + r, c + 1.0


@inlined
def sinc_near(z):
    """(sin(r)/r, cos r) of z = r^2 for r <= NEAR: entire in z, no root and no division."""
    s = (((((((S8 * z + S7) * z + S6) * z + S5) * z + S4) * z + S3) * z + S2) * z + S1) * z
    c = (((((((C8 * z + C7) * z + C6) * z + C5) * z + C4) * z + C3) * z + C2) * z + C1) * z
    return s + 1.0, c + 1.0


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
def mul(a, b, c, d, e, f, g, h):
    """The product (a, b, c, d)(e, f, g, h)."""
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


@inlined
def between(a, b, c, d, e, f, g, h):
    """The relative quaternion (a, b, c, d)^-1 (e, f, g, h)."""
    return mul(a, -b, -c, -d, e, f, g, h)


@inlined
def cross(a, b, c, d, e, f):
    """The cross product (a, b, c) x (d, e, f)."""
    return b * f - c * e, c * d - a * f, a * e - b * d


@inlined
def exp(x, y, z):
    """The unit quaternion exp(v)."""
    s, c = sinc(x * x + y * y + z * z)
    return c, s * x, s * y, s * z


@inlined
def log(w, x, y, z):
    """The principal logarithm, |log| <= pi; of -1, which has none, pi about the first axis."""
    length = math.sqrt(x * x + y * y + z * z)
    if length < TINY:
        if w < 0.0:
            return math.pi, 0.0, 0.0
        return x / w, y / w, z / w
    scale = math.atan2(length, w) / length
    return scale * x, scale * y, scale * z


@inlined
def log_between(a, b, c, d, e, f, g, h):
    """log((a, b, c, d)^-1 (e, f, g, h)): the step from one keyframe to the next."""
    w, x, y, z = between(a, b, c, d, e, f, g, h)
    return log(w, x, y, z)


@inlined
def polar(x, y, z):
    """(|v|, v/|v|); the axis of a vanishing vector is zero."""
    length = math.sqrt(x * x + y * y + z * z)
    scale = 1.0 / (length + TINY) if length > TINY else 0.0
    return length, scale * x, scale * y, scale * z


@inlined
def unrotate(s, c, nx, ny, nz, x, y, z):
    """The vector (x, y, z) seen after the turn exp(theta n), s = sin theta, c = cos theta: R^T v."""
    tx, ty, tz = cross(nx, ny, nz, x, y, z)
    ux, uy, uz = cross(nx, ny, nz, tx, ty, tz)
    k = 2.0 * s * c
    m = 2.0 * s * s
    return x - k * tx + m * ux, y - k * ty + m * uy, z - k * tz + m * uz


@inlined
def rotate(w, qx, qy, qz, x, y, z):
    """The vector (x, y, z) turned by the unit quaternion."""
    tx, ty, tz = cross(qx, qy, qz, x, y, z)
    ux, uy, uz = cross(qx, qy, qz, tx, ty, tz)
    return x + 2.0 * (w * tx + ux), y + 2.0 * (w * ty + uy), z + 2.0 * (w * tz + uz)


@inlined
def jacobian_coefficients(p2):
    """A = (1 - cos p)/p^2 and B = (p - sin p)/p^3 of p2 = p^2, by series below p = 1."""
    if p2 < 1.0:
        a = 0.5 - p2 / 24 * (
            1
            - p2
            / 30
            * (
                1
                - p2
                / 56
                * (1 - p2 / 90 * (1 - p2 / 132 * (1 - p2 / 182 * (1 - p2 / 240 * (1 - p2 / 306)))))
            )
        )
        b = 1 / 6 - p2 / 120 * (
            1
            - p2
            / 42
            * (
                1
                - p2
                / 72
                * (1 - p2 / 110 * (1 - p2 / 156 * (1 - p2 / 210 * (1 - p2 / 272 * (1 - p2 / 342)))))
            )
        )
        return a, b
    p = math.sqrt(p2)
    half = math.sin(0.5 * p)
    return 2.0 * half * half / p2, (p - math.sin(p)) / (p2 * p)


@inlined
def inverse_jacobian_coefficient(p2):
    """D = 1/p^2 - (1 + cos p)/(2 p sin p) of p2 = p^2; singular at a full turn."""
    if p2 < 1.0:
        # sum of |B_2k| p^(2k-2) / (2k)!, the Bernoulli numbers
        return 1 / 12 + p2 * (
            1 / 720
            + p2
            * (
                1 / 30240
                + p2
                * (
                    1 / 1209600
                    + p2
                    * (
                        1 / 47900160
                        + p2
                        * (
                            691 / 1307674368000
                            + p2
                            * (
                                1 / 74724249600
                                + p2
                                * (
                                    3617 / 10670622842880000
                                    + p2
                                    * (
                                        43867 / 5109094217170944000
                                        + p2 * 174611.0 / 8.028576626982912e20
                                    )
                                )
                            )
                        )
                    )
                )
            )
        )
    p = math.sqrt(p2)
    return (1.0 - 0.5 * p / math.tan(0.5 * p)) / p2


@inlined
def right_jacobian(px, py, pz, x, y, z):
    """Jr(p) v with p a rotation vector: Jr = I - A [p] + B [p]^2 (`jacobian_coefficients`)."""
    a, b = jacobian_coefficients(px * px + py * py + pz * pz)
    tx, ty, tz = cross(px, py, pz, x, y, z)
    ux, uy, uz = cross(px, py, pz, tx, ty, tz)
    return x - a * tx + b * ux, y - a * ty + b * uy, z - a * tz + b * uz


@inlined
def inverse_right_jacobian(px, py, pz, x, y, z):
    """Jr(p)^-1 v = v + [p] v / 2 + D [p]^2 v."""
    d = inverse_jacobian_coefficient(px * px + py * py + pz * pz)
    tx, ty, tz = cross(px, py, pz, x, y, z)
    ux, uy, uz = cross(px, py, pz, tx, ty, tz)
    return x + 0.5 * tx + d * ux, y + 0.5 * ty + d * uy, z + 0.5 * tz + d * uz


# Near-minimax polynomial in z = x^2 for atan(x)/x on |x| <= tan(pi/8): error 1.3e-18.
A1, A2, A3, A4 = -0.3333333333333312, 0.1999999999994035, -0.14285714279197312, 0.11111110742286896
A5, A6, A7, A8 = -0.0909089673297879, 0.0769204396500265, -0.06662936116136517, 0.058467627400560856
A9, A10, A11 = -0.05034575594522044, 0.03795171422296338, -0.017790395523288063
TAN_PI_8 = math.sqrt(2.0) - 1.0


@inlined
def arc_angle(a, b, c, d, e, f, g, h):
    """The angle between unit quaternions and its sine and cosine: (theta, sin, cos), branch-free.

    tan(theta/4) = |p - q| / (|p + q| + 2) loses nothing for small angles [0, pi].
    """
    dw, dx, dy, dz = a - e, b - f, c - g, d - h
    pw, px, py, pz = a + e, b + f, c + g, d + h
    minus = dw * dw + dx * dx + dy * dy + dz * dz
    s = math.sqrt(minus)
    m = math.sqrt(pw * pw + px * px + py * py + pz * pz)
    n = m + 2.0
    wide = s > TAN_PI_8 * n
    x = (s - n if wide else s) / (s + n if wide else n)
    z = x * x
    r = (
        (
            (
                (((((((A11 * z + A10) * z + A9) * z + A8) * z + A7) * z + A6) * z + A5) * z + A4)
                * z
                + A3
            )
            * z
            + A2
        )
        * z
        + A1
    ) * z
    theta = 4.0 * ((x + x * r) + (0.25 * math.pi if wide else 0.0))
    return theta, 0.5 * s * m, 1.0 - 0.5 * minus


@inlined
def turn(a, b, c, d, e, f, g, h):
    """|v| and v/|v| of v = log((a, b, c, d)^-1 (e, f, g, h)), |v| <= pi, branch-free; 0 for 0."""
    theta, _, _ = arc_angle(a, b, c, d, e, f, g, h)
    _, x, y, z = between(a, b, c, d, e, f, g, h)
    scale = 1.0 / math.sqrt(x * x + y * y + z * z + TINY)
    return theta, scale * x, scale * y, scale * z


@inlined
def slerp(a, b, c, d, e, f, g, h, u):
    """The point at u on the great arc from (a, b, c, d) to (e, f, g, h), no sign flip.

    Near antipodes it loses digits, and length: `nested.restored` gives that back.
    """
    theta, sine, cosine = arc_angle(a, b, c, d, e, f, g, h)
    s, k = sincos(u * theta)
    q = s / max(sine, ANTIPODAL_SINE if cosine < 0.0 else TINY)
    p = k - cosine * q
    return p * a + q * e, p * b + q * f, p * c + q * g, p * d + q * h
