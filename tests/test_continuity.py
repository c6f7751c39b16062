"""The continuity and fairness instruments on curves whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.instruments.accuracy import errors, knots, with_slopes
from quatspline.instruments.continuity import jumps, measured_continuity, speeds
from quatspline.instruments.fairness import fairness
from quatspline.registry import scheme
from quatspline.trajectories.smooth import tumble, tumble_rates
from quatspline.trajectories.walks import walk

AXIS = np.array([0.6, 0.0, 0.8])


class _Spin(Curve):
    """exp(theta(t) n) with theta = t^2/8 and a kink of a chosen order at t = 1."""

    name = "spin"
    title = reference = "test"
    continuity, order, support, constant_rate = 3, 3, None, "no"
    kink: tuple[float, int] = (0.0, 1)

    def _fit(self, keyframes) -> None:
        """Nothing to prepare."""

    def _orientation(self, t):
        size, power = self.kink
        theta = 0.5 * t + t**2 / 8 + size * np.maximum(t - 1.0, 0.0) ** power
        return quaternion.exp(theta[:, None] * AXIS)


def spin(size: float, power: int) -> Curve:
    cls = type("_Kinked", (_Spin,), {"kink": (size, power), "name": "spin"})
    return cls([0.0, 1.0, 2.0], quaternion.exp(np.outer([0.0, 0.3, 0.6], AXIS)))


def test_a_smooth_curve_has_no_jump():
    table = jumps(spin(0.0, 1))
    assert table["continuous"].all()
    assert measured_continuity(table) == 3


@pytest.mark.parametrize(("power", "k"), [(1, 0), (2, 1), (3, 2)])
def test_a_planted_jump_is_found_to_one_per_cent(power, k):
    size = 0.05
    table = jumps(spin(size, power))
    assert measured_continuity(table) == k
    # theta is half the angle: the derivative of order `power` jumps by 2 power! size
    expected = 2.0 * size * (1, 2, 6)[power - 1]
    assert table.loc[power, "jump"] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize(("name", "k"), [("slerp", 0), ("nielson", 1), ("quartic", 2), ("kim", 2)])
def test_measured_continuity_of_the_papers_schemes(name, k):
    rng = np.random.default_rng(3)
    keyframes = walk(rng, 7, 60.0)[:, 0]
    uneven = np.cumsum(rng.uniform(0.5, 1.5, 7))
    for times in (None, uneven):
        assert measured_continuity(jumps(scheme(name)(times, keyframes))) == k


def test_nielsons_jump_falls_with_the_third_power():
    sizes = []
    for n in (41, 81):
        t = np.linspace(0.0, 10.0, n)
        sizes.append(jumps(scheme("nielson")(t, tumble(t), tolerance=1e-12)).loc[2, "jump"])
    assert 2.5 < np.log2(sizes[0] / sizes[1]) < 3.5


def test_speed_at_keyframes_of_a_constant_spin():
    curve = scheme("slerp")(None, quaternion.exp(np.outer(np.arange(5) * 0.4, AXIS)))
    measured = speeds(curve)
    assert measured["least_key_speed"] == pytest.approx(1.0)
    assert measured["peak_speed"] == pytest.approx(1.0)


def test_fairness_of_a_known_spin():
    # omega = 2 (0.5 + t/4) n, alpha = n/2 on [0, 2]
    measured = fairness(spin(0.0, 1))
    assert measured["torque"] == pytest.approx(0.25 * 2.0, rel=1e-6)
    assert measured["length"] == pytest.approx(3.0, rel=1e-9)
    assert measured["peak"] == pytest.approx(0.5, rel=1e-6)
    assert measured["jerk"] == pytest.approx(0.0, abs=1e-3)


def test_the_smooth_motions_rates_are_its_derivatives():
    t, h = np.linspace(0.5, 9.5, 19), 1e-5
    step = quaternion.log(quaternion.mul(quaternion.conj(tumble(t - h)), tumble(t + h)))
    omega, alpha = tumble_rates(t)
    np.testing.assert_allclose(step / h, omega, atol=1e-8)
    after, before = tumble_rates(t + h)[0], tumble_rates(t - h)[0]
    np.testing.assert_allclose((after - before) / (2.0 * h), alpha, atol=1e-8)


@pytest.mark.parametrize("kind", ["uniform", "jittered", "log-uniform"])
def test_knots_span_the_motion(kind):
    t = knots(np.random.default_rng(0), kind, 33)
    assert t[0] == 0.0
    assert t[-1] == pytest.approx(10.0)
    assert (np.diff(t) > 0).all()


def test_slopes_are_orders():
    rows = []
    for n in (41, 81, 161):
        t = np.linspace(0.0, 10.0, n)
        rows.append({"scheme": "slerp", "keyframes": n, **errors(scheme("slerp")(t, tumble(t)))})
    import pandas as pd

    table = with_slopes(pd.DataFrame(rows), ["scheme"])
    assert table["slope"].iloc[-1] == pytest.approx(2.0, abs=0.1)
    assert table["regression"].iloc[-1] == pytest.approx(2.0, abs=0.1)
