"""What the compiled driver does, in plain Python: one sample at a time, from the same functions."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from quatspline.inputs.arrays import FloatArray, IntArray
from quatspline.kernels.jit import BLOCK, CONSTANTS, REACH, RESULT, ROWS, UNREPORTED, Kernel
from quatspline.kernels.values import Quat, arc, keyframe


def fit_tracks(
    kernel: Kernel,
    tracks: FloatArray,
    h: FloatArray,
    closed: bool,
    signs: FloatArray,
    parameters: FloatArray,
    segments: FloatArray,
    report: FloatArray,
    beyond: FloatArray,
) -> float:
    """Run a fit kernel on every track (K, n, 4); the largest reach that they report.

    What lies ``beyond`` the segments is out of reach: Python checks the bounds of rows.
    """
    report[:, REACH] = UNREPORTED
    for k, sign in enumerate(signs.tolist()):
        kernel.python(tracks[k], h, closed, sign, parameters, segments[k], report[k])
    return float(report[:, REACH].max())


def sample(
    kernel: Kernel,
    knots: FloatArray,
    segments: FloatArray,
    segment: IntArray,
    t: FloatArray,
    out: FloatArray,
) -> None:
    """Fill out (m, K, 4 or 3) at times t (m,) since the first keyframe, in segments (m,)."""
    evaluate = kernel.sample or _by_sheet(kernel, out.shape[-1])
    start, stop = knots[segment], knots[segment + 1]
    rates = 1.0 / (stop - start)
    u = np.where(t >= stop, 1.0, (t - start) * rates).tolist()
    for k in range(segments.shape[0]):
        rows: dict[int, list[float]] = {}
        for j, (i, rate) in enumerate(zip(segment.tolist(), rates.tolist(), strict=True)):
            c = rows.get(i) or rows.setdefault(i, segments[k, i].tolist())
            out[j, k] = evaluate(c, u[j], rate)


def largest_misses(
    kernel: Kernel,
    knots: FloatArray,
    segments: FloatArray,
    tracks: FloatArray,
    keys: FloatArray,
    signs: FloatArray,
) -> FloatArray:
    """The largest angle (K,) in rad between curve and keyframes, from either side of each."""
    at = np.searchsorted(knots, keys[:-1])
    ends = np.append(at[1:], len(knots) - 1) - 1
    q = np.empty((2 * at.size, segments.shape[0], 4))
    first, last = knots[at], knots[ends + 1]
    sample(kernel, knots, segments, np.concatenate([at, ends]), np.append(first, last), q)
    misses = np.zeros(segments.shape[0])
    for k, sign in enumerate(signs.tolist()):
        for i in range(at.size):
            for j, key in ((i, i), (at.size + i, i + 1)):
                theta, _, _ = arc(Quat(*q[j, k].tolist()), keyframe(tracks[k], key, sign))
                misses[k] = max(misses[k], theta) if theta == theta else math.inf
    return 2.0 * misses


def _by_sheet(kernel: Kernel, width: int) -> Callable[[list[float], float, float], FloatArray]:
    """One sample of a kernel that is written for blocks."""
    sheet, python = np.zeros((ROWS, BLOCK)), kernel.python

    def evaluate(c: list[float], u: float, rate: float) -> FloatArray:
        sheet[0, 0], sheet[1, 0] = u, rate
        sheet[CONSTANTS : CONSTANTS + len(c), 0] = c
        python(sheet, 1)
        return sheet[RESULT : RESULT + width, 0]

    return evaluate
