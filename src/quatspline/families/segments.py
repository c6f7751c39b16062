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
from itertools import pairwise
from typing import Any

import numpy as np

from quatspline._jit import (
    BLOCK,
    CONSTANTS,
    RESULT,
    ROWS,
    Kernel,
    call_fit,
    call_sample,
    compiled,
    inlined,
)
from quatspline.curve import WRONG_FIXED_POINT, Curve, SolveReport
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

    family: Family
    batched = True

    def _solve(self, kernel: Kernel, parameters: FloatArray | None = None) -> FloatArray:
        """Run a fit kernel over all tracks; returns its report, (K, 4)."""
        frames = self._keyframes
        self.fit_kernel = kernel
        self.parameters = (
            np.zeros(1) if parameters is None else np.ascontiguousarray(parameters, float)
        )
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
        self._first = float(self._keyframes.times[0])
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
        values: list[Any] = [c.reshape(shape) if shape else c[0].item() for c in columns]
        iterations, change, residual, converged = values
        solved = SolveReport(method, stop, iterations, change, residual, converged, tolerance)
        self._conclude(solved, on_failure)

    def _evaluate(self, samples: FloatArray, order: int, out: FloatArray, threads: int) -> None:
        t = samples.reshape(-1)
        if not (t.flags.c_contiguous and t.flags.writeable):  # one compiled signature serves all
            t = t.copy()
        origin = self._first
        if threads == 1 or t.size < 2 * THREAD_MINIMUM:
            bad = self._sample(t, order, out.reshape(-1), origin)
        else:
            bad = self._sample_in_threads(t, order, out, min(threads, t.size // THREAD_MINIMUM))
        if bad >= 0:
            self._refuse(samples, int(bad))

    def _sample_in_threads(self, t: FloatArray, order: int, out: FloatArray, count: int) -> int:
        edges = np.linspace(0, t.size, count + 1).astype(int)
        with ThreadPoolExecutor(count) as pool:
            runs = [
                pool.submit(self._sample, t[a:b], order, out[a:b].reshape(-1), self._first)
                for a, b in pairwise(edges)
            ]
            found = [(run.result(), a) for run, a in zip(runs, edges, strict=False)]
        return min((index + a for index, a in found if index >= 0), default=-1)

    def _sample(self, t: FloatArray, order: int, out: FloatArray, origin: float) -> int:
        index: int = sample(
            self.kernels[order].address,
            order,
            self.segment_knots,
            self.segments,
            self._keyframes.closed,
            self._keyframes.signs,
            origin,
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
        tracks, width = self._keyframes.tracks.shape[0], 3 if order else 4
        out = np.empty((t.size, tracks, width))
        self._sample(np.array(t, dtype=float), order, out.reshape(-1), 0.0)
        return out[:, 0]


@compiled
def fit_tracks(address, tracks, h, closed, signs, parameters, segments, report):
    """Call a fit kernel on every track (K, n, 4)."""
    for k in range(tracks.shape[0]):
        call_fit(address, tracks[k], h, closed, signs[k], parameters, segments[k], report[k])


@compiled
def sample(address, order, knots, segments, closed, signs, origin, slack, t, out):
    """Evaluate all tracks at t (m,) into out (m * K * width,); the first bad index, or -1."""
    size = min(BATCH, t.size)
    blocks = (size + BLOCK - 1) // BLOCK
    sheet = np.empty((ROWS, BLOCK))
    pointer = sheet.ctypes
    u = np.empty(size)
    where = np.empty(size, np.int64)
    run = np.empty(blocks, np.int64)  # the segment of a whole block, or -1
    tracks = segments.shape[0]
    segment = 0
    for start in range(0, t.size, size):
        count = min(size, t.size - start)
        segment, wraps, bad = _locate(
            knots, closed, origin, slack, t[start : start + count], segment, u, where, run
        )
        if bad >= 0:
            return start + bad
        for k in range(tracks):
            filled, length = -1, 0
            for b in range((count + BLOCK - 1) // BLOCK):
                first = b * BLOCK
                n = min(BLOCK, count - first)
                for j in range(n):
                    sheet[0, j] = u[first + j]
                if run[b] < 0:
                    filled = -1
                    i = 0
                    while i < n:
                        end = i + 1
                        while end < n and where[first + end] == where[first + i]:
                            end += 1
                        _fill(sheet, knots, segments[k], where[first + i], i, end)
                        i = end
                elif run[b] != filled or n > length:
                    _fill(sheet, knots, segments[k], run[b], 0, n)
                    filled, length = run[b], n
                call_sample(address, pointer, n)
                _store(sheet, order, out, start + first, n, k, tracks)
            if order == 0 and wraps and signs[k] < 0.0:
                _flip(t[start : start + count], origin, knots[-1], out, start, k, tracks)
    return -1


@compiled
def _locate(knots, closed, origin, slack, t, segment, u, where, run):
    """Local parameter and segment of each sample, block by block.

    Returns the last segment, whether any sample lies in another period, and the first bad index.
    """
    wraps = False
    for b in range((t.size + BLOCK - 1) // BLOCK):
        first = b * BLOCK
        n = min(BLOCK, t.size - first)
        lo, hi = knots[segment], knots[segment + 1]
        inside = 0
        for j in range(first, first + n):
            x = t[j] - origin
            inside += (x >= lo) & (x < hi)
        if inside == n:
            rate = 1.0 / (hi - lo)  # a product in both branches: whole and split blocks agree
            for j in range(first, first + n):
                u[j] = ((t[j] - origin) - lo) * rate
            run[b] = segment
            continue
        run[b] = -1
        for j in range(first, first + n):
            x = t[j] - origin
            if not (x >= 0.0 and x < knots[-1]):
                if closed and abs(x) < np.inf:
                    x = _wrapped(x, knots[-1])
                    wraps = True
                elif not closed and x >= -slack and x <= knots[-1] + slack:
                    x = min(max(x, 0.0), knots[-1])
                else:
                    return segment, wraps, j
            if not (x >= knots[segment] and x < knots[segment + 1]):
                segment = _find(knots, x, segment)
            where[j] = segment
            u[j] = (x - knots[segment]) * (1.0 / (knots[segment + 1] - knots[segment]))
    return segment, wraps, -1


@inlined
def _wrapped(x, period):
    """The time within the first period."""
    return min(max(x - math.floor(x / period) * period, 0.0), period)


@inlined
def _find(knots, x, segment):
    """The segment of x: the next one in a sorted sweep, otherwise by bisection."""
    last = knots.size - 2
    if segment < last and x >= knots[segment + 1] and x < knots[segment + 2]:
        return segment + 1
    low, high = 0, last + 1
    while high - low > 1:
        middle = (low + high) >> 1
        if knots[middle] <= x:
            low = middle
        else:
            high = middle
    return low


@inlined
def _fill(sheet, knots, segments, i, first, end):
    """The constants of segment i for the samples first ... end - 1 of a block."""
    rate = 1.0 / (knots[i + 1] - knots[i])
    for j in range(first, end):
        sheet[1, j] = rate
    for c in range(segments.shape[1]):
        value = segments[i, c]
        for j in range(first, end):
            sheet[CONSTANTS + c, j] = value


@inlined
def _store(sheet, order, out, start, n, k, tracks):
    """The result rows, component first, into out, sample first."""
    if order == 0 and tracks == 1:  # a constant stride: the stores vectorise
        for j in range(n):
            at = 4 * (start + j)
            out[at] = sheet[RESULT, j]
            out[at + 1] = sheet[RESULT + 1, j]
            out[at + 2] = sheet[RESULT + 2, j]
            out[at + 3] = sheet[RESULT + 3, j]
        return
    width = 3 if order else 4
    for j in range(n):
        at = width * ((start + j) * tracks + k)
        for c in range(width):
            out[at + c] = sheet[RESULT + c, j]


@compiled
def _flip(t, origin, period, out, start, k, tracks):
    """The sign of samples an odd number of periods away, on a track that returns as -q."""
    for j in range(t.size):
        if math.floor((t[j] - origin) / period) % 2.0 == 1.0:
            at = 4 * ((start + j) * tracks + k)
            for c in range(4):
                out[at + c] = -out[at + c]
