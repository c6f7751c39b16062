"""A thousand builds of random hard keyframes; ``tests/fuzz/run.py`` draws as many as one likes."""

import numpy as np
import pytest
from cases import Case, case, names
from checks import fault, outcome
from run import chunk

import quatspline as qs

BUILDS, PARTS = 1000, 4


@pytest.mark.parametrize("part", range(PARTS))
def test_nothing_breaks(part: int) -> None:
    size = BUILDS // PARTS
    found = chunk(2, part * size, size, names())
    assert not found["failures"]
    assert found["counts"]["ok"] > 0.8 * size


def test_a_case_is_always_the_same() -> None:
    for index in range(20):
        one, other = (case(3, index, names()) for _ in range(2))
        assert one.scheme == other.scheme
        assert np.array_equal(one.quaternions, other.quaternions)
        assert one.options.keys() == other.options.keys()


def test_faults_are_seen() -> None:
    """The checks find what they look for, in curves bent on purpose."""
    q = [[1.0, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0.8, 0, 0]]
    drawn = Case("slerp", None, np.array(q))
    for at, value, wanted in (
        (8, 9.0, "misses a keyframe"),
        (4, np.nan, "misses a keyframe by nan"),
        (0, 1.0 + 1e-10, "norm off by"),
    ):
        curve = qs.build("slerp", None, q)
        assert fault(curve, drawn) == ""
        curve.segments[0, 1, at] *= value  # type: ignore[attr-defined]
        assert wanted in fault(curve, drawn)
    assert outcome(Case("slerp", None, np.zeros((3, 4))))[0] == "failed"
