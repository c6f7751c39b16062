"""Spherical averages of Buss & Fillmore: an interpolating cubic B-spline of weighted means."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from quatspline.families.means import SPHERICAL_MEAN, newton_step, set_mean
from quatspline.fitting.block_tridiagonal import backward, forward, workspace
from quatspline.fitting.bspline import (
    end_velocity,
    knot_weights,
    middle,
    spacing,
    weight_after,
    weight_before,
)
from quatspline.fitting.mean_leaps import leaps, share_a_half
from quatspline.fitting.newton import ARMIJO, CAP, SHORTEST, STALLED
from quatspline.kernels.jacobians import inverse_jacobian_matrix
from quatspline.kernels.jit import (
    CHANGE,
    ITERATIONS,
    REACH,
    RESIDUAL,
    compiled,
    fit_kernel,
    inlined,
)
from quatspline.kernels.values import exp, keyframe, log, norm, put_quat, quat_at, unit, vec_at
from quatspline.keyframes import Keyframes
from quatspline.options import Iterations, OnFailure, Positive, Stop
from quatspline.segments import SegmentCurve

ROUNDING = 1e-28
"""A sum of squared left sides this small has nothing left to descend."""


class SphericalAverage(SegmentCurve):
    """Interpolating cubic B-spline by spherical averages, Buss & Fillmore (2001).

    C^2, interpolating, global, order 4.  The curve is the mean on S^3 of four controls d_j with the
    weights of a cubic B-spline on the keyframes' knots (`means`, `bspline`), so that at a
    keyframe, with weights m_i, c_i, p_i,

        m_i ln(q_i^-1 d_{i-1}) + c_i ln(q_i^-1 d_i) + p_i ln(q_i^-1 d_{i+1}) = 0                   (1)

    solved for all d_i at once by Newton's method, block tridiagonal, with halved steps.  The iteration
    of the publication [buss2001] is not known to us.  A mean is unique while its four controls lie in
    one open half of S^3.  Beyond that the curve may leap between keyframes that it meets: where a
    search along the segment finds a leap, the residual is infinite and the solve counts as failed.

    Options
    -------
    ends
        "natural": knots and controls reflected at the ends, no angular acceleration there, order 2.
        "clamped": end velocities estimated in the chart of four keyframes.
    stop, tolerance, max_iterations, on_failure
        As for every iterative scheme.
    """

    title = "Spherical average B-spline"
    reference = "buss2001"
    continuity = 2
    order = 4
    support = None
    constant_rate = "everywhere"
    iterative = True
    family = SPHERICAL_MEAN
    departs = {
        "test_keeps_given_signs": "controls of so long a step share no half sphere: no solution found"
    }

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        ends: Literal["natural", "clamped"] = "natural",
        stop: Stop = "residual",
        tolerance: Positive = 1e-6,
        max_iterations: Iterations = 100,
        on_failure: OnFailure = "raise",
    ) -> None:
        clamped = ends == "clamped" and not keyframes.closed
        parameters = np.array([stop == "residual", tolerance, max_iterations, clamped], float)
        self._report("newton", stop, tolerance, self._solve(FIT, parameters), on_failure)


@inlined
def _sides(q, d, i, m, p, sign):
    """The three logarithms of (1), their weights, and its left side."""
    k = quat_at(q[i], 0)
    a, b, c = keyframe(d, i - 1, sign), keyframe(d, i, sign), keyframe(d, i + 1, sign)
    l, w = (log(~k * a), log(~k * b), log(~k * c)), (m[i], 1.0 - m[i] - p[i], p[i])
    return l, w, w[0] * l[0] + w[1] * l[1] + w[2] * l[2]


@compiled
def _look(problem, d):
    """The sum of squares of (1) and the largest miss at a keyframe, to first order, in rad."""
    q, m, p, sign, first, last = problem
    total = worst = 0.0
    for i in range(first, last):
        _, w, side = _sides(q, d, i, m, p, sign)
        total += side @ side
        a, b, c = keyframe(d, i - 1, sign), keyframe(d, i, sign), keyframe(d, i + 1, sign)
        worst = max(worst, norm(newton_step(quat_at(q[i], 0), (a, b, c, b), (*w, 0.0))))
    return total, 2.0 * worst


@compiled
def _direction(problem, d, work):
    """Newton's updates into work's x; returns the longest, or infinity."""
    q, m, p, sign, first, last = problem
    n, cyclic = last - first, first == 0
    for k in range(n):
        l, w, side = _sides(q, d, first + k, m, p, sign)
        lower, own = w[0] * inverse_jacobian_matrix(l[0]), w[1] * inverse_jacobian_matrix(l[1])
        forward(k, n, cyclic, lower, own, w[2] * inverse_jacobian_matrix(l[2]), -side, work)
    backward(n, cyclic, work)
    longest = 0.0
    for k in range(n):
        size = norm(vec_at(work[3][k], 0))
        longest = max(longest, size) if size < math.inf else math.inf
    return longest


@compiled
def _update(d, old, first, x, length):
    """d_i = old_i exp(length x_i); returns the change, ||d - old|| / ||d||."""
    total = 0.0
    for k in range(x.shape[0]):
        before = quat_at(old[first + k], 0)
        after = unit(before * exp(length * vec_at(x[k], 0)))
        put_quat(d[first + k], 0, after)
        total += (after - before) @ (after - before)
    return math.sqrt(total / d.shape[0])


@inlined
def _copy(source, target):
    # a slice assignment would compile its error message's string functions: 13 s
    for i in range(source.shape[0]):
        put_quat(target[i], 0, quat_at(source[i], 0))


@compiled
def _iterate(problem, d, parameters, report):
    """Newton from d with halved steps."""
    by_residual, tolerance, limit = parameters[0] > 0.0, parameters[1], parameters[2]
    first, last = problem[4], problem[5]
    total, worst = _look(problem, d)
    count, change = 0, 0.0
    work, old = workspace(max(last - first, 1), first == 0), d.copy()
    while first < last and count < limit and not (by_residual and worst <= tolerance):
        longest = _direction(problem, d, work)
        if not longest < math.inf:
            break
        _copy(d, old)
        length, before = min(1.0, CAP / longest) if longest > 0.0 else 1.0, total
        change = _update(d, old, first, work[3], length)
        total, worst = _look(problem, d)
        while not (total <= (1.0 - 2.0 * ARMIJO * length) * before or total < ROUNDING):
            length *= 0.5
            if length < SHORTEST:
                _copy(old, d)
                report[ITERATIONS], report[CHANGE] = count, change
                return
            change = _update(d, old, first, work[3], length)
            total, worst = _look(problem, d)
        count += 1
        if change <= STALLED or (not by_residual and change <= tolerance):
            break
    report[ITERATIONS], report[CHANGE] = count, change


@inlined
def _beyond(d, i, j):
    """The reflection d_i d_j^-1 d_i."""
    return quat_at(d[i], 0) * ~quat_at(d[j], 0) * quat_at(d[i], 0)


@compiled
def _control(q, d, i, sign, closed, clamped):
    """d_i for i = -1 ... n, phantoms included."""
    n = d.shape[0]
    if not closed and clamped and (i < 0 or i >= n):
        return quat_at(q[0 if i < 0 else n - 1], 0)
    if not closed and i < 0:
        return _beyond(d, 0, 1)
    if not closed and i >= n:
        return _beyond(d, n - 1, n - 2)
    return keyframe(d, i, sign)


@inlined
def _controls(q, d, i, sign, closed, clamped):
    """d_{i-1} ... d_{i+2}."""
    return (
        _control(q, d, i - 1, sign, closed, clamped),
        _control(q, d, i, sign, closed, clamped),
        _control(q, d, i + 1, sign, closed, clamped),
        _control(q, d, i + 2, sign, closed, clamped),
    )


@inlined
def _weights(h, i, closed, clamped):
    """m_i, the coefficients of B_{i+1} + B_{i+2} and p_{i+1} on segment i."""
    h0, h1 = spacing(h, i - 2, closed, clamped), spacing(h, i - 1, closed, clamped)
    h3, h4 = spacing(h, i + 1, closed, clamped), spacing(h, i + 2, closed, clamped)
    inner = middle(h1, h[i], h3, weight_before(h1, h[i], h3))
    return weight_before(h0, h1, h[i]), inner, weight_after(h[i], h3, h4)


@compiled
def _write(q, h, d, sign, closed, clamped, segments):
    """Constants of `means`; returns whether the curve leaps, as means that are not unique do."""
    leaping = False
    for i in range(h.size):
        points = _controls(q, d, i, sign, closed, clamped)
        weights = _weights(h, i, closed, clamped)
        set_mean(segments[i], points, *weights)
        if not (leaping or share_a_half(points)):
            leaping = leaps(points, *weights)
    return leaping


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Solve for the controls, then store them segment by segment."""
    n, clamped = q.shape[0], parameters[3] > 0.0
    m, p = np.empty(h.size + 1), np.empty(h.size + 1)
    knot_weights(h, closed, clamped, m, p)
    d = q.copy()
    if clamped:
        start, end = (
            (h[0] / 3.0) * end_velocity(q, h, False),
            (h[-1] / 3.0) * end_velocity(q, h, True),
        )
        put_quat(d[0], 0, quat_at(q[0], 0) * exp(start))
        put_quat(d[n - 1], 0, quat_at(q[n - 1], 0) * exp(-end))
    first, last = (0, n) if closed else (1, n - 1)
    _iterate((q, m, p, sign, first, last), d, parameters, report)
    if _write(q, h, d, sign, closed, clamped, segments):
        report[RESIDUAL] = math.inf
    report[REACH] = 0.0
