"""Normalised linear interpolation (nlerp): slerp's arcs at uneven speed, without a sine."""

from __future__ import annotations

from numba import carray

from quatspline.families.chords import SIZE, set_acceleration, set_chord, set_point, set_velocity
from quatspline.fitting.tangents import keyframe
from quatspline.kernels.jit import BLOCK, REACH, ROWS, fit_kernel, sample_kernel
from quatspline.kernels.operations import Operations, Per
from quatspline.keyframes import Keyframes
from quatspline.segments import Family, SegmentCurve


@sample_kernel
def ORIENTATION(sheet, n):
    """(1)."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        set_point(s, j, 1.0 - s[0, j], s[0, j])


@sample_kernel
def VELOCITY(sheet, n):
    """(2): weights 1 - u and u in chords.py (1)."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        set_velocity(s, j, 1.0 - s[0, j], -1.0, s[0, j], 1.0)


@sample_kernel
def ACCELERATION(sheet, n):
    """The same in chords.py (2)."""
    s = carray(sheet, (ROWS, BLOCK))
    for j in range(n):
        set_acceleration(s, j, 1.0 - s[0, j], -1.0, 0.0, s[0, j], 1.0, 0.0)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The chord from each keyframe to the next."""
    for i in range(h.size):
        theta = set_chord(segments, i, keyframe(q, i, sign), keyframe(q, i + 1, sign))
        report[REACH] = max(report[REACH], theta)


_KERNELS = (ORIENTATION, VELOCITY, ACCELERATION)


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
    family = Family(SIZE, near=_KERNELS, far=_KERNELS)
    operations = Operations(roots=Per(sample=1), logs=Per(segment=1))

    def _fit(self, keyframes: Keyframes) -> None:
        self._solve(FIT)
