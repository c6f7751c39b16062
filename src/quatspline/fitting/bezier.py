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
from quatspline.fitting.tangents import end_velocity, step
from quatspline.kernels.jit import REACH, compiled, fit_kernel
from quatspline.kernels.values import exp, keyframe, put_vec, vec_at


@compiled
def set_controls(c, p0, p1, p2, p3):
    """Store De Casteljau's arcs on four controls as a segment's constants (`nested.TRIANGLE`)."""
    for k in range(6):
        set_parameter(c, k, 0.0, 1.0)
    return max(set_arc(c, 0, p0, p1), set_arc(c, ARC, p1, p2), set_arc(c, 2 * ARC, p2, p3))


@compiled
def _blend(q, h, sign, i, tension, continuity, bias, v):
    """(2) and (3): v[0] leaving and v[1] reaching keyframe i, which has neighbours."""
    n = h.size
    a, b = step(q, i - 1, i, sign), step(q, i, i + 1, sign)
    before, after = h[(i - 1) % n], h[i % n]
    k = (1.0 - tension) / (before + after)
    left = (k * (1.0 + bias) * after / before) * a
    right = (k * (1.0 - bias) * before / after) * b
    put_vec(v[0], 0, (1.0 + continuity) * left + (1.0 - continuity) * right)
    put_vec(v[1], 0, (1.0 - continuity) * left + (1.0 + continuity) * right)


@compiled
def _velocities(q, h, closed, sign, parameters):
    """v_i^out and v_i^in of every keyframe, (n, 2, 3)."""
    n, plain = q.shape[0], parameters.size == 1
    v, chart = np.empty((n, 2, 3)), np.empty((5, 4))
    for i in range(n):
        if closed or 0 < i < n - 1:
            t, c, b = 0.0, 0.0, 0.0
            if not plain:
                t, c, b = parameters[1 + i], parameters[1 + n + i], parameters[1 + 2 * n + i]
            _blend(q, h, sign, i, t, c, b, v[i])
        else:
            put_vec(v[i, 0], 0, end_velocity(q, h, i, 3, parameters[0], chart))
            v[i, 1] = v[i, 0]
    return v


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Kochanek-Bartels segments by (1); parameters: ends, then (or all 0) T, C, B by keyframe."""
    v = _velocities(q, h, closed, sign, parameters)
    reach = 0.0
    for i in range(h.size):
        q0, q1 = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        b = q0 * exp((h[i] / 3.0) * vec_at(v[i, 0], 0))
        c = q1 * exp((-h[i] / 3.0) * vec_at(v[(i + 1) % q.shape[0], 1], 0))
        reach = max(reach, set_controls(segments[i], q0, b, c, q1))
    report[REACH] = reach
