"""nu-quaternion spline of Nielson (2004): cubic B-spline by nested slerps, solved by iteration."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from quatspline.families.nested import TRIANGLE
from quatspline.fitting.bezier import set_controls
from quatspline.fitting.newton import STALLED
from quatspline.fitting.nu_rows import newton_legs
from quatspline.kernels.jit import (
    CHANGE,
    ITERATIONS,
    REACH,
    RESIDUAL,
    compiled,
    fit_kernel,
    inlined,
)
from quatspline.kernels.values import arc, keyframe, norm, put_quat, quat_at, slerp
from quatspline.keyframes import Keyframes
from quatspline.options import Iterations, OnFailure, Positive, Stop, per_keyframe
from quatspline.segments import SegmentCurve

METHOD, BY_RESIDUAL, TOLERANCE, LIMIT, STATIONARY, TENSION = range(6)
"""Places of the options among a fit kernel's parameters; the tensions are the rest."""

METHODS = ("jacobi", "gauss-seidel", "newton")
JACOBI, GAUSS_SEIDEL, NEWTON = range(3)


class Nielson(SegmentCurve):
    """nu-spline of Nielson (2004): interpolating cubic B-spline by de Casteljau with slerps.

    C^1 (not C^2: the acceleration jumps at keyframes, by O(h^3) on smooth motion), interpolating,
    global; order 4.  Control quaternions d_i, with h_i = t_i - t_{i-1} and tension nu_i:

        gamma_i  = 2 (h_i + h_{i+1}) / (nu_i h_i h_{i+1} + 2 (h_i + h_{i+1}))                     (1)
        lambda_i = (gamma_{i-1} h_{i-1} + h_i) / (gamma_{i-1} h_{i-1} + h_i + gamma_i h_{i+1})    (2)
        mu_i     = gamma_i h_i / (gamma_i h_i + h_{i+1} + gamma_{i+1} h_{i+2})                    (3)
        L_i = slerp(d_{i-1}, d_i, lambda_i),  R_i = slerp(d_i, d_{i+1}, mu_i)                     (4)
        q_i = slerp(L_i, R_i, delta_i),  delta_i = h_i / (h_i + h_{i+1})                          (5)

    Segment i is de Casteljau's algorithm on (q_i, R_i, L_{i+1}, q_{i+1}).  The published iteration
    solves (5) for each d_i in turn from the others [nielson2004].  At large steps or uneven times it
    may rest at a wrong fixed point; its residual tells, and the solve counts as failed.

    Options
    -------
    tension
        nu_i, one for every keyframe or one each; not negative.
    ends
        "natural", or "stationary": zero phantom spacings, so that the curve starts and stops at rest.
    method
        "jacobi" (as published: all d_i from the last set), "gauss-seidel" (the newest at once), or
        "newton" (`fitting.nu_rows`): the same curve in 3 to 6 updates, also where the others fail.
    stop, tolerance, max_iterations, on_failure
        As for every iterative scheme.
    """

    title = "Nielson's nu-quaternion spline"
    reference = "nielson2004"
    continuity = 1
    order = 4
    support = None
    constant_rate = "everywhere"
    iterative = True
    rescue = {"method": "newton"}
    family = TRIANGLE

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        tension: ArrayLike = 0.0,
        ends: Literal["natural", "stationary"] = "natural",
        method: Literal["jacobi", "gauss-seidel", "newton"] = "jacobi",
        stop: Stop = "residual",
        tolerance: Positive = 1e-6,
        max_iterations: Iterations = 2000,
        on_failure: OnFailure = "raise",
    ) -> None:
        nu = per_keyframe("tension", tension, keyframes.count, math.inf)
        if (nu < 0.0).any():
            i = int(np.argmax(nu < 0.0))
            raise ValueError(f"tension[{i}] = {nu[i]:g}: must not be negative")
        if ends == "stationary" and keyframes.closed:
            raise ValueError("ends='stationary': a closed curve has no ends")
        if (nu > 0.0).any():
            self.order = 2
        if ends == "stationary" or (nu > 0.0).any():
            self.constant_rate = "no"
        limit = max_iterations
        switches = [METHODS.index(method), stop == "residual", tolerance, limit]
        parameters = np.array([*switches, ends == "stationary", *nu], dtype=float)
        self._report(method, stop, tolerance, self._solve(FIT, parameters), on_failure)


@compiled
def _spacing(h, i, n, closed, stationary):
    """h_i = t_i - t_{i-1}; the phantoms h_0, h_n are 0 (stationary) or as their neighbours."""
    if closed:
        return h[(i - 1) % n]
    if i < 1 or i > n - 1:
        return 0.0 if stationary else h[0 if i < 1 else n - 2]
    return h[i - 1]


@compiled
def _weights(h, closed, stationary, nu):
    """lambda, mu, delta of every keyframe: (n, 3)."""
    n = nu.size
    gamma = np.empty(n)
    weights = np.empty((n, 3))
    for i in range(n):
        a, b = _spacing(h, i, n, closed, stationary), _spacing(h, i + 1, n, closed, stationary)
        gamma[i] = 2.0 * (a + b) / (nu[i] * a * b + 2.0 * (a + b))
    for i in range(n):
        before, after = gamma[(i - 1) % n], gamma[(i + 1) % n]
        h0 = _spacing(h, i - 1, n, closed, stationary)
        h1 = _spacing(h, i, n, closed, stationary)
        h2 = _spacing(h, i + 1, n, closed, stationary)
        h3 = _spacing(h, i + 2, n, closed, stationary)
        weights[i, 0] = (before * h0 + h1) / (before * h0 + h1 + gamma[i] * h2)
        weights[i, 1] = gamma[i] * h1 / (gamma[i] * h1 + h2 + after * h3)
        weights[i, 2] = h1 / (h1 + h2)
    return weights


@compiled
def _ratio(x, theta, sine):
    """sin(x theta) / sin(theta), x in the limit."""
    return math.sin(x * theta) / sine if theta > 0.0 else x


@compiled
def _sides(d, i, weights, sign):
    """(4): L_i and R_i."""
    a, b, c = keyframe(d, i - 1, sign), keyframe(d, i, sign), keyframe(d, i + 1, sign)
    return slerp(a, b, weights[i, 0]), slerp(b, c, weights[i, 1])


@compiled
def _update(d, i, weights, sign, q):
    """(5) solved for d_i, the others and the angles held."""
    a, b, c = keyframe(d, i - 1, sign), keyframe(d, i, sign), keyframe(d, i + 1, sign)
    left, right = _sides(d, i, weights, sign)
    ta, sa, _ = arc(a, b)
    tc, sc, _ = arc(b, c)
    beta, sb, _ = arc(left, right)
    lam, mu, delta = weights[i, 0], weights[i, 1], weights[i, 2]
    s1, s2 = _ratio(1.0 - delta, beta, sb), _ratio(delta, beta, sb)
    before, after = s1 * _ratio(1.0 - lam, ta, sa), s2 * _ratio(mu, tc, sc)
    own = s1 * _ratio(lam, ta, sa) + s2 * _ratio(1.0 - mu, tc, sc)
    p = (1.0 / own) * (quat_at(q[i], 0) - before * a - after * c)
    return (1.0 / norm(p)) * p


@compiled
def _miss(d, i, weights, sign, q):
    """The rotation angle between slerp(L_i, R_i, delta_i) and q_i."""
    left, right = _sides(d, i, weights, sign)
    theta, _, _ = arc(slerp(left, right, weights[i, 2]), quat_at(q[i], 0))
    return 2.0 * theta


@compiled
def _change(d, old):
    """||d - old|| / ||d||."""
    moved, size = 0.0, 0.0
    for i in range(d.shape[0]):
        step = quat_at(d[i], 0) - quat_at(old[i], 0)
        moved += step @ step
        size += quat_at(d[i], 0) @ quat_at(d[i], 0)
    return math.sqrt(moved / size)


@inlined
def _copy(source, target):
    for i in range(source.shape[0]):
        put_quat(target[i], 0, quat_at(source[i], 0))


@compiled
def _residual(d, first, last, weights, sign, q):
    worst = 0.0
    for i in range(first, last):
        miss = _miss(d, i, weights, sign, q)
        worst = max(worst, miss) if miss == miss else math.inf
    return worst


@compiled
def _iterate(q, weights, closed, sign, parameters, report):
    """The published iteration from d = q; fills the report."""
    jacobi, by_residual = parameters[METHOD] == JACOBI, parameters[BY_RESIDUAL] > 0.0
    tolerance, limit = parameters[TOLERANCE], parameters[LIMIT]
    n = q.shape[0]
    first, last = (0, n) if closed else (1, n - 1)
    d, old = q.copy(), q.copy()
    residual = _residual(d, first, last, weights, sign, q) if by_residual else math.inf
    change = 0.0
    count = 0
    while count < limit and first < last and not (by_residual and residual <= tolerance):
        _copy(d, old)
        source = old if jacobi else d
        for i in range(first, last):
            put_quat(d[i], 0, _update(source, i, weights, sign, q))
        change = _change(d, old)
        count += 1
        if not change < math.inf:  # no number any more: the last controls that were some
            change = math.inf
            _copy(old, d)
            break
        if by_residual:
            residual = _residual(d, first, last, weights, sign, q)
        if not (change > STALLED) or (not by_residual and change <= tolerance):
            break
    report[ITERATIONS], report[CHANGE] = count, change
    report[RESIDUAL] = _residual(d, first, last, weights, sign, q)
    return d


@compiled
def _set_iterated_legs(q, weights, closed, sign, parameters, legs, report):
    """R_i and L_{i+1} of every segment by the published iteration."""
    d = _iterate(q, weights, closed, sign, parameters, report)
    for i in range(legs.shape[0]):
        a, b = keyframe(d, i, sign), keyframe(d, i + 1, sign)
        put_quat(legs[i, 0], 0, slerp(a, b, weights[i, 1]))
        put_quat(legs[i, 1], 0, slerp(a, b, weights[(i + 1) % q.shape[0], 0]))


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Solve for the control quaternions, then store de Casteljau's arcs of every segment."""
    weights = _weights(h, closed, parameters[STATIONARY] > 0.0, parameters[TENSION:])
    legs = np.empty((h.size, 2, 4))
    if parameters[METHOD] == NEWTON:
        by_change, limit = parameters[BY_RESIDUAL] == 0.0, int(parameters[LIMIT])
        tolerance = parameters[TOLERANCE]
        newton_legs(q, weights, closed, sign, tolerance, by_change, limit, legs, report)
    else:
        _set_iterated_legs(q, weights, closed, sign, parameters, legs, report)
    reach = 0.0
    for i in range(h.size):
        p, r = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        right, left = quat_at(legs[i, 0], 0), quat_at(legs[i, 1], 0)
        reach = max(reach, set_controls(segments[i], p, right, left, r))
    report[REACH] = reach
