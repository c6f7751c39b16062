"""Degrees that a body feels, against closed forms; and noise, against what was added."""

from __future__ import annotations

import numpy as np
import pytest

import quatspline as qs
from quatspline import keyframes as kf
from quatspline import quaternion
from quatspline.fitting.told_noise import told_noise
from quatspline.instruments.extent import extent, peak_rate
from walks import walk


def test_slerp_keeps_to_its_arcs_at_the_speed_of_its_fastest_step() -> None:
    angles = np.radians([0.0, 30.0, 30.0, 100.0])
    times = np.array([0.0, 1.0, 3.0, 5.0])
    q = quaternion.exp(0.5 * angles[:, None] * [0.0, 0.6, 0.8])
    row = extent(qs.build("slerp", times, q))
    assert row["excursion"] == 0.0
    assert row["hold_rotation"] == 0.0
    assert row["peak_rate"] == pytest.approx(35.0, rel=1e-12)


def test_a_hold_counts_as_an_excursion_and_its_absence_as_none() -> None:
    q = walk(6, 50.0, seed=1)
    assert np.isnan(extent(qs.build("local-quintic", None, q))["hold_rotation"])
    held = extent(qs.build("local-quintic", None, q[[0, 1, 2, 2, 3, 4]]))
    assert 1.0 < held["hold_rotation"] <= held["excursion"]


@pytest.mark.parametrize("name", ["quartic", "local-quintic", "squad", "kim"])
def test_the_peak_rate_is_that_of_dense_samples(name: str) -> None:
    curve = qs.build(name, np.cumsum([0, 1, 0.3, 2, 0.7, 1.1, 0.9]), walk(7, 70.0, seed=2))
    dense = np.linalg.norm(curve(np.linspace(*curve.domain, 200_001), 1), axis=1).max()
    assert dense <= peak_rate(curve) * (1 + 1e-9)
    assert peak_rate(curve) == pytest.approx(dense, rel=1e-7)


@pytest.mark.parametrize("degrees", [0.1, 0.5, 2.0])
def test_noise_is_told_from_motion(degrees: float) -> None:
    rng, t = np.random.default_rng(5), np.arange(400) / 30.0
    moved = np.stack([0.4 * np.sin(t), 0.3 * np.cos(0.7 * t), 0.2 * t], axis=1)
    q = quaternion.exp(0.5 * moved)
    errors = quaternion.exp(0.5 * np.radians(degrees) * rng.normal(size=(400, 3)))
    assert told_noise(kf.prepare(t, q)) == 0.0
    told = np.degrees(told_noise(kf.prepare(t, quaternion.mul(q, errors))))
    assert told == pytest.approx(degrees, rel=0.1)


def test_the_noise_of_each_track_is_told_alone() -> None:
    rng = np.random.default_rng(6)
    sizes = np.radians([0.0, 0.1, 0.4])
    smooth = 0.4 * np.sin(np.arange(300) / 30.0)[:, None, None] * [0.6, 0.0, 0.8]
    q = quaternion.exp(0.5 * (smooth + sizes[:, None] * rng.normal(size=(300, 3, 3))))
    told = told_noise(kf.prepare(None, q))
    alone = [float(told_noise(kf.prepare(None, q[:, k]))) for k in range(3)]
    np.testing.assert_allclose(told, alone, rtol=1e-12)
    np.testing.assert_allclose(told, sizes, rtol=0.15)


def test_steps_of_a_random_walk_are_no_noise() -> None:
    for seed in range(8):
        assert told_noise(kf.prepare(None, walk(120, 15.0, seed=seed))) == 0.0
