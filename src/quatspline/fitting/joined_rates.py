"""Segments that join rates at keyframes: what the local quintic and its monotone sibling share.

Whatever the rates are, both segments that meet at a keyframe get the same, so that the curve is C^2.
"""

from __future__ import annotations

import numpy as np

from quatspline.families.rotation_vector import set_end_rates
from quatspline.fitting.local_rates import chords, continued, local_rates
from quatspline.kernels.jit import inlined
from quatspline.kernels.values import put_vec, quat_at, vec_at


@inlined
def steps_and_rates(q, h, closed, sign, m):
    """Steps ln(q_i^-1 q_{i+1}) of all segments (segments, 3), and (v, a) of all keyframes (n, 6).

    The rates are those of `local_rates` with the window m, in log units.
    """
    n, first = q.shape[0], m if closed else 0
    points, gaps = continued(q, h, closed, sign, m)
    x = np.empty((m, 4, points.shape[0]))
    chords(points, x)
    steps, rates = np.empty((h.size, 3)), np.empty((n, 6))
    for i in range(h.size):
        put_vec(steps[i], 0, vec_at(x[0, :, first + i], 0))
    for i in range(n):
        v, a = local_rates(x, gaps, closed, first + i)
        put_vec(rates[i], 0, v)
        put_vec(rates[i], 3, a)
    return steps, rates


@inlined
def join(q, h, steps, rates, segments):
    """Constants of every segment from the rates at its ends; returns the reach."""
    reach = 0.0
    for i in range(h.size):
        base, step = quat_at(q[i], 0), vec_at(steps[i], 0)
        start = _by_u(rates[i], h[i])
        stop = _by_u(rates[(i + 1) % q.shape[0]], h[i])
        reach = max(reach, set_end_rates(segments[i], base, step, *start, *stop))
    return reach


@inlined
def _by_u(rates, h):
    """h v and h^2 a."""
    return h * vec_at(rates, 0), (h * h) * vec_at(rates, 3)
