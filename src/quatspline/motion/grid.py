"""Times at which a curve is sampled: by a rate or a count, whole stamps of integer ones."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quatspline.quaternion import FloatArray

MOST_SAMPLES = 50_000_000
"""More samples than this are a slip of the unit, and would not fit into memory."""


def sample_times(
    first: float | int,
    last: float | int,
    rate: float | None,
    count: int | None,
    per_second: int = 1,
) -> NDArray[Any]:
    """First + k/rate within the domain, or count of them from first to last.

    ``rate`` is per second, of which there are ``per_second`` units of time in one.

    Between integers, as the domain of integer stamps has them, times are the nearest whole stamps,
    int64 and exact.  Raises ValueError for too many samples, and for more than there are stamps.
    """
    if isinstance(first, int) and isinstance(last, int):
        return _stamps(first, last, rate, count, per_second)
    if rate is not None:
        rate /= per_second
    return _times(float(first), float(last), rate, count)


def _times(first: float, last: float, rate: float | None, count: int | None) -> FloatArray:
    # A step that lands on the end but for the rounding of the times belongs to the grid.
    slack = 4.0 * float(np.spacing(max(abs(first), abs(last))))
    steps = (last - first + slack) * rate if rate is not None else (count or 1) - 1
    _refuse_many(steps)
    if rate is None:
        return np.linspace(first, last, int(steps) + 1)
    return np.minimum(first + np.arange(int(steps) + 1) / rate, last)


def _stamps(
    first: int, last: int, rate: float | None, count: int | None, per_second: int
) -> NDArray[np.int64]:
    span = last - first
    if rate is not None:
        step = per_second / Fraction(
            repr(float(rate))
        )  # the decimal as typed: 1e-7 is no binary fraction
        steps = int(span / step)
    else:
        steps = (count or 1) - 1
        step = Fraction(span, max(steps, 1))
    _refuse_many(steps)
    if step < 1 and steps:
        raise ValueError(
            f"stamps are integers: samples {float(step):.3g} apart would fall on the same stamp"
        )
    return _rounded(first, step, steps + 1)


def _rounded(first: int, step: Fraction, count: int) -> NDArray[np.int64]:
    """The integers nearest first + k step, without a rounding on the way."""
    whole, rest = divmod(step.numerator, step.denominator)
    over = step.denominator
    fits = 2 * count * max(rest, 1) + over < 2**63
    k = np.arange(count, dtype=np.int64 if fits else object)
    offsets = (2 * k * rest + over) // (2 * over)
    return np.asarray(first + k.astype(np.int64) * whole + offsets.astype(np.int64))


def _refuse_many(steps: float) -> None:
    if steps >= MOST_SAMPLES:
        raise ValueError(f"{steps + 1:.6g} samples are too many: at most {MOST_SAMPLES:,}")
