"""Options that no arithmetic carries, and no memory, are refused in one sentence."""

from typing import Any

import numpy as np
import pytest

import quatspline as qs
from walks import walk


@pytest.mark.parametrize(
    ("name", "options", "sentence"),
    [
        (
            "kochanek-bartels",
            {"tension": 1e17},
            r"^tension\[0\] = 1e\+17: must be between -1e\+06 and 1e\+06",
        ),
        (
            "kochanek-bartels",
            {"bias": [0, 0, -1e9, 0, 0]},
            r"^bias\[2\] = -1e\+09: must be between",
        ),
        ("kochanek-bartels", {"continuity": 1e300}, r"^continuity\[0\] = 1e\+300: must be between"),
        ("quintic", {"curvature": 1e300}, r"^curvature=1e\+300: must be between"),
        ("quintic", {"curvature": -1e7}, r"^curvature=-10000000\.0: must be between"),
        ("local-quintic", {"window": 10**9}, r"^window=1000000000: must be at most 100"),
        ("fast-slerp", {"terms": 10**6}, r"^terms=1000000: must be at most 1000"),
        ("incremental-slerp", {"steps": 10**9}, r"^steps=1000000000: must be at most"),
        ("min-torque", {"subintervals": 10**9}, r"^subintervals=1000000000: must be at most"),
    ],
)
def test_absurd_options_are_refused(name: str, options: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        qs.build(name, None, walk(5, 40.0), **options)


def test_subintervals_that_no_memory_holds_are_refused() -> None:
    still = np.tile([1.0, 0.0, 0.0, 0.0], (1200, 1))
    with pytest.raises(
        ValueError,
        match=r"^1,199 steps .* \(subintervals=1000\) are 1,199,000: at most 1,000,000",
    ):
        qs.build("min-torque", None, still, subintervals=1000)


def test_points_that_no_memory_holds_are_refused() -> None:
    still = np.tile([1.0, 0.0, 0.0, 0.0], (30_000, 1))
    with pytest.raises(ValueError, match=r"^steps=4096: 122,875,904 points are too many"):
        qs.build("incremental-slerp", None, still, steps=4096)


def test_numbers_that_float64_does_not_hold_are_refused() -> None:
    for options in ({"curvature": 10**400}, {"curvature": -(10**400)}):
        with pytest.raises(ValueError, match=r"^curvature=-?1000+\.\.\.: expected a finite number"):
            qs.build("quintic", None, walk(5, 40.0), **options)
    with pytest.raises(ValueError, match=r"^max_iterations=18446744073709551616: must be at most"):
        qs.build("nielson", None, walk(5, 40.0), max_iterations=2**64)
    with pytest.raises(ValueError, match=r"^max_iterations=10001: must be at most 10000"):
        qs.build("kim", None, walk(5, 40.0), max_iterations=10_001)


def test_an_end_velocity_that_no_segment_carries_is_refused() -> None:
    for velocity in ([1e300, 0, 0], [0, 1e17, 0]):
        with pytest.raises(ValueError, match=r"^start_velocity\[\d\] = 1e\+.* rad on a segment"):
            qs.build("kim", None, walk(5, 40.0), ends="clamped", start_velocity=velocity)
