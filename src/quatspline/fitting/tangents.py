"""Tangents at keyframes from their neighbours: chart velocities, and what open ends take.

In the chart x_j = ln(q_i^-1 q_j) centred at a keyframe, ordinary derivatives are body rates in log
units, so that the slope of the polynomial through m of its points estimates the velocity:

    v_i = sum_{j != i} l_j'(t_i) x_j,
    l_j'(t_i) = 1/(t_j - t_i) prod_{k != i, j} (t_i - t_k)/(t_j - t_k)                           (1)

Three points give v_i = (h_i s_{i-1} + h_{i-1} s_i) / (h_{i-1} + h_i), s_j = L_j / h_j, with an
error O(h^2), five points O(h^4).  At the ends of open data the window is shifted inward.
"""

from __future__ import annotations

import math

import numpy as np

from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.values import Vec, keyframe, log, norm, put_vec, vec_at
from quatspline.quaternion import OPPOSITE

# notation: log units throughout (half rotation vectors); h_i = t_{i+1} - t_i,
# L_i = ln(q_i^-1 q_{i+1})

CHART, SECANT = 0.0, 1.0
"""Velocities at the ends of open data: by (1), or that of slerp on the first and last segment."""


@inlined
def step(q, i, j, sign):
    """ln(q_i^-1 q_j)."""
    return log(~keyframe(q, i, sign) * keyframe(q, j, sign))


@inlined
def _lifted(x, expected):
    """The logarithm on the branch nearer to where it is expected: carries the chart past pi."""
    r = norm(x)
    if abs(r - math.pi) < OPPOSITE:
        r = norm(expected)
        return (math.pi / r if r > 0.0 else 0.0) * expected
    other = (1.0 - 2.0 * math.pi / r if r > 0.0 else 1.0) * x
    return other if norm(other - expected) < norm(x - expected) else x


@compiled
def _walk(q, h, sign, i, node, stop, way, chart):
    """Points and times of a window from its centre, node, to its node ``stop`` (way +-1)."""
    j = i
    while node != stop:
        expected = vec_at(chart[node], 0) + step(q, j, j + way, sign)
        gap = h[(j if way > 0 else j - 1) % h.size]
        j += way
        chart[node + way, 3] = chart[node, 3] + way * gap
        node += way
        put_vec(chart[node], 0, _lifted(step(q, i, j, sign), expected))


@compiled
def chart_velocity(q, h, closed, sign, i, window, chart):
    """(1) at keyframe i by up to ``window`` (3 to 5) keyframes; chart (5, 4) takes points and times."""
    n = q.shape[0]
    m = window if closed else min(window, n)
    first = i - window // 2
    if not closed:
        first = min(max(first, 0), n - m)
    c = i - first
    chart[c] = 0.0
    _walk(q, h, sign, i, c, m - 1, 1, chart)
    _walk(q, h, sign, i, c, 0, -1, chart)
    v = Vec(0.0, 0.0, 0.0)
    for j in range(m):
        if j != c:
            slope = 1.0 / chart[j, 3]
            for k in range(m):
                if k not in (c, j):
                    slope *= chart[k, 3] / (chart[k, 3] - chart[j, 3])
            v = v + slope * vec_at(chart[j], 0)
    return v


@compiled
def end_velocity(q, h, i, window, ends, chart):
    """What an end of open data takes: (1), or the velocity of slerp, s_0 or s_{n-2}."""
    if ends == SECANT:
        k = 0 if i == 0 else q.shape[0] - 2
        return (1.0 / h[k]) * step(q, k, k + 1, 1.0)
    return chart_velocity(q, h, False, 1.0, i, window, chart)


@compiled
def chart_velocities(q, h, closed, sign, window, ends):
    """v_i at every keyframe, (n, 3) in log units per time."""
    n = q.shape[0]
    v, chart = np.empty((n, 3)), np.empty((5, 4))
    for i in range(n):
        if closed or 0 < i < n - 1:
            put_vec(v[i], 0, chart_velocity(q, h, closed, sign, i, window, chart))
        else:
            put_vec(v[i], 0, end_velocity(q, h, i, window, ends, chart))
    return v
