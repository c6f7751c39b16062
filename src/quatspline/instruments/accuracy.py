"""Error of a curve to dense truth on an analytic motion, and orders of convergence."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.instruments.derivatives import rates
from quatspline.quaternion import FloatArray
from quatspline.trajectories.smooth import INNER, SPAN, tumble, tumble_rates

SAMPLES = 8
"""Samples per segment, in its interior: enough to see the largest error to a few per cent."""

ERRORS = {"inner_angle": "", "inner_omega": "_omega", "inner_alpha": "_alpha"}
"""Errors that orders are read from, with the suffix of their columns."""

TARGETS = {"spacing_1deg": 1.0, "spacing_0.1deg": 0.1, "spacing_0.01deg": 0.01}
"""Angles in degrees that a spacing is looked for at, by column."""


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
    t, inner = _times(curve)
    omega, alpha = tumble_rates(inner)
    own_omega, own_alpha = rates(curve, inner)
    return {
        "inner_angle": inner_angle(curve),
        "angle": _angle(curve, t),
        "inner_omega": float(np.linalg.norm(own_omega - omega, axis=-1).max()),
        "inner_alpha": float(np.linalg.norm(own_alpha - alpha, axis=-1).max()),
    }


def inner_angle(curve: Curve) -> float:
    """The first of `errors` alone."""
    return _angle(curve, _times(curve)[1])


def _times(curve: Curve) -> tuple[FloatArray, FloatArray]:
    """Times inside segments, and those of them on [3, 7]."""
    t = curve.times[0] + curve.keyframes.inside(SAMPLES)
    return t, t[(t >= INNER[0]) & (t <= INNER[1])]


def _angle(curve: Curve, t: FloatArray) -> float:
    return float(quaternion.distance(curve(t), tumble(t)).max())


def measured_order(spacings: ArrayLike, errors: ArrayLike) -> float:
    """The power of the spacing that errors fall with: the slope of the regression on logarithms.

    Of spacings and errors (m,), m at least 2; NaN where an error is 0 or not finite.
    """
    x, y = _logs(spacings), _logs(errors)
    return float(np.polyfit(x, y, 1)[0]) if np.isfinite(y).all() else np.nan


def with_slopes(table: pd.DataFrame, by: list[str], levels: int = 5) -> pd.DataFrame:
    """Adds to rows of refinements the orders that errors fall with in the spacing.

    Needs columns keyframes and `ERRORS`.  ``slope``, ``slope_omega``, ``slope_alpha`` are the orders
    from the level before, ``regression`` (and so on) those over the last levels.
    """
    groups = []
    for _, rows in table.groupby(by, sort=False):
        rows = rows.sort_values("keyframes")
        x = 1.0 / (rows["keyframes"].to_numpy(dtype=float) - 1.0)
        orders: dict[str, Any] = {}
        for error, suffix in ERRORS.items():
            y = rows[error].to_numpy(dtype=float)
            pairs = [measured_order(x[i - 1 : i + 1], y[i - 1 : i + 1]) for i in range(1, len(y))]
            last = np.flatnonzero(np.isfinite(_logs(y)))[-levels:]
            fit = measured_order(x[last], y[last]) if last.size >= 3 else np.nan
            orders |= {f"slope{suffix}": [np.nan, *pairs], f"regression{suffix}": fit}
        groups.append(rows.assign(**orders))
    return pd.concat(groups, ignore_index=True)


def with_reach(table: pd.DataFrame, by: list[str]) -> pd.DataFrame:
    """Adds the spacing from which on the inner angle stays below 1, 0.1 and 0.01 degrees.

    Columns of `TARGETS` (larger is better: fewer keyframes do), interpolated between levels on
    logarithms; NaN where the levels do not show it, with the reason in column ``unreached``.
    """
    groups = []
    for _, rows in table.groupby(by, sort=False):
        rows = rows.sort_values("keyframes")
        x, y = _logs(rows["spacing"]), _logs(rows["inner_angle"])
        reached = {name: reach(x, y, np.log(np.radians(t))) for name, t in TARGETS.items()}
        reasons = [f"{TARGETS[name]:g} degrees: {why}" for name, (_, why) in reached.items() if why]
        spacings = {name: value for name, (value, _) in reached.items()}
        groups.append(rows.assign(**spacings, unreached="; ".join(reasons) or None))
    return pd.concat(groups, ignore_index=True)


def reach(x: FloatArray, y: FloatArray, goal: float) -> tuple[float, str | None]:
    """The spacing e^x from which on the errors e^y stay below e^goal, and why it is NaN if it is.

    x (m,) falls; levels whose error is not finite are left out.
    """
    known = np.isfinite(y)
    x, y = x[known], y[known]
    if not known.any():
        return np.nan, "no error measured"
    above = np.flatnonzero(y > goal)
    if not above.size:
        return np.nan, f"met at every spacing, up to {np.exp(x[0]):.3g}"
    i = int(above[-1])
    if i == x.size - 1:
        return np.nan, f"not met at a spacing of {np.exp(x[-1]):.3g}"
    share = (y[i] - goal) / (y[i] - y[i + 1])
    return float(np.exp(x[i] + share * (x[i + 1] - x[i]))), None


def _logs(values: ArrayLike) -> FloatArray:
    with np.errstate(divide="ignore"):
        return np.log(np.asarray(values, dtype=float))
