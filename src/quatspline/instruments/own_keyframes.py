"""A curve on a user's own keyframes: what a comparison says of it."""

from __future__ import annotations

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.instruments.continuity import jumps, measured_continuity, rounding, speeds
from quatspline.instruments.curvature import curvature_energy
from quatspline.instruments.derivatives import closed_forms
from quatspline.instruments.extent import extent
from quatspline.instruments.fairness import fairness
from quatspline.instruments.trials import Row, facts
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray

ENERGIES = ("torque", "jerk", "peak")


def measured(curve: Curve) -> Row:
    """The row of a single-track curve in `quatspline.compare`, without timings and without what is said of others."""
    smooth = measured_continuity(jumps(curve))
    fair = _above_rounding(curve, fairness(curve))
    if smooth < 1:  # a jump of the velocity is an infinite torque, which no quadrature sees
        fair |= dict.fromkeys(ENERGIES, np.inf)
    pace, report = speeds(curve), curve.solve_report
    return {
        "continuity": smooth,
        "misses": _misses(curve),
        **fair,
        "key_speed": pace["least_key_speed"],
        "peak_speed": pace["peak_speed"],
        **_asked_of_a_body(curve, smooth, float(fair["peak"])),
        "curvature": _bending(curve, smooth),
        **reaches(curve),
        "iterations": report.iterations if report else None,
        "solver": report.method if report else None,
        **facts(curve),
    }


def steps(keyframes: Keyframes) -> FloatArray:
    """The angle of each segment of a single track, rad: in all what a curve turns that wanders nowhere."""
    q = keyframes.quaternions
    after = np.concatenate([q[1:], q[:1]]) if keyframes.closed else q[1:]
    return np.asarray(quaternion.distance(q[: len(after)], after), dtype=float)


def reaches(curve: Curve) -> Row:
    """Columns on how many keyframes shape a segment, and how many of them come after its own two."""
    return {"support": _or_all(curve.support), "lookahead": _or_all(curve.lookahead)}


def _or_all(count: int | None) -> str:
    return "all" if count is None else str(count)


def _asked_of_a_body(curve: Curve, smooth: int, peak: float) -> Row:
    """Columns in degrees; a curve that leaps has no rate."""
    row = extent(curve) | {"peak_acceleration": float(np.degrees(peak))}
    return row if smooth >= 0 else row | {"peak_rate": np.inf}


def _bending(curve: Curve, smooth: int) -> float:
    """The curvature energy, infinite at corners; stencils on libraries' orientations would take too long."""
    if not closed_forms(curve):
        return np.nan
    return np.inf if smooth < 1 else curvature_energy(curve).energy


def _above_rounding(curve: Curve, fair: Row) -> Row:
    """Energies of which nothing but rounding is left, at rest or at a constant rate, are zero."""
    h = curve.keyframes.spacings
    alpha, slope = (rounding(curve, order) for order in (2, 3))
    floors = (alpha**2 * (h**-3).sum(), slope**2 * (h**-5).sum(), alpha * (h**-2).max())
    zero = [name for name, floor in zip(ENERGIES, floors, strict=True) if fair[name] <= floor]
    return fair | dict.fromkeys(zero, 0.0)


def _misses(curve: Curve) -> float:
    """The largest angle at a keyframe, rad."""
    at = curve.times[: curve.keyframes.count]
    return float(quaternion.distance(curve(at), curve.keyframes.quaternions).max())
