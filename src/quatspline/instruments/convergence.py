"""Convergence of iterative schemes: failures by kind, the rate of an iteration, and what theory says.

In the limit of small steps every cubic B-spline on the sphere solves the flat equations

    m_i d_{i-1} + (1 - m_i - p_i) d_i + p_i d_{i+1} = q_i,      d_0 = q_0,  d_{n-1} = q_{n-1}  (1)

    m_i = h_i^2 / ((h_{i-1} + h_i)(h_{i-2} + h_{i-1} + h_i)),
    p_i = h_{i-1}^2 / ((h_{i-1} + h_i)(h_{i-1} + h_i + h_{i+1})),      h_{-1} = h_0,  h_{n-1} = h_{n-2}

so that a linear iteration converges at the spectral radius of its matrix for (1).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from quatspline.curve import Curve
from quatspline.options import declared_by
from quatspline.quaternion import FloatArray
from quatspline.solving import SolveReport

FAILURES = ("limit", "wrong", "gave_up", "not_finite")
"""Kinds of failure: the iterations ran out; it rests where the curve misses keyframes; the solver gave
up (no shorter step helps); numbers overflowed."""

CHECKPOINTS = (2, 4, 6, 8, 12, 16, 24, 32, 48, 64)
"""Iterations between which changes are compared, even: eigenvalues of the Jacobi matrix come in pairs
of either sign, and the change alternates with them."""

FLOOR = 1e-12
"""Relative changes below this are rounding, and tell no rate."""

TINY = 1e-300
"""A tolerance that is never met."""


def methods(scheme: type[Curve]) -> tuple[str | None, ...]:
    """The solvers that an iterative scheme offers; (None,) where there is one only."""
    option = declared_by(scheme).get("method")
    return get_args(option.annotation) if option is not None else (None,)


def solved(
    scheme: type[Curve], times: FloatArray, keyframes: FloatArray, method: str | None, **more: Any
) -> tuple[Curve, SolveReport]:
    """The curve through keyframes (n, 4) or (n, K, 4), converged or not, and the solver's report."""
    chosen: dict[str, Any] = {} if method is None else {"method": method}
    curve = scheme(times, keyframes, on_failure="return", **chosen, **more)
    assert curve.solve_report is not None
    return curve, curve.solve_report


def failures(report: SolveReport, limit: int) -> dict[str, int]:
    """How many tracks failed, by kind (see FAILURES)."""
    failed = ~np.atleast_1d(report.converged)
    iterations, change, residual = (
        np.atleast_1d(x)[failed] for x in (report.iterations, report.change, report.residual)
    )
    finite = np.isfinite(change) & np.isfinite(residual)
    ran_out = finite & (iterations >= limit)
    rests = finite & ~ran_out & (change <= report.tolerance)
    counts = (ran_out, rests, finite & ~ran_out & ~rests, ~finite)
    return {kind: int(hit.sum()) for kind, hit in zip(FAILURES, counts, strict=True)}


def measured_rate(
    scheme: type[Curve], times: FloatArray, keyframes: FloatArray, method: str | None
) -> FloatArray:
    """The factor by which an iteration reduces the change, late in a solve: (K,) of (n, K, 4).

    A superlinear iteration gives a small number, that of its last steps above rounding.  NaN where
    fewer than two checkpoints have a change above rounding, or where changes do not fall.
    """
    changes = np.array(
        [
            solved(scheme, times, keyframes, method, tolerance=TINY, max_iterations=k)[1].change
            for k in CHECKPOINTS
        ]
    )
    return np.array([_late_rate(column) for column in changes.reshape(len(CHECKPOINTS), -1).T])


def _late_rate(changes: FloatArray) -> float:
    last = int(np.count_nonzero(np.cumprod(changes > FLOOR))) - 1
    if last < 1:
        return float("nan")
    steps = CHECKPOINTS[last] - CHECKPOINTS[last - 1]
    rate = float((changes[last] / changes[last - 1]) ** (1.0 / steps))
    return rate if rate < 1.0 else float("nan")


# -- theory -------------------------------------------------------------------------------------


def flat_equations(times: FloatArray) -> FloatArray:
    """The matrix (n - 2, n - 2) of (1) for the inner control points at times (n,)."""
    h = np.diff(times)
    h = np.concatenate([h[:1], h, h[-1:]])  # the phantom spacings of natural ends
    far, left, right, beyond = h[:-3], h[1:-2], h[2:-1], h[3:]
    m = right**2 / ((left + right) * (far + left + right))
    p = left**2 / ((left + right) * (left + right + beyond))
    return np.diag(1.0 - m - p) + np.diag(m[1:], -1) + np.diag(p[:-1], 1)


def theoretical_rate(method: str | None, times: FloatArray) -> float:
    """The spectral radius of a linear iteration for (1) at times (n,); NaN for other iterations."""
    if method not in ITERATIONS or len(times) < 3:
        return float("nan")
    return float(np.abs(np.linalg.eigvals(ITERATIONS[method](flat_equations(times)))).max())


def _jacobi(matrix: FloatArray) -> FloatArray:
    """I - D^-1 A."""
    return np.asarray(np.eye(len(matrix)) - matrix / np.diag(matrix)[:, None], dtype=float)


def _gauss_seidel(matrix: FloatArray) -> FloatArray:
    """-(D + L)^-1 U."""
    return np.asarray(-np.linalg.solve(np.tril(matrix), np.triu(matrix, 1)), dtype=float)


Iteration = Callable[[FloatArray], NDArray[np.float64]]
ITERATIONS: dict[str | None, Iteration] = {
    "jacobi": _jacobi,
    "fixed-point": _jacobi,  # it divides each residual by the weight of its own control: the same
    "gauss-seidel": _gauss_seidel,
}
"""Iteration matrices of the linear methods, by the name that solvers report."""
