"""Continuity at keyframes: jumps of q, omega, alpha and of alpha's derivative, and the speed there.

A jump is the difference of the one-sided limits, extrapolated from inside the segments on both sides
with two steps.  What is continuous leaves only extrapolation error, which falls with the step, and
rounding; what jumps stays put.  The next order is the control that must stay.

Closed forms serve where the curve has its own.  A library's curve is known by its orientations, in
double precision: nine-point stencils on these tell jumps of the acceleration above 1e-6 / h^2.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from quatspline.curve import Curve
from quatspline.instruments.breaks import UNBROKEN, breaks
from quatspline.instruments.derivatives import closed_forms, rates_since
from quatspline.instruments.trials import Row
from quatspline.quaternion import FloatArray

QUANTITIES = ("q", "omega", "alpha", "jerk")
UNITS = ("1", "rad/t", "rad/t^2", "rad/t^3")
STEPS = (1e-2, 1e-3)
"""Steps as shares of the adjoining segment."""

ROUNDING = 1e-8
"""Jumps of closed forms below this share of the size on the curve count as none: rounding ..."""
UNSOLVED = 30.0
"""... and what a solve leaves: its residual times this, over the shortest spacing to the order (the third
derivatives of cubic blending functions are 6 to 18) ..."""
STENCIL = (1e-7, 1e-7, 1e-6, 1e-3)
"""... and jumps of libraries' orientations and of stencils on these below these, an entry an order, over the
shortest spacing to that order: ten to a hundred times the rounding that smooth segments were seen to leave.
Orientations themselves are off by 1e-8 where a library takes arc cosines, or so small a turn for none."""
NOISE = (1e-14, 1e-13, 1e-12, 1e-9)
"""Closed forms leave this much rounding, an entry an order, over the spacing beside the knot to that order: all
that is left of curves at rest or at a constant rate, whose own size says nothing."""
TICKS = (32.0, 1e2, 1e3, 1e6)
"""An ulp of time leaves so many times what the curve turns in it, an entry an order, over the shortest spacing to
that order: the limits are extrapolated with weights of 30 in all, jumps of a slope over a thousandth of it ..."""
STENCIL_TICKS = (32.0, 1e5, 1e8, 1e10)
"""... and stencils have weights of up to 80 and 360 in all at an end, over steps of 6e-3 to the order."""
FALLING = 0.05
"""So do those that fall to this share when the step falls to a tenth."""

ONE_SIDED = 4
"""Points of the one-sided extrapolation to a knot: exact for cubics."""
LIMIT = np.array([4.0, -6.0, 4.0, -1.0])
SLOPE = np.array([-13.0 / 3.0, 19.0 / 2.0, -7.0, 11.0 / 6.0])
"""Weights of values at h, 2h, 3h, 4h for the value and for h times the slope at 0."""

DENSE = 7
"""Samples per segment for the size of a quantity."""

AT_REST = 1e-12
"""A motion that turns by less in all, in rad, is at rest: what is left is rounding."""


def jumps(curve: Curve, orders: Sequence[int] = (0, 1, 2, 3)) -> pd.DataFrame:
    """Jumps of a single-track curve, one row a derivative order asked for.

    Columns: order (0 to 3), quantity, unit, jump (largest over the knots, in its unit, for orders 0, as an
    angle, and 1 also inside segments; lower is smoother), coarse_jump (with the tenfold step), size (largest
    on the curve), relative (0 where the size itself is rounding), and continuous (a verdict).
    Derivatives are those of `rates_since`.
    """
    at, step = _inner_knots(curve)
    gaps = [_jumps(curve, at, share * step) for share in STEPS]
    inside = breaks(curve) if {0, 1} & set(orders) else UNBROKEN
    broken = (inside.leap, inside.corner, 0.0, 0.0)
    rows, sizes = [], _sizes(curve)
    for order in orders:
        coarse, fine = (float(np.max(found[order], initial=broken[order])) for found in gaps)
        size = sizes[order]
        floor = _floor(curve, order, size, sizes[1])
        scaled = inside.scaled if order else inside.leap
        local = float(np.max(gaps[1][order] * step**order, initial=scaled if order < 2 else 0.0))
        smooth = fine <= floor or fine <= FALLING * coarse or local <= rounding(curve, order)
        relative = fine / size if size > floor else 0.0
        names = (order, QUANTITIES[order], UNITS[order])
        rows.append((*names, fine, coarse, size, relative, smooth))
    columns = ["order", "quantity", "unit", "jump", "coarse_jump", "size", "relative", "continuous"]
    return pd.DataFrame(rows, columns=columns)


def measured_continuity(table: pd.DataFrame) -> int:
    """k of C^k by a table of `jumps`: -1 where the curve itself jumps."""
    broken = table.loc[~table["continuous"], "order"]
    return int(broken.min()) - 1 if len(broken) else int(table["order"].max())


def speeds(curve: Curve) -> Row:
    """Least speed at inner keyframes and peak speed, as shares of the mean speed.

    A curve that stops at every keyframe is smooth cheaply: the first is then 0.  Both are NaN where the
    motion rests throughout, the first also without inner keyframes.
    """
    at, _ = _inner_knots(curve)
    dense = curve.keyframes.inside(DENSE)
    speed, at_keys = (np.linalg.norm(rates_since(curve, t)[0], axis=-1) for t in (dense, at))
    mean = float(speed.mean())
    if mean * float(curve.keyframes.knots[-1]) <= AT_REST:
        return {"least_key_speed": np.nan, "peak_speed": np.nan}
    least = float(at_keys.min()) / mean if at.size else np.nan
    return {"least_key_speed": least, "peak_speed": float(speed.max()) / mean}


def _inner_knots(curve: Curve) -> tuple[FloatArray, FloatArray]:
    """Knots with a segment on either side (a closed curve's seam too), and the shorter spacing."""
    knots, h = curve.keyframes.knots, curve.keyframes.spacings
    if curve.closed:
        return knots[1:], np.minimum(h, np.roll(h, -1))
    return knots[1:-1], np.minimum(h[:-1], h[1:])


def _jumps(curve: Curve, at: FloatArray, step: FloatArray) -> list[FloatArray]:
    """The jump at every knot, of every order."""
    if at.size == 0:
        return [np.zeros(0)] * len(QUANTITIES)
    after, before = (_one_sided(curve, at, step, side) for side in (1, -1))
    return [np.linalg.norm(a - b, axis=-1) for a, b in zip(after, before, strict=True)]


def _one_sided(curve: Curve, at: FloatArray, step: FloatArray, side: int) -> list[FloatArray]:
    """Limits at knots ``at`` (m,) from one side (+1 or -1): q (m, 4), then three derivatives (m, 3).

    Knots are times since the first keyframe; beyond a closed curve's seam its first segment goes on.
    Values at 1 to 4 steps (m,) away are extrapolated; the last is the slope of the acceleration.
    """
    nodes = at[:, None] + side * step[:, None] * np.arange(1.0, ONE_SIDED + 1)
    t, period = nodes.reshape(-1), curve.keyframes.knots[-1]
    rates = rates_since(curve, np.where(t > period, t - period, t))
    q, omega, alpha = (
        values.reshape(*nodes.shape, -1) for values in (curve.inner(t)[:, 0], *rates)
    )
    limits = [np.einsum("j,mji->mi", LIMIT, values) for values in (q, omega, alpha)]
    return [*limits, np.einsum("j,mji->mi", SLOPE, alpha) / (side * step[:, None])]


def _sizes(curve: Curve) -> list[float]:
    """Largest sizes of q, of both rates and of the acceleration's slope between samples."""
    omega, alpha = rates_since(curve, curve.keyframes.inside(DENSE))
    apart = curve.keyframes.spacings[:, None, None] / DENSE
    slope = np.diff(alpha.reshape(-1, DENSE, 3), axis=1) / apart
    return [1.0, *(float(np.linalg.norm(x, axis=-1).max()) for x in (omega, alpha, slope))]


def rounding(curve: Curve, order: int) -> float:
    """What rounding leaves of a rate of an order, over the spacing of keyframes to that order."""
    return (NOISE if closed_forms(curve) else STENCIL)[order]


def _floor(curve: Curve, order: int, size: float, speed: float) -> float:
    """What a jump of this order has to exceed to be told from rounding, of orientations and of time."""
    keyframes = curve.keyframes
    scale = float(keyframes.spacings.min()) ** -order
    tick = float(np.spacing(keyframes.knots[-1])) * speed * scale
    if not closed_forms(curve):
        return STENCIL[order] * scale + STENCIL_TICKS[order] * tick
    report = curve.solve_report
    solved = UNSOLVED * float(report.residual) * scale if report else 0.0
    return ROUNDING * size + TICKS[order] * tick + solved
