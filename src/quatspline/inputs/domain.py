"""The domain of a curve: its times, and samples of it taken or refused in one sentence."""

from __future__ import annotations

from functools import cached_property
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from quatspline.inputs import stamps
from quatspline.inputs.arrays import BoolArray, FloatArray, at, float_array, real_array

EDGE = 4
"""Samples this many ulp outside an open domain count as its end."""


class Domain:
    """From the first keyframe time to the last; a closed curve's is a period.

    Parameters
    ----------
    times : keyframe times as given (`stamps.stamps`), of a closed curve with the return
    period : the last of them since the first, in float64
    closed : whether samples wrap
    hold : whether samples outside an open domain are taken at its nearer end
    """

    def __init__(
        self, times: NDArray[Any], period: float, closed: bool, hold: bool = False
    ) -> None:
        self.times, self.period, self.closed = times, period, closed
        self.hold = hold and not closed
        self.plain = times.dtype == np.float64
        self.origin = float(times[0]) if self.plain else 0.0

    @property
    def ends(self) -> tuple[Any, Any]:
        """First and last time: numbers, or datetimes where keyframes have them."""
        first, last = self.times[0], self.times[-1]
        return (first, last) if self.times.dtype.kind in "mM" else (first.item(), last.item())

    def take(self, t: Any) -> tuple[FloatArray, float]:
        """Samples as float64 (C-contiguous, of any shape), and how far outside the domain they may lie.

        They count from `origin`: as given, or, of keyframes with other stamps than float64, since the
        first keyframe.
        """
        if type(t) is float and self.plain:
            return np.array(t), self._slack
        given = self._given(t)
        since = given if self.plain else stamps.elapsed(given, self.times[0])
        exact = self.plain and (given.dtype.kind != "f" or given.dtype.itemsize >= 8)
        return float_array("t", since), self._slack if exact else self._slack_of(given.dtype)

    def held(self, t: FloatArray, slack: float) -> tuple[FloatArray, BoolArray]:
        """Samples as `take` gives them at the nearer end where they are outside, and which were."""
        since = t - self.origin
        outside = np.isfinite(t) & ((since < -slack) | (since > self.period + slack))
        ends = self.origin, self.origin + self.period
        return np.where(outside, np.clip(t, *ends), t), outside

    def wrap(self, t: FloatArray, slack: float) -> tuple[FloatArray, Any, Any]:
        """Times since the first keyframe (m,), brought into the domain.

        Also where an odd number of periods was taken off for it, and which are bad.
        """
        if self.closed:
            bad = ~np.isfinite(t)
            periods = np.floor(np.where(bad, 0.0, t) / self.period)
            return np.clip(t - periods * self.period, 0.0, self.period), periods % 2 == 1, bad
        bad = ~((t >= -slack) & (t <= self.period + slack))
        return np.clip(t, 0.0, self.period), np.zeros(t.shape, bool), bad

    def refuse(self, t: Any, index: int) -> NoReturn:
        """Raise the ValueError that names a sample by its index among all."""
        given = self._given(t)
        where = np.unravel_index(index, given.shape) if given.shape else ()
        label, stamp = at("t", where), given[where]
        if not stamps.finite(stamp):
            raise ValueError(f"{label} = {stamp}: not a finite number")
        first, last = map(stamps.shown, self.ends)
        raise ValueError(f"{label} = {stamps.shown(stamp)}: outside the domain [{first}, {last}]")

    def _given(self, t: Any) -> NDArray[Any]:
        """Samples as an array of what they are."""
        return real_array("t", t) if self.plain else stamps.stamps("t", t)

    @cached_property
    def _slack(self) -> float:
        return self._slack_of(np.dtype(np.float64))

    def _slack_of(self, kind: np.dtype[Any]) -> float:
        """EDGE ulp of an end, in samples of a dtype."""
        return EDGE * stamps.resolution(self.times[0], self.times[-1], kind)
