"""The curve of least torque, against which the fairness of every other curve is measured."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from quatspline.engines import engine
from quatspline.families.rotation_vector import ROTATION_VECTOR
from quatspline.fitting.least_torque import minimise
from quatspline.kernels.jit import REACH
from quatspline.keyframes import Keyframes
from quatspline.options import AtMost, Count, Iterations, OnFailure, Positive
from quatspline.proposed.local_quintic import LocalQuinticSpline
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve

ROWS = 8000
"""Rows of array algebra that an iteration's work on one node counts as, see `engine.run`."""

MOST = 1_000_000
"""Subintervals, of 1.3 kB each while they are solved for."""

HIT = 1e-9
"""Largest miss at a keyframe in rad, where the tolerance is less: keyframes are nodes, so that a miss
is rounding, magnified where a turn between nodes is nearly a full one."""


class MinimumTorqueSpline(SegmentCurve):
    """Minimum-torque interpolant: least integral of |alpha|^2, free ends [barr1992; park1997].

    C^2, interpolating, global.  Every interval between keyframes is cut into sub-intervals with

        Q(u) = q_j exp(phi(u)),    phi the quintic of both ends' velocity and acceleration       (1)

    and the rates at all nodes and the turns of the inner ones minimise the Gauss sum

        E = sum_s sum_g w_g h_s |alpha_s(u_g)|^2                                                 (2)

    by Gauss-Newton steps on the banded normal equations, damped where E would rise.  A minimum has
    omega''' = omega'' x omega within intervals and alpha = 0 at the ends.  E bounds the true
    minimum from above, within 1e-8 at four sub-intervals, within one homotopy class of curves.

    Options
    -------
    subintervals
        An interval's; 1 is within 3e-4 of the energy at 4 on all keyframe sets of `torque_sets`, of steps up
        to 110 degrees, and within 7e-3 on those of `step_sets` at 170.
    tolerance, max_iterations, on_failure
        The iteration stops when the relative change of all unknowns meets the tolerance, or comes to rest above
        it, at rounding: no smaller change in eight updates, which by the gradient gain nothing.  That counts
        as converged, and `change` tells what was reached: about 1e-11 with one sub-interval.
        The curve must also meet its keyframes within the tolerance, or 1e-9 rad where that is less.
    """

    title = "Minimum torque (reference)"
    reference = "barr1992"
    continuity = 2
    order = 4
    support = None
    constant_rate = "everywhere"
    closable = False
    iterative = True
    practical_keyframes = 200
    rough = {"subintervals": 1}
    family = ROTATION_VECTOR

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        subintervals: Annotated[Count, AtMost(1000)] = 4,
        tolerance: Positive = 1e-6,
        max_iterations: Iterations = 200,
        on_failure: OnFailure = "raise",
    ) -> None:
        m = subintervals
        pieces = keyframes.tracks.shape[0] * keyframes.spacings.size * m
        if pieces > MOST:
            raise ValueError(
                f"{pieces // m:,} steps between keyframes of {m} subintervals each (subintervals={m}) are "
                f"{pieces:,}: at most {MOST:,} are solved for"
            )
        h = np.repeat(keyframes.spacings / m, m)
        knots = np.append(keyframes.inside(np.arange(m) / m), keyframes.knots[-1])
        nodes, rates = _start(keyframes, knots, m)
        segments = np.empty((len(nodes), h.size, self.family.constants))
        report = np.zeros((len(nodes), 4))
        # E of every track, rad^2 / time^3, and which came to rest at rounding
        work = ROWS * nodes.shape[0] * h.size
        self.energy, rest = engine.run(
            minimise, work, nodes, rates, h, m, tolerance, max_iterations, segments, report
        )
        self._set_segments(segments, report[:, REACH].max(), knots)
        self._report(
            "gauss-newton",
            "change",
            tolerance,
            report,
            on_failure,
            within=max(tolerance, HIT),
            settled=rest,
        )


def _start(keyframes: Keyframes, knots: FloatArray, m: int) -> tuple[FloatArray, FloatArray]:
    """Orientations (K, nodes, 4) at knots, and half the rates (K, nodes, 6), of which the search begins."""
    start = LocalQuinticSpline.from_keyframes(keyframes)
    nodes = np.moveaxis(start.inner(knots, 0), 1, 0).copy()
    nodes[:, ::m] = keyframes.tracks
    rates = np.empty((*nodes.shape[:2], 6))
    for order in (1, 2):
        half = rates[..., 3 * order - 3 : 3 * order]
        np.multiply(np.moveaxis(start.inner(knots, order), 1, 0), 0.5, out=half)
    return nodes, rates
