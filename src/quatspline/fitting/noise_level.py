"""How noisy keyframes are, told from them alone."""

from __future__ import annotations

import numpy as np

from quatspline import quaternion
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray

MEDIAN = 1.5381722544550522
"""The median length of a vector of three standard normal components: sqrt(2 P^-1(3/2, 1/2))."""


def noise_level(keyframes: Keyframes) -> FloatArray:
    """The standard deviation of the keyframes' rotation errors in rad an axis, (*K,).

    The median length of the third divided differences of the turns between keyframes, over what white
    noise of unit deviation makes of them.  Motion that four neighbouring keyframes follow leaves little
    of itself in these, and what few outliers leave does not move a median.  Sparse keyframes of a lively
    motion seem noisy; an error common to neighbours is none to it.  Lengths, not components: no axis
    of the body is privileged.  0 for fewer than four keyframes.

    Examples
    --------
    >>> import quatspline as qs
    >>> from quatspline.fitting.noise_level import noise_level
    >>> errors = np.random.default_rng(0).normal(scale=0.02, size=(1000, 3))
    >>> spin = np.arange(1000.0)[:, None] * [0.1, 0.0, 0.0]
    >>> q = qs.quaternion.mul(qs.quaternion.exp(spin), qs.quaternion.exp(errors / 2))
    >>> float(noise_level(qs.build("slerp", None, q).keyframes).round(2))
    0.02
    """
    q, h = _neighbours(keyframes)
    if h.size < 3:
        return np.zeros(keyframes.track_shape)
    rates = 2.0 * quaternion.log(quaternion.mul(quaternion.conj(q[:-1]), q[1:])) / h[:, None, None]
    h0, h1, h2 = h[:-2], h[1:-1], h[2:]
    before, after = (1.0 / (h0 + h1))[:, None, None], (1.0 / (h1 + h2))[:, None, None]
    third = after * (rates[2:] - rates[1:-1]) - before * (rates[1:-1] - rates[:-2])
    # errors of the four keyframes count with c0, -c0 - c1, c1 + c2, -c2 in it
    c0, c1 = 1.0 / (h0 * (h0 + h1)), (1.0 / (h0 + h1) + 1.0 / (h1 + h2)) / h1
    c2 = 1.0 / (h2 * (h1 + h2))
    unit = np.sqrt(c0**2 + (c0 + c1) ** 2 + (c1 + c2) ** 2 + c2**2)
    lengths = np.linalg.norm(third, axis=-1) / unit[:, None]
    level: FloatArray = np.median(lengths, axis=0) / MEDIAN
    return level.reshape(keyframes.track_shape)


def _neighbours(keyframes: Keyframes) -> tuple[FloatArray, FloatArray]:
    """Keyframes (n, K, 4) and their spacings, a closed curve's first three repeated at its end."""
    q, h = np.moveaxis(keyframes.tracks, 1, 0), keyframes.spacings / keyframes.unit
    if keyframes.closed:
        q = np.concatenate([q, keyframes.signs[:, None] * q[:3]])
        h = np.concatenate([h, h[:2]])
    return q, h
