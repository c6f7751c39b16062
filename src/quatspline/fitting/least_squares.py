"""Least squares for the controls of `fewer_knots`: Gauss-Newton steps, damped after Levenberg where the misses rise."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.engines import engine
from quatspline.fitting import fewer_knots
from quatspline.fitting.smoothing import REST, STALL
from quatspline.keyframes import Keyframes, segment_of
from quatspline.quaternion import FloatArray

ROWS = {"normal": 20, "misses": 4, "stepped": 3, "settle": 3, "write": 3}
"""Rows of array algebra that these count as, on one keyframe or control, in plain Python (`engine.run`)."""

FIRST, GROWTH, MOST = 1e-6, 10.0, 1e4
"""Damping, as a share of the normal equations' mean diagonal: the least, its factor, and where it is given up."""

ROUNDING = 1e-9
"""A relative rise of the misses that is none."""

SMALLEST = 1e-15
"""Of misses in log units: below it they are rounding."""


@dataclass(frozen=True)
class Fitted:
    """Controls d (m, 4) and increments w (m, 3) with the misses e (n, 3) and their weighted sum of squares."""

    d: FloatArray
    w: FloatArray
    e: FloatArray
    cost: float


@dataclass(frozen=True)
class Outcome:
    """Where a solve ended: its last update turned controls by up to the residual, in rad."""

    state: Fitted
    iterations: int
    change: float
    residual: float
    rest: bool


class LeastSquares:
    """The problem of one track: keyframes, knots (N + 1,) since the first, weights (n,)."""

    def __init__(self, keyframes: Keyframes, knots: FloatArray, weights: FloatArray) -> None:
        self.q, self.weights = keyframes.quaternions, weights
        self.h = np.diff(knots) / keyframes.unit
        self.at = segment_of(knots, keyframes.knots)
        u = (keyframes.knots - knots[self.at]) / np.diff(knots)[self.at]
        self.cover = np.empty((u.size, 3))
        _run("basis", u.size, self.h, self.at, u, self.cover)
        self.start = self._start(keyframes, knots)

    def _start(self, keyframes: Keyframes, knots: FloatArray) -> Fitted:
        """Controls on slerp, at the means of the three knots that belong to each; increments along its turns."""
        ends = np.concatenate([[knots[0]] * 2, knots, [knots[-1]] * 2])
        i, u = keyframes.locate((ends[:-2] + ends[1:-1] + ends[2:]) / 3.0)
        turns = quaternion.log(quaternion.mul(quaternion.conj(self.q[:-1]), self.q[1:]))
        d = quaternion.mul(self.q[i], quaternion.exp(u[:, None] * turns[i]))
        turned = np.concatenate([np.zeros((1, 3)), np.cumsum(turns, axis=0)])
        along = turned[i] + u[:, None] * turns[i]
        return self._settled(d, np.diff(along, axis=0, prepend=along[:1]))

    def _settled(self, d: FloatArray, w: FloatArray) -> Fitted:
        """The state of controls and increments that are nearly theirs; both are written to."""
        e = np.empty((len(self.q), 3))
        _run("settle", len(d), d, w)
        _run("misses", len(e), self.q, self.at, self.cover, d, w, e)
        return Fitted(d, w, e, float(np.sum(self.weights * np.sum(e * e, axis=1))))

    def solve(self, tolerance: float, limit: int) -> Outcome:
        """Minimise the weighted misses until an update turns no control by more than the tolerance."""
        state, damping, change, turned = self.start, 0.0, np.inf, [np.inf]
        for done in range(limit):
            found = self._update(state, damping, tolerance)
            if found is None:
                return Outcome(state, done, np.inf, np.inf, rest=False)
            state, damping, change, residual = found
            turned.append(residual)
            rest = residual <= REST and min(turned[-STALL:]) >= min(turned[:-STALL], default=np.inf)
            if residual <= tolerance or rest:
                return Outcome(state, done + 1, change, residual, rest=True)
        return Outcome(state, limit, change, turned[-1], rest=False)

    def _update(
        self, state: Fitted, damping: float, tolerance: float
    ) -> tuple[Fitted, float, float, float] | None:
        """The next state, damping, relative change and largest turn; None where no damping lessens the misses."""
        band, rhs = np.empty((3 * len(state.d), fewer_knots.BAND)), np.empty((len(state.d), 3))
        given = self.at, self.cover, state.w, self.weights, state.e, band, rhs
        _run("normal", len(self.q), *given)
        allowed = (1.0 + ROUNDING) * state.cost + SMALLEST**2 * float(np.sum(self.weights))
        while damping <= MOST:
            delta = _solved(band, rhs, damping)
            largest = 2.0 * float(np.sqrt(np.max(np.sum(delta * delta, axis=1))))
            if largest < np.inf:
                d, w = np.empty(state.d.shape), np.zeros(state.w.shape)
                change = float(_run("stepped", len(d), state.d, state.w, delta, d, w))
                trial = self._settled(d, w)
                if trial.cost <= allowed or largest <= tolerance:
                    return trial, damping / GROWTH if damping > FIRST else 0.0, change, largest
            damping = max(FIRST, GROWTH * damping)
        return None

    def write(self, state: Fitted, segments: FloatArray) -> float:
        """Constants of the curve's segments; returns their reach."""
        return float(_run("write", len(segments), self.h, state.d, state.w, segments))


def _run(name: str, rows: int, *arguments: Any) -> Any:
    """A function of `fewer_knots`."""
    return engine.run(getattr(fewer_knots, name), ROWS.get(name, 1) * rows, *arguments)


def _solved(band: FloatArray, rhs: FloatArray, damping: float) -> FloatArray:
    """Turns delta (m, 3) of the damped equations; infinite where these are singular to rounding."""
    from scipy.linalg import LinAlgError, solveh_banded  # slow to import: others need not wait

    damped = band.copy()
    damped[:, 0] += damping * float(np.mean(band[:, 0]))
    with np.errstate(all="ignore"):
        try:
            delta: FloatArray = solveh_banded(
                damped.T, rhs.reshape(-1), overwrite_ab=True, lower=True, check_finite=False
            ).reshape(rhs.shape)
        except LinAlgError:
            return np.full(rhs.shape, np.inf)
    return np.where(np.isfinite(delta), delta, np.inf)
