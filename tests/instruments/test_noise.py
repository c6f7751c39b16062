"""The noise instrument on linear schemes, whose gains are integrals of their blending functions."""

from __future__ import annotations

import numpy as np
import pytest

from quatspline import quaternion
from quatspline.instruments.noise import noise
from quatspline.instruments.trials import builder
from toys import AXIS, Toy

COUNT, SPACING, TRIALS = 9, 2.0, 400
TIMES = SPACING * np.arange(float(COUNT))
SAME = np.tile([1.0, 0.0, 0.0, 0.0], (COUNT, 1))
SPUN = quaternion.exp(0.25 * TIMES[:, None] * AXIS)
CLOSE = 0.03
"""Of 400 trials: three standard deviations."""


def gains(name, keys, kind, trials=TRIALS):
    row = noise(builder(name), TIMES, keys, kind, np.random.default_rng(5), trials)
    return [row["gain"], row["gain_omega"], row["gain_alpha"]]


def test_slerp_averages_two_keyframes():
    """Weights 1 - u and u: the mean of their squares is 2/3; the rate is a difference over a spacing."""
    found = gains("slerp", SAME, "keyframes")
    assert found[:2] == pytest.approx([np.sqrt(2.0 / 3.0), np.sqrt(2.0)], rel=CLOSE)
    assert found[2] == 0.0


def test_late_keyframes_of_a_spin():
    """The end times stay: of eight segments six have two late keyframes, two have one."""
    found = gains("slerp", SPUN, "times")
    expected = [np.sqrt((6 * 2 + 2 * 1) / 3 / 8), np.sqrt((6 * 2 + 2 * 1) / 8)]
    assert found[:2] == pytest.approx(expected, rel=CLOSE)


def test_acceleration_of_a_cubic_spline():
    """A linear scheme's gain is that of its response to unit keyframes: here scipy's, in the flat limit."""
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(np.arange(COUNT), np.eye(COUNT), bc_type="natural")
    u, w = np.polynomial.legendre.leggauss(8)
    t = (np.arange(COUNT - 1)[:, None] + 0.5 + 0.5 * u).reshape(-1)
    weights = np.tile(0.5 * w, COUNT - 1) / (COUNT - 1)
    expected = [np.sqrt(weights @ np.sum(spline(t, k) ** 2, axis=1)) for k in range(3)]
    assert gains("kim", SAME, "keyframes") == pytest.approx(expected, rel=CLOSE)


def test_a_curve_that_ignores_its_keyframes_has_no_gain():
    class Still(Toy):
        def _orientation(self, t):
            return np.broadcast_to([1.0, 0.0, 0.0, 0.0], (len(t), 4))

    row = noise(Still, TIMES, SAME, "keyframes", np.random.default_rng(0), 2)
    assert list(row.values()) == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


def test_gains_have_no_unit():
    """The unit of time does not matter, nor the size of the errors' seed."""
    other = noise(builder("squad"), 60.0 * TIMES, SPUN, "times", np.random.default_rng(5), 20)
    assert list(other.values()) == pytest.approx(gains("squad", SPUN, "times", 20), rel=1e-5)
