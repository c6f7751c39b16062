"""Smoothed keyframes for one weight lambda, by damped Gauss-Newton steps on `reinsch`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from quatspline.engines import engine
from quatspline.fitting import reinsch
from quatspline.quaternion import FloatArray

ROWS = {"measure": 2, "linearise": 6, "normal": 12, "turns": 3, "write": 5}
"""Rows of array algebra that these count as on one keyframe, in plain Python, and others one (`engine.run`)."""

ROUNDING, RATE = 1e-9, 1e-15
"""A relative rise of F that is none, and the rounding of a turn between keyframes, which lambda magnifies."""

SHORTEST = 1e-3
"""The share of a step below which nothing is gained by halving it."""

STALL, REST = 5, 1e-6
"""Updates without a smaller one, none of them over so many rad, that are rounding: a large lambda magnifies it."""


@dataclass(frozen=True)
class State:
    """Smoothed keyframes r (n, 4) with what `reinsch` measures of them; cost is F for a lambda."""

    r: FloatArray
    steps: FloatArray
    d: FloatArray
    e: FloatArray
    rss: float
    cost: float


@dataclass(frozen=True)
class Solution:
    """Where a solve ended: the last update turned keyframes by up to the residual, in rad.

    One that came to rest at rounding, above the tolerance, has converged too.
    """

    state: State
    iterations: int
    change: float
    residual: float
    converged: bool
    rest: bool = False


class Smoothing:
    """Reinsch's problem for one track: keyframes (n, 4), spacings, closing sign and weights (n,)."""

    def __init__(
        self, q: FloatArray, h: FloatArray, closed: bool, sign: float, w: FloatArray
    ) -> None:
        from scipy.linalg import cholesky_banded  # slow to import: others need not wait

        self.q, self.h, self.closed, self.sign, self.w = q, h, closed, sign, w
        self.place = reinsch.places(len(q), closed)
        self.rows = len(q) if closed else len(q) - 2
        width = min(reinsch.CLOSED if closed else reinsch.OPEN, self.rows - 1)
        self.flat_r, self.flat_k = np.zeros((2, self.rows, width + 1))
        _run("flat", len(q), h, 1.0 / w, self.place, self.flat_r, self.flat_k)
        self.factor = cholesky_banded(self.flat_r.T, lower=True, check_finite=False)
        self.least = float(np.sum((2.0 * RATE / h) ** 2) / h.min())  # energy of rounding alone

    def gamma(self, d: FloatArray) -> FloatArray:
        """Accelerations R^-1 d, (rows, 3)."""
        from scipy.linalg import cho_solve_banded

        solution: FloatArray = cho_solve_banded((self.factor, True), d, check_finite=False)
        return solution

    def trace(self, weight: float) -> float:
        """Trace of the influence matrix in one dimension [hutchinson1985]: parameters spent an axis."""
        share, factor = _scaled(weight)
        given = self.flat_r, self.flat_k, share, factor
        return len(self.q) - self.rows + float(_run("trace", self.rows, *given))

    def solve(self, weight: float, tolerance: float, limit: int, r: FloatArray) -> Solution:
        """Minimise F for lambda = weight, from r on, until an update turns no keyframe by more than the tolerance."""
        state, turned = self._measured(r, weight), [np.inf]
        change = np.inf
        for done in range(limit):
            found = self._update(state, weight, tolerance)
            if found is None:
                return Solution(state, done, np.inf, np.inf, converged=False)
            state, change, residual = found
            turned.append(residual)
            rest = residual <= REST and min(turned[-STALL:]) >= min(turned[:-STALL], default=np.inf)
            if residual <= tolerance or rest:
                return Solution(state, done + 1, change, residual, True, residual > tolerance)
        return Solution(state, limit, change, turned[-1], converged=False)

    def _update(
        self, state: State, weight: float, tolerance: float
    ) -> tuple[State, float, float] | None:
        """The state a step further, its relative change, its largest turn; None where F rises on every share of it."""
        delta, share = self._step(state, weight), 1.0
        allowed = (1.0 + ROUNDING) * state.cost + weight * self.least
        largest = float(np.sqrt(np.max(np.sum(delta * delta, axis=1))))
        while share >= SHORTEST and largest < np.inf:
            fresh = np.empty(state.r.shape)
            change = float(_run("turned", len(fresh), state.r, delta, share, fresh))
            trial = self._measured(fresh, weight)
            if trial.cost <= allowed or share * largest <= tolerance:
                return trial, change, share * largest
            share *= 0.5
        return None

    def write(self, state: State, segments: FloatArray) -> float:
        """Constants of the curve's segments; returns their reach."""
        given = state.r, state.steps, self.h, self.gamma(state.d), self.place, segments
        return float(_run("write", len(self.q), *given))

    def _measured(self, r: FloatArray, weight: float) -> State:
        steps, d, e = np.empty((self.h.size, 3)), np.empty((self.rows, 3)), np.empty((len(r), 3))
        given = self.q, r, self.h, self.sign, self.w, self.place, steps, d, e
        rss = float(_run("measure", len(r), *given))
        return State(r, steps, d, e, rss, rss + weight * float(np.sum(d * self.gamma(d))))

    def _step(self, state: State, weight: float) -> FloatArray:
        """delta (n, 3) of (3) in `reinsch`; not finite where the matrix is singular to rounding."""
        from scipy.linalg import LinAlgError, solveh_banded

        n, iw = len(self.q), 1.0 / self.w
        share, factor = _scaled(weight)
        columns, delta = np.empty((n, 27)), np.full((n, 3), np.inf)
        _run("linearise", n, state.steps, self.h, state.e, self.place, columns)
        # one more than the blocks' distance in rows of three, but no more than there are
        width = min(3 * self.flat_r.shape[1] + 2, 3 * self.rows)
        band, rhs = np.zeros((3 * self.rows, width)), np.empty((self.rows, 3))
        given = self.place, self.closed, self.flat_r, share, factor, band, rhs
        _run("normal", n, columns, state.e, state.d, iw, *given)
        with np.errstate(all="ignore"):
            try:
                z = solveh_banded(
                    band.T,
                    rhs.reshape(-1),
                    overwrite_ab=True,
                    overwrite_b=True,
                    lower=True,
                    check_finite=False,
                )
            except LinAlgError:
                return delta
        z = factor * z.reshape(self.rows, 3)
        _run("turns", n, columns, state.e, z, iw, self.place, self.closed, delta)
        return delta


def _run(name: str, keyframes: int, *arguments: Any) -> Any:
    """A function of `reinsch`."""
    return engine.run(getattr(reinsch, name), ROWS.get(name, 1) * keyframes, *arguments)


def _scaled(weight: float) -> tuple[float, float]:
    """1 and lambda over the larger of them: (3) in `reinsch` holds for z = factor x its solution."""
    size = max(1.0, weight)
    return 1.0 / size, weight / size
