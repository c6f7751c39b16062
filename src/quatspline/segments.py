"""SegmentCurve: curves that are one row of constants a segment, evaluated by compiled kernels.

A scheme of this kind supplies a fit kernel (keyframes -> constants) or computes the constants
itself, and names the family whose sample kernels evaluate them.  One compiled driver
(`families.driver`) does the rest for all: it finds the segments, wraps closed curves, refuses times
outside the domain, and hands blocks of samples to the kernels, component first.
"""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from quatspline.curve import Curve
from quatspline.inputs.arrays import BoolArray, FloatArray
from quatspline.kernels.driver import described, fit_tracks, sample
from quatspline.kernels.family import Family
from quatspline.kernels.jit import CHANGE, ITERATIONS, RESIDUAL, UNREPORTED, Kernel
from quatspline.kernels.misses import largest_misses
from quatspline.kernels.scalars import NEAR
from quatspline.solving import WRONG_FIXED_POINT, SolveReport

CHUNK = 4096
"""Segments fitted at once where a call asks for a window of a long curve ..."""
LAZY = 4 * CHUNK
"""... which has more segments than this."""

THREAD_MINIMUM = 20_000
"""Samples that make a further thread worth its start."""


class SegmentCurve(Curve):
    """A curve of segments with constants: see the module; subclasses fit, this evaluates."""

    family: Family
    measures_itself: bool = False
    """Whether its fit kernel reports what the constants that it wrote miss at keyframes."""
    batched = True
    _waiting: BoolArray | None = None
    """While a long curve is not wholly fitted: which chunks wait."""
    _fitting: threading.Lock

    def _solve(
        self, kernel: Kernel, parameters: FloatArray | None = None, *, whole: bool = False
    ) -> FloatArray:
        """Run a fit kernel over all tracks; returns its report, (K, 4).

        A long curve of a local scheme waits for calls and fits the windows that they ask for, unless
        ``whole``: for parameters that belong to keyframes.  An iterative scheme reports on all.
        """
        frames = self._keyframes
        self.fit_kernel = kernel
        self.parameters = (
            np.zeros(1) if parameters is None else np.ascontiguousarray(parameters, float)
        )
        tracks, count = frames.tracks.shape[0], frames.spacings.shape[0]
        segments = np.empty((tracks, count, self.family.constants))
        report = np.zeros((tracks, 4))
        if self.support is not None and count > LAZY and not (whole or self.iterative):
            self._waiting = np.ones(-(-count // CHUNK), bool)
            self._fitting = threading.Lock()
            # Kernels for any angle, now and later: a value must not depend on what was called before.
            self._set_segments(segments, np.inf)
        else:
            self._set_segments(
                segments,
                self._fit_rows(frames.tracks, frames.spacings, frames.closed, segments, report),
            )
        return report

    def _fit_rows(
        self,
        tracks: FloatArray,
        h: FloatArray,
        closed: bool,
        segments: FloatArray,
        report: FloatArray,
    ) -> float:
        signs = self._keyframes.signs
        reach: float = fit_tracks(
            self.fit_kernel.address, tracks, h, closed, signs, self.parameters, segments, report
        )
        if reach == UNREPORTED:
            raise TypeError(f"{self.name}: its fit kernel does not write report[REACH]")
        return reach

    def _fit_window(self, low: float, high: float) -> None:
        """Fit the chunks of segments from low to high where that was not done before.

        Both are times since the first keyframe.
        """
        inside = low >= 0.0 and high < self.segment_knots[-1]
        if self._keyframes.closed and not inside:
            low, high = 0.0, self.segment_knots[-1]
        first, last = np.searchsorted(self.segment_knots[1:-1], (low, high), "right") // CHUNK
        with self._fitting:
            if self._waiting is None:
                return
            for chunk in first + np.flatnonzero(self._waiting[first : last + 1]):
                self._fit_chunk(chunk * CHUNK)
                self._waiting[chunk] = False
            if not self._waiting.any():
                self._waiting = None

    def _fit_chunk(self, start: int) -> None:
        """Fit CHUNK segments from their keyframes and enough on either side."""
        frames, margin = self._keyframes, self.support or 0
        n, stop = frames.count, min(start + CHUNK, self.segments.shape[1])
        index = np.arange(start - margin, stop + margin + 1)
        if not frames.closed:
            index = index[(index >= 0) & (index < n)]
        tracks = frames.tracks[:, index % n]
        tracks *= (frames.signs[:, None] ** (index // n % 2))[..., None]  # keyframes of other turns
        tracks.setflags(write=False)  # as those of the whole: one compiled signature serves both
        h = frames.spacings[index[:-1] % n]
        rows = np.empty((tracks.shape[0], h.size, self.family.constants))
        self._fit_rows(tracks, h, False, rows, np.zeros((tracks.shape[0], 4)))
        before = start - index[0]
        self.segments[:, start:stop] = rows[:, before : before + stop - start]

    def _set_segments(
        self, segments: FloatArray, reach: float, knots: FloatArray | None = None
    ) -> None:
        """Take constants (K, segments, constants); reach is the largest half angle in a sample.

        ``knots`` since the first keyframe, where segments are finer than keyframe intervals.
        """
        frames = self._keyframes
        self.segments = segments = np.ascontiguousarray(segments, dtype=float)
        self.segment_knots = np.ascontiguousarray(frames.knots if knots is None else knots)
        shape = frames.tracks.shape[0], self.segment_knots.size - 1, self.family.constants
        if segments.shape != shape:  # kernels read by address: a wrong shape would read elsewhere
            raise ValueError(f"segments has shape {segments.shape}: expected {shape}")
        self.described = described(self.segment_knots, segments, frames.signs, frames.closed)
        self.kernels = self.family.near if reach <= NEAR else self.family.far

    def _report(
        self,
        method: str,
        stop: str,
        tolerance: float,
        report: FloatArray,
        on_failure: str,
        *,
        within: float | None = None,
        settled: BoolArray | None = None,
    ) -> None:
        """Judge a solve by its report (K, 4) and by what was written, and keep it; see `Curve._conclude`.

        The residual is the larger of what the iteration says of its equations and what the finished
        curve misses.  What is not a number counts as infinity, and is never within a tolerance.
        ``within`` is the residual allowed: by default the tolerance, or WRONG_FIXED_POINT tolerances
        where the change decides.  ``settled`` tracks (K,) are at rest, whatever their last change was.
        """
        if within is None:
            within = (WRONG_FIXED_POINT if stop == "change" else 1.0) * tolerance
        change = _finite(report[:, CHANGE])
        residual = _finite(report[:, RESIDUAL])
        if not self.measures_itself:
            residual = np.maximum(residual, self._misses())
        met = (change if stop == "change" else residual) <= tolerance
        if settled is not None:
            met = met | settled
        right = residual <= within
        shape = self._keyframes.track_shape
        columns = [report[:, ITERATIONS].astype(int), change, residual, met & right]
        values: list[Any] = [c.reshape(shape) if shape else c[0].item() for c in columns]
        iterations, change, residual, converged = values
        solved = SolveReport(method, stop, iterations, change, residual, converged, tolerance)
        self._conclude(solved, on_failure)

    def _misses(self) -> FloatArray:
        """What the constants miss at keyframes, (K,) in rad; `families.misses`."""
        frames = self._keyframes
        misses: FloatArray = largest_misses(
            self.kernels[0].address,
            self.segment_knots,
            self.segments,
            frames.tracks,
            frames.knots,
            frames.signs,
        )
        return misses

    def _evaluate(
        self,
        t: FloatArray,
        origin: float,
        slack: float,
        order: int,
        out: FloatArray,
        threads: int,
    ) -> int:
        if self._waiting is not None and t.size:
            self._fit_window(t.min() - origin, t.max() - origin)
        kernel = self.kernels[order].address, order, self.described, origin, slack
        if threads == 1 or t.size < 2 * THREAD_MINIMUM:
            return int(sample(*kernel, t, out))
        return _in_threads(kernel, t, out, min(threads, t.size // THREAD_MINIMUM))

    # The driver wraps and checks; these serve those who call them directly with inner times.

    def _orientation(self, t: FloatArray) -> FloatArray:
        return self._inner(t, 0)

    def _velocity(self, t: FloatArray) -> FloatArray:
        return self._inner(t, 1)

    def _acceleration(self, t: FloatArray) -> FloatArray:
        return self._inner(t, 2)

    def _inner(self, t: FloatArray, order: int) -> FloatArray:
        return self.inner(t, order)[:, 0]


def _in_threads(kernel: tuple[Any, ...], t: FloatArray, out: FloatArray, count: int) -> int:
    """Run the driver on as many parts of the samples; the first bad index, or -1."""
    edges = np.linspace(0, t.size, count + 1).astype(int).tolist()
    width = out.size // t.size
    with ThreadPoolExecutor(count) as pool:
        runs = [
            pool.submit(partial(sample, *kernel), t[a:b], out[width * a : width * b])
            for a, b in pairwise(edges)
        ]
        found = [(run.result(), a) for run, a in zip(runs, edges, strict=False)]
    return min((index + a for index, a in found if index >= 0), default=-1)


def _finite(column: FloatArray) -> FloatArray:
    """A column of a report, with infinity for what is not a number."""
    return np.where(np.isnan(column), np.inf, column)
