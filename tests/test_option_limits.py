"""Options that no arithmetic carries, and no memory, are refused in one sentence."""

from typing import Any

import pytest

import quatspline as qs
from walks import walk


@pytest.mark.parametrize(
    ("name", "options", "sentence"),
    [
        ("kochanek-bartels", {"tension": 1e17}, r"^tension\[0\] = 1e\+17: must be at most 1e\+06"),
        ("kochanek-bartels", {"bias": [0, 0, -1e9, 0, 0]}, r"^bias\[2\] = -1e\+09: must be at most"),
        ("kochanek-bartels", {"continuity": 1e300}, r"^continuity\[0\] = 1e\+300: must be at most"),
        ("quintic", {"curvature": 1e300}, r"^curvature=1e\+300: must be at most 1e\+06"),
        ("quintic", {"curvature": -1e7}, r"^curvature=-10000000\.0: must be at most"),
        ("local-quintic", {"window": 10**9}, r"^window=1000000000: must be at most 100"),
        ("fast-slerp", {"terms": 10**6}, r"^terms=1000000: must be at most 1000"),
        ("incremental-slerp", {"steps": 10**9}, r"^steps=1000000000: must be at most"),
        ("min-torque", {"subintervals": 10**9}, r"^subintervals=1000000000: must be at most"),
    ],
)
def test_absurd_options_are_refused(name: str, options: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        qs.build(name, None, walk(5, 40.0), **options)


def test_points_that_no_memory_holds_are_refused() -> None:
    with pytest.raises(ValueError, match=r"^steps=100000: 199,900,000 points are too many"):
        qs.build("incremental-slerp", None, walk(2000, 1.0), steps=100_000)
