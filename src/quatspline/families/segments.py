"""SegmentCurve: curves that are one row of constants a segment, evaluated by compiled kernels.

A scheme of this kind supplies a fit kernel (keyframes -> constants) or computes the constants
itself, and names the family whose sample kernels evaluate them.  One compiled driver does
the rest for all: it finds the segments, wraps closed curves, refuses times outside the domain, and
hands blocks of samples to the kernels, component first, so that their loops vectorise.
"""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numba import carray  # noqa: F401 - kernels import it from here

from quatspline._jit import (
    BLOCK,
    CONSTANTS,
    RESULT,
    ROWS,
    Kernel,
    call_fit,
    call_sample,
    compiled,
)
from quatspline.curve import WRONG_FIXED_POINT, Curve, SolveReport
from quatspline.keyframes import Keyframes
from quatspline.primitives import NEAR
from quatspline.quaternion import FloatArray

ITERATIONS, CHANGE, RESIDUAL, REACH = range(4)
"""Entries of a fit kernel's report."""

BATCH = 2048
"""Samples located at once, before their tracks are evaluated."""

THREAD_MINIMUM = 20_000
"""Samples that make a further thread worth its start."""


@dataclass(frozen=True)
class Family:
    """The sample kernels that evaluate one layout of constants.

    Attributes
    ----------
    constants : numbers a segment
    near : kernels for orders 0, 1, 2 where every half angle stays within `primitives.NEAR`
    far : kernels for any angle
    """

    constants: int
    near: tuple[Kernel, Kernel, Kernel]
    far: tuple[Kernel, Kernel, Kernel]


class SegmentCurve(Curve):
    """A curve of segments with constants: see the module; subclasses fit, this evaluates."""

    family: ClassVar[Family]
    batched = True

    def _solve(self, kernel: Kernel, parameters: FloatArray | None = None) -> FloatArray:
        """Run a fit kernel over all tracks; returns its report, (K, 4)."""
        frames = self._keyframes
        self.fit_kernel = kernel
        self.parameters = np.zeros(1) if parameters is None else np.ascontiguousarray(parameters, float)
        shape = (frames.tracks.shape[0], frames.spacings.shape[0], self.family.constants)
        segments = np.empty(shape)
        report = np.zeros((shape[0], 4))
        fit_tracks(
            kernel.address,
            frames.tracks,
            frames.spacings,
            frames.closed,
            frames.signs,
            self.parameters,
            segments,
            report,
        )
        self._set_segments(segments, report[:, REACH].max())
        return report

    def _set_segments(
        self, segments: FloatArray, reach: float, knots: FloatArray | None = None
    ) -> None:
        """Take constants (K, segments, constants); reach is the largest half angle in a sample.

        ``knots`` since the first keyframe, where segments are finer than keyframe intervals.
        """
        self.segments = segments
        self.segment_knots = self._keyframes.knots if knots is None else knots
        self.kernels = self.family.near if reach <= NEAR else self.family.far

    def _report(
        self, method: str, stop: str, tolerance: float, report: FloatArray, on_failure: str
    ) -> None:
        """Judge a solve by its report (K, 4) and keep it; see `Curve._conclude`."""
        met = report[:, CHANGE if stop == "change" else RESIDUAL] <= tolerance
        right = report[:, RESIDUAL] <= (WRONG_FIXED_POINT if stop == "change" else 1.0) * tolerance
        shape = self._keyframes.track_shape
        columns = [
            report[:, ITERATIONS].astype(int),
            report[:, CHANGE],
            report[:, RESIDUAL],
            met & right,
        ]
        if shape:
            values = [column.reshape(shape) for column in columns]
        else:
            values = [column[0].item() for column in columns]
        self._conclude(SolveReport(method, stop, *values, tolerance), on_failure)

    def _evaluate(self, samples: FloatArray, order: int, out: FloatArray, threads: int) -> None:
        t = np.ascontiguousarray(samples.reshape(-1))
        count = min(threads, max(1, t.size // THREAD_MINIMUM))
        if count == 1:
            bad = self._sample(t, order, out)
        else:
            edges = np.linspace(0, t.size, count + 1).astype(int)
            with ThreadPoolExecutor(count) as pool:
                runs = [
                    pool.submit(self._sample, t[a:b], order, out[a:b])
                    for a, b in zip(edges, edges[1:], strict=False)
                ]
                found = [(run.result(), a) for run, a in zip(runs, edges, strict=False)]
            bad = min((index + a for index, a in found if index >= 0), default=-1)
        if bad >= 0:
            self._refuse(samples, int(bad))

    def _sample(self, t: FloatArray, order: int, out: FloatArray) -> int:
        frames = self._keyframes
        index: int = sample(
            self.kernels[order].address,
            order,
            self.segment_knots,
            self.segments,
            frames.closed,
            frames.signs,
            frames.times[0],
            self._slack,
            t,
            out,
        )
        return index

    # The driver wraps and checks; these serve those who call them directly with inner times.

    def _orientation(self, t: FloatArray) -> FloatArray:
        return self._inner(t, 0)

    def _velocity(self, t: FloatArray) -> FloatArray:
        return self._inner(t, 1)

    def _acceleration(self, t: FloatArray) -> FloatArray:
        return self._inner(t, 2)

    def _inner(self, t: FloatArray, order: int) -> FloatArray:
        out = np.empty((t.size, self._keyframes.tracks.shape[0], 3 if order else 4))
        self._evaluate(t + self._keyframes.times[0], order, out, 1)
        return out[:, 0]


@compiled
def fit_tracks(address, tracks, h, closed, signs, parameters, segments, report):
    """Call a fit kernel on every track (K, n, 4)."""
    for k in range(tracks.shape[0]):
        call_fit(address, tracks[k], h, closed, signs[k], parameters, segments[k], report[k])


@compiled
def sample(address, order, knots, segments, closed, signs, origin, slack, t, out):
    """Evaluate all tracks at t (m,) into out (m, K, 4 or 3); the first bad index, or -1."""
    size = min(BATCH, t.size)
    sheet = np.empty((ROWS, BLOCK))
    where = np.empty(size, np.int64)
    u = np.empty(size)
    flip = np.zeros(size, np.bool_)
    segment = 0
    for start in range(0, t.size, size):
        count = min(size, t.size - start)
        segment, flips, bad = _locate(
            knots, closed, origin, slack, t[start : start + count], segment, where, u, flip
        )
        if bad >= 0:
            return start + bad
        for k in range(segments.shape[0]):
            filled, length = -1, 0
            for first in range(0, count, BLOCK):
                n = min(BLOCK, count - first)
                for j in range(n):
                    sheet[0, j] = u[first + j]
                filled, length = _fill(
                    sheet, knots, segments[k], where[first : first + n], filled, length
                )
                call_sample(address, sheet.ctypes, n)
                _store(sheet, order, out[start + first : start + first + n, k])
            if order == 0 and flips and signs[k] < 0.0:
                for j in range(count):
                    if flip[j]:
                        for c in range(4):
                            out[start + j, k, c] = -out[start + j, k, c]
    return -1


@compiled
def _locate(knots, closed, origin, slack, t, segment, where, u, flip):
    """Segment and local parameter of each sample: (last segment, any flip, first bad index)."""
    last = knots.size - 2
    period = knots[last + 1]
    flips = False
    lo, hi = knots[segment], knots[segment + 1]
    inside = 0
    for j in range(t.size):
        x = t[j] - origin
        inside += (x >= lo) & (x < hi)
    if inside == t.size:
        h = hi - lo
        for j in range(t.size):
            u[j] = ((t[j] - origin) - lo) / h
            where[j] = segment
            flip[j] = False
        return segment, False, -1
    for j in range(t.size):
        x = t[j] - origin
        odd = False
        if not (x >= 0.0 and x < period):
            if closed:
                if not (abs(x) < np.inf):
                    return segment, flips, j
                periods = math.floor(x / period)
                x = min(max(x - periods * period, 0.0), period)
                odd = periods % 2.0 == 1.0
                flips = flips or odd
            elif x >= -slack and x <= period + slack:
                x = min(max(x, 0.0), period)
            else:
                return segment, flips, j
        if not (x >= knots[segment] and x < knots[segment + 1]):
            if segment < last and x >= knots[segment + 1] and x < knots[segment + 2]:
                segment += 1
            else:
                segment = min(np.searchsorted(knots, x, side="right") - 1, last)
        flip[j] = odd
        where[j] = segment
        u[j] = (x - knots[segment]) / (knots[segment + 1] - knots[segment])
    return segment, flips, -1


@compiled
def _fill(sheet, knots, segments, where, filled, length):
    """Constants of the samples' segments into the sheet; what one segment fills is kept."""
    n = where.size
    one = where[0] == where[n - 1]
    if one:
        for j in range(n):
            one = one and where[j] == where[0]
    if one:
        i = where[0]
        if i == filled and n <= length:
            return filled, length
        rate = 1.0 / (knots[i + 1] - knots[i])
        for j in range(n):
            sheet[1, j] = rate
        for c in range(segments.shape[1]):
            value = segments[i, c]
            for j in range(n):
                sheet[CONSTANTS + c, j] = value
        return i, n
    for j in range(n):
        i = where[j]
        sheet[1, j] = 1.0 / (knots[i + 1] - knots[i])
        for c in range(segments.shape[1]):
            sheet[CONSTANTS + c, j] = segments[i, c]
    return -1, 0


@compiled
def _store(sheet, order, out):
    """The result rows, component first, into out (n, 4 or 3)."""
    if order == 0:
        for j in range(out.shape[0]):
            out[j, 0] = sheet[RESULT, j]
            out[j, 1] = sheet[RESULT + 1, j]
            out[j, 2] = sheet[RESULT + 2, j]
            out[j, 3] = sheet[RESULT + 3, j]
    else:
        for j in range(out.shape[0]):
            out[j, 0] = sheet[RESULT, j]
            out[j, 1] = sheet[RESULT + 1, j]
            out[j, 2] = sheet[RESULT + 2, j]
