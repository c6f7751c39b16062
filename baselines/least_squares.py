"""Least squares: a cumulative cubic B-spline on fewer knots, as near its keyframes as these allow."""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline.families.cumulative import CUMULATIVE
from quatspline.fitting.knots import knots_of
from quatspline.fitting.least_squares import LeastSquares
from quatspline.fitting.smoothing import REST
from quatspline.fitting.weights import positive
from quatspline.kernels.jit import REACH
from quatspline.keyframes import Keyframes
from quatspline.options import Iterations, OnFailure, Positive
from quatspline.segments import SegmentCurve


class LeastSquaresSpline(SegmentCurve):
    """Least-squares cumulative cubic B-spline on given knots, after [sommer2020]: C^2, global, not interpolating.

    Controls d_j on clamped knots are sought that minimise sum w_i |2 ln(Q(t_i)^-1 q_i)|^2: on one axis the
    spline of scipy's ``make_lsq_spline`` with k = 3.  It serves for compression: a quaternion for every knot
    and three more, instead of one for every keyframe.

    Options
    -------
    knots
        Interior knots, as times in the keyframes' own unit; or their number, for that many at keyframes, as
        evenly as these allow.  By default about every second keyframe has one.
    weights
        w, of one keyframe each: 1 over the variance of its errors in units of the others'.
    tolerance, max_iterations, on_failure
        The solve stops when an update turns no control by more than the tolerance, in rad: that is the
        report's residual; one that comes to rest above it, at rounding, has converged too.

    Attributes
    ----------
    knots : all knots, both ends among them, in time since the first keyframe, (N + 1,)
    controls : control quaternions d_j, (N + 3, *K, 4)
    """

    title = "Least-squares cumulative cubic B-spline"
    reference = "sommer2020"
    interpolates = False
    continuity = 2
    order = 3
    support = None
    constant_rate = "everywhere"
    closable = False
    iterative = True
    measures_itself = True
    min_keyframes = 4
    family = CUMULATIVE
    departs = {
        "test_order": "from 641 keyframes on; with fewer, errors of order 4 outweigh those of order 3"
    }

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        knots: Any = None,
        weights: Any = None,
        tolerance: Positive = 1e-10,
        max_iterations: Iterations = 100,
        on_failure: OnFailure = "raise",
    ) -> None:
        self.knots = knots_of(keyframes, knots)
        w = positive(weights, keyframes.count)
        tracks, rest, controls = keyframes.tracks.shape[0], [], []
        segments = np.empty((tracks, self.knots.size - 1, self.family.constants))
        report = np.empty((tracks, 4))
        for k in range(tracks):
            problem = LeastSquares(keyframes.track(k), self.knots, w)
            found = problem.solve(tolerance, max_iterations)
            report[k, :REACH] = found.iterations, found.change, found.residual
            report[k, REACH] = problem.write(found.state, segments[k])
            controls.append(found.state.d)
            rest.append(found.rest)
        self.controls = np.stack(controls, axis=1).reshape(-1, *keyframes.track_shape, 4)
        self._set_segments(segments, report[:, REACH].max(), self.knots)
        judged = "levenberg", "residual", tolerance, report, on_failure
        self._report(*judged, within=max(tolerance, REST), settled=np.array(rest))
