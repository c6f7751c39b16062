"""Spacings of keyframe times that float64 can carry, and why others are refused."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quatspline.inputs.arrays import FloatArray, refuse_infinite
from quatspline.inputs.stamps import shown

SHORTEST, LONGEST = 2.0**-200, 2.0**200
"""Spacings within these bounds: kernels form powers of them, and accelerations their inverse square."""

DIGITS = 1e-14
"""A spacing below this share of the whole duration has hardly a digit left in the times after it."""


def explain_times(t: NDArray[Any], knots: FloatArray, spacings: FloatArray) -> None:
    """Refuse times that do not increase, or with spacings that float64 cannot carry."""
    if t.dtype.kind == "f":
        refuse_infinite("times", t)
    stuck = np.flatnonzero(t[1:] <= t[:-1])
    if stuck.size:
        i = int(stuck[0]) + 1
        raise ValueError(
            f"times[{i}] = {shown(t[i])} does not exceed times[{i - 1}] = {shown(t[i - 1])}: "
            "times must strictly increase"
        )
    if not np.isfinite(knots[-1]):
        raise ValueError(f"times span {shown(t[0])} to {shown(t[-1])}: too long for float64")
    equal = np.flatnonzero(spacings <= 0.0)
    if equal.size:
        i = int(equal[0]) + 1
        raise ValueError(
            f"times[{i}] = {shown(t[i])} is too close to times[{i - 1}] = {shown(t[i - 1])}, "
            f"{float(knots[i])!r} after times[0]: float64 cannot tell them apart"
        )
    wrong = (spacings < SHORTEST) | (spacings > LONGEST)
    if not wrong.any():
        wrong = spacings < DIGITS * knots[-1]
    i = int(np.argmax(wrong))
    h, bound = float(spacings[i]), f"below {DIGITS:.1g} of the whole duration, {knots[-1]:.3g}"
    if h < SHORTEST:
        bound = f"shorter than {SHORTEST:.2g}"
    elif h > LONGEST:
        bound = f"longer than {LONGEST:.2g}"
    raise ValueError(
        f"times[{i}] to times[{i + 1}] is {h!r}, {bound}: float64 cannot carry its rates"
    )
