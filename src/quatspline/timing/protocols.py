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
from quatspline.kernels.driver import described, sample
from quatspline.kernels.jit import call_fit, compiled
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve

Protocol = Literal["per-frame", "solve-once"]
PROTOCOLS: tuple[Protocol, ...] = ("per-frame", "solve-once")

SLACK = np.inf
"""Frames lie within the domain but for rounding: there is nothing to refuse."""


def frames(
    scheme: type[Curve], keyframes: Keyframes, t: FloatArray, protocol: Protocol, **options: Any
) -> Callable[[int], FloatArray]:
    """A function of a repeat count that generates the frames at t (m,) by one protocol; -> (m, 4)."""
    make = partial(scheme.from_keyframes, keyframes, **options)
    curve = make()
    if isinstance(curve, SegmentCurve) and hasattr(curve, "fit_kernel"):
        return _compiled(curve, t, protocol)
    return _interpreted(make, keyframes, t, protocol)


def _compiled(
    curve: SegmentCurve, t: FloatArray, protocol: Protocol
) -> Callable[[int], FloatArray]:
    k = curve.keyframes
    out = np.empty((t.size, 1, 4))
    segments, report = np.empty_like(curve.segments), np.zeros((1, 4))
    fit = (
        curve.fit_kernel.address,
        k.tracks,
        k.spacings,
        k.closed,
        k.signs,
        curve.parameters,
        segments,
        report,
    )
    places = described(curve.segment_knots, segments, k.signs, k.closed)
    loop = _per_frame if protocol == "per-frame" else _solve_once

    def generate(repeats: int) -> FloatArray:
        # The curve is named here so that the arrays whose addresses are in `places` live on.
        kernel, origin = curve.kernels[0].address, float(k.times[0])
        loop(repeats, *fit, kernel, places, origin, SLACK, t, out.reshape(-1))
        return out[:, 0]

    return generate


def _interpreted(
    make: Callable[[], Curve], keyframes: Keyframes, t: FloatArray, protocol: Protocol
) -> Callable[[int], FloatArray]:
    out, origin = np.empty((t.size, 1, 4)), float(keyframes.times[0])
    singly = [slice(i, i + 1) for i in range(t.size)]
    parts = singly if protocol == "per-frame" else [slice(None)]

    def generate(repeats: int) -> FloatArray:
        for _ in range(repeats):
            for part in parts:
                make()._evaluate(t[part], origin, SLACK, 0, out[part].reshape(-1), 1)
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
