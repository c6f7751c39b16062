"""Continuity at keyframes: jumps of q, omega, alpha and of alpha's derivative, and the speed there.

A jump is the difference of the one-sided limits, extrapolated from inside the segments on both sides
with two steps.  What is continuous leaves only extrapolation error and rounding, which fall with the
step; what jumps stays put.  The next order is the control that must stay.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from quatspline.curve import Curve
from quatspline.instruments.derivatives import derivative, one_sided
from quatspline.quaternion import FloatArray

QUANTITIES = ("q", "omega", "alpha", "jerk")
UNITS = ("1", "rad/t", "rad/t^2", "rad/t^3")
STEPS = (1e-2, 1e-3)
"""Steps as shares of the adjoining segment."""

CONTINUOUS = (1e-5, 1e-5, 1e-5, 1e-3)
"""Jumps below this share of the size on the curve, an entry an order, count as none (the last order is a
difference of accelerations, numerical ones too) ..."""
FALLING = 0.05
"""... and so do those that fall to this share when the step falls to a tenth."""

DENSE = 10
"""Samples a segment for the size of a quantity."""


def jumps(curve: Curve, orders: Sequence[int] = (0, 1, 2, 3)) -> pd.DataFrame:
    """Jumps of a single-track curve, one row a derivative order asked for.

    Columns: order (0 to 3), quantity, unit, jump (largest over the knots, in its unit; lower is
    smoother), coarse_jump (with the tenfold step), size (largest on the curve), relative, and
    continuous (a verdict).
    """
    at, step = _inner_knots(curve)
    dense = _dense(curve)
    rows, sizes = [], dict[int, float]()
    for order in orders:
        # the size of the order below, a step of which is a scale where this order is 0
        before = sizes.get(order - 1) or (_size(curve, dense, order - 1) if order else 1.0)
        coarse, fine = (_jump(curve, at, share * step, order) for share in STEPS)
        size = sizes[order] = _size(curve, dense, order)
        relative = fine / size if size > 0.0 else 0.0
        scale = max(size, before / float(np.diff(curve.times).mean()))
        smooth = fine <= CONTINUOUS[order] * scale or fine <= FALLING * coarse
        rows.append((order, QUANTITIES[order], UNITS[order], fine, coarse, size, relative, smooth))
    names = ["order", "quantity", "unit", "jump", "coarse_jump", "size", "relative", "continuous"]
    return pd.DataFrame(rows, columns=names)


def measured_continuity(table: pd.DataFrame) -> int:
    """k of C^k by a table of `jumps`: -1 where the curve itself jumps."""
    broken = table.loc[~table["continuous"], "order"]
    return int(broken.min()) - 1 if len(broken) else int(table["order"].max())


def speeds(curve: Curve) -> dict[str, float]:
    """Least speed at inner keyframes and peak speed, as shares of the mean speed.

    A curve that stops at every keyframe is smooth cheaply: the first is then 0.
    """
    at, _ = _inner_knots(curve)
    speed = np.linalg.norm(derivative(curve, _dense(curve), 1), axis=-1)
    at_keys = np.linalg.norm(derivative(curve, at, 1), axis=-1)
    mean = float(speed.mean())
    return {
        "least_key_speed": float(at_keys.min()) / mean,
        "peak_speed": float(speed.max()) / mean,
    }


def _inner_knots(curve: Curve) -> tuple[FloatArray, FloatArray]:
    """Knots with a segment on either side (a closed curve's seam too), and the shorter spacing."""
    times = curve.times
    h = np.diff(times)
    if curve.closed:
        return times[1:], np.minimum(h, np.roll(h, -1))
    return times[1:-1], np.minimum(h[:-1], h[1:])


def _dense(curve: Curve) -> FloatArray:
    times = curve.times
    u = (np.arange(DENSE) + 0.5) / DENSE
    return (times[:-1, None] + np.diff(times)[:, None] * u).reshape(-1)


def _jump(curve: Curve, at: FloatArray, step: FloatArray, order: int) -> float:
    if at.size == 0:
        return 0.0
    sides = [one_sided(curve, at, step, side, order) for side in (1, -1)]
    return float(np.linalg.norm(sides[0] - sides[1], axis=-1).max())


def _size(curve: Curve, dense: FloatArray, order: int) -> float:
    if order < 3:
        return float(np.linalg.norm(derivative(curve, dense, order), axis=-1).max())
    h = np.repeat(np.diff(curve.times), DENSE) * STEPS[1]
    slope = derivative(curve, dense + h, 2) - derivative(curve, dense - h, 2)
    return float(np.linalg.norm(slope / (2.0 * h[:, None]), axis=-1).max())
