"""Catmull-Rom spline by the pyramid of Barry and Goldman, with slerps in place of lines."""

from __future__ import annotations

from quatspline.families.arcs import SIZE as ARC
from quatspline.families.arcs import set_arc
from quatspline.families.nested import TRIANGLE, set_parameter
from quatspline.kernels.jit import REACH, fit_kernel, inlined
from quatspline.kernels.values import keyframe, restored, slerp
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve


class BarryGoldman(SegmentCurve):
    """Catmull-Rom spline of Barry & Goldman (1988) with slerps, Schlag (1991).

    C^1, interpolating, local (four keyframes shape a segment); order 3.  On [t_i, t_{i+1}], with
    neighbours j = i - 1 ... i + 2 (here 0 ... 3),

        p_01 = slerp(q_0, q_1; (t - t_0)/(t_1 - t_0)),  p_12 and p_23 likewise                   (1)
        p_012 = slerp(p_01, p_12; (t - t_0)/(t_2 - t_0))                                         (2)
        p_123 = slerp(p_12, p_23; (t - t_1)/(t_3 - t_1))                                         (3)
        Q = slerp(p_012, p_123; (t - t_1)/(t_2 - t_1))                                           (4)

    At a keyframe it has the three-point velocity of `catmull-rom`.  The ends of open data are
    reflected, q_{-1} = slerp(q_1, q_0; 2) and t_{-1} = 2 t_0 - t_1: order 2 there
    [barry1988; schlag1991].
    """

    title = "Barry-Goldman-Schlag Catmull-Rom spline"
    reference = "schlag1991"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "everywhere"
    family = TRIANGLE

    def _fit(self, keyframes: Keyframes) -> None:
        self._solve(FIT)


@inlined
def _reflected(p, q):
    """slerp(p, q; 2): what lies beyond an open end q."""
    return restored(slerp(p, q, 2.0), p)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The three arcs of (1), and the parameters of (1)-(4) as functions of u."""
    n, reach = h.size, 0.0
    for i in range(n):
        inside, ahead = i > 0 or closed, i < n - 1 or closed
        b, c = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        a = keyframe(q, i - 1, sign) if inside else _reflected(c, b)
        d = keyframe(q, i + 2, sign) if ahead else _reflected(b, c)
        h1 = h[i]
        h0, h2 = h[i - 1] if inside else h1, h[(i + 1) % n] if ahead else h1
        s = segments[i]
        reach = max(reach, set_arc(s, 0, a, b), set_arc(s, ARC, b, c), set_arc(s, 2 * ARC, c, d))
        set_parameter(s, 0, 1.0, h1 / h0)
        set_parameter(s, 1, 0.0, 1.0)
        set_parameter(s, 2, -h1 / h2, h1 / h2)
        set_parameter(s, 3, h0 / (h0 + h1), h1 / (h0 + h1))
        set_parameter(s, 4, 0.0, h1 / (h1 + h2))
        set_parameter(s, 5, 0.0, 1.0)
    report[REACH] = reach
