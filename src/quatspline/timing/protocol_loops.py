"""The paper's protocols as compiled loops, so that no interpreter is timed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from quatspline.engines.compiler import address, machine
from quatspline.engines.driver import described, sample
from quatspline.engines.intrinsics import call_fit
from quatspline.inputs.arrays import FloatArray
from quatspline.kernels.jit import compiled
from quatspline.segments import SegmentCurve


def compiled_frames(
    curve: SegmentCurve, t: FloatArray, per_frame: bool
) -> Callable[[int], FloatArray]:
    """A function of a repeat count that generates the frames at t (m,); -> (m, 4)."""
    k = curve.keyframes
    out = np.empty((t.size, 1, 4))
    segments, report = np.empty_like(curve.segments), np.zeros((1, 4))
    fit = (
        address(curve.fit_kernel),
        k.tracks,
        k.spacings,
        k.closed,
        k.signs,
        curve.parameters,
        segments,
        report,
    )
    places = described(curve.segment_knots, segments, k.signs, k.closed)
    loop = machine(_per_frame if per_frame else _solve_once)

    def generate(repeats: int) -> FloatArray:
        # The curve is named here so that the arrays whose addresses are in `places` live on.
        kernel, origin = address(curve.kernels[0]), float(k.times[0])
        loop(repeats, *fit, kernel, places, origin, np.inf, t, out.reshape(-1))
        return out[:, 0]

    return generate


@compiled
def _per_frame(
    repeats, fit, tracks, h, closed, signs, parameters, segments, report, address, curve, origin,
    slack, t, out,
):  # fmt: skip
    for _ in range(repeats):
        for i in range(t.size):
            call_fit(fit, tracks[0], h, closed, signs[0], parameters, segments[0], report[0])
            one = out[4 * i : 4 * i + 4]
            sample(address, 0, curve, origin, slack, t[i : i + 1], one)


@compiled
def _solve_once(
    repeats, fit, tracks, h, closed, signs, parameters, segments, report, address, curve, origin,
    slack, t, out,
):  # fmt: skip
    for _ in range(repeats):
        call_fit(fit, tracks[0], h, closed, signs[0], parameters, segments[0], report[0])
        sample(address, 0, curve, origin, slack, t, out)
