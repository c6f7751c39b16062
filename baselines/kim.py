"""Interpolating cumulative cubic B-spline of Kim, Kim & Shin (Computer Animation 1995).

Controls d_i are sought whose B-spline (`families.bspline`, (1)) meets the keyframes.  With
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

from quatspline._jit import compiled, fit_kernel, inlined
from quatspline.families.block_tridiagonal import (
    added,
    backward,
    forward,
    matmul,
    set_vector,
    vector,
    workspace,
)
from quatspline.families.bspline import (
    end_velocity,
    increments,
    knot_weights,
    quaternion,
    row,
    set_quaternion,
    small_log,
    squared,
    tie,
    turned,
    write_segments,
)
from quatspline.families.cumulative import CUMULATIVE
from quatspline.families.segments import REACH, SegmentCurve
from quatspline.keyframes import Keyframes
from quatspline.options import Count, OnFailure, Positive, Stop
from quatspline.primitives import between, log_between, mul, sinc, sinc_near
from quatspline.quaternion import FloatArray

METHOD, BY_CHANGE, TOLERANCE, LIMIT, CLAMPED, HAS_START, HAS_END, VELOCITIES = range(8)
PARAMETERS = VELOCITIES + 6
LIMITS = {"newton": 200, "fixed-point": 1000}

FAR = 3.2
"""Squared half angle from which `sinc_near` no longer serves."""

BEFORE, AFTER, WHOLE = 0, 3, 6
"""Columns of the jets (s, c, b) of m_k w_k, p_k w_{k+1} and w_{k+1} in row k."""

FAR = 3.2
"""Squared half angle from which `sinc_near` no longer serves."""

BEFORE, AFTER, WHOLE = 0, 3, 6
"""Columns of the jets (s, c, b) of m_k w_k, p_k w_{k+1} and w_{k+1} in row k."""

CAP = 0.8
"""Largest half angle by which one Newton update may turn an increment."""

ARMIJO = 1e-4
SHORTEST = 1e-3
"""A step length below this means that Newton's direction no longer descends."""

STAGE = 40
"""Updates after which a descent counts as stalled: those that succeed need 4 to 10."""

LEAST_GROWTH = 1.0 / 256.0
LEAST_GROWTH = 1.0 / 256.0
LOOSE = 1e-5
"""Tolerance of the homotopy's inner stages."""

TIES, QUADRATIC = 3, 1e-8
"""Corrections by `tie` at most; each squares the gap, and after one of 1e-8 nothing is left."""

ROUNDING = 1e-13
"""Misses below this are rounding: there the line search has nothing left to compare."""


@compiled
def far_sinc(z):
    """`sinc` as a call: rare in the loops below, whose code stays small."""
    return sinc(z)


@inlined
def set_jet(jets, k, first, z):
    """(s, c, b) of v with |v|^2 = z: sin|v|/|v|, cos|v|, and (1 - s c)/|v|^2, as Jr(2 v) needs."""
    if z < FAR:
        s, c = sinc_near(z)
    else:
        s, c = far_sinc(z)
    b = (1.0 - s * c) / z
    if z < 1e-3:  # the difference cancels; its series is exact to 1e-12 here
        b = 2.0 / 3.0 - z * (2.0 / 15.0 - z * (4.0 / 315.0))
    jets[k, first], jets[k, first + 1], jets[k, first + 2] = s, c, b


@compiled
def set_jets(m, p, w, jets):
    """Rows (s, c, b) at knot k of m w_k, p w_{k+1} and w_{k+1}: a loop of its own, as its many
    constants would fill the registers of any other."""
    n = w.shape[0]
    for k in range(n):
        z = squared(row(w, k))
        set_jet(jets, k + 1, BEFORE, m[k + 1] * m[k + 1] * z)
        set_jet(jets, k, AFTER, p[k] * p[k] * z)
        set_jet(jets, k, WHOLE, z)
    for c in range(3):
        jets[0, BEFORE + c], jets[n, AFTER + c] = jets[n, BEFORE + c], jets[0, AFTER + c]


@compiled
def look(problem, w, d, old, jets, misses):
    """Misses of (2) at w, in the frames of d_{k+1}: ln(exp(-w_{k+1}) d_k^-1 d_{k+1}) with (1).

    Returns the sum of their squares, the largest as a rotation angle, and the squared change of
    all controls against old.
    """
    targets, m, p, sign = problem
    n, cyclic = w.shape[0], sign != 0.0
    set_jets(m, p, w, jets)
    total = worst = change = 0.0
    before, w0, x0, y0, z0 = row(w, n - 1), 1.0, 0.0, 0.0, 0.0
    for k in range(n + 1):
        after = row(w, k if k < n else 0)
        f, g = m[k] * jets[k, BEFORE], p[k] * jets[k, AFTER]
        # d_k = q_k K_k^-1, K_k^-1 = exp(-p w_{k+1}) exp(m w_k)
        turn = mul(
            *(jets[k, AFTER + 1], -g * after[0], -g * after[1], -g * after[2]),
            *(jets[k, BEFORE + 1], f * before[0], f * before[1], f * before[2]),
        )
        w1, x1, y1, z1 = mul(*quaternion(targets, k), *turn)
        if not cyclic or k < n:  # a closed curve's last control is its first
            u, v, s, t = w1 - old[k, 0], x1 - old[k, 1], y1 - old[k, 2], z1 - old[k, 3]
            change += u * u + v * v + s * s + t * t
        set_quaternion(d, k, w1, x1, y1, z1)
        if k > 0:
            s, c = jets[k - 1, WHOLE], jets[k - 1, WHOLE + 1]
            relative = between(w0, x0, y0, z0, w1, x1, y1, z1)
            gap = between(c, s * before[0], s * before[1], s * before[2], *relative)
            miss = small_log(*gap)
            set_vector(misses, k - 1, miss)
            total += squared(miss)
            worst = max(worst, squared(miss))
        before, w0, x0, y0, z0 = after, w1, x1, y1, z1
    return total, 2.0 * math.sqrt(worst), change


@inlined
def spun(f, a, b, w):
    """f (I + a [v] + b [v]^2) of v = f w, from the jet of v:

    a = -s^2 and b give f Jr(2 v); a = -2 s c and 2 s^2 in place of b give f R(exp v)^T.
    """
    x, y, z = f * w[0], f * w[1], f * w[2]
    n = x * x + y * y + z * z
    return (
        f * (1.0 + b * (x * x - n)),
        f * (b * x * y - a * z),
        f * (b * x * z + a * y),
        f * (b * x * y + a * z),
        f * (1.0 + b * (y * y - n)),
        f * (b * y * z - a * x),
        f * (b * x * z - a * y),
        f * (b * y * z + a * x),
        f * (1.0 + b * (z * z - n)),
    )


@inlined
def knot_blocks(m, before, p, after, jets, k):
    """How K_k changes, in its own left frame: dK = (P d(after) - M d(before)) K,

    M = m Jr(2 m before),   P = p R(exp(-m before)) Jl(2 p after).
    """
    s, c, b = jets[k, BEFORE], jets[k, BEFORE + 1], jets[k, BEFORE + 2]
    t, g = jets[k, AFTER], jets[k, AFTER + 2]
    turn = spun(1.0, -2.0 * s * c * m, 2.0 * s * s * m * m, before)
    return spun(m, -s * s, b, before), matmul(turn, spun(p, t * t, g, after))


@compiled
def assemble(problem, w, jets, work):
    """Eliminate Newton's system for (2); work's x holds the misses and will hold the move.

    Row k, in the frame of d_{k+1}, with R = R(exp(w_{k+1}))^T:
    R M_k x_k + (Jr(2 w_{k+1}) - M_{k+1} - R P_k) x_{k+1} + P_{k+1} x_{k+2} = miss_k.
    """
    _, m, p, sign = problem
    n, misses = w.shape[0], work[3]
    here = row(w, 0)
    lower, upper = knot_blocks(m[0], row(w, n - 1), p[0], here, jets, 0)
    for k in range(n):
        after = row(w, k + 1 if k < n - 1 else 0)
        next_lower, next_upper = knot_blocks(m[k + 1], here, p[k + 1], after, jets, k + 1)
        s, c, b = jets[k, WHOLE], jets[k, WHOLE + 1], jets[k, WHOLE + 2]
        back = spun(1.0, -2.0 * s * c, 2.0 * s * s, here)
        diagonal = added(spun(1.0, -s * s, b, here), -1.0, next_lower)
        diagonal = added(diagonal, -1.0, matmul(back, upper))
        rhs = vector(misses, k)
        forward(k, n, sign != 0.0, matmul(back, lower), diagonal, next_upper, rhs, work)
        lower, upper, here = next_lower, next_upper, after
    backward(n, sign != 0.0, work)


@inlined
def copy(source, target, factor):
    """target = factor source, over the rows of source."""
    for k in range(source.shape[0]):
        for c in range(source.shape[1]):
            target[k, c] = factor * source[k, c]


@compiled
def descend(problem, w, controls, tolerance, by_change, limit):
    """Newton's method with capped, halved steps: (updates, residual, change, met, side).

    Changes w in place; controls[side] then belongs to it.
    """
    n, cyclic, side = w.shape[0], problem[3] != 0.0, 0
    work, move, jets = workspace(n, cyclic), np.empty((n, 3)), np.empty((n + 1, 9))
    total, worst, _ = look(problem, w, controls[0], controls[1], jets, work[3])
    updates, change, met = 0, 0.0, not by_change and worst <= tolerance
    while updates < limit and not met:
        assemble(problem, w, jets, work)
        longest = keep(work[3], move)
        if not longest < math.inf:
            break
        length, before, known = min(1.0, CAP / longest), total, worst
        shift(w, move, length)
        while True:
            total, worst, moved = look(
                problem, w, controls[1 - side], controls[side], jets, work[3]
            )
            if total <= (1.0 - 2.0 * ARMIJO * length) * before or worst <= ROUNDING:
                break
            length *= 0.5
            if not length >= SHORTEST:
                shift(w, move, -2.0 * length)
                return updates, known, change, False, side
            shift(w, move, -length)
        side, updates = 1 - side, updates + 1
        change = math.sqrt(moved / (n if cyclic else n + 1))
        met = change <= tolerance if by_change else worst <= tolerance
        if not (met or total < before):
            break
    return updates, worst, change, met, side


@inlined
def keep(x, move):
    """Copy Newton's move; returns its longest vector, infinite where one is not finite."""
    longest, doubt = 0.0, 0.0
    for k in range(x.shape[0]):
        move[k, 0], move[k, 1], move[k, 2] = x[k, 0], x[k, 1], x[k, 2]
        size = x[k, 0] ** 2 + x[k, 1] ** 2 + x[k, 2] ** 2
        longest = max(longest, size)
        doubt += 0.0 * size
    return math.sqrt(longest) if doubt == 0.0 else math.inf


@inlined
def shift(w, move, length):
    """w + length move, in place."""
    for k in range(w.shape[0]):
        for c in range(3):
            w[k, c] += length * move[k, c]


@compiled
def continued(problem, w, controls, tolerance, by_change, limit):
    """Homotopy in the data: the steps are eased to a share of themselves, which then grows to 1.

    What an eased problem's solution says about the next share starts the next descent.  Gives
    the keyframes themselves as controls where it fails.
    """
    targets, m, p, sign = problem
    n = w.shape[0]
    eased, best = np.empty((n + 1, 4)), np.empty((n, 3))
    done, growth, updates = 0.0, 0.25, 0
    while growth > LEAST_GROWTH and updates < limit:
        share = min(1.0, done + growth)
        ease(targets, share, eased, w)
        if done > 0.0:
            copy(best, w, share / done)
        last = share == 1.0
        more, _, change, met, side = descend(
            problem if last else (eased, m, p, sign),
            w,
            controls,
            tolerance if last else LOOSE,
            by_change and last,
            min(STAGE, limit - updates),
        )
        updates += more
        if met and last:
            return updates, change, True, side
        if met:
            copy(w, best, 1.0)
            done, growth = share, 2.0 * growth
        else:
            growth *= 0.5
    copy(targets, controls[0], 1.0)
    return updates, 0.0, False, 0


@compiled
def ease(targets, share, eased, w):
    """Targets whose steps are a share of the given ones, and those steps' logarithms w.

    Only steps count in (2), so that the end of a closed chain need not be its start.
    """
    copy(targets[:1], eased, 1.0)
    for k in range(w.shape[0]):
        x, y, z = log_between(*quaternion(targets, k), *quaternion(targets, k + 1))
        set_vector(w, k, (share * x, share * y, share * z))
        set_quaternion(eased, k + 1, *mul(*quaternion(eased, k), *turned(share, (x, y, z))))


@compiled
def relax(problem, w, d, tolerance, by_change, limit):
    """The published fixed point (3), all controls at once: (updates, change)."""
    targets, m, p, sign = problem
    n, cyclic = w.shape[0], sign != 0.0
    fresh = np.empty((n + 1, 4))
    copy(targets, d, 1.0)
    copy(targets, fresh, 1.0)
    updates, change = 0, 0.0
    while updates < limit:
        increments(d, w)
        worst = moved = 0.0
        for i in range(0 if cyclic else 1, n):
            before = row(w, i - 1 if i > 0 else n - 1)
            turn = mul(*turned(-m[i], before), *turned(p[i], row(w, i)))
            r = small_log(*between(*mul(*quaternion(d, i), *turn), *quaternion(targets, i)))
            worst = max(worst, squared(r))
            turn = turned(1.0 / (1.0 - m[i] - p[i]), r)
            set_quaternion(fresh, i, *mul(*quaternion(d, i), *turn))
            for c in range(4):
                moved += (fresh[i, c] - d[i, c]) ** 2
        if not by_change and 2.0 * math.sqrt(worst) <= tolerance:
            break
        if cyclic:
            for c in range(4):
                fresh[n, c] = sign * fresh[0, c]
        copy(fresh, d, 1.0)
        updates, change = updates + 1, math.sqrt(moved / (n if cyclic else n + 1))
        if by_change and change <= tolerance:
            break
    increments(d, w)
    return updates, change


@compiled
def pose(q, h, sign, clamped, velocities):
    """The problem (targets, m, p, sign), sign 0 for an open curve; velocities (2, 3) become the
    increments h v / 3 to a clamped curve's outer controls.

    Where the end controls are known, d_0 and d_{n-1} themselves are the targets, with m = p = 0.
    """
    n, closed = h.size, sign != 0.0
    targets, m, p = np.empty((n + 1, 4)), np.empty(n + 1), np.empty(n + 1)
    knot_weights(h, closed, clamped, m, p)
    copy(q, targets, 1.0)
    if closed:
        copy(q[:1], targets[n:], sign)
    else:
        m[0] = p[0] = m[n] = p[n] = 0.0
    if clamped:
        for c in range(3):
            velocities[0, c] *= h[0] / 3.0
            velocities[1, c] *= h[n - 1] / 3.0
        set_quaternion(targets, 0, *mul(*quaternion(q, 0), *turned(1.0, row(velocities, 0))))
        set_quaternion(targets, n, *mul(*quaternion(q, n), *turned(-1.0, row(velocities, 1))))
    return targets, m, p, sign


@inlined
def set_velocities(q, h, parameters, velocities):
    """Half the given end velocities (body, rad per time), or the chart's estimates."""
    for side in range(2):
        if parameters[HAS_START + side] != 0.0:
            for c in range(3):
                velocities[side, c] = 0.5 * parameters[VELOCITIES + 3 * side + c]
        else:
            x, y, z = end_velocity(q, h, side == 1)
            velocities[side, 0], velocities[side, 1], velocities[side, 2] = x, y, z


@compiled
def newton(problem, w, controls, tolerance, by_change, limit):
    """Newton from the steps' logarithms, then by homotopy: (updates, change, met, side)."""
    increments(problem[0], w)
    updates, worst, change, met, side = descend(
        problem, w, controls, tolerance, by_change, min(STAGE, limit)
    )
    if not met and worst > ROUNDING and updates < limit:
        more, change, met, side = continued(
            problem, w, controls, tolerance, by_change, limit - updates
        )
        updates += more
    return updates, change, met, side


@compiled
def settle(d, w, met):
    """Increments that lead exactly from control to control, d_{k+1} = d_k exp(w_{k+1})."""
    if not met:
        increments(d, w)
    else:
        for _ in range(TIES):
            if tie(d, w) <= QUADRATIC:
                break


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Segments of the interpolating spline; `parameters` as laid out by METHOD ... VELOCITIES."""
    clamped, by_change = parameters[CLAMPED] != 0.0, parameters[BY_CHANGE] != 0.0
    tolerance, limit = parameters[TOLERANCE], int(parameters[LIMIT])
    ends, w, side = np.zeros((2, 3)), np.empty((h.size, 3)), 0
    controls = np.empty((2, h.size + 1, 4))
    if clamped:
        set_velocities(q, h, parameters, ends)
    problem = pose(q, h, sign if closed else 0.0, clamped, ends)
    if parameters[METHOD] != 0.0:
        report[0], report[1] = relax(problem, w, controls[0], tolerance, by_change, limit)
        report[3], report[2] = write_segments(
            q, h, closed, clamped, sign, controls[0], w, ends, segments
        )
        return
    updates, change, met, side = newton(problem, w, controls, tolerance, by_change, limit)
    while True:
        settle(controls[side], w, met)
        report[3], report[2] = write_segments(
            q, h, closed, clamped, sign, controls[side], w, ends, segments
        )
        if not met or by_change or report[2] <= tolerance or updates >= limit:
            break
        # What is written misses by more than equation (2) did: ask (2) for more.
        more, _, change, met, side = descend(
            problem, w, controls, 0.1 * tolerance, False, limit - updates
        )
        updates += more
        if more == 0:
            break
    report[0], report[1] = updates, change


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
    family = CUMULATIVE
    operations = {"exps per sample": 3, "logs per keyframe": 1}

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
        max_iterations: Count | None = None,
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
    array = np.asarray(given)
    shapes = sorted({(3,), (*keyframes.track_shape, 3)}, key=len)
    if array.dtype.kind not in "iuf" or array.shape not in shapes:
        expected = " or ".join(map(str, shapes))
        raise ValueError(f"{name} has shape {array.shape}, {array.dtype}: expected {expected}")
    if not np.isfinite(array).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        raise ValueError(f"{name}{list(where)} = {array[where]}: not a finite number")
    rows: FloatArray = array.astype(float).reshape(-1, 3)
    return rows
