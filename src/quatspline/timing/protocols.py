"""The paper's two ways to generate frames: fit once per frame, or fit once and evaluate.

Timed is the mathematics: fit and evaluation from prepared keyframes.  Compiled schemes loop in
compiled code, so that a few microseconds of interpreter do not hide what is compared; others run
through the same steps in Python.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Literal

import numpy as np

from quatspline.curve import Curve
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve

Protocol = Literal["per-frame", "solve-once"]
PROTOCOLS: tuple[Protocol, ...] = ("per-frame", "solve-once")


def frames(
    scheme: type[Curve], keyframes: Keyframes, t: FloatArray, protocol: Protocol, **options: Any
) -> Callable[[int], FloatArray]:
    """A function of a repeat count that generates the frames at t (m,) by one protocol; -> (m, 4)."""
    make = partial(scheme.from_keyframes, keyframes, **options)
    curve = make()
    if isinstance(curve, SegmentCurve) and hasattr(curve, "fit_kernel"):
        from quatspline.timing.protocol_loops import compiled_frames  # numba

        return compiled_frames(curve, t, protocol == "per-frame")
    return _interpreted(make, keyframes, t, protocol)


def _interpreted(
    make: Callable[[], Curve], keyframes: Keyframes, t: FloatArray, protocol: Protocol
) -> Callable[[int], FloatArray]:
    out, since = np.empty((t.size, 4)), t - float(keyframes.times[0])
    singly = [slice(i, i + 1) for i in range(t.size)]
    parts = singly if protocol == "per-frame" else [slice(None)]

    def generate(repeats: int) -> FloatArray:
        for _ in range(repeats):
            for part in parts:
                out[part] = make().inner(since[part])[:, 0]
        return out

    return generate
