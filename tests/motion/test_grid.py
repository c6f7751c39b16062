"""Times of samples between integer stamps: whole, nearest, without rounding on the way."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from quatspline.motion.grid import sample_times

EPOCH = 1_650_000_000_000_000_001


@pytest.mark.parametrize("count", [1, 2, 3, 7, 1000])
def test_count_of_integer_stamps(count: int) -> None:
    last = EPOCH + 10_000_000_123
    times = sample_times(EPOCH, last, None, count)
    assert times.dtype == np.int64
    steps = max(count - 1, 1)
    for k, t in enumerate(times.tolist()):
        assert abs(t - EPOCH - Fraction(k * (last - EPOCH), steps)) <= Fraction(1, 2)
    assert times[0] == EPOCH
    assert count == 1 or times[-1] == last


@pytest.mark.parametrize(
    ("rate", "step"),
    [(1e-7, Fraction(10**7)), (3e-6, Fraction(10**6, 3)), (0.123456789012345, None), (1.0, None)],
)
def test_rate_of_integer_stamps(rate: float, step: Fraction | None) -> None:
    step = step or 1 / Fraction(repr(rate))
    span = int(1000 * step)
    times = sample_times(EPOCH, EPOCH + span, rate, None)
    assert times.dtype == np.int64
    assert len(times) == span / step // 1 + 1
    for k, t in enumerate(times.tolist()):
        assert abs(t - EPOCH - k * step) <= Fraction(1, 2)
    assert times[-1] <= EPOCH + span


def test_the_ends_of_64_bits_are_reached() -> None:
    first, last = -(2**63), 2**63 - 1
    times = sample_times(first, last, None, 5)
    assert times[[0, 2, 4]].tolist() == [first, 0, last]


def test_more_samples_than_stamps_are_refused() -> None:
    with pytest.raises(ValueError, match=r"samples 0\.5 apart would fall on the same stamp"):
        sample_times(EPOCH, EPOCH + 10, None, 21)
    with pytest.raises(ValueError, match="would fall on the same stamp"):
        sample_times(EPOCH, EPOCH + 10, 3.0, None)
    with pytest.raises(ValueError, match="samples are too many"):
        sample_times(EPOCH, EPOCH + 10**18, 1.0, None)
