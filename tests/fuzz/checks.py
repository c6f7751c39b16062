"""What must hold of any curve through valid keyframes."""

from __future__ import annotations

import re
import warnings
from typing import Any

import numpy as np
from cases import Case

import quatspline as qs
from quatspline import quaternion
from quatspline.solving import WRONG_FIXED_POINT

UNIT, HIT = 1e-12, 1e-9

REFUSALS = (
    r"are exact antipodes",
    r"float64 (cannot carry|does not tell)",
    r"must strictly increase",
    r"log-cubic closes only curves",
    r"too uneven for degree",
    r"rad on a segment of",
    r"float64 does not tell so many within",
    r"the march brings rates there",
)
"""What may be refused of keyframes that were drawn at random: sentences that say why."""

Outcome = tuple[str, str]


def outcome(case: Case) -> Outcome:
    """("ok" | "refused" | "diverged" | "failed", what)."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            curve = case.build()
            problem = fault(curve, case)
    except qs.ConvergenceError:
        return "diverged", case.scheme
    except ValueError as error:
        known = next((p for p in REFUSALS if re.search(p, str(error))), None)
        return ("refused", known) if known else ("failed", f"ValueError: {error}")
    except Exception as error:  # whatever else leaks is a fault
        return "failed", f"{type(error).__name__}: {error}"
    return ("failed", problem) if problem else ("ok", "")


def fault(curve: qs.Curve, case: Case) -> str:
    """The first thing wrong with a curve, or nothing."""
    keys = curve.times[: curve.keyframes.count]
    poses = curve(keys)
    miss = quaternion.distance(poses, curve.quaternions).max() if curve.interpolates else 0.0
    tolerance = _tolerance(curve)
    if not miss <= max(HIT, tolerance):
        return f"misses a keyframe by {miss:.2g}"
    t = _samples(curve)
    for order in (0, 1, 2):
        values = poses if order == 0 else curve(keys, order)
        for part in (values, curve(t, order), curve(t[0], order)):
            if not np.isfinite(part).all():
                return f"order {order} is not finite"
    for part in (poses, curve(t)):
        off = np.abs(np.linalg.norm(part, axis=-1) - 1.0).max()
        if not off <= UNIT:
            return f"norm off by {off:.2g}"
    return ""


def _tolerance(curve: qs.Curve) -> float:
    """What a solve may leave: its tolerance, or, stopped by change, what counts as converged then."""
    report = curve.solve_report
    if report is None:
        return 0.0
    return report.tolerance * (WRONG_FIXED_POINT if report.stop == "change" else 1.0)


def _samples(curve: qs.Curve) -> Any:
    """Times inside every segment, in the middle, next to its ends and at random."""
    rng = np.random.default_rng(7)
    inner = curve.keyframes.inside([0.5, 1e-9, 1e-3, 1.0 - 1e-9, *rng.random(4)])
    if curve.times.dtype == np.int64:
        return curve.times[0] + np.round(inner).astype(np.int64)
    first, last = curve.domain
    return np.clip(first + inner, first, last)
