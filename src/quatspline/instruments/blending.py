"""Blending functions read off a curve: what a scheme does with single-axis keyframes.

About one axis everything commutes, so ln Q(u) = sum_j B_j(u) theta_j exactly, and one keyframe
turned by theta shows its own blending function: B_j = ln Q / theta.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.quaternion import FloatArray

ANGLE = 0.5
"""Half angle in rad of the turned keyframe: any will do, the response is linear."""
PADDING = 4
"""Keyframes on either side, so that no end is felt."""


def blending(
    scheme: type[Curve], u: FloatArray, *, cumulative: bool, around: int = 4, **options: Any
) -> pd.DataFrame:
    """B_0, B_1, ... (or their cumulative sums) of the keyframes around a segment, at u (m,).

    Columns u, B0, B1, ... (dimensionless), as many as keyframes ``around`` it, an even number; uniform unit knots.
    ``options`` are the scheme's.
    """
    before = PADDING + around // 2 - 2
    columns: dict[str, FloatArray] = {"u": u}
    for j in range(around):
        angle = np.zeros((2 * before, 3))
        keyframe = before - around // 2 + j
        if cumulative:
            angle[keyframe:, 2] = ANGLE
        else:
            angle[keyframe, 2] = ANGLE
        curve = scheme(None, quaternion.exp(angle), **options)
        columns[f"B{j}"] = curve.log(before - 1 + u)[:, 2] / ANGLE
    return pd.DataFrame(columns)
