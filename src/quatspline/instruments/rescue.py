"""Curves for a comparison: a scheme is judged, and not the iteration that it was published with.

Where that iteration does not converge, the options that a class names in `Curve.rescue` are tried; what
became of both is said in plain words.
"""

from __future__ import annotations

import math
from typing import Any

from quatspline.curve import Curve
from quatspline.keyframes import Keyframes
from quatspline.solving import ConvergenceError, SolveReport

PROPER = {"newton": "Newton's method", "jacobi": "Jacobi's iteration"}
"""Solvers that bear a name."""


def solved(cls: type[Curve], keyframes: Keyframes, **given: Any) -> tuple[Curve, str | None]:
    """The curve of a scheme, and a note where its published iteration did not find it.

    Raises
    ------
    ConvergenceError
        In words for a table, of both solvers where both were tried.
    """
    try:
        return cls.from_keyframes(keyframes, **given), None
    except ConvergenceError as error:
        first = error.report
    if not cls.rescue:
        raise ConvergenceError(f"did not converge: {unsolved(first)}", first)
    try:
        curve = cls.from_keyframes(keyframes, **(given | cls.rescue))
    except ConvergenceError as error:
        both = f"{unsolved(first)}; nor did {_proper(error.report)}: {unsolved(error.report)}"
        told = f"the published iteration did not converge: {both}"
        raise ConvergenceError(told, error.report) from None
    how = _proper(curve.solve_report) if curve.solve_report else "other options"
    told = f"the published iteration did not converge on these keyframes ({unsolved(first)})"
    return curve, f"{told}; the curve was found by {how}"


def _proper(report: SolveReport) -> str:
    return PROPER.get(report.method, report.method)


def unsolved(report: SolveReport) -> str:
    """What a solve of a single track that did not converge was still short of."""
    after = f"after {report.iterations} iteration{'' if report.iterations == 1 else 's'}"
    if not math.isfinite(report.residual):
        return f"{after} it still misses keyframes by an unknown amount"
    if report.residual > report.tolerance:
        return f"{after} it still misses keyframes by {report.residual:.2g} rad"
    if not math.isfinite(report.change):
        return f"{after} its numbers overflow"
    return f"{after} it has not settled: the last changed it by {report.change:.1g} of its size"
