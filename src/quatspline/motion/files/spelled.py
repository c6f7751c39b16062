"""Times as text spells them, kept exact: float64 loses the differences of nanosecond stamps."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal, InvalidOperation

import numpy as np

from quatspline.inputs.stamps import EXACT
from quatspline.motion.motion import Times
from quatspline.quaternion import FloatArray

LARGEST = 2**63 - 1


def exact(spelled: Sequence[str], times: FloatArray) -> Times:
    """Times (n,) as spelled: int64 where all are whole and one is beyond `EXACT`, else as read.

    Raises
    ------
    OverflowError
        Where integers do not fit into 64 bits; its argument is the first row of one.
    """
    if not np.any(np.abs(times) > EXACT) or np.any(times != np.floor(times)):
        return times
    values = list(map(_decimal, spelled))
    if any(value != int(value) for value in values):
        return times
    beyond = next((row for row, value in enumerate(values) if abs(value) > LARGEST), None)
    if beyond is None:
        return np.array([int(value) for value in values], dtype=np.int64)
    if spelled[beyond].lstrip("+-").isdigit():
        raise OverflowError(beyond)
    return times  # floating point that happens to be whole, such as 1e300


def same(one: str, other: str) -> bool:
    """Whether two spellings that float64 cannot tell apart are of one number."""
    return _decimal(one) == _decimal(other)


def _decimal(text: str) -> Decimal:
    try:
        return Decimal(text)
    except InvalidOperation:  # an exponent beyond those of Decimal, though zero as float64
        return Decimal(float(text))
