"""SegmentCurve: curves that are one row of constants per segment, in plain Python or compiled.

A scheme of this kind supplies a fit kernel (keyframes -> constants) or computes the constants
itself, and names the family whose functions evaluate them.  What is compiled, one driver
(`engines.driver`) does for all: it finds the segments, wraps closed curves, refuses times
outside the domain, and hands blocks of samples to the kernels, component first.  Before that,
`engines.plain` does the same one sample at a time (see `engines.engine`).
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from typing import Any, Literal

import numpy as np

from quatspline.counted import Counted
from quatspline.curve import Curve
from quatspline.engines import engine, plain
from quatspline.inputs.arrays import BoolArray, FloatArray
from quatspline.kernels.family import Family
from quatspline.kernels.jit import (
    CHANGE,
    ITERATIONS,
    OVERWRITTEN,
    REACH,
    RESIDUAL,
    ROWS,
    UNREPORTED,
    Kernel,
)
from quatspline.kernels.scalars import NEAR
from quatspline.keyframes import segment_of
from quatspline.solving import WRONG_FIXED_POINT, SolveReport
from quatspline.system.pages import Pages

CHUNK, AT_ONCE = 256, 16
"""Segments that are fitted where a call asks for one of them, and how many neighbouring chunks at once, ..."""
LAZY = 64 * CHUNK
"""... of a curve that has more segments than this."""

MOST = 0.5
"""Share of a curve's chunks that are most of them: wanted at once, they are written in larger pages."""

THREAD_MINIMUM = 20_000
"""Samples that make a further thread worth its start."""

FITTED, ITERATED = 4.0, 40.0
"""Samples that the fit of a segment counts as, at once (unless a curve's ``fitted`` says more) and by an iteration."""


class SegmentCurve(Curve):
    """A curve of segments with constants: see the module; subclasses fit, this evaluates."""

    family: Family
    operations = Counted()
    measures_itself: bool = False
    """Whether its fit kernel reports what the constants that it wrote miss at keyframes."""
    batched = True
    fitted = FITTED
    _waiting: BoolArray | None = None
    """While a long curve is not wholly fitted: which chunks wait."""
    _fitting: threading.Lock
    _room: Pages
    _refused = False
    """Whether plain Python refused to do what machine code does, such as dividing by zero."""
    _sample: Any = None
    """The compiled driver, once this curve is compiled."""

    @property
    def engine(self) -> Literal["python", "compiled"]:
        """What evaluates its orientations: plain Python at first, machine code once that repays compiling.

        Rates have kernels of their own, each of which is compiled once its work repays it.
        """
        return "compiled" if self._compiled[0] or self._repays(0, 0) else "python"

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
        report = np.zeros((tracks, 4))
        if self.support is not None and count > LAZY and not (whole or self.iterative):
            self._waiting = np.ones(-(-count // CHUNK), bool)
            self._fitting = threading.Lock()
            # Kernels for any angle, now and later: a value must not depend on what was called before.
            shape = tracks, count, self.family.constants
            self._room = Pages(math.prod(shape))
            self._set_segments(self._room.array.reshape(shape), np.inf)
        else:
            fitted = self._fit_rows(frames.tracks, frames.spacings, frames.closed, report)
            self._set_segments(*fitted)
        return report

    def _fit_rows(
        self, tracks: FloatArray, h: FloatArray, closed: bool, report: FloatArray, pieces: int = 1
    ) -> tuple[FloatArray, float]:
        """Constants (K, pieces of intervals, constants) by the fit kernel, and the largest reach.

        Raises
        ------
        TypeError
            Where the kernel reports no reach, or writes beyond the constants of its family.
        """
        shape = len(tracks), h.size * pieces, self.family.constants
        room = np.empty(math.prod(shape) + ROWS)
        segments, beyond = room[:-ROWS].reshape(shape), room[-ROWS:]
        each = ITERATED if self.iterative else self.fitted
        work = len(tracks) * h.size * pieces * each
        self.fit_kernel.work += work
        given = tracks, h, closed, self._keyframes.signs, self.parameters, segments, report, beyond
        compiled = self._refused or engine.compiles(0.0, self.fit_kernel)
        reach: float = self._run("fit_tracks", compiled, self.fit_kernel, *given)
        if reach == OVERWRITTEN:
            raise TypeError(
                f"{self.name}: its fit kernel writes beyond the {shape[-1]} constants of its family"
            )
        if (report[:, REACH] == UNREPORTED).any():  # of one track, the largest reach would hide it
            raise TypeError(f"{self.name}: its fit kernel does not write report[REACH]")
        return segments, reach

    def _fit_where(self, t: FloatArray) -> None:
        """Fit the chunks of segments that samples t, since the first keyframe, lie in, unless that was done before."""
        with self._fitting:
            if self._waiting is None:
                return
            wanted = self._waiting & self._asked(t)
            if wanted.mean() > MOST:
                self._room.whole()
            for run in _runs(wanted):
                self._fit_chunks(run)
                self._waiting[run] = False
            if not self._waiting.any():
                self._waiting = None

    def _asked(self, t: FloatArray) -> BoolArray:
        """Which chunks samples lie in; where they are as many as the segments between them, all of those.

        Then hardly one is without a sample, and to look at every sample would take longer than a fit.
        """
        starts = self.segment_knots[CHUNK:-1:CHUNK]
        low, high = t.min(), t.max()
        inside = low >= 0.0 and high < self.segment_knots[-1]
        if self._keyframes.closed and not inside:
            return np.ones(starts.size + 1, bool)
        asked = np.zeros(starts.size + 1, bool)
        first, last = np.searchsorted(starts, (low, high), "right")
        if t.size < (last - first) * CHUNK:
            asked[np.searchsorted(starts, t, "right")] = True
        else:
            asked[first : last + 1] = True
        return asked

    def _fit_chunks(self, run: slice) -> None:
        """Fit neighbouring chunks from their keyframes and enough on either side."""
        frames, margin = self._keyframes, self.support or 0
        start, n = run.start * CHUNK, frames.count
        stop = min(run.stop * CHUNK, self.segments.shape[1])
        index = np.arange(start - margin, stop + margin + 1)
        if not frames.closed:
            index = index[(index >= 0) & (index < n)]
        tracks = frames.tracks[:, index % n]
        tracks *= (frames.signs[:, None] ** (index // n % 2))[..., None]  # keyframes of other turns
        tracks.setflags(write=False)  # as those of the whole: one compiled signature serves both
        h = frames.spacings[index[:-1] % n]
        rows, _ = self._fit_rows(tracks, h, False, np.zeros((tracks.shape[0], 4)))
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
        self.kernels = self.family.near if reach <= NEAR else self.family.far
        # By order: that the kernel of one is there says nothing of what compiling another costs.
        self._compiled: list[bool | None] = [self._refused or None] * len(self.kernels)
        self._work = [0.0] * len(self.kernels)
        self._sample = None  # it was told where other constants are

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
        """What the constants miss at keyframes, (K,) in rad."""
        frames = self._keyframes
        curve = self.segment_knots, self.segments, frames.tracks, frames.knots, frames.signs
        compiled = self._compiled[0] or self._repays(0, 2 * frames.spacings.size)
        misses: FloatArray = self._run("largest_misses", compiled, self.kernels[0], *curve)
        return misses

    # -- engines --------------------------------------------------------------------------------

    def _repays(self, order: int, samples: int) -> bool:
        """Count samples of an order, and whether its kernel takes them: it is there, or they repay it.

        A curve keeps to what it began with, plain Python until its own work repays compiling.
        """
        kernel, work = self.kernels[order], samples * self.segments.shape[0]
        self._work[order] += work
        kernel.work += work
        begins = self._compiled[order] is None
        compiled = engine.compiles(self._work[order], kernel if begins else None)
        self._compiled[order] = compiled
        return compiled

    def _run(self, name: str, compiled: bool, *arguments: Any) -> Any:
        """A function of `plain`, or of `native`."""
        if not compiled:
            with engine.unfit_suppressed():
                return getattr(plain, name)(*arguments)
            self._refused = True
        return getattr(engine.native(), name)(*arguments)

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
            self._fit_where(t - origin)
        kernel = self.kernels[order]
        if not self._compiled[order] and not self._repays(order, t.size):
            with engine.unfit_suppressed():
                return self._evaluate_plainly(t - origin, slack, order, out)
            self._compiled[order] = True
        sample = self._sample or self._compile()
        given = kernel.address or engine.address(kernel), order, self.described, origin, slack
        if threads == 1 or t.size < 2 * THREAD_MINIMUM:
            return int(sample(*given, t, out))
        return int(
            engine.native().in_threads(
                sample, given, t, out, min(threads, t.size // THREAD_MINIMUM)
            )
        )

    def _compile(self) -> Any:
        """Tell the driver where this curve is; returns the driver."""
        frames, native = self._keyframes, engine.native()
        curve = self.segment_knots, self.segments, frames.signs, frames.closed
        self.described = native.described(*curve)
        self._sample = native.sampler()
        return self._sample

    def _evaluate_plainly(self, t: FloatArray, slack: float, order: int, out: FloatArray) -> int:
        inner, flips, bad = self._domain.wrap(t, slack)
        if bad.any():
            return int(np.argmax(bad))
        result = out.reshape(t.size, self.segments.shape[0], 3 if order else 4)
        segment = segment_of(self.segment_knots, inner)
        curve = self.segment_knots, self.segments, segment, inner, result
        plain.sample(self.kernels[order], *curve)
        if order == 0:
            result[np.ix_(flips, self._keyframes.signs < 0.0)] *= -1.0
        return -1

    # The driver wraps and checks; these serve those who call them directly with inner times.

    def _orientation(self, t: FloatArray) -> FloatArray:
        return self._inner(t, 0)

    def _velocity(self, t: FloatArray) -> FloatArray:
        return self._inner(t, 1)

    def _acceleration(self, t: FloatArray) -> FloatArray:
        return self._inner(t, 2)

    def _inner(self, t: FloatArray, order: int) -> FloatArray:
        return self.inner(t, order)[:, 0]


def _runs(wanted: BoolArray) -> Iterator[slice]:
    """Neighbouring chunks that are wanted, AT_ONCE of them at most."""
    index = np.flatnonzero(wanted)
    for run in np.split(index, np.flatnonzero(np.diff(index) > 1) + 1):
        for k in range(0, run.size, AT_ONCE):
            part = run[k : k + AT_ONCE]
            yield slice(int(part[0]), int(part[-1]) + 1)


def _finite(column: FloatArray) -> FloatArray:
    """A column of a report, with infinity for what is not a number."""
    return np.where(np.isnan(column), np.inf, column)
