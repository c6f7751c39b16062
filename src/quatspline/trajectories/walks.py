"""Random keyframes: walks of fixed step angle about random axes, open or closed into loops."""

from __future__ import annotations

import numpy as np

from quatspline import quaternion
from quatspline.quaternion import FloatArray


def directions(rng: np.random.Generator, shape: tuple[int, ...]) -> FloatArray:
    """Unit vectors (*shape, 3), uniform on the sphere."""
    v = rng.normal(size=(*shape, 3))
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def walk(rng: np.random.Generator, count: int, degrees: float, tracks: int = 1) -> FloatArray:
    """Keyframes (count, tracks, 4): each a rotation of ``degrees`` about a random axis after the last.

    The first is a random orientation.
    """
    first = rng.normal(size=(tracks, 4))
    half = np.radians(degrees) / 2.0
    steps = quaternion.exp(half * directions(rng, (count - 1, tracks)))
    keyframes = np.empty((count, tracks, 4))
    keyframes[0] = quaternion.normalise(first)
    for i in range(count - 1):
        keyframes[i + 1] = quaternion.mul(keyframes[i], steps[i])
    # products drift off the sphere by rounding alone: a long walk is normalised once
    return quaternion.normalise(keyframes)


def loop(rng: np.random.Generator, count: int, degrees: float, tracks: int = 1) -> FloatArray:
    """Closed keyframes (count, tracks, 4): walks whose closing step is also of about ``degrees``.

    A walk of count - 2 steps is joined to its start by one more keyframe at equal distance
    ``degrees`` from both ends, where their distance allows; others are drawn again.
    """
    half = np.radians(degrees) / 2.0
    done = np.empty((count, 0, 4))
    while done.shape[1] < tracks:
        w = walk(rng, count - 1, degrees, max(64, 2 * tracks))
        gap = quaternion.distance(w[-1], w[0]) / 2.0
        cosine = np.cos(half) / np.cos(gap / 2.0)
        possible = cosine <= 1.0
        w, cosine = w[:, possible], cosine[possible]
        sign = np.where(np.einsum("ki,ki->k", w[-1], w[0]) < 0.0, -1.0, 1.0)
        middle = quaternion.normalise(w[-1] + sign[:, None] * w[0])
        # any direction orthogonal to both ends leads to keyframes at equal distance from them
        side = rng.normal(size=middle.shape)
        for end in _basis(middle, w[0]):
            side -= np.einsum("ki,ki->k", side, end)[:, None] * end
        side = quaternion.normalise(side)
        last = cosine[:, None] * middle + np.sqrt(1.0 - cosine**2)[:, None] * side
        done = np.concatenate([done, np.concatenate([w, last[None]])], axis=1)
    return done[:, :tracks]


def _basis(a: FloatArray, b: FloatArray) -> tuple[FloatArray, FloatArray]:
    """An orthonormal basis of the plane of a and b."""
    rest = b - np.einsum("ki,ki->k", a, b)[:, None] * a
    return a, quaternion.normalise(rest)
