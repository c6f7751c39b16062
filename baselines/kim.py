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
    control,
    end_velocity,
    increment,
    increments,
    keyframe,
    knot_weights,
    set_control,
    set_phantoms,
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
"""Rows of the jets (s, c, b) of m_k w_k, p_k w_{k+1} and w_{k+1}."""

LOWER, OWN, UPPER, COLUMNS = 0, 9, 18, 64
"""Rows of a sheet of Newton's blocks, so many columns at a time."""

CAP = 0.8
"""Largest half angle by which one Newton update may turn an increment."""

ARMIJO = 1e-4
SHORTEST = 1e-3
"""A step length below this means that Newton's direction no longer descends."""

STAGE = 40
"""Updates after which a descent counts as stalled: those that succeed need 4 to 10."""

LEAST_GROWTH = 1.0 / 256.0
LOOSE = 1e-5
"""Tolerance of the homotopy's inner stages."""

TIES, QUADRATIC = 3, 1e-8
"""Corrections by `tie` at most; each squares the gap, and after one of 1e-8 nothing is left."""

ROUNDING = 1e-13
"""Misses below this are rounding: there the line search has nothing left to compare."""


@inlined
def set_jet(s, c, b, k, z):
    """sin|v|/|v|, cos|v| and (1 - s c)/|v|^2, of which Jr(2 v) is made, for |v|^2 = z below FAR."""
    s[k], c[k] = sinc_near(z)
    # The difference cancels where z is small; its series is exact to 1e-12 there.
    series = 2.0 / 3.0 - z * (2.0 / 15.0 - z * (4.0 / 315.0))
    b[k] = series if z < 1e-3 else (1.0 - s[k] * c[k]) / max(z, 1e-3)


@compiled
def set_far_jets(jets, m, p, j, size):
    """`set_jet` of the three multiples of w_j for any size = |w_j|^2."""
    for first in range(BEFORE, WHOLE + 1, 3):
        k = j if first == BEFORE else j - 1
        if k >= 0 and k < m.size:
            factor = m[k] if first == BEFORE else p[k] if first == AFTER else 1.0
            z = factor * factor * size
            s, c = sinc(z)
            jets[first, k], jets[first + 1, k] = s, c
            jets[first + 2, k] = 2.0 / 3.0 if z < 1e-6 else (1.0 - s * c) / z


@compiled
def set_jets(m, p, w, jets):
    """The jets (s, c, b) of m_k w_k, p_k w_{k+1} and w_{k+1} for every knot k, in rows BEFORE,
    AFTER and WHOLE; loops of few constants and no branch, which vectorise."""
    n = m.size
    x, y, z = w[0], w[1], w[2]
    size = np.empty(n + 1)
    for j in range(n + 1):
        size[j] = x[j] * x[j] + y[j] * y[j] + z[j] * z[j]
    s, c, b = jets[BEFORE], jets[BEFORE + 1], jets[BEFORE + 2]
    for k in range(n):
        set_jet(s, c, b, k, m[k] * m[k] * size[k])
    s, c, b = jets[AFTER], jets[AFTER + 1], jets[AFTER + 2]
    for k in range(n):
        set_jet(s, c, b, k, p[k] * p[k] * size[k + 1])
    s, c, b = jets[WHOLE], jets[WHOLE + 1], jets[WHOLE + 2]
    for k in range(n):
        set_jet(s, c, b, k, size[k + 1])
    for j in range(n + 1):
        if not size[j] < FAR:
            set_far_jets(jets, m, p, j, size[j])


@compiled
def set_controls(m, p, w, jets, targets, d):
    """(1): d_k = q_k K_k^-1 with K_k^-1 = exp(-p_k w_{k+1}) exp(m_k w_k)."""
    x, y, z = w[0], w[1], w[2]
    s, c, t, e = jets[BEFORE], jets[BEFORE + 1], jets[AFTER], jets[AFTER + 1]
    q0, q1, q2, q3 = targets[0], targets[1], targets[2], targets[3]
    d0, d1, d2, d3 = d[0], d[1], d[2], d[3]
    for k in range(m.size):
        f, g = m[k] * s[k], -p[k] * t[k]
        after = (e[k], g * x[k + 1], g * y[k + 1], g * z[k + 1])
        turn = mul(*after, c[k], f * x[k], f * y[k], f * z[k])
        d0[k], d1[k], d2[k], d3[k] = mul(q0[k], q1[k], q2[k], q3[k], *turn)


@compiled
def look(problem, w, d, jets, misses):
    """Misses of (2) at w: (sum of squares, largest as a rotation angle).

    In the frame of d_{k+1} they are ln(exp(-w_{k+1}) d_k^-1 d_{k+1}) with the controls (1).
    """
    targets, m, p, sign, clamped = problem
    n = misses.shape[0]
    set_phantoms(w, sign != 0.0, clamped)
    set_jets(m, p, w, jets)
    set_controls(m, p, w, jets, targets, d)
    gaps = np.empty((4, n))
    set_gaps(w, jets, d, gaps)
    total = worst = 0.0
    for k in range(n):
        miss = small_log(*control(gaps, k))
        set_vector(misses, k, miss)
        total += squared(miss)
        worst = max(worst, squared(miss))
    return total, 2.0 * math.sqrt(worst)


@compiled
def set_gaps(w, jets, d, gaps):
    """exp(-w_{k+1}) d_k^-1 d_{k+1}."""
    x, y, z = w[0], w[1], w[2]
    s, c = jets[WHOLE], jets[WHOLE + 1]
    d0, d1, d2, d3 = d[0], d[1], d[2], d[3]
    g0, g1, g2, g3 = gaps[0], gaps[1], gaps[2], gaps[3]
    for k in range(gaps.shape[1]):
        step = between(d0[k], d1[k], d2[k], d3[k], d0[k + 1], d1[k + 1], d2[k + 1], d3[k + 1])
        whole = (c[k], s[k] * x[k + 1], s[k] * y[k + 1], s[k] * z[k + 1])
        g0[k], g1[k], g2[k], g3[k] = between(*whole, *step)


@inlined
def spun(f, a, b, x, y, z):
    """f (I + a [v] + b [v]^2) of v = f (x, y, z), from the jet of v:

    a = -s^2 and b give f Jr(2 v); a = -2 s c and 2 s^2 in place of b give f R(exp v)^T.
    """
    x, y, z = f * x, f * y, f * z
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
def scattered(sheet, first, j, a):
    """Write a block down column j of the sheet."""
    sheet[(first + 0) * COLUMNS + j] = a[0]
    sheet[(first + 1) * COLUMNS + j] = a[1]
    sheet[(first + 2) * COLUMNS + j] = a[2]
    sheet[(first + 3) * COLUMNS + j] = a[3]
    sheet[(first + 4) * COLUMNS + j] = a[4]
    sheet[(first + 5) * COLUMNS + j] = a[5]
    sheet[(first + 6) * COLUMNS + j] = a[6]
    sheet[(first + 7) * COLUMNS + j] = a[7]
    sheet[(first + 8) * COLUMNS + j] = a[8]


@inlined
def gathered(sheet, first, j):
    """Read a block from column j of the sheet."""
    return (
        sheet[(first + 0) * COLUMNS + j],
        sheet[(first + 1) * COLUMNS + j],
        sheet[(first + 2) * COLUMNS + j],
        sheet[(first + 3) * COLUMNS + j],
        sheet[(first + 4) * COLUMNS + j],
        sheet[(first + 5) * COLUMNS + j],
        sheet[(first + 6) * COLUMNS + j],
        sheet[(first + 7) * COLUMNS + j],
        sheet[(first + 8) * COLUMNS + j],
    )


@compiled
def set_knot_blocks(start, count, m, p, w, jets, sheet):
    """How K_k changes in its own left frame: dK = (P_k d(w_{k+1}) - M_k d(w_k)) K; here

    P_k = p R(exp(-m w_k)) Jl(2 p w_{k+1}), and M_k = m Jr(2 m w_k) where it is needed.
    """
    # slices: an index that starts at 0 cannot be negative, which keeps the loop free of checks
    x, y, z, m, p = w[0, start:], w[1, start:], w[2, start:], m[start:], p[start:]
    s, c = jets[BEFORE, start:], jets[BEFORE + 1, start:]
    t, g = jets[AFTER, start:], jets[AFTER + 2, start:]
    for k in range(count):
        f = 2.0 * s[k] * m[k]
        turn = spun(1.0, -c[k] * f, m[k] * s[k] * f, x[k], y[k], z[k])
        left = spun(p[k], t[k] * t[k], g[k], x[k + 1], y[k + 1], z[k + 1])
        scattered(sheet, UPPER, k, matmul(turn, left))


@compiled
def set_row_blocks(start, count, m, w, jets, sheet):
    """Blocks of rows k = start ... of Newton's system, see `assemble`."""
    x, y, z, m = w[0, start:], w[1, start:], w[2, start:], m[start:]
    s, b = jets[BEFORE, start:], jets[BEFORE + 2, start:]
    t, e, g = jets[WHOLE, start:], jets[WHOLE + 1, start:], jets[WHOLE + 2, start:]
    for k in range(count):
        u, v, t2 = k + 1, m[k + 1], t[k] * t[k]
        back = spun(1.0, -2.0 * t[k] * e[k], 2.0 * t2, x[u], y[u], z[u])
        own = added(
            spun(1.0, -t2, g[k], x[u], y[u], z[u]),
            -1.0,
            spun(v, -s[u] * s[u], b[u], x[u], y[u], z[u]),
        )
        own = added(own, -1.0, matmul(back, gathered(sheet, UPPER, k)))
        lower = matmul(back, spun(m[k], -s[k] * s[k], b[k], x[k], y[k], z[k]))
        scattered(sheet, LOWER, k, lower)
        scattered(sheet, OWN, k, own)


@compiled
def assemble(problem, w, jets, work):
    """Solve Newton's system for (2); work's x holds the misses and then the move.

    Row k, in the frame of d_{k+1}, with R = R(exp(w_{k+1}))^T:
    R M_k x_k + (Jr(2 w_{k+1}) - M_{k+1} - R P_k) x_{k+1} + P_{k+1} x_{k+2} = miss_k.
    """
    _, m, p, sign, _ = problem
    n, misses = w.shape[1] - 2, work[3]
    sheet = np.empty(27 * COLUMNS)
    for start in range(0, n, COLUMNS - 1):
        count = min(COLUMNS - 1, n - start)
        set_knot_blocks(start, count + 1, m, p, w, jets, sheet)
        set_row_blocks(start, count, m, w, jets, sheet)
        for j in range(count):
            lower, own = gathered(sheet, LOWER, j), gathered(sheet, OWN, j)
            upper, rhs = gathered(sheet, UPPER, j + 1), vector(misses, start + j)
            forward(start + j, n, sign != 0.0, lower, own, upper, rhs, work)
    backward(n, sign != 0.0, work)


@inlined
def copy(source, target, factor):
    """target = factor source, over the columns of source."""
    for c in range(source.shape[0]):
        for k in range(source.shape[1]):
            target[c, k] = factor * source[c, k]


@inlined
def moved(d, old, count):
    """Relative change of the first count controls."""
    total = 0.0
    for c in range(4):
        for k in range(count):
            total += (d[c, k] - old[c, k]) ** 2
    return math.sqrt(total / count)


@compiled
def descend(problem, w, controls, tolerance, by_change, limit):
    """Newton's method with capped, halved steps: (updates, residual, change, met, side).

    Changes w in place; controls[side] then belongs to it.
    """
    n, cyclic, side = w.shape[1] - 2, problem[3] != 0.0, 0
    work, move, jets = workspace(n, cyclic), np.empty((n, 3)), np.empty((9, n + 1))
    total, worst = look(problem, w, controls[0], jets, work[3])
    updates, change, met = 0, 0.0, not by_change and worst <= tolerance
    while updates < limit and not met:
        assemble(problem, w, jets, work)
        longest = keep(work[3], move)
        if not longest < math.inf:
            break
        length, before, known = min(1.0, CAP / longest), total, worst
        shift(w, move, length)
        while True:
            total, worst = look(problem, w, controls[1 - side], jets, work[3])
            if total <= (1.0 - 2.0 * ARMIJO * length) * before or worst <= ROUNDING:
                break
            length *= 0.5
            if not length >= SHORTEST:
                shift(w, move, -2.0 * length)
                return updates, known, change, False, side
            shift(w, move, -length)
        side, updates = 1 - side, updates + 1
        change = moved(controls[side], controls[1 - side], n if cyclic else n + 1)
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
    for k in range(move.shape[0]):
        for c in range(3):
            w[c, k + 1] += length * move[k, c]


@compiled
def continued(problem, w, controls, tolerance, by_change, limit):
    """Homotopy in the data: the steps are eased to a share of themselves, which then grows to 1.

    What an eased problem's solution says about the next share starts the next descent.  Gives
    the keyframes themselves as controls where it fails.
    """
    targets, m, p, sign, clamped = problem
    eased, best = np.empty(targets.shape), np.empty(w.shape)
    done, growth, updates = 0.0, 0.25, 0
    while growth > LEAST_GROWTH and updates < limit:
        share = min(1.0, done + growth)
        ease(targets, share, eased, w)
        if done > 0.0:  # the outer columns stay: they may be a clamped curve's ends
            copy(best[:, 1:-1], w[:, 1:-1], share / done)
        last = share == 1.0
        more, _, change, met, side = descend(
            problem if last else (eased, m, p, sign, clamped),
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
    set_control(eased, 0, *control(targets, 0))
    for k in range(targets.shape[1] - 1):
        x, y, z = log_between(*control(targets, k), *control(targets, k + 1))
        w[0, k + 1], w[1, k + 1], w[2, k + 1] = share * x, share * y, share * z
        set_control(eased, k + 1, *mul(*control(eased, k), *turned(share, (x, y, z))))


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
            turn = mul(*turned(-m[i], increment(w, i)), *turned(p[i], increment(w, i + 1)))
            r = small_log(*between(*mul(*control(d, i), *turn), *control(targets, i)))
            worst = max(worst, squared(r))
            turn = turned(1.0 / (1.0 - m[i] - p[i]), r)
            set_control(fresh, i, *mul(*control(d, i), *turn))
        if not by_change and 2.0 * math.sqrt(worst) <= tolerance:
            break
        if cyclic:
            for c in range(4):
                fresh[c, n] = sign * fresh[c, 0]
        updates, change = updates + 1, moved(fresh, d, n if cyclic else n + 1)
        copy(fresh, d, 1.0)
        increments(d, w)
        if by_change and change <= tolerance:
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
    for i in range(q.shape[0]):
        set_control(targets, i, *keyframe(q, i))
    if closed:
        set_control(targets, n, sign * q[0, 0], sign * q[0, 1], sign * q[0, 2], sign * q[0, 3])
    else:
        m[0] = p[0] = m[n] = p[n] = 0.0
    if clamped:
        set_control(targets, 0, *mul(*keyframe(q, 0), *turned(1.0, increment(w, 0))))
        set_control(targets, n, *mul(*keyframe(q, n), *turned(-1.0, increment(w, n + 1))))
    return targets, m, p, sign, clamped


@compiled
def set_ends(q, h, parameters, w):
    """Increments h v / 3 to a clamped curve's outer controls, v being half the given angular
    velocities or the chart's estimates."""
    for side in range(2):
        k = VELOCITIES + 3 * side
        v = (0.5 * parameters[k], 0.5 * parameters[k + 1], 0.5 * parameters[k + 2])
        if parameters[HAS_START + side] == 0.0:
            v = end_velocity(q, h, side == 1)
        j, third = side * (h.size + 1), h[side * (h.size - 1)] / 3.0
        w[0, j], w[1, j], w[2, j] = third * v[0], third * v[1], third * v[2]


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
    w, controls = np.empty((3, h.size + 2)), np.empty((2, 4, h.size + 1))
    if clamped:
        set_ends(q, h, parameters, w)
    problem = pose(q, h, sign if closed else 0.0, clamped, w)
    if parameters[METHOD] != 0.0:
        report[0], report[1] = relax(problem, w, controls[0], tolerance, by_change, limit)
        report[3], report[2] = write_segments(q, h, closed, clamped, sign, controls[0], w, segments)
        return
    updates, change, met, side = newton(problem, w, controls, tolerance, by_change, limit)
    while True:
        settle(controls[side], w, met)
        report[3], report[2] = write_segments(
            q, h, closed, clamped, sign, controls[side], w, segments
        )
        if not met or by_change or report[2] <= tolerance or updates >= limit:
            break
        # What is written misses by more than equation (2) did: ask (2) for more.
        more, _, change, met, side = descend(
            problem, w, controls, 0.1 * tolerance, by_change, limit - updates
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
        parameters[:, LIMIT] = min(max_iterations or LIMITS[method], 2**53)
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
