"""Torque energies on the committed sets, against the published bounds."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from quatspline.experiment import Run
from quatspline.instruments.fairness import fairness
from quatspline.quaternion import distance
from quatspline.registry import load, scheme, shipped
from quatspline.trajectories.sets import step_sets, torque_sets

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


@pytest.mark.parametrize("degrees", [10, 170])
def test_step_sets_have_their_step(degrees):
    first, again = step_sets(degrees, 2), step_sets(degrees, 5)[:2]
    for (t, q), (t2, q2) in zip(first, again, strict=True):
        np.testing.assert_array_equal(t, t2)
        np.testing.assert_array_equal(q, q2)
        np.testing.assert_allclose(np.degrees(distance(q[1:], q[:-1])), degrees, rtol=1e-9)
        assert 4 <= len(q) <= 9


def _row(name: str, index: int, torque: float | None, **more: object) -> dict[str, object]:
    known = dict.fromkeys(("torque", "jerk", "length", "peak"), torque) if torque else {}
    jumps = {"velocity_jumps": False} if torque else {}
    return {
        "scheme": name,
        "data": "committed",
        "set": index,
        "version": "1",
        **known,
        **jumps,
        **more,
    }


def test_ratios_are_to_the_same_keyframes():
    experiment = load(shipped("experiments") / "fairness.py", "experiment")
    rows = [_row("min-torque", 0, 2.0), _row("min-torque", 1, 4.0)]
    rows += [_row("a", 0, 3.0), _row("a", 1, 4.0)]
    rows += [_row("b", 0, 2.0, velocity_jumps=True), _row("b", 1, 4.0)]
    rows += [_row("c", 0, None, failure="ValueError: no"), _row("c", 1, 6.0)]
    table = experiment.gather(Run(quick=True), pd.DataFrame(rows)).set_index("scheme")
    assert table["sets"].tolist() == [2, 2, 2, 2]
    assert table.loc["a", ["least", "median", "worst"]].tolist() == [1.0, 1.25, 1.5]
    assert np.isinf(table.loc["b", "median"])
    assert table.loc["b", "jerk_median"] == 1.0
    assert (table.loc["c", "failed"], table.loc["c", "failure"]) == (1, "ValueError: no")
    assert table.loc["c", "median"] == 1.5


def test_without_a_reference_there_is_no_ratio():
    experiment = load(shipped("experiments") / "fairness.py", "experiment")
    rows = [_row("min-torque", 0, None, failure="ConvergenceError: no"), _row("a", 0, 3.0)]
    table = experiment.gather(Run(quick=True), pd.DataFrame(rows)).set_index("scheme")
    assert table.loc["a", "failed"] == 1
    assert table.loc["a", "failure"] == "no min-torque to compare with"
