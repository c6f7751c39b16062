"""Edge cases: whether a scheme's curve is exact, wrong, not a number or refused, and by how much."""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.instruments.derivatives import derivative
from quatspline.instruments.trials import Row, reason
from quatspline.quaternion import FloatArray
from quatspline.registry import scheme
from quatspline.trajectories.edges import EdgeCase

EXACT = 1e-6
"""Errors below this share of the case's largest step are none: solvers stop at 1e-11 rad, and at half a
turn rounding is magnified; what is wrong is so by decades more."""

UNIT = 1e-9
"""How far a quaternion's norm may be off 1."""

REST = 1e-12
"""Steps below this, in rad, are rounding of equal keyframes."""

SAMPLES = 10
"""Samples a segment, keyframes besides."""


def edge_result(case: EdgeCase, name: str, **options: Any) -> Row:
    """What a scheme does with a case.

    result: "exact" (the truth is met; keys are met, where there is none), "wrong", "NaN" (in orientation or
    rates) or "error"; checked: what was compared; deviation: the largest angle in rad (lower is better);
    relative: its share of the largest step between keyframes (of 1 rad at rest); failure: the reason.
    """
    checked = "keys" if case.truth is None else "truth"
    try:
        curve = scheme(name)(case.times, case.keyframes, closed=case.closed, **options)
        return {"checked": checked, **_judged(case, curve)}
    except Exception as error:  # a refusal is a result, too
        return {"checked": checked, "result": "error", "failure": reason(error)}


def _judged(case: EdgeCase, curve: Curve) -> Row:
    t = _samples(case.times)
    q = curve(t)
    bad = _unusable(curve, t, q)
    if bad is not None:
        return {"result": "NaN" if "not a number" in bad else "wrong", "failure": bad}
    deviation = _deviation(case, curve, t, q)
    relative = deviation / _step(case.keyframes)
    result = "exact" if relative <= EXACT else "wrong"
    return {"result": result, "deviation": deviation, "relative": relative}


def _deviation(case: EdgeCase, curve: Curve, t: FloatArray, q: FloatArray) -> float:
    """The largest angle to the truth, or to the keyframes where there is no other."""
    if case.truth is not None:
        return float(quaternion.distance(q, case.truth(t)).max())
    keys = curve(case.times[: len(case.keyframes)])
    return float(quaternion.distance(keys, case.keyframes).max())


def _unusable(curve: Curve, t: FloatArray, q: FloatArray) -> str | None:
    for order, quantity in enumerate(("orientation", "velocity", "acceleration")):
        values = q if order == 0 else derivative(curve, t, order)
        if not np.isfinite(values).all():
            return f"{quantity} is not a number"
    off = float(np.abs(np.linalg.norm(q, axis=-1) - 1.0).max())
    return f"norm is off 1 by {off:.2g}" if off > UNIT else None


def _step(keyframes: FloatArray) -> float:
    step = float(quaternion.distance(keyframes[1:], keyframes[:-1]).max())
    return step if step > REST else 1.0


def _samples(times: FloatArray) -> FloatArray:
    u = np.arange(SAMPLES) / SAMPLES
    inside = times[:-1, None] + np.diff(times)[:, None] * u
    return np.append(inside.reshape(-1), times[-1])
