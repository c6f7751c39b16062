"""Slerp-Bezier segments: De Casteljau's algorithm by slerps on end points and end velocities.

Controls (q_i, b_i, c_{i+1}, q_{i+1}) make a curve that leaves with 3 ln(q_i^-1 b_i)/h and arrives
with 3 ln(c_{i+1}^-1 q_{i+1})/h (log units), so that velocities v_i, v_{i+1} are met by

    b_i = q_i exp(h_i v_i / 3),    c_{i+1} = q_{i+1} exp(-h_i v_{i+1} / 3)                       (1)

Kochanek & Bartels (1984) blend the slopes s_i = L_i / h_i on either side of a keyframe by tension
T, continuity C and bias B [kochanek1984], here on arbitrary knots, a = h_i / (h_{i-1} + h_i):

    v_i^out = (1 - T) ((1 + C)(1 + B) a s_{i-1} + (1 - C)(1 - B) (1 - a) s_i)                    (2)
    v_i^in  = (1 - T) ((1 - C)(1 + B) a s_{i-1} + (1 + C)(1 - B) (1 - a) s_i)                    (3)

T = C = B = 0 is the chart velocity of three points: Catmull & Rom's.
"""

from __future__ import annotations

import numpy as np

from quatspline.families.arcs import SIZE as ARC
from quatspline.families.arcs import set_arc
from quatspline.families.nested import set_parameter
from quatspline.fitting.tangents import end_velocity, keyframe, moved, step
from quatspline.kernels.jit import REACH, compiled, fit_kernel


@compiled
def set_controls(segments, i, p0, p1, p2, p3):
    """Store De Casteljau's arcs on four controls as constants of segment i (`nested.TRIANGLE`)."""
    r0 = set_arc(segments, i, 0, p0[0], p0[1], p0[2], p0[3], p1[0], p1[1], p1[2], p1[3])
    r1 = set_arc(segments, i, ARC, p1[0], p1[1], p1[2], p1[3], p2[0], p2[1], p2[2], p2[3])
    r2 = set_arc(segments, i, 2 * ARC, p2[0], p2[1], p2[2], p2[3], p3[0], p3[1], p3[2], p3[3])
    for k in range(6):
        set_parameter(segments, i, k, 0.0, 1.0)
    return max(r0, r1, r2)


@compiled
def set_bezier(segments, i, q, sign, h, v, w):
    """(1): segment i, leaving with v and arriving with w."""
    p0, p3 = keyframe(q, i, sign), keyframe(q, i + 1, sign)
    k = h / 3.0
    p1 = moved(p0, k * v[0], k * v[1], k * v[2])
    p2 = moved(p3, -k * w[0], -k * w[1], -k * w[2])
    return set_controls(segments, i, p0, p1, p2, p3)


@compiled
def _blend(q, h, sign, i, tension, continuity, bias, v):
    """(2) and (3): v[0] leaving and v[1] reaching keyframe i, which has neighbours."""
    n = h.size
    a, b = step(q, i - 1, i, sign), step(q, i, i + 1, sign)
    before, after = h[(i - 1) % n], h[i % n]
    k = (1.0 - tension) / (before + after)
    left, right = k * (1.0 + bias) * after / before, k * (1.0 - bias) * before / after
    for c in range(3):
        v[0, c] = (1.0 + continuity) * left * a[c] + (1.0 - continuity) * right * b[c]
        v[1, c] = (1.0 - continuity) * left * a[c] + (1.0 + continuity) * right * b[c]


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Kochanek-Bartels segments; parameters: ends, then (or all 0) T, C, B by keyframe."""
    n, plain = q.shape[0], parameters.size == 1
    v, time, x = np.empty((n, 2, 3)), np.empty(5), np.empty((5, 3))
    for i in range(n):
        if closed or 0 < i < n - 1:
            t, c, b = 0.0, 0.0, 0.0
            if not plain:
                t, c, b = parameters[1 + i], parameters[1 + n + i], parameters[1 + 2 * n + i]
            _blend(q, h, sign, i, t, c, b, v[i])
        else:
            end = end_velocity(q, h, i, 3, parameters[0], time, x)
            v[i, 0, 0], v[i, 0, 1], v[i, 0, 2] = end
            v[i, 1] = v[i, 0]
    for i in range(h.size):
        j = (i + 1) % n
        report[REACH] = max(report[REACH], set_bezier(segments, i, q, sign, h[i], v[i, 0], v[j, 1]))
