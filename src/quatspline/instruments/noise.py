"""Noise: what a curve makes of small errors of its keyframes and of their times.

For a linear scheme with blending functions B_j the gain of orientation is sqrt(mean sum_j B_j(u)^2):
sqrt(2/3) for slerp.  Gains below 1 smooth, gains above 1 amplify.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.instruments.derivatives import rates
from quatspline.instruments.trials import Build, Row
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray

Keys = tuple[FloatArray, FloatArray]

SIGMA = 1e-4
"""Standard deviation of keyframes' errors in rad an axis, and of times' in shares of the mean spacing:
small enough that responses are linear, large against rounding."""

SAMPLES = 5
"""Gauss-Legendre points per segment: exact for squares of quartics, which blending functions are."""


def noise(
    build: Build,
    times: FloatArray,
    keyframes: FloatArray,
    kind: str,
    rng: np.random.Generator,
    trials: int,
) -> Row:
    """Gains of one curve for errors of its "keyframes" or "times"; lower is calmer.

    gain: rms deviation of orientation over that of the error; gain_omega, gain_alpha: rms deviation of
    body velocity and acceleration, times the mean spacing and its square, over the same.  Errors of times
    (inner ones: the domain stays) count as the turns that the rms speed makes of them.
    """
    curve = build(times, keyframes)
    spacing = float(curve.keyframes.spacings.mean())
    t, weights = _nodes(curve.keyframes)
    truth = _motion(curve, t)
    if kind == "keyframes":
        unit = SIGMA * np.sqrt(3.0)  # the rms angle of errors about three axes
    else:
        unit = SIGMA * spacing * float(np.sqrt(weights @ np.sum(truth[1] ** 2, axis=-1)))
    squares = np.zeros(3)
    for _ in range(trials):
        disturbed = build(*DISTURBED[kind](times, keyframes, rng))
        squares += _squares(_motion(disturbed, t), truth, weights) / trials
    gains = np.sqrt(squares) * spacing ** np.arange(3.0) / unit
    return dict(zip(("gain", "gain_omega", "gain_alpha"), gains.tolist(), strict=True))


def _turned(times: FloatArray, q: FloatArray, rng: np.random.Generator) -> Keys:
    errors = rng.normal(scale=SIGMA, size=(len(q), 3))
    return times, quaternion.mul(q, quaternion.exp(0.5 * errors))


def _jittered(times: FloatArray, q: FloatArray, rng: np.random.Generator) -> Keys:
    late = times.copy()
    late[1:-1] += SIGMA * float(np.diff(times).mean()) * rng.normal(size=len(times) - 2)
    return late, q


DISTURBED: dict[str, Callable[[FloatArray, FloatArray, np.random.Generator], Keys]] = {
    "keyframes": _turned,
    "times": _jittered,
}


def _nodes(keyframes: Keyframes) -> tuple[FloatArray, FloatArray]:
    """Times (m,) and weights (m,), of sum 1, of a mean over the domain."""
    u, w = np.polynomial.legendre.leggauss(SAMPLES)
    weights = 0.5 * np.outer(keyframes.spacings, w) / keyframes.knots[-1]
    return keyframes.times[0] + keyframes.inside(0.5 + 0.5 * u), weights.reshape(-1)


def _motion(curve: Curve, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Orientation (m, 4), velocity and acceleration (m, 3)."""
    return curve(t), *rates(curve, t)


def _squares(
    motion: tuple[FloatArray, ...], truth: tuple[FloatArray, ...], weights: FloatArray
) -> FloatArray:
    """Mean squared deviations (3,) of orientation (angle), velocity and acceleration."""
    apart = [quaternion.distance(motion[0], truth[0])]
    apart += [np.linalg.norm(a - b, axis=-1) for a, b in zip(motion[1:], truth[1:], strict=True)]
    return np.array([weights @ gap**2 for gap in apart])
