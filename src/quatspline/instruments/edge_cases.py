"""Edge cases: whether a scheme's curve is exact, wrong, not a number or refused, and by how much.

A scheme is judged against what it claims: that a constant rate is kept, everywhere or away from the ends, and
that keyframes are met.  Where it claims nothing it is off as it says; but no curve claims to go astray.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quatspline import quaternion
from quatspline.catalogue import scheme
from quatspline.curve import Curve
from quatspline.instruments.derivatives import derivative
from quatspline.instruments.trials import Row, reason
from quatspline.quaternion import FloatArray
from quatspline.trajectories.edge_cases import EdgeCase

BoolArray = NDArray[np.bool_]

NEGLIGIBLE = 1e-6
"""Errors below this share of the case's largest step are none: solvers stop at 1e-11 rad, and at half a
turn rounding is magnified; what is wrong is so by decades more."""

UNIT = 1e-9
"""How far a quaternion's norm may be off 1."""

REST = 1e-12
"""Steps below this, in rad, are rounding of equal keyframes."""

ASTRAY = 0.5
"""A curve that is off by this share of a step has gone astray, whatever it claims: the long way round, or over a
fold of its chart."""

ENDS = 4
"""Segments that feel the ends of an open curve which all keyframes shape."""

SAMPLES = 10
"""Samples per segment, keyframes besides."""


def edge_result(case: EdgeCase, name: str, **options: Any) -> Row:
    """What a scheme does with a case.

    result: "exact" (the truth is met; keys are met, where there is none), "as claimed" (off only where the scheme
    claims nothing), "wrong", "NaN" (in orientation or rates) or "error"; checked: "truth", "truth inside"
    (away from the ends) or "keys", by what the scheme claims; deviation: the largest angle in rad (lower is
    better), of a wrong one where it is at fault; relative: its share of the largest step between keyframes
    (of 1 rad at rest); failure: the reason.
    """
    checked = None
    try:
        cls = scheme(name)
        checked = "keys" if case.truth is None else CHECKED[_claim(case, cls)]
        curve = cls(case.times, case.keyframes, closed=case.closed, **options)
        return {"checked": checked, **_judged(case, curve)}
    except Exception as error:  # a refusal is a result, too
        return {"checked": checked, "result": "error", "failure": reason(error)}


CHECKED = {"everywhere": "truth", "interior": "truth inside", "no": "keys"}
"""What a curve is held against, by its claim of a constant rate."""


def _claim(case: EdgeCase, curve: Curve | type[Curve]) -> str:
    """The claim of a constant rate, as far as the case tries it.

    A curve at rest has to stay, one that closes has no ends.
    """
    if not _moves(case) or (case.closed and curve.constant_rate == "interior"):
        return "everywhere"
    return curve.constant_rate


def _judged(case: EdgeCase, curve: Curve) -> Row:
    t = _samples(curve)
    q = curve(t)
    bad = _unusable(curve, t, q)
    if bad is not None:
        return {"result": "NaN" if "not a number" in bad else "wrong", "failure": bad}
    off, claimed = _deviations(case, curve, t, q)
    step = _step(case.keyframes)
    # keyframes are no truth to a curve that passes near them
    strays = off > ASTRAY * step if case.truth or curve.interpolates else np.zeros(off.shape, bool)
    faults = off[(off > NEGLIGIBLE * step) & (claimed | strays)]
    deviation = float(faults.max() if faults.size else off.max())
    result = "wrong" if faults.size else "exact" if deviation <= NEGLIGIBLE * step else "as claimed"
    return {"result": result, "deviation": deviation, "relative": deviation / step}


def _deviations(
    case: EdgeCase, curve: Curve, t: FloatArray, q: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Angles to the truth, or to the keyframes where there is no other, and where they are claimed to be none."""
    if case.truth is None:
        keys = curve(case.times[: len(case.keyframes)])
        off = quaternion.distance(keys, case.keyframes)
        return off, np.full(off.shape, curve.interpolates)
    key = np.arange(t.size) % SAMPLES == 0
    claimed = _kept(case, curve, t) | (key if curve.interpolates else False)
    return quaternion.distance(q, case.truth(t)), claimed


def _kept(case: EdgeCase, curve: Curve, t: FloatArray) -> BoolArray:
    """At which times (m,) a constant rate is claimed to be kept."""
    claim = _claim(case, curve)
    if claim != "interior":
        return np.full(t.shape, claim == "everywhere")
    margin = ENDS if curve.support is None else curve.support // 2 - 1
    if 2 * margin >= len(case.times):
        return np.zeros(t.shape, dtype=bool)
    return np.asarray((t >= case.times[margin]) & (t <= case.times[-1 - margin]))


def _unusable(curve: Curve, t: FloatArray, q: FloatArray) -> str | None:
    for order, quantity in enumerate(("orientation", "velocity", "acceleration")):
        values = q if order == 0 else derivative(curve, t, order)
        if not np.isfinite(values).all():
            return f"{quantity} is not a number"
    off = float(np.abs(np.linalg.norm(q, axis=-1) - 1.0).max())
    return f"norm is off 1 by {off:.2g}" if off > UNIT else None


def _step(keyframes: FloatArray) -> float:
    step = _largest(keyframes)
    return step if step > REST else 1.0


def _moves(case: EdgeCase) -> bool:
    return _largest(case.keyframes) > REST


def _largest(keyframes: FloatArray) -> float:
    return float(quaternion.distance(keyframes[1:], keyframes[:-1]).max())


def _samples(curve: Curve) -> FloatArray:
    keyframes = curve.keyframes
    since = np.append(keyframes.inside(np.arange(SAMPLES) / SAMPLES), keyframes.knots[-1])
    return curve.times[0] + since
