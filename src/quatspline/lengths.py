"""Quaternions and vectors of any length but zero: inverses, and interpolation of direction and length.

A direction goes along the great arc of its sphere or along the chord, a length from one to the other;
the two do not mix.  Public as part of `quatspline.quaternion`.
"""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from quatspline.inputs.arrays import FloatArray, at, float_array, refuse_infinite
from quatspline.inputs.orientations import directions

ANTIPODAL = 4 * float(np.finfo(float).eps)
"""Unit quaternions or vectors whose sum is shorter than this have no shortest arc between them."""

Lengths = Literal["geometric", "linear"]
"""How a length goes from l to m: l^(1 - t) m^t, or (1 - t) l + t m."""


def inverse(q: ArrayLike) -> FloatArray:
    """q^-1 = (w, -v) / |q|^2 of quaternions (..., 4) of any length but zero.

    Raises
    ------
    ValueError
        What is no quaternion, not finite, or of length zero.
    """
    units, lengths = split("q", q, 4)
    return units * (1.0, -1.0, -1.0, -1.0) / lengths[..., None]


def slerp_modulus(
    a: ArrayLike, b: ArrayLike, t: ArrayLike, lengths: Lengths = "geometric"
) -> FloatArray:
    """Slerp of quaternions (..., 4) of any length but zero, with their moduli interpolated.

    With geometric lengths it is a (a^-1 b)^t, the general power being
    |p|^t exp(t ln(p / |p|)): the modulus falls or grows at a constant rate of its logarithm.

    Parameters
    ----------
    a, b : (..., 4), scalar first; no sign is flipped, as in `slerp`
    t : any real numbers (...), 0 at a and 1 at b; axes are broadcast
    lengths : "geometric" or "linear"

    Raises
    ------
    ValueError
        What is no such thing, not finite, of length zero, or of opposite directions.
    """
    return _interpolated(a, b, t, lengths, ("a", "b", 4), _arc)


def slerp_vectors(
    u: ArrayLike, v: ArrayLike, t: ArrayLike, lengths: Lengths = "linear"
) -> FloatArray:
    """Vectors (..., 3) between u and v: the direction turns at a constant rate from one to the other.

    sin((1 - t) theta)/sin(theta) u + sin(t theta)/sin(theta) v of unit vectors, theta the angle between
    them, times the length.  It is `rotate(power(shortest_rotation(u, v), t), u)` of equal lengths.

    Parameters
    ----------
    u, v : (..., 3), of any length but zero
    t : any real numbers (...), 0 at u and 1 at v; axes are broadcast
    lengths : "linear" or "geometric"

    Raises
    ------
    ValueError
        What is no such thing, not finite, of length zero, or of opposite directions.
    """
    return _interpolated(u, v, t, lengths, ("u", "v", 3), _arc)


def lerp_vectors(
    u: ArrayLike, v: ArrayLike, t: ArrayLike, lengths: Lengths = "linear"
) -> FloatArray:
    """The same as `slerp_vectors`, at uneven speed: k(t) ((1 - t) u + t v), the factor k fixing the length.

    Directions go along the chord of the unit sphere; they turn fastest in the middle, as those of
    `nlerp` do.

    Parameters
    ----------
    u, v : (..., 3), of any length but zero
    t : any real numbers (...), 0 at u and 1 at v; axes are broadcast
    lengths : "linear" or "geometric"

    Raises
    ------
    ValueError
        What is no such thing, not finite, of length zero, or of opposite directions.
    """
    return _interpolated(u, v, t, lengths, ("u", "v", 3), _chord)


def split(name: str, given: ArrayLike, width: int) -> tuple[FloatArray, FloatArray]:
    """Unit directions (..., width) and lengths (...) of what ends in an axis of that width.

    Raises
    ------
    ValueError
        Another shape, numbers that are not finite, a length of zero; the name and the place are told.
    """
    array = float_array(name, given)
    if array.ndim == 0 or array.shape[-1] != width:
        raise ValueError(f"{name} has shape {array.shape}: expected a last axis of {width}")
    refuse_infinite(name, array)
    largest = np.abs(array).max(axis=-1)
    if not (largest > 0.0).all():
        place = at(name, np.argwhere(largest == 0.0)[0])
        raise ValueError(f"{place} has a direction of length zero")
    scaled = array / largest[..., None]  # squares of very small or large numbers leave float64
    return directions(array), largest * np.linalg.norm(scaled, axis=-1)


def _interpolated(
    a: ArrayLike,
    b: ArrayLike,
    t: ArrayLike,
    lengths: Lengths,
    names: tuple[str, str, int],
    path: Any,
) -> FloatArray:
    if lengths not in get_args(Lengths):
        raise ValueError(f"lengths={lengths!r}: expected 'geometric' or 'linear'")
    first, second, width = names
    (p, l), (q, m) = split(first, a, width), split(second, b, width)
    u = float_array("t", t)
    refuse_infinite("t", u)
    try:
        lead = np.broadcast_shapes(l.shape, m.shape, u.shape)
    except ValueError:
        raise ValueError(
            f"{first}, {second} and t do not go together: leading axes {l.shape}, {m.shape}, {u.shape}"
        ) from None
    p, q = (np.broadcast_to(x, (*lead, width)) for x in (p, q))
    opposite = np.linalg.norm(p + q, axis=-1) < ANTIPODAL
    if opposite.any():
        place = at("", np.argwhere(opposite)[0])
        raise ValueError(f"{first} and {second} are antipodes{place}: no single arc joins them")
    length = l ** (1.0 - u) * m**u if lengths == "geometric" else (1.0 - u) * l + u * m
    return np.asarray(length[..., None] * path(p, q, np.broadcast_to(u, lead)[..., None]))


def _arc(p: FloatArray, q: FloatArray, u: FloatArray) -> FloatArray:
    """cos(u theta) p + sin(u theta) n, with n the direction of the arc at p."""
    chord = q - p
    squared = np.einsum("...i,...i->...", chord, chord)[..., None]
    ahead = chord + 0.5 * squared * p  # q - (p . q) p without its cancellation: sin(theta) n
    theta = 2.0 * np.arctan2(np.sqrt(squared), np.linalg.norm(p + q, axis=-1, keepdims=True))
    sine = np.linalg.norm(ahead, axis=-1, keepdims=True)
    share = np.where(sine > 0.0, np.sin(u * theta) / np.where(sine > 0.0, sine, 1.0), u)
    return np.asarray(np.cos(u * theta) * p + share * ahead)


def _chord(p: FloatArray, q: FloatArray, u: FloatArray) -> FloatArray:
    return directions((1.0 - u) * p + u * q)
