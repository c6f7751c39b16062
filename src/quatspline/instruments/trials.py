"""What experiments over all schemes share: a curve solved tightly, facts about it, failures as rows."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from quatspline.catalogue import scheme, version
from quatspline.curve import Curve
from quatspline.instruments.derivatives import analytic
from quatspline.quaternion import FloatArray
from quatspline.system.sentence import printable

if TYPE_CHECKING:
    import pandas as pd

TIGHT = 1e-11
"""Tolerance (rad) of iterative schemes, so that what a solve leaves is far below what is measured."""

Row = dict[str, Any]
Build = Callable[[FloatArray, FloatArray], Curve]
"""What makes a curve of times (n,) and keyframes (n, 4): a scheme with its options chosen."""


def builder(name: str, tolerance: float = TIGHT, **options: Any) -> Build:
    """A scheme by name with default options, solved to a tolerance where it is iterative.

    Raises
    ------
    ValueError
        An unknown scheme, or one that cannot be used, and why.
    """
    cls = scheme(name)
    given: Row = {"tolerance": tolerance, **options} if cls.iterative else options
    return lambda times, keyframes: cls(times, keyframes, **given)


def records(table: pd.DataFrame) -> list[Row]:
    """The rows of a table."""
    return [
        dict(zip(map(str, table.columns), row, strict=True))
        for row in table.itertuples(index=False)
    ]


def facts(curve: Curve) -> Row:
    """Columns that every table of schemes has: whose rates they are, and the version measured."""
    rates = "analytic" if analytic(curve) else "numeric"
    return {"rates": rates, "version": version(curve.name)}


def attempted(measure: Callable[[], list[Row]], **given: Any) -> list[Row]:
    """The rows measured, after what is given of each.

    For what does not apply or fails, one row with its reason.
    """
    try:
        rows = measure()
    except (Exception, SystemExit) as error:  # whatever a scheme raises is a result
        rows = [{"failure": reason(error)}]
    return [given | row for row in rows]


def reason(error: BaseException) -> str:
    """What a scheme raised, on one line."""
    return f"{type(error).__name__}: {printable(' '.join(str(error).split()))}"
