"""What a curve asks of the body that follows it, in degrees: how fast, how far off the way, how much during holds."""

from __future__ import annotations

import numpy as np

from quatspline.curve import Curve
from quatspline.instruments.derivatives import rates_since
from quatspline.instruments.excursion import excursion
from quatspline.instruments.panels import around
from quatspline.instruments.trials import Row
from quatspline.quaternion import FloatArray

EXACT = 1e-9
"""Degrees below which nothing but rounding is left."""

GRID, CANDIDATES = 9, 8
"""Samples per segment, its ends included, and the fastest segments that are then looked into."""
FINER, ZOOMS = 5, 12
"""Samples of that search, and how often its interval is halved: a smooth peak is then found to 1e-9."""


def extent(curve: Curve) -> Row:
    """Columns of a single-track curve, all in degrees; less is better.

    excursion: the largest distance to the arc between neighbouring keyframes, which where they are equal
    is that keyframe; hold_rotation: the same of such holds alone, NaN where there are none; peak_rate:
    the largest |omega| (degrees/t).
    """
    found = excursion(curve)
    hold = found.off[found.hold]
    return {
        "excursion": float(_largest(found.off)),
        "hold_rotation": float(_largest(hold)) if hold.size else np.nan,
        "peak_rate": float(np.degrees(peak_rate(curve))),
    }


def excursions(curve: Curve) -> FloatArray:
    """The column excursion of every track, (*K,)."""
    return _largest(excursion(curve).off)


def _largest(off: FloatArray) -> FloatArray:
    """The largest of angles (m, *K) in rad, in degrees and without rounding."""
    angles = np.degrees(off.max(axis=0))
    return np.where(angles > EXACT, angles, 0.0)


def peak_rate(curve: Curve) -> float:
    """The largest |omega| of a single-track curve, rad/t, on both sides of keyframes too."""
    knots = curve.keyframes.knots
    grid = curve.keyframes.inside(np.linspace(0.0, 1.0, GRID)).reshape(-1, GRID)
    grid[:, -1] = np.nextafter(knots[1:], 0.0)  # of this segment, not of the next
    speeds = _speeds(curve, grid)
    most, likely = float(speeds.max()), np.argsort(speeds.max(axis=1))[-CANDIDATES:]
    grid, speeds = grid[likely], speeds[likely]
    for _ in range(ZOOMS):
        low, high = around(grid, speeds)
        grid = np.linspace(low, high, FINER, axis=1)
        speeds = _speeds(curve, grid)
    return max(most, float(speeds.max()))


def _speeds(curve: Curve, since: FloatArray) -> FloatArray:
    omega = rates_since(curve, since.reshape(-1))[0]
    return np.asarray(np.linalg.norm(omega, axis=-1).reshape(since.shape), dtype=float)
