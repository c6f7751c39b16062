"""Torque energies on the committed sets, against the published bounds."""

from __future__ import annotations

import numpy as np
import pytest

from quatspline.instruments.fairness import fairness
from quatspline.registry import scheme
from quatspline.trajectories.sets import torque_sets

SETS = 30
# bounds of the median on all 200 sets, a little wider for a sample of 30
BOUNDS = {
    "nielson": (1.0, 1.0015),
    "spherical-average": (1.0, 1.005),
    "local-quintic": (1.0, 1.015),
    "kim": (1.0, 1.02),
    "squad": (1.15, 1.32),
    "barry-goldman": (1.15, 1.32),
    "hermite": (1.15, 1.32),
}


@pytest.fixture(scope="module")
def least() -> list[float]:
    curves = (scheme("min-torque")(t, q, tolerance=1e-9) for t, q, _ in torque_sets(SETS))
    return [fairness(curve)["torque"] for curve in curves]


@pytest.mark.parametrize("name", BOUNDS)
def test_torque_over_the_minimum(name, least):
    cls = scheme(name)
    options = {"tolerance": 1e-9} if cls.iterative else {}
    energies = [fairness(cls(t, q, **options))["torque"] for t, q, _ in torque_sets(SETS)]
    ratios = np.array(energies) / least
    low, high = BOUNDS[name]
    assert low <= np.median(ratios) <= high
    assert ratios.min() > 1.0 - 1e-6


def test_sets_are_committed():
    first, again = torque_sets(3), torque_sets(200)[:3]
    for (t, q, degrees), (t2, q2, degrees2) in zip(first, again, strict=True):
        np.testing.assert_array_equal(t, t2)
        np.testing.assert_array_equal(q, q2)
        assert degrees == degrees2
        assert 20.0 <= degrees <= 110.0
        assert 4 <= len(q) <= 9
