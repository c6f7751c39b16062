"""Controls that callers of a library have to bring along: slopes, inner quaternions.

They are the textbook's, so that what is measured is the library's evaluation.
"""

from __future__ import annotations

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import with_return
from quatspline.quaternion import FloatArray, conj, exp, log, mul


def parabola_slopes(chords: FloatArray, spacings: FloatArray, closed: bool) -> FloatArray:
    """Slopes (n + 1, k) at the ends of n chords (n, k), each that of the parabola through three points.

    v_i = (h_i s_{i-1} + h_{i-1} s_i) / (h_{i-1} + h_i) with chords s_i over spacings h_i (n,); at an open end
    2 s_0 - v_1, closed the neighbours go round.
    """
    s, h = chords, spacings[:, None]
    inner = (h[1:] * s[:-1] + h[:-1] * s[1:]) / (h[:-1] + h[1:])
    if closed:
        seam = (h[:1] * s[-1:] + h[-1:] * s[:1]) / (h[:1] + h[-1:])
        return np.concatenate([seam, inner, seam])
    if len(s) == 1:
        return np.concatenate([s, s])
    return np.concatenate([2.0 * s[:1] - inner[:1], inner, 2.0 * s[-1:] - inner[-1:]])


def hermite_tangents(keyframes: Keyframes) -> FloatArray:
    """Derivatives (n, 4), closed (n + 1, 4), of a curve in R^4 by the parabola through three keyframes."""
    q, h = with_return(keyframes), keyframes.spacings
    slopes = parabola_slopes(np.diff(q, axis=0) / h[:, None], h, keyframes.closed)
    if (
        keyframes.closed
    ):  # seen from the end the first chord has the closing sign, and the other way round
        s, sign = np.diff(q, axis=0)[[0, -1]] / h[[0, -1], None], keyframes.sign
        first = (h[0] * sign * s[1] + h[-1] * s[0]) / (h[0] + h[-1])
        slopes[0], slopes[-1] = first, sign * first
    return slopes


def inner_quaternions(keyframes: Keyframes) -> tuple[FloatArray, FloatArray]:
    """Squad's a_i^+ and a_i^-, each (n, 4), closed (n + 1, 4), for uneven times [shoemake1987].

    a_i^+ = q_i exp((h_i v_i - L_i) / 2) and a_i^- = q_i exp((L_{i-1} - h_{i-1} v_i) / 2), with L_i = ln(q_i^-1
    q_{i+1}) and v_i by the parabola; at an open end they are the keyframe.
    """
    q, h = with_return(keyframes), keyframes.spacings[:, None]
    steps = log(mul(conj(q[:-1]), q[1:]))
    v = parabola_slopes(steps / h, keyframes.spacings, keyframes.closed)
    if not keyframes.closed:
        v[0], v[-1] = steps[0] / h[0], steps[-1] / h[-1]
    after, before = (h * v[:-1] - steps) / 2.0, (steps - h * v[1:]) / 2.0
    none = np.zeros((1, 3))  # nothing asks for the point after the last or before the first
    return mul(q, exp(np.concatenate([after, none]))), mul(q, exp(np.concatenate([none, before])))
