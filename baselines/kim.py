"""Interpolating cumulative cubic B-spline of Kim, Kim & Shin (Computer Animation 1995).

Controls d_i are sought whose B-spline (`fitting.bspline`, (1)) meets the keyframes.  With
K_i = exp(-m_i w_i) exp(p_i w_{i+1}) the curve at knot i is d_i K_i, so that q_i = d_i K_i means

    d_i = q_i K_i^-1,                                                                          (1)
    K_i^-1 exp(w_{i+1}) K_{i+1} = q_i^-1 q_{i+1},                                              (2)

equations in the increments w alone.  ``method="newton"`` solves (2) for the w as free vectors:
their lengths may exceed pi, where the logarithms of the controls could not follow.
``method="fixed-point"`` is the published iteration

    d_i <- d_i exp(r_i / c_i),   r_i = ln((d_i K_i)^-1 q_i),   c_i = 1 - m_i - p_i,          (3)

with factor 3/2 on uniform knots; it contracts up to steps of about 100 degrees.
"""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np

from quatspline.families.cumulative import CUMULATIVE
from quatspline.fitting.bspline import (
    end_velocity,
    increments,
    knot_weights,
    set_phantoms,
    settle,
    write_segments,
)
from quatspline.fitting.bspline_rows import descend, solve
from quatspline.fitting.newton import STALLED, copy, moved
from quatspline.inputs.arrays import at, real_array, refuse_infinite
from quatspline.kernels.jit import CHANGE, ITERATIONS, REACH, RESIDUAL, compiled, fit_kernel
from quatspline.kernels.quick import exp, log
from quatspline.kernels.values import (
    keyframe,
    put_quat_column,
    put_vec_column,
    quat_at,
    quat_column,
    vec_at,
    vec_column,
)
from quatspline.keyframes import Keyframes
from quatspline.options import LARGEST, Iterations, OnFailure, Positive, Stop
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve

METHOD, BY_CHANGE, TOLERANCE, LIMIT, CLAMPED, HAS_START, HAS_END, VELOCITIES = range(8)

PARAMETERS = VELOCITIES + 6

LIMITS = {"newton": 200, "fixed-point": 1000}


@compiled
def relax(problem, w, d, tolerance, by_change, limit):
    """The published fixed point (3), all controls at once: (updates, change)."""
    targets, m, p, sign, clamped = problem
    n, cyclic = w.shape[1] - 2, sign != 0.0
    fresh = np.empty(d.shape)
    copy(targets, d, 1.0)
    copy(targets, fresh, 1.0)
    updates, change = 0, 0.0
    increments(d, w)
    while updates < limit:
        set_phantoms(w, cyclic, clamped)
        worst = 0.0
        for i in range(0 if cyclic else 1, n):
            k = exp(-m[i] * vec_column(w, i)) * exp(p[i] * vec_column(w, i + 1))
            r = log(~(quat_column(d, i) * k) * quat_column(targets, i))
            worst = max(worst, r @ r)
            step = exp((1.0 / (1.0 - m[i] - p[i])) * r)
            put_quat_column(fresh, i, quat_column(d, i) * step)
        if not by_change and 2.0 * math.sqrt(worst) <= tolerance:
            break
        if cyclic:
            put_quat_column(fresh, n, sign * quat_column(fresh, 0))
        updates, change = updates + 1, moved(fresh, d, n if cyclic else n + 1)
        copy(fresh, d, 1.0)
        increments(d, w)
        if change <= STALLED or (by_change and change <= tolerance):
            break
    return updates, change


@compiled
def pose(q, h, sign, clamped, w):
    """The problem (targets, m, p, sign, clamped), sign 0 for an open curve.

    Where the end controls are known, d_0 and d_N themselves are the targets, with m = p = 0; the
    increments h v / 3 that lead to those of a clamped curve stand in w already.
    """
    n, closed = h.size, sign != 0.0
    targets, m, p = np.empty((4, n + 1)), np.empty(n + 1), np.empty(n + 1)
    knot_weights(h, closed, clamped, m, p)
    for i in range(n + 1):
        put_quat_column(targets, i, keyframe(q, i, sign))
    if not closed:
        m[0] = p[0] = m[n] = p[n] = 0.0
    if clamped:
        put_quat_column(targets, 0, quat_at(q[0], 0) * exp(vec_column(w, 0)))
        put_quat_column(targets, n, quat_at(q[n], 0) * exp(-vec_column(w, n + 1)))
    return targets, m, p, sign, clamped


@compiled
def set_ends(q, h, parameters, w):
    """Increments h v / 3 to a clamped curve's outer controls, v given (halved) or estimated."""
    for side in range(2):
        v = 0.5 * vec_at(parameters, VELOCITIES + 3 * side)
        if parameters[HAS_START + side] == 0.0:
            v = end_velocity(q, h, side == 1)
        put_vec_column(w, side * (h.size + 1), (h[side * (h.size - 1)] / 3.0) * v)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Segments of the interpolating spline; `parameters` as laid out by METHOD ... VELOCITIES."""
    clamped, by_change = parameters[CLAMPED] != 0.0, parameters[BY_CHANGE] != 0.0
    tolerance, limit = parameters[TOLERANCE], int(parameters[LIMIT])
    w, d = np.empty((3, h.size + 2)), np.empty((4, h.size + 1))
    if clamped:
        set_ends(q, h, parameters, w)
    problem = pose(q, h, sign if closed else 0.0, clamped, w)
    if parameters[METHOD] != 0.0:
        report[ITERATIONS], report[CHANGE] = relax(problem, w, d, tolerance, by_change, limit)
        report[REACH], report[RESIDUAL] = write_segments(
            q, h, closed, clamped, sign, d, w, segments
        )
        return
    # In the room of the constants, which are written when the jets are no longer read.
    jets = segments.reshape(-1)[: 9 * (h.size + 1)].reshape((9, h.size + 1))
    x = w, d, jets
    updates, change, met = solve(problem, x, tolerance, by_change, limit)
    while True:
        settle(d, w, met)
        report[REACH], report[RESIDUAL] = write_segments(
            q, h, closed, clamped, sign, d, w, segments
        )
        if not met or by_change or report[RESIDUAL] <= tolerance or updates >= limit:
            break
        # What is written misses by more than equation (2) did: ask (2) for more.
        more, _, change, met = descend(problem, x, 0.1 * tolerance, by_change, limit - updates)
        updates += more
        if more == 0:
            break
    report[ITERATIONS], report[CHANGE] = updates, change


class Kim(SegmentCurve):
    """Interpolating cumulative cubic B-spline of Kim, Kim & Shin (1995).

    C^2, interpolating, global: every keyframe shapes the whole curve.  The controls solve the
    block-tridiagonal equations (1), (2) of this module; a sample is three exponentials multiplied.
    Third order only, as these do not commute, and not symmetric in time [kim1995bspline].

    Options
    -------
    ends : "natural" (no angular acceleration at the ends) or "clamped"; closed curves have none
    start_velocity, end_velocity : body angular velocities (3,) or (*K, 3) in rad per time, with
        clamped ends; by default the chart estimates from four keyframes
    method : "newton" on the increments, or the published "fixed-point"
    stop, tolerance, max_iterations, on_failure : as for every iterative scheme
    """

    title = "Interpolating cumulative cubic B-spline"
    reference = "kim1995bspline"
    continuity = 2
    order = 3
    support = None
    constant_rate = "everywhere"
    iterative = True
    measures_itself = True
    family = CUMULATIVE

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        ends: Literal["natural", "clamped"] = "natural",
        start_velocity: Any = None,
        end_velocity: Any = None,
        method: Literal["newton", "fixed-point"] = "newton",
        stop: Stop = "residual",
        tolerance: Positive = 1e-6,
        max_iterations: Iterations | None = None,
        on_failure: OnFailure = "raise",
    ) -> None:
        if keyframes.closed and ends == "clamped":
            raise ValueError("ends='clamped': a closed curve has no ends")
        parameters = np.zeros((keyframes.tracks.shape[0], PARAMETERS))
        parameters[:, METHOD] = method == "fixed-point"
        parameters[:, BY_CHANGE] = stop == "change"
        parameters[:, TOLERANCE] = tolerance
        parameters[:, LIMIT] = max_iterations or LIMITS[method]
        parameters[:, CLAMPED] = ends == "clamped"
        given = {"start_velocity": start_velocity, "end_velocity": end_velocity}
        for side, (name, velocity) in enumerate(given.items()):
            if velocity is not None:
                first = VELOCITIES + 3 * side
                parameters[:, HAS_START + side] = 1.0
                parameters[:, first : first + 3] = _velocities(name, velocity, ends, keyframes)
        self._report(method, stop, tolerance, self._solve_tracks(parameters), on_failure)

    def _solve_tracks(self, parameters: FloatArray) -> FloatArray:
        """Fit all tracks at once or, where their end velocities differ, one by one."""
        if (parameters == parameters[0]).all():
            return self._solve(FIT, parameters[0])
        frames, segments, reports = self._keyframes, [], []
        for k, own in enumerate(parameters):
            self._keyframes = frames.track(k)
            reports.append(self._solve(FIT, own))
            segments.append(self.segments)
        self._keyframes, report = frames, np.concatenate(reports)
        self._set_segments(np.concatenate(segments), report[:, REACH].max())
        return report


def _velocities(name: str, given: Any, ends: str, keyframes: Keyframes) -> FloatArray:
    """End velocities (3,) or (*K, 3) as rows, refused where they are not finite numbers."""
    if ends != "clamped":
        raise ValueError(f"{name}: only with ends='clamped', not ends={ends!r}")
    array = real_array(name, given)
    shapes = sorted({(3,), (*keyframes.track_shape, 3)}, key=len)
    if array.shape not in shapes:
        expected = " or ".join(map(str, shapes))
        raise ValueError(f"{name} has shape {array.shape}: expected {expected}")
    refuse_infinite(name, array)
    h = keyframes.spacings[0 if name == "start_velocity" else -1]
    if (np.abs(array) * h > LARGEST).any():
        where = tuple(int(i) for i in np.argwhere(np.abs(array) * h > LARGEST)[0])
        raise ValueError(
            f"{at(name, where)} = {array[where]:g}: more than {LARGEST:g} rad on a segment of {h:g}"
        )
    rows: FloatArray = array.astype(float).reshape(-1, 3)
    return rows
