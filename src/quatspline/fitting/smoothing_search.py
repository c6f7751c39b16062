"""How much to smooth: lambda where a criterion is least, on a grid from weak to strong.

Per axis, with n keyframes, rss = sum w |e|^2 and the trace tr of `Smoothing.trace`,

    GCV(lambda) = (rss / 3n) / (1 - tr/n)^2                           [craven1979]              (1)
    risk(lambda) = rss / 3n + 2 sigma^2 tr/n                                                    (2)

for unknown noise and for errors of standard deviation sigma about every axis.  A minimum inside the grid
is refined by the parabola through three values, of the logarithm of (1).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from quatspline.fitting.smoothing import Smoothing, Solution
from quatspline.quaternion import FloatArray

EXPONENTS = np.arange(-4.0, 8.25, 0.5)
"""The grid, powers of ten of the median spacing cubed."""

COARSE = 1e-5
"""Tolerance in rad of the grid's solves, which suffices for (1) and (2)."""

RISES = 4
"""A criterion that rose so often in a row has had its least value."""

DECADE = 1.0
"""The step of a path to a lambda that a solve does not reach from the keyframes themselves."""

LEAST = 1e-300
"""What logarithms are taken of where all keyframes are met exactly."""

Criterion = Callable[[float, float], float]
"""Of rss / 3n and tr / n."""


def gcv(rss: float, tr: float) -> float:
    """The logarithm of (1)."""
    return math.log(max(rss, LEAST)) - 2.0 * math.log(max(1.0 - tr, LEAST))


def risk(sigma: float) -> Criterion:
    """(2)."""
    return lambda rss, tr: rss + 2.0 * sigma * sigma * tr


@dataclass
class Search:
    """Solves of one track from weak to strong smoothing, each begun where the one before it ended.

    Attributes
    ----------
    problem : what is solved
    limit : updates that a solve may take
    solved : smoothed keyframes (n, 4) along the grid so far; a solve that did not converge ends them
    left : rss of each
    spent : tr / n of each
    """

    problem: Smoothing
    limit: int
    solved: list[FloatArray] = field(default_factory=list)
    left: list[float] = field(default_factory=list)
    spent: list[float] = field(default_factory=list)

    def least(self, *criteria: Criterion) -> tuple[float, FloatArray]:
        """The smallest of the criteria's lambda, and keyframes (n, 4) to begin its solve with."""
        exponent = min(self._exponent(criterion) for criterion in criteria)
        nearest = round((exponent - EXPONENTS[0]) / (EXPONENTS[1] - EXPONENTS[0]))
        known = nearest < len(self.solved)
        return self._weight(exponent), self.solved[nearest] if known else self.problem.q

    def _exponent(self, criterion: Criterion) -> float:
        values: list[float] = []
        best = 0
        while self._reaches(len(values)):
            k = len(values)
            rss = self.left[k] / (3 * len(self.problem.q))
            values.append(criterion(rss, self.spent[k]))
            best = k if values[k] < values[best] else best
            rising = k >= RISES and all(
                values[i] > values[i - 1] for i in range(k - RISES + 1, k + 1)
            )
            if rising:
                break
        return float(EXPONENTS[best]) + _vertex(values, best) * float(EXPONENTS[1] - EXPONENTS[0])

    def _reaches(self, k: int) -> bool:
        """Whether the solve at place k of the grid is there, or was made now."""
        if k < len(self.solved):
            return True
        if k >= EXPONENTS.size:
            return False
        weight = self._weight(float(EXPONENTS[k]))
        start = self.solved[-1] if self.solved else self.problem.q
        found = self.problem.solve(weight, COARSE, self.limit, start)
        if found.converged:
            self.solved.append(found.state.r)
            self.left.append(found.state.rss)
            self.spent.append(self.problem.trace(weight) / len(self.problem.q))
        return found.converged

    def _weight(self, exponent: float) -> float:
        return float(10.0**exponent * np.median(self.problem.h) ** 3)


def reached(problem: Smoothing, weight: float, tolerance: float, limit: int) -> Solution:
    """The solve for one lambda from the keyframes on; where that fails, along a path of growing lambda.

    A strong pull keeps steps short, so that a solve far from straight creeps; a path does not.
    """
    direct = problem.solve(weight, tolerance, limit, problem.q)
    if direct.converged or weight <= 0.0:
        return direct
    exponent = EXPONENTS[0] - math.log10(weight / np.median(problem.h) ** 3)
    r = problem.q
    for share in 10.0 ** np.arange(exponent, 0.0, DECADE):
        found = problem.solve(share * weight, COARSE, limit, r)
        if not found.converged:
            return direct
        r = found.state.r
    return problem.solve(weight, tolerance, limit, r)


def _vertex(values: list[float], k: int) -> float:
    """Where the parabola through values k - 1, k, k + 1 is least, counted from k; 0 at either end."""
    if not 0 < k < len(values) - 1:
        return 0.0
    before, here, after = values[k - 1 : k + 2]
    bend = before - 2.0 * here + after
    return 0.5 * (before - after) / bend if bend > 0.0 else 0.0
