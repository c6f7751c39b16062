"""Locality: how far a change of one keyframe reaches, in segments to either side and in size."""

from __future__ import annotations

import numpy as np
import pandas as pd

from quatspline import quaternion
from quatspline.instruments.trials import Build, Row
from quatspline.quaternion import FloatArray

SIZE = 1e-2
"""The keyframe is turned by this angle in rad: small against steps, large against rounding."""

FELT = 1e-8
"""Responses below this share of the change are none: above rounding (1e-16 over `SIZE`) and what an
iteration solved to 1e-11 leaves, so that a decay of 0.27 a segment is followed for 14 segments."""

SAMPLES = 12
"""Samples per segment."""

TAIL = 2
"""Segments next to the keyframe that a decay is not read from, and ..."""
POINTS = 3
"""... the number of segments beyond them that it needs."""


def responses(build: Build, times: FloatArray, keyframes: FloatArray) -> pd.DataFrame:
    """Responses to turns of the middle keyframe about three axes, one row per segment.

    Columns: offset, counted from the keyframe (-1 is the segment before it, 1 the one after), and
    response, the largest angle between the curves on the segment over that of the turn (1 is neutral).
    """
    middle = len(keyframes) // 2
    curve = build(times, keyframes)
    t = times[0] + curve.keyframes.inside(SAMPLES).reshape(-1, SAMPLES)
    before = curve(t)
    largest = np.zeros(len(t))
    for axis in np.eye(3):
        turned = keyframes.copy()
        turned[middle] = quaternion.mul(turned[middle], quaternion.exp(0.5 * SIZE * axis))
        angle = quaternion.distance(build(times, turned)(t), before)
        largest = np.maximum(largest, angle.max(axis=1))  # NaN stays
    offset = np.arange(len(t)) - middle
    return pd.DataFrame({"offset": offset + (offset >= 0), "response": largest / SIZE})


def locality(table: pd.DataFrame) -> Row:
    """What a table of `responses` says.

    amplification: the largest response (1 at best for a curve that meets its keyframes); reach_before,
    reach_after: segments to the farthest one that feels the change; support: segments in all, which is
    the number of keyframes that shape one; decay: factor a segment far from the keyframe (lower is more
    local), NaN where there is no tail to read it from.
    """
    felt = table.loc[~(table["response"] <= FELT), "offset"]  # NaN is felt
    before, after = max([0, *-felt]), max([0, *felt])
    return {
        "amplification": float(np.max(table["response"].to_numpy())),
        "reach_before": before,
        "reach_after": after,
        "support": before + after,
        "decay": _decay(table),
    }


def _decay(table: pd.DataFrame) -> float:
    far = table[(table["offset"].abs() > TAIL) & (table["response"] > FELT)]
    slopes = []
    for _, side in far.groupby(np.sign(far["offset"])):
        if len(side) >= POINTS:
            slopes.append(np.polyfit(side["offset"].abs(), np.log(side["response"]), 1)[0])
    return float(np.exp(max(slopes))) if slopes else np.nan
