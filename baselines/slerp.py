"""Spherical linear interpolation (slerp): the plain reference."""

from __future__ import annotations

from quatspline.families.arcs import ARC, set_arc
from quatspline.kernels.jit import REACH, fit_kernel
from quatspline.kernels.values import keyframe
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve


class Slerp(SegmentCurve):
    """Piecewise spherical linear interpolation, Shoemake (1985).

    C^0, interpolating, local (two keyframes shape a segment), constant rate on each segment:

        Q(u) = q_i (q_i^-1 q_{i+1})^u = q_i cos(u theta) + b_i sin(u theta)                      (1)

    with b_i orthogonal to q_i on the arc to q_{i+1} [shoemake1985].
    """

    title = "Spherical linear interpolation (slerp)"
    reference = "shoemake1985"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    family = ARC

    def _fit(self, keyframes: Keyframes) -> None:
        self._solve(FIT)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The arc from each keyframe to the next."""
    reach = 0.0
    for i in range(h.size):
        theta = set_arc(segments[i], 0, keyframe(q, i, sign), keyframe(q, i + 1, sign))
        reach = max(reach, theta)
    report[REACH] = reach
