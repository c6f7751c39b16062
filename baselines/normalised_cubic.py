"""A cubic spline through the quaternions' four numbers, normalised: everyone's first idea."""

from __future__ import annotations

import numpy as np

from quatspline.families.normalised import NORMALISED, set_excess
from quatspline.kernels.jit import REACH, compiled, fit_kernel
from quatspline.kernels.values import keyframe, put_quat, quat_at
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve


@compiled
def bends(q, h, closed, sign):
    """m_i of (2) at every keyframe, (n, 4), by elimination from keyframe 0 on.

    On closed curves the last keyframe's m stays unknown as z; the others are y_i + z w_i, for their
    equations are tridiagonal.
    """
    n = q.shape[0]
    m, rest = np.zeros((n, 4)), np.zeros((n, 4))
    factor, w = np.zeros(n), np.zeros(n)
    first, last = (0, n - 1) if closed else (1, n - 1)
    for i in range(first, last):
        before, after = h[i - 1], h[i]
        pivot = 2.0 * (before + after)
        y, coupled = right_side(q, h, i, sign), 0.0
        if i == 0:
            coupled = -before * sign
        else:
            pivot -= before * factor[i - 1]
            y = y - before * quat_at(rest[i - 1], 0)
            coupled = -before * w[i - 1]
        if closed and i == n - 2:
            coupled -= after
        factor[i], w[i] = after / pivot, coupled / pivot
        put_quat(rest[i], 0, (1.0 / pivot) * y)
    for i in range(last - 1, first - 1, -1):  # m takes the y_i
        y = quat_at(rest[i], 0)
        if i < last - 1:
            y = y - factor[i] * quat_at(m[i + 1], 0)
            w[i] -= factor[i] * w[i + 1]
        put_quat(m[i], 0, y)
    if closed:
        before, after = h[n - 2], h[n - 1]
        pivot = 2.0 * (before + after) + before * w[n - 2] + after * sign * w[0]
        known = before * quat_at(m[n - 2], 0) + (after * sign) * quat_at(m[0], 0)
        z = (1.0 / pivot) * (right_side(q, h, n - 1, sign) - known)
        for i in range(n - 1):
            put_quat(m[i], 0, quat_at(m[i], 0) + w[i] * z)
        put_quat(m[n - 1], 0, z)
    return m


@compiled
def right_side(q, h, i, sign):
    """6 (s_i - s_{i-1})."""
    ahead = (6.0 / h[i]) * (keyframe(q, i + 1, sign) - keyframe(q, i, sign))
    return ahead - (6.0 / h[i - 1]) * (keyframe(q, i, sign) - keyframe(q, i - 1, sign))


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """f and g of the family from (2)."""
    m = bends(q, h, closed, sign)
    for i in range(h.size):
        k = h[i] * h[i] / 6.0
        m0, m1 = keyframe(m, i, sign), keyframe(m, i + 1, sign)
        a, b = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        set_excess(segments[i], a, b, (-k) * (2.0 * m0 + m1), k * (m0 + 2.0 * m1))
    report[REACH] = 0.0


class NormalisedCubic(SegmentCurve):
    """Normalised cubic spline in R^4 [deboor2001]: a spline of the four numbers, divided by its length.

    C^2, interpolating, global.  The natural cubic spline x through the aligned quaternions as points of R^4,

        Q(t) = x(t) / |x(t)|                                                                     (1)
        h_{i-1} m_{i-1} + 2 (h_{i-1} + h_i) m_i + h_i m_{i+1} = 6 (s_i - s_{i-1}),               (2)
        s_i = (q_{i+1} - q_i) / h_i,    m_i = x''(t_i),    m_0 = m_{n-1} = 0

    one tridiagonal linear system; closed curves have m_n = s m_0, with the sign s of the return.  Equal turns
    are no equal chords: a constant spin ripples, and steps towards 180 degrees cut through the ball.
    """

    title = "Normalised cubic spline in R⁴"
    reference = "deboor2001"
    continuity = 2
    order = 4
    support = None
    constant_rate = "no"
    family = NORMALISED

    def _fit(self, keyframes: Keyframes) -> None:
        self._solve(FIT)
