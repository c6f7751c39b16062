"""What iterative schemes say of their solves: SolveReport, and ConvergenceError where one failed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

WRONG_FIXED_POINT = 1000.0
"""A stop by change with a residual over this many tolerances is not a solution."""


@dataclass(frozen=True)
class SolveReport:
    """What an iterative solver did; if there are several tracks, fields have their shape.

    Attributes
    ----------
    method, stop : the iteration, and the rule that ended it ("residual" or "change")
    iterations : number of updates, including the accepted one
    change : relative change of all control quaternions in the last update
    residual : largest miss at a keyframe, a rotation angle in rad: by the equations or by the finished
        curve, measured on both sides, whichever is larger; infinite if it is not a number.  For a curve
        that passes near its keyframes, the rotation of the solved poses in the last update
    converged : whether the stopping rule was met at a correct solution
    tolerance : the requested tolerance

    Examples
    --------
    >>> import quatspline as qs
    >>> keyframes = [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0, 0.6, 0.8, 0], [0, 0, 1, 0]]
    >>> report = qs.build("nielson", None, keyframes, tolerance=1e-9).solve_report
    >>> report.method, report.converged, report.residual <= report.tolerance
    ('jacobi', True, True)
    >>> qs.build("quartic", None, keyframes).solve_report is None
    True
    """

    method: str
    stop: str
    iterations: Any
    change: Any
    residual: Any
    converged: Any
    tolerance: float


class ConvergenceError(RuntimeError):
    """A solver did not converge; ``report`` is its `SolveReport`.

    Examples
    --------
    >>> import quatspline as qs
    >>> keyframes = [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0, 0.6, 0.8, 0], [0, 0, 1, 0]]
    >>> try:
    ...     qs.build("nielson", None, keyframes, max_iterations=2)
    ... except qs.ConvergenceError as error:
    ...     error.report.iterations
    2
    """

    def __init__(self, message: str, report: SolveReport) -> None:
        super().__init__(message)
        self.report = report

    def __reduce__(self) -> Any:
        return type(self), (self.args[0], self.report)


def require_converged(name: str, report: SolveReport, *, tracks: bool) -> None:
    """Raise ConvergenceError of the first track that did not converge, named by its index if there are several."""
    if np.all(report.converged):
        return
    k = np.unravel_index(int(np.argmin(report.converged)), np.shape(report.converged))
    track = f" on track {[int(i) for i in k]}" if tracks else ""
    values = (report.iterations, report.change, report.residual)
    iterations, change, residual = (np.asarray(x)[k] for x in values)
    raise ConvergenceError(
        f"{name} ({report.method}) did not converge{track}: after {iterations} iterations "
        f"change {change:.3g}, residual {residual:.3g} rad, tolerance {report.tolerance:g}",
        report,
    )


def joined(reports: Sequence[SolveReport | None], shape: tuple[int, ...]) -> SolveReport | None:
    """One report whose fields have the shape of the tracks."""
    if not reports or any(r is None for r in reports):
        return None
    first = reports[0]
    assert first is not None
    columns = {
        field: np.array([getattr(r, field) for r in reports]).reshape(shape)
        for field in ("iterations", "change", "residual", "converged")
    }
    return SolveReport(first.method, first.stop, tolerance=first.tolerance, **columns)
