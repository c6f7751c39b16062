"""The local quintic: its rates by scipy's splines, C2, order, fairness, spins, smooth windows."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import quatspline as qs
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.quaternion import FloatArray
from walks import apart, loop, spin, uneven, walk

SAME = 1e-12
FREE = (2, np.zeros(3))


def rates_by_scipy(t: FloatArray, q: FloatArray, i: int, m: int) -> FloatArray:
    """omega and alpha at keyframe i from an ordinary spline in the chart centred there."""
    first, last = max(0, i - m), min(len(t) - 1, i + m)
    x = quaternion.log(quaternion.mul(quaternion.conj(q[i]), q[first : last + 1]))
    cut = i - m > 0 and i - first >= 2, i + m < len(t) - 1 and last - i >= 2
    spline = CubicSpline(t[first : last + 1], x, bc_type=["not-a-knot" if c else FREE for c in cut])
    return 2 * np.array([spline(t[i], 1), spline(t[i], 2)])


@pytest.mark.parametrize("window", [1, 2, 3, 5])
@pytest.mark.parametrize("count", [2, 3, 4, 6, 12])
def test_rates_are_those_of_a_spline_in_the_chart(count: int, window: int) -> None:
    t, q = uneven(count), walk(count, 40.0, seed=count)
    curve = qs.build("local-quintic", t, q, window=window)
    for i in range(count):
        wanted = rates_by_scipy(t, curve.quaternions, i, window)
        found = np.array([curve(t[i], 1), curve(t[i], 2)])
        assert np.abs(found - wanted).max() < SAME * max(1.0, np.abs(wanted).max())


@pytest.mark.parametrize("degrees", [5.0, 60.0, 110.0, 150.0, 175.0])
def test_c2_to_rounding(degrees: float) -> None:
    t, q = uneven(15), walk(15, degrees)
    curve = qs.build("local-quintic", t, q)
    for order in (0, 1, 2):
        at, before = curve(t[1:-1], order), curve(np.nextafter(t[1:-1], 0.0), order)
        scale = max(1.0, np.abs(curve(np.linspace(t[0], t[-1], 301), 2)).max())
        assert np.abs(at - before).max() < SAME * scale


@pytest.mark.parametrize("turns", [0, 1, 2, 3])
@pytest.mark.parametrize("count", [3, 5, 9])
def test_closed_curves_are_c2_at_the_seam(count: int, turns: int) -> None:
    t = uneven(count + 1)
    q = loop(t, turns) if count > 2 * turns else walk(count, 50.0)
    curve = qs.build("local-quintic", t, q, closed=True)
    sign = curve.keyframes.sign
    end = np.nextafter(t[-1], 0.0)
    for order in (0, 1, 2):
        value = sign * curve(end, order) if order == 0 else curve(end, order)
        assert np.abs(value - curve(t[0], order)).max() < 1e-10


def test_a_closed_curve_is_an_open_one_of_more_turns() -> None:
    t, q = uneven(8), walk(7, 60.0)
    for sign in (1, -1):
        curve = qs.build("local-quintic", t, q, closed=True, align=False, closing_sign=sign)
        signs = np.repeat(float(sign) ** np.arange(5), 7)[:, None]
        times = np.concatenate([t[:-1] + k * t[-1] for k in range(5)])
        longer = qs.build("local-quintic", times, signs * np.tile(q, (5, 1)), align=False)
        s = np.linspace(2 * t[-1], 3 * t[-1], 101)
        for order in (0, 1, 2):
            assert np.abs(curve(s, order) - longer(s, order)).max() < 1e-10


@pytest.mark.parametrize("degrees", [10, 60, 110, 119, 125, 150, 170, 179])
def test_constant_spin(degrees: int) -> None:
    """Exact beyond 119 degrees per step too: a window that would fold has no share."""
    t = uneven(12)
    t /= np.diff(t).max()
    rate = np.radians(degrees)
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    curve = qs.build("local-quintic", t, spin(t, axis, rate))
    s = np.linspace(t[0], t[-1], 501)
    assert np.abs(curve(s, 1) - rate * axis).max() < SAME
    assert np.abs(curve(s, 2)).max() < 1e-11


def test_constant_spin_the_long_way_round() -> None:
    """align=False: steps of up to nearly a full turn."""
    t = np.arange(9.0)
    axis = np.array([0.6, 0.0, 0.8])
    for degrees in (200, 270, 330, 350):
        curve = qs.build("local-quintic", t, spin(t, axis, np.radians(degrees)), align=False)
        s = np.linspace(0.0, 8.0, 301)
        assert np.abs(curve(s, 1) - np.radians(degrees) * axis).max() < 1e-11


def motion(t: FloatArray) -> FloatArray:
    """The smooth motion that the orders of all schemes were measured on."""
    a = np.stack(
        [0.8 * np.sin(1.1 * t), 0.6 * np.cos(0.7 * t + 0.3), 0.5 * np.sin(1.7 * t + 1)], -1
    )
    b = np.stack([0.3 * t, 0.0 * t, 0.2 * np.cos(t)], -1)
    return quaternion.mul(quaternion.exp(a), quaternion.exp(b))


@pytest.mark.parametrize(
    ("name", "given", "order"),
    [
        ("local-quintic", {}, 4),
        ("local-quintic", {"window": 2}, 4),
        ("local-quintic", {"window": 1}, 2),
        ("quintic", {}, 3),
        ("quintic", {"curvature": 3.0}, 2),
        ("quintic", {"curvature": 0.5}, 2),
    ],
)
def test_interior_order(name: str, given: dict[str, float], order: int) -> None:
    s = np.linspace(3.0, 7.0, 801)
    errors = []
    for count in (81, 161, 321):
        t = np.linspace(0.0, 10.0, count)
        curve = qs.build(name, t, motion(t), **given)
        errors.append(apart(curve(s), motion(s)))
    assert np.log2(errors[0] / errors[-1]) / 2 == pytest.approx(order, abs=0.15)
    assert curve.order == order


def energy(curve: Curve) -> float:
    """The integral of |alpha|^2 by Gauss quadrature between keyframes."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    lo, h = curve.times[:-1, None], np.diff(curve.times)[:, None]
    alpha = curve(lo + 0.5 * h * (nodes + 1), 2)
    return float(np.sum(0.5 * h * weights * np.sum(alpha**2, axis=-1)))


def test_nearly_of_least_torque() -> None:
    rng = np.random.default_rng(11)
    ratios = []
    for seed in range(15):
        count = int(rng.integers(4, 10))
        t = np.concatenate([[0.0], np.cumsum(rng.uniform(0.5, 1.5, count - 1))])
        q = walk(count, rng.uniform(20.0, 110.0), seed)
        least = qs.build("min-torque", t, q).energy[0]
        ratios.append(energy(qs.build("local-quintic", t, q)) / least)
    assert min(ratios) > 1.0
    assert np.median(ratios) < 1.01
    assert max(ratios) < 1.1


@pytest.mark.parametrize("degrees", [70.0, 90.0, 110.0, 130.0, 150.0, 165.0])
def test_depends_continuously_on_the_keyframes(degrees: float) -> None:
    """Windows shrink as steps grow; none is cut off at once, at no angle."""
    t = np.arange(9.0)
    s = np.linspace(0.0, 8.0, 401)
    for seed in range(20):
        q = walk(9, degrees, seed)
        nudge = quaternion.exp(1e-9 * np.random.default_rng(seed).normal(size=(9, 3)))
        one = qs.build("local-quintic", t, q, align=False)
        two = qs.build("local-quintic", t, quaternion.mul(q, nudge), align=False)
        assert apart(one(s), two(s)) < 1e-6


def test_a_growing_step_moves_the_curve_gradually() -> None:
    """A spin's step grows through the whole range in which windows give way."""
    t = np.arange(9.0)
    s = np.linspace(0.0, 8.0, 201)
    tilt = quaternion.exp(0.1 * np.random.default_rng(2).normal(size=(9, 3)))
    last = None
    for degrees in np.arange(60.0, 178.0, 0.25):
        q = quaternion.mul(spin(t, [0.0, 0.0, 1.0], np.radians(degrees)), tilt)
        # in the frame that spins along, so that only the shape of the curve is compared
        undo = spin(s, [0.0, 0.0, 1.0], -np.radians(degrees))
        now = quaternion.mul(undo, qs.build("local-quintic", t, q, align=False)(s))
        assert last is None or apart(now, last) < np.radians(1.0)
        last = now


def test_window_sets_the_claims() -> None:
    q = walk(20, 30.0)
    for window, order in ((1, 2), (2, 4), (3, 4), (4, 4)):
        curve = qs.build("local-quintic", None, q, window=window)
        assert (curve.order, curve.support) == (order, 2 * window + 2)
        moved = q.copy()
        moved[10] = quaternion.mul(q[10], quaternion.exp([0.1, 0.0, 0.0]))
        other = qs.build("local-quintic", None, moved, window=window)
        middle = np.arange(19) + 0.5
        far = np.abs(curve(middle) - other(middle)).max(axis=1) > 0.0
        assert np.array_equal(np.flatnonzero(far), np.arange(10 - window - 1, 10 + window + 1))


@pytest.mark.parametrize("closed", [False, True])
def test_tracks_are_single_curves(closed: bool) -> None:
    q = np.stack([walk(9, degrees, seed) for seed, degrees in enumerate((20.0, 100.0, 160.0))], 1)
    t = uneven(9 + closed)
    s = np.linspace(t[0], t[-1], 77)
    curve = qs.build("local-quintic", t, q, closed=closed)
    for k in range(3):
        single = qs.build("local-quintic", t, q[:, k], closed=closed)
        for order in (0, 1, 2):
            assert np.abs(curve(s, order)[:, k] - single(s, order)).max() < 1e-11


def test_quintic_of_curvature_three_is_the_quartic() -> None:
    t, q = uneven(9), walk(9, 80.0)
    s = np.linspace(t[0], t[-1], 200)
    one, two = qs.build("quintic", t, q, curvature=3.0), qs.build("quartic", t, q)
    for order in (0, 1, 2):
        assert np.array_equal(one(s, order), two(s, order))


def test_quintic_keeps_constant_rates_inside_only() -> None:
    t = np.arange(8.0)
    curve = qs.build("quintic", t, spin(t, [0.0, 0.0, 1.0], 0.5))
    assert np.abs(curve(np.linspace(1.0, 6.0, 101), 2)).max() < SAME
    assert np.abs(curve(np.linspace(0.0, 1.0, 101), 2)).max() > 0.1
