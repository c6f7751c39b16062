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
from quatspline.kernels.scalars import exp, log_between, mul
from quatspline.quaternion import OPPOSITE

# notation: log units throughout (half rotation vectors); h_i = t_{i+1} - t_i,
# L_i = ln(q_i^-1 q_{i+1})

CHART, SECANT = 0.0, 1.0
"""Velocities at the ends of open data: by (1), or that of slerp on the first and last segment."""


@inlined
def keyframe(q, i, sign):
    """q_i for any i, closed data going on as q_{i+n} = sign q_i."""
    n = q.shape[0]
    s = 1.0
    if i < 0 or i >= n:
        s = sign if (i // n) % 2 else 1.0
        i %= n
    return s * q[i, 0], s * q[i, 1], s * q[i, 2], s * q[i, 3]


@inlined
def moved(p, x, y, z):
    """p exp(v): the point that velocity v reaches from p."""
    w, a, b, c = exp(x, y, z)
    return mul(p[0], p[1], p[2], p[3], w, a, b, c)


@inlined
def step(q, i, j, sign):
    """ln(q_i^-1 q_j)."""
    a, b = keyframe(q, i, sign), keyframe(q, j, sign)
    return log_between(a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3])


@inlined
def _lifted(x, y, z, px, py, pz):
    """The logarithm on the branch nearer to where it is expected: carries the chart past pi."""
    r = math.sqrt(x * x + y * y + z * z)
    if abs(r - math.pi) < OPPOSITE:
        r = math.sqrt(px * px + py * py + pz * pz)
        k = math.pi / r if r > 0.0 else 0.0
        return k * px, k * py, k * pz
    k = 1.0 - 2.0 * math.pi / r if r > 0.0 else 1.0
    near = (x - px) ** 2 + (y - py) ** 2 + (z - pz) ** 2
    far = (k * x - px) ** 2 + (k * y - py) ** 2 + (k * z - pz) ** 2
    return (k * x, k * y, k * z) if far < near else (x, y, z)


@compiled
def _walk(q, h, sign, i, node, stop, way, time, x):
    """Times and chart points of a window from its centre, node, to its node ``stop`` (way +-1)."""
    j = i
    while node != stop:
        a, b, c = step(q, j, j + way, sign)
        a, b, c = a + x[node, 0], b + x[node, 1], c + x[node, 2]
        gap = h[(j if way > 0 else j - 1) % h.size]
        j += way
        time[node + way] = time[node] + way * gap
        node += way
        dx, dy, dz = step(q, i, j, sign)
        x[node, 0], x[node, 1], x[node, 2] = _lifted(dx, dy, dz, a, b, c)


@compiled
def chart_velocity(q, h, closed, sign, i, window, time, x):
    """(1) at keyframe i by up to ``window`` (3 to 5) keyframes; time (5,), x (5, 3): scratch."""
    n = q.shape[0]
    m = window if closed else min(window, n)
    first = i - window // 2
    if not closed:
        first = min(max(first, 0), n - m)
    c = i - first
    time[c] = 0.0
    x[c] = 0.0
    _walk(q, h, sign, i, c, m - 1, 1, time, x)
    _walk(q, h, sign, i, c, 0, -1, time, x)
    vx, vy, vz = 0.0, 0.0, 0.0
    for j in range(m):
        if j != c:
            slope = 1.0 / time[j]
            for k in range(m):
                if k not in (c, j):
                    slope *= time[k] / (time[k] - time[j])
            vx += slope * x[j, 0]
            vy += slope * x[j, 1]
            vz += slope * x[j, 2]
    return vx, vy, vz


@compiled
def secant_velocity(q, h, i):
    """The velocity of slerp at an end of open data: s_0 or s_{n-2}."""
    k = 0 if i == 0 else q.shape[0] - 2
    x, y, z = step(q, k, k + 1, 1.0)
    return x / h[k], y / h[k], z / h[k]


@compiled
def end_velocity(q, h, i, window, ends, time, x):
    """What an end of open data takes."""
    if ends == SECANT:
        return secant_velocity(q, h, i)
    return chart_velocity(q, h, False, 1.0, i, window, time, x)


@compiled
def chart_velocities(q, h, closed, sign, window, ends):
    """v_i at every keyframe, (n, 3) in log units a time."""
    n = q.shape[0]
    v, time, x = np.empty((n, 3)), np.empty(5), np.empty((5, 3))
    for i in range(n):
        if closed or 0 < i < n - 1:
            v[i, 0], v[i, 1], v[i, 2] = chart_velocity(q, h, closed, sign, i, window, time, x)
        else:
            v[i, 0], v[i, 1], v[i, 2] = end_velocity(q, h, i, window, ends, time, x)
    return v
