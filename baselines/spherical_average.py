"""Spherical averages of Buss & Fillmore: an interpolating cubic B-spline of weighted means."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from quatspline.families.means import SIZE, SPHERICAL_MEAN, WEIGHTS, curvature, newton_step
from quatspline.fitting import bspline
from quatspline.fitting.block_tridiagonal import backward, forward, workspace
from quatspline.fitting.mean_leaps import leaps, share_a_half
from quatspline.fitting.tangents import keyframe, moved
from quatspline.kernels.jit import CHANGE, ITERATIONS, RESIDUAL, compiled, fit_kernel, inlined
from quatspline.kernels.operations import Operations, Per
from quatspline.kernels.scalars import exp, log_between, mul
from quatspline.keyframes import Keyframes
from quatspline.options import Count, OnFailure, Positive, Stop
from quatspline.segments import SegmentCurve

CAP = 0.8
"""Largest half angle by which one update may turn a control."""
ARMIJO = 1e-4
SHORTEST = 1e-3
"""A step length below this means that Newton's direction no longer descends."""
ROUNDING = 1e-28
"""A sum of squared left sides this small has nothing left to descend."""


class SphericalAverage(SegmentCurve):
    """Interpolating cubic B-spline by spherical averages, Buss & Fillmore (2001).

    C^2, interpolating, global, order 4.  The curve is the mean on S^3 of four controls d_j with the
    weights of a cubic B-spline on the keyframes' knots (`spherical_mean`, `bspline`), so that at a
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
    operations = Operations(logs=Per(sample=12), iteration=Operations(logs=Per(keyframe=3)))
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
        max_iterations: Count = 100,
        on_failure: OnFailure = "raise",
    ) -> None:
        clamped = ends == "clamped" and not keyframes.closed
        parameters = np.array([stop == "residual", tolerance, max_iterations, clamped], float)
        self._report("newton", stop, tolerance, self._solve(FIT, parameters), on_failure)


@inlined
def _block(f, l):
    """f Jr^-1(2 l) = f (I + [l] + k [l]^2), row by row."""
    x, y, z = l
    r = x * x + y * y + z * z
    k = curvature(r)
    return (
        f * (1.0 + k * (x * x - r)),
        f * (k * x * y - z),
        f * (k * x * z + y),
        f * (k * x * y + z),
        f * (1.0 + k * (y * y - r)),
        f * (k * y * z - x),
        f * (k * x * z - y),
        f * (k * y * z + x),
        f * (1.0 + k * (z * z - r)),
    )


@inlined
def _sides(q, d, i, m, p, sign):
    """The three logarithms of (1) and its left side."""
    k = (q[i, 0], q[i, 1], q[i, 2], q[i, 3])
    a = log_between(*k, *keyframe(d, i - 1, sign))
    b = log_between(*k, *keyframe(d, i, sign))
    c = log_between(*k, *keyframe(d, i + 1, sign))
    own = 1.0 - m[i] - p[i]
    return (
        a,
        b,
        c,
        (
            m[i] * a[0] + own * b[0] + p[i] * c[0],
            m[i] * a[1] + own * b[1] + p[i] * c[1],
            m[i] * a[2] + own * b[2] + p[i] * c[2],
        ),
    )


@compiled
def _look(problem, d):
    """The sum of squares of (1) and the largest miss at a keyframe, to first order, in rad."""
    q, m, p, sign, first, last = problem
    total = worst = 0.0
    for i in range(first, last):
        _, _, _, (x, y, z) = _sides(q, d, i, m, p, sign)
        total += x * x + y * y + z * z
        b = keyframe(d, i, sign)
        w = (m[i], 1.0 - m[i] - p[i], p[i], 0.0)
        k = (q[i, 0], q[i, 1], q[i, 2], q[i, 3])
        x, y, z = newton_step(k, keyframe(d, i - 1, sign), b, keyframe(d, i + 1, sign), b, w)
        worst = max(worst, x * x + y * y + z * z)
    return total, 2.0 * math.sqrt(worst)


@compiled
def _direction(problem, d, work):
    """Newton's updates into work's x; returns the longest, or infinity."""
    q, m, p, sign, first, last = problem
    n, cyclic = last - first, first == 0
    for k in range(n):
        i = first + k
        a, b, c, (x, y, z) = _sides(q, d, i, m, p, sign)
        own = 1.0 - m[i] - p[i]
        lower, diagonal, upper = _block(m[i], a), _block(own, b), _block(p[i], c)
        forward(k, n, cyclic, lower, diagonal, upper, (-x, -y, -z), work)
    backward(n, cyclic, work)
    longest = 0.0
    for k in range(n):
        size = work[3][k, 0] ** 2 + work[3][k, 1] ** 2 + work[3][k, 2] ** 2
        longest = max(longest, size) if size < math.inf else math.inf
    return math.sqrt(longest)


@compiled
def _update(d, old, first, x, length):
    """d_i = old_i exp(length x_i); returns the change, ||d - old|| / ||d||."""
    total = 0.0
    for k in range(x.shape[0]):
        i = first + k
        turn = exp(length * x[k, 0], length * x[k, 1], length * x[k, 2])
        w, a, b, c = mul(old[i, 0], old[i, 1], old[i, 2], old[i, 3], *turn)
        s = 1.0 / math.sqrt(w * w + a * a + b * b + c * c)
        d[i, 0], d[i, 1], d[i, 2], d[i, 3] = s * w, s * a, s * b, s * c
        for j in range(4):
            total += (d[i, j] - old[i, j]) ** 2
    return math.sqrt(total / d.shape[0])


@inlined
def _copy(source, target):
    # a slice assignment would compile its error message's string functions: 13 s
    for i in range(source.shape[0]):
        for k in range(4):
            target[i, k] = source[i, k]


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
        if not by_residual and change <= tolerance:
            break
    report[ITERATIONS], report[CHANGE] = count, change


@inlined
def _beyond(d, i, j):
    """The reflection d_i d_j^-1 d_i."""
    a = (d[i, 0], d[i, 1], d[i, 2], d[i, 3])
    w, x, y, z = mul(*a, d[j, 0], -d[j, 1], -d[j, 2], -d[j, 3])
    return mul(w, x, y, z, *a)


@compiled
def _control(q, d, i, sign, closed, clamped):
    """d_i for i = -1 ... n, phantoms included."""
    n = d.shape[0]
    if not closed and clamped and (i < 0 or i >= n):
        return keyframe(q, 0 if i < 0 else n - 1, 1.0)
    if not closed and i < 0:
        return _beyond(d, 0, 1)
    if not closed and i >= n:
        return _beyond(d, n - 1, n - 2)
    return keyframe(d, i, sign)


@compiled
def _write(q, h, d, sign, closed, clamped, segments):
    """Constants of `spherical_mean`; returns whether the curve leaps, as means that are not unique do."""
    leaping = False
    for i in range(h.size):
        h0, h1 = (
            bspline.spacing(h, i - 2, closed, clamped),
            bspline.spacing(h, i - 1, closed, clamped),
        )
        h3, h4 = (
            bspline.spacing(h, i + 1, closed, clamped),
            bspline.spacing(h, i + 2, closed, clamped),
        )
        before = bspline.weight_before(h0, h1, h[i])
        after = bspline.weight_after(h[i], h3, h4)
        c = bspline.middle(h1, h[i], h3, bspline.weight_before(h1, h[i], h3))
        points = (
            _control(q, d, i - 1, sign, closed, clamped),
            _control(q, d, i, sign, closed, clamped),
            _control(q, d, i + 1, sign, closed, clamped),
            _control(q, d, i + 2, sign, closed, clamped),
        )
        for k in range(4):
            for j in range(4):
                segments[i, 4 * k + j] = points[k][j]
            segments[i, WEIGHTS + 1 + k] = c[k]
        segments[i, WEIGHTS], segments[i, SIZE - 1] = before, after
        if not (leaping or share_a_half(points)):
            leaping = leaps(points, before, c, after)
    return leaping


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Solve for the controls, then store them segment by segment."""
    n, clamped = q.shape[0], parameters[3] > 0.0
    m, p = np.empty(h.size + 1), np.empty(h.size + 1)
    bspline.knot_weights(h, closed, clamped, m, p)
    d = q.copy()
    if clamped:
        for end in range(2):
            i, k = (n - 1, -h[n - 2] / 3.0) if end else (0, h[0] / 3.0)
            x, y, z = bspline.end_velocity(q, h, end == 1)
            a = moved(keyframe(q, i, 1.0), k * x, k * y, k * z)
            d[i, 0], d[i, 1], d[i, 2], d[i, 3] = a
    first, last = (0, n) if closed else (1, n - 1)
    _iterate((q, m, p, sign, first, last), d, parameters, report)
    if _write(q, h, d, sign, closed, clamped, segments):
        report[RESIDUAL] = math.inf
