"""Normalised linear interpolation (nlerp): slerp's arcs at uneven speed, without a sine."""

from __future__ import annotations

from quatspline.families.chords import (
    SIZE,
    set_chord,
    weighted_acceleration,
    weighted_point,
    weighted_velocity,
)
from quatspline.kernels.family import family
from quatspline.kernels.jit import REACH, fit_kernel, inlined
from quatspline.kernels.values import keyframe
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve


@inlined
def point(c, u):
    """(1)."""
    return weighted_point(c, 1.0 - u, u)


@inlined
def velocity(c, u):
    """(2): weights 1 - u and u in chords.py (2)."""
    return weighted_velocity(c, 1.0 - u, -1.0, u, 1.0)


@inlined
def acceleration(c, u):
    """The same in chords.py (3)."""
    return weighted_acceleration(c, 1.0 - u, -1.0, 0.0, u, 1.0, 0.0)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The chord from each keyframe to the next."""
    reach = 0.0
    for i in range(h.size):
        theta = set_chord(segments[i], keyframe(q, i, sign), keyframe(q, i + 1, sign))
        reach = max(reach, theta)
    report[REACH] = reach


class Nlerp(SegmentCurve):
    """Piecewise normalised linear interpolation (nlerp).

    C^0, interpolating, local (two keyframes shape a segment); slerp's arcs, slow at the ends of a
    segment and fast in its middle, by (1 + cos theta)/2 : 1:

        Q(u) = ((1 - u) q_i + u q_{i+1}) / |(1 - u) q_i + u q_{i+1}|                             (1)
        omega = 2 n phi'/h,  phi' = sin(theta) / (1 - 2u(1 - u)(1 - cos(theta)))                 (2)

    with theta n = L_i [shoemake1985, of which it is the chord].
    """

    title = "Normalised linear interpolation (nlerp)"
    reference = "shoemake1985"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "no"
    family = family(SIZE, point, velocity=velocity, acceleration=acceleration)

    def _fit(self, keyframes: Keyframes) -> None:
        self._solve(FIT)
