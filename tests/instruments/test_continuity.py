"""The continuity and fairness instruments on curves whose answer is known."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from quatspline import quaternion
from quatspline.catalogue import scheme, schemes
from quatspline.claims.own import own_rates
from quatspline.curve import Curve
from quatspline.discovery import shipped
from quatspline.instruments.accuracy import (
    ERRORS,
    errors,
    knots,
    measured_order,
    reach,
    with_reach,
    with_slopes,
)
from quatspline.instruments.continuity import jumps, measured_continuity, speeds
from quatspline.instruments.fairness import fairness
from quatspline.instruments.trials import builder
from quatspline.runs.experiment import Run
from quatspline.system.loading import load
from quatspline.trajectories.smooth import tumble, tumble_rates
from quatspline.trajectories.walks import walk
from toys import AXIS, Turn, turned


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


class _Joined(Turn):
    """A quartic half angle whose derivative of order `power` jumps by power! `size` at t = 1."""

    size, power = 0.0, 2

    def theta(self, t):
        after, n = np.maximum(t - 1.0, 0.0), self.power
        return (
            0.5 * t + t**4 / 8 + self.size * after**n,
            0.5 + t**3 / 2 + self.size * n * after ** (n - 1) * (t > 1.0),
            1.5 * t**2 + self.size * n * (n - 1) * after ** max(n - 2, 0) * (t > 1.0),
        )


def joined(size: float, power: int, **more: object) -> Curve:
    cls = type("_Join", (_Joined,), {"size": size, "power": power, "name": "join", **more})
    return turned(cls, [0.0, 1.0, 2.0])


@pytest.mark.parametrize("size", [0.05, 1e-6])
@pytest.mark.parametrize(("power", "k"), [(1, 0), (2, 1), (3, 2)])
def test_closed_forms_tell_a_jump_of_a_millionth(power, k, size):
    table = jumps(joined(size, power))
    assert measured_continuity(table) == k
    assert table.loc[power, "jump"] == pytest.approx(2.0 * size * (1, 2, 6)[power - 1], rel=0.01)


def test_a_c1_join_keeps_its_jump_at_any_step():
    table = jumps(joined(0.05, 2))
    assert table.loc[2, "jump"] == pytest.approx(table.loc[2, "coarse_jump"], rel=1e-3)


def test_the_control_order_stays():
    """One order on: what is continuous leaves an extrapolation error, which falls, and what jumps stays."""
    table = jumps(scheme("quartic")(None, walk(np.random.default_rng(3), 7, 60.0)[:, 0]))
    assert table.loc[2, "jump"] < 1e-3 * table.loc[2, "coarse_jump"]
    assert table.loc[3, "jump"] == pytest.approx(table.loc[3, "coarse_jump"], rel=0.05)


def test_rates_that_a_library_reports_do_not_decide():
    """Its curve does: the same join, with an acceleration reported that is noise."""

    def noisy(self, t):
        return np.sin(1e6 * t)[:, None] * AXIS

    library = joined(0.0, 2, peer="numpy", _acceleration=noisy)
    assert measured_continuity(jumps(library)) == 3
    ours = joined(0.0, 2, _acceleration=noisy)
    assert measured_continuity(jumps(ours)) == 1


def test_own_rates_are_held_against_the_curve():
    def fast(self, t):
        return 1.02 * self.omega(t)

    rows = {row["quantity"]: row for row in own_rates(joined(0.0, 2, _velocity=fast))}
    assert rows["omega"]["relative"] == pytest.approx(0.02, rel=1e-6)
    assert rows["alpha"]["relative"] < 1e-8
    assert all(row["relative"] < 1e-8 for row in own_rates(joined(0.0, 2)))
    assert own_rates(spin(0.0, 1)) == []


@pytest.mark.parametrize(("size", "k"), [(1.0, -1), (1e-4, -1), (0.0, 3)])
def test_a_leap_inside_a_segment_is_found(size, k):
    class Leap(Turn):
        def theta(self, t):
            return 0.5 * t + 0.5 * size * (t > 1.3), 0.5 + 0.0 * t, 0.0 * t

    table = jumps(turned(Leap, [0.0, 1.0, 2.0]))
    assert measured_continuity(table) == k
    assert table.loc[0, "jump"] == pytest.approx(size, abs=1e-9)


def test_a_leap_in_a_slow_segment_of_a_fast_curve_is_found():
    """5 degrees at t = 10.3, where the curve turns by a degree a segment, and by 60 in all others."""
    leap, slow, fast = np.radians([5.0, 1.0, 60.0])

    class Uneven(Turn):
        def theta(self, t):
            inside = np.clip(t - 10.0, 0.0, 1.0)
            angle = fast * (t - inside) + slow * inside + leap * (t > 10.3)
            return 0.5 * angle, 0.5 * fast + 0.0 * t, 0.0 * t

    table = jumps(turned(Uneven, np.arange(21.0)), orders=(0,))
    assert table.loc[0, "jump"] == pytest.approx(leap, abs=1e-9)
    assert measured_continuity(table) == -1


class _Stops(Turn):
    """3 u^2 - 2 u^3 on every unit segment: at rest at keyframes, 1.5 times the mean speed between."""

    def theta(self, t):
        i = np.floor(t)
        u = t - i
        return i + u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u), 6.0 - 12.0 * u


def test_a_stop_at_every_keyframe_is_seen():
    measured = speeds(turned(_Stops, np.arange(6.0)))
    assert measured["least_key_speed"] == 0.0
    assert measured["peak_speed"] == pytest.approx(1.5, rel=0.02)


@pytest.mark.parametrize("name", ["slerp", "quartic", "kim", "local-quintic"])
def test_a_motion_at_rest_has_no_shares_of_its_speed(name):
    rest = np.tile([0.5, 0.5, 0.5, 0.5], (6, 1))
    assert all(np.isnan(share) for share in speeds(scheme(name)(None, rest)).values())


KNOWN = [
    ("scipy-rotation-spline", "60 degrees, uniform", 2),
    ("scipy-rotation-spline", "170 degrees, uneven", 1),
    ("interpolatepy-squad-c2", "60 degrees, uneven", 2),
    ("quartic", "170 degrees, uneven", 2),
]


@pytest.mark.parametrize(("name", "case", "k"), KNOWN)
def test_what_is_known_of_schemes(name, case, k):
    if name not in schemes():
        pytest.skip(f"{name}: its library is not installed")
    module = load(shipped("experiments") / "continuity.py", "experiment")
    curve = builder(name)(*module.keyframes_of(Run(quick=True), case))
    assert measured_continuity(jumps(curve)) == k
    stops = name == "interpolatepy-squad-c2"
    assert (speeds(curve)["least_key_speed"] < 1e-6) == stops


def test_rates_of_splines_are_not_those_of_its_curve():
    if "splines-catmull-rom" not in schemes():
        pytest.skip("splines is not installed")
    keyframes = walk(np.random.default_rng(3), 5, 80.0)[:, 0]
    rows = own_rates(scheme("splines-catmull-rom")(None, keyframes))
    assert [row["quantity"] for row in rows] == ["omega"]
    assert 1e-5 < rows[0]["relative"] < 0.1


def test_what_a_solve_leaves_is_no_jump():
    """At the default tolerance of 1e-6 and tighter: C1 and C2 all the same."""
    keyframes = walk(np.random.default_rng(5), 7, 60.0)[:, 0]
    for name, k in (("nielson", 1), ("kim", 2)):
        for tolerance in (1e-4, 1e-6, 1e-11):
            assert (
                measured_continuity(jumps(scheme(name)(None, keyframes, tolerance=tolerance))) == k
            )


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


def test_fairness_of_a_known_jerk():
    """Half angle t/2 + t^4/8: omega = 1 + t^3, alpha = 3 t^2, alpha' = 6 t on [0, 2]."""
    measured = fairness(joined(0.0, 2))
    assert measured["length"] == pytest.approx(6.0)
    assert measured["torque"] == pytest.approx(9.0 * 32.0 / 5.0)
    assert measured["jerk"] == pytest.approx(36.0 * 8.0 / 3.0)
    assert measured["peak"] == pytest.approx(12.0, rel=0.05)


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


def test_a_measured_order_is_the_power_of_the_spacing():
    h = np.array([1.0, 0.5, 0.25])
    assert measured_order(h, 7.0 * h**3) == pytest.approx(3.0, abs=1e-12)
    assert measured_order(h[:2], [1.0, 1.0]) == pytest.approx(0.0, abs=1e-12)
    for bad in (0.0, np.nan, np.inf):
        assert np.isnan(measured_order(h, [1.0, bad, 0.1]))


def test_slopes_skip_levels_that_failed():
    h = 1.0 / np.arange(4.0, 12.0)
    error = 2.0 * h**4
    error[3] = np.nan
    rows = {"scheme": "s", "keyframes": 1.0 / h + 1.0, **dict.fromkeys(ERRORS, error)}
    slopes = with_slopes(pd.DataFrame(rows), ["scheme"])["slope"]
    assert np.flatnonzero(slopes.isna()).tolist() == [0, 3, 4]
    assert slopes.dropna().to_numpy() == pytest.approx(np.full(5, 4.0), abs=1e-12)


def test_slopes_are_orders():
    rows = []
    for n in (41, 81, 161):
        t = np.linspace(0.0, 10.0, n)
        rows.append({"scheme": "slerp", "keyframes": n, **errors(scheme("slerp")(t, tumble(t)))})
    table = with_slopes(pd.DataFrame(rows), ["scheme"])
    for suffix, order in (("", 2.0), ("_omega", 1.0), ("_alpha", 0.0)):
        assert table[f"slope{suffix}"].iloc[-1] == pytest.approx(order, abs=0.1)
        assert table[f"regression{suffix}"].iloc[-1] == pytest.approx(order, abs=0.1)


def test_the_spacing_that_reaches_an_angle():
    """Errors 2 h^3 reach a goal at the cube root of its half, levels apart as they are."""
    x = np.log([1.0, 0.5, 0.25, 0.125])
    y = np.log(2.0) + 3.0 * x
    found, why = reach(x, y, np.log(0.03))
    assert found == pytest.approx((0.03 / 2.0) ** (1.0 / 3.0))
    assert why is None
    y[1] = np.nan  # a level that failed is left out
    assert reach(x, y, np.log(0.03))[0] == pytest.approx(found)


def test_a_spacing_that_cannot_be_read_says_why():
    x = np.log([1.0, 0.5])
    assert "not met at a spacing of 0.5" in str(reach(x, np.array([0.0, -1.0]), -2.0)[1])
    assert "met at every spacing, up to 1" in str(reach(x, np.array([0.0, -1.0]), 1.0)[1])
    assert reach(x, np.full(2, np.nan), 0.0)[1] == "no error measured"


def test_an_error_that_rises_again_has_not_reached_its_goal():
    x = np.log([1.0, 0.5, 0.25, 0.125])
    found, _ = reach(x, np.log([1.0, 0.001, 1.0, 0.001]), np.log(0.1))
    assert 0.125 < found < 0.25


def test_reasons_stand_in_the_table():
    levels = {"scheme": "s", "keyframes": [11, 21], "spacing": [1.0, 0.5]}
    table = with_reach(pd.DataFrame(levels | {"inner_angle": [0.1, 0.01]}), ["scheme"])
    assert 0.5 < table["spacing_1deg"].iloc[0] < 1.0
    assert table["spacing_0.1deg"].isna().all()
    assert table["unreached"].iloc[0].startswith("0.1 degrees: not met")
