"""Error of a curve to dense truth on an analytic motion, and orders of convergence."""

from __future__ import annotations

import numpy as np
import pandas as pd

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.instruments.derivatives import rates
from quatspline.quaternion import FloatArray
from quatspline.trajectories.smooth import INNER, SPAN, tumble, tumble_rates

SAMPLES = 8
"""Samples a segment, in its interior: enough to see the largest error to a few per cent."""


def knots(rng: np.random.Generator, kind: str, count: int) -> FloatArray:
    """Times (count,) over [0, SPAN]: "uniform", "jittered" (by 35 %) or "log-uniform" spacings."""
    if kind == "jittered":
        t = np.linspace(0.0, SPAN, count)
        t[1:-1] += rng.uniform(-0.35, 0.35, count - 2) * (t[1] - t[0])
        return t
    spread = 1.0 if kind == "log-uniform" else 0.0
    h = np.exp(rng.uniform(-spread, spread, count - 1))
    return np.concatenate([[0.0], np.cumsum(h) * (SPAN / h.sum())])


def errors(curve: Curve) -> dict[str, float]:
    """Largest errors of a curve through keyframes of the tumble.

    inner_angle, angle (rad, on [3, 7] and everywhere), inner_omega (rad/t), inner_alpha (rad/t^2).
    """
    times = curve.times
    u = (np.arange(SAMPLES) + 0.5) / SAMPLES
    t = (times[:-1, None] + np.diff(times)[:, None] * u).reshape(-1)
    inner = (t >= INNER[0]) & (t <= INNER[1])
    angle = quaternion.distance(curve(t), tumble(t))
    omega, alpha = tumble_rates(t[inner])
    own_omega, own_alpha = rates(curve, t[inner])
    return {
        "inner_angle": float(angle[inner].max()),
        "angle": float(angle.max()),
        "inner_omega": float(np.linalg.norm(own_omega - omega, axis=-1).max()),
        "inner_alpha": float(np.linalg.norm(own_alpha - alpha, axis=-1).max()),
    }


def with_slopes(table: pd.DataFrame, by: list[str], levels: int = 5) -> pd.DataFrame:
    """Adds to rows of refinements: the slope from the level before, and a regression over levels.

    Needs columns keyframes and inner_angle; slopes are orders in the spacing.
    """
    groups = []
    for _, rows in table.groupby(by, sort=False):
        rows = rows.sort_values("keyframes")
        x = -np.log(rows["keyframes"].to_numpy(dtype=float) - 1.0)
        y = np.log(rows["inner_angle"].to_numpy(dtype=float))
        slope = np.full(len(rows), np.nan)
        slope[1:] = np.diff(y) / np.diff(x)
        known = np.isfinite(y)
        last = np.flatnonzero(known)[-levels:]
        fit = np.polyfit(x[last], y[last], 1)[0] if last.size >= 3 else np.nan
        groups.append(rows.assign(slope=slope, regression=fit))
    return pd.concat(groups, ignore_index=True)
