"""The cumulative Hermite spline of Kim, Kim & Shin, and the chart velocities at keyframes."""

from __future__ import annotations

import math

import numpy as np
import pytest

import quatspline as qs
from golden import GOLDEN, KNOTS, Q, assert_golden
from quatspline import quaternion, stencil
from quatspline.fitting.tangents import CHART, SECANT, chart_velocities

T = KNOTS["nonuniform"]
NEAR = 1e-9


def logs(q, p):
    return quaternion.log(quaternion.mul(quaternion.conj(q), p))


def wound(count=7, turns=1.0, seed=3):
    """Keyframes spread over full turns: an odd number closes with the sign -1."""
    angles = np.arange(count) * math.pi * turns / count
    tilt = quaternion.exp(0.2 * np.random.default_rng(seed).normal(size=(count, 3)))
    return quaternion.mul(quaternion.exp(np.outer(angles, [0.0, 0.6, 0.8])), tilt)


@pytest.mark.parametrize("window", [3, 5])
def test_golden(window):
    entry = f"kks_hermite_{window}pt"
    assert GOLDEN["schemes"][entry]["knots"] == "nonuniform"
    curve = qs.build("hermite", T, Q, window=window)
    assert_golden(curve, entry, (1e-12, 1e-12, 1e-10))


@pytest.mark.parametrize("window", [3, 5])
@pytest.mark.parametrize("turns", [None, 1.0, 2.0])
def test_c1_with_the_velocities_asked_for(window, turns):
    q, closed = (Q, False) if turns is None else (wound(turns=turns), True)
    h = np.random.default_rng(1).uniform(0.6, 1.5, len(q) - (not closed))
    times = np.concatenate([[0.0], np.cumsum(h)]) - 3.0
    curve = qs.build("hermite", times, q, closed=closed, window=window)
    sign = -1.0 if turns == 1.0 else 1.0
    period = times[-1] - times[0]
    velocities = chart_velocities(curve.quaternions, h, closed, sign, window, CHART)
    knots = times[: len(q)]
    np.testing.assert_allclose(curve(knots), curve.quaternions, atol=1e-14)
    np.testing.assert_allclose(curve(knots, 1), 2.0 * velocities, atol=1e-12)
    inner = knots + period if closed else knots[1:-1]
    for order, smooth in ((0, True), (1, True), (2, False)):
        jump = np.abs(curve(inner + NEAR, order) - curve(inner - NEAR, order)).max()
        assert (jump < 1e-6) == smooth
    t = np.linspace(times[0], times[-1], 203)[1:-1]
    velocity, acceleration = stencil.rates(
        lambda s: curve(s + times[0]), t - times[0], times - times[0]
    )
    np.testing.assert_allclose(curve(t, 1), velocity, atol=1e-8)
    np.testing.assert_allclose(curve(t, 2), acceleration, atol=2e-5)
    if closed:
        np.testing.assert_allclose(curve(t + period), sign * curve(t), atol=1e-12)


def test_three_point_velocities():
    h = np.diff(T)
    v = chart_velocities(Q, h, False, 1.0, 3, CHART)
    s = logs(Q[:-1], Q[1:]) / h[:, None]
    a, b = h[:-1, None], h[1:, None]
    np.testing.assert_allclose(v[1:-1], (b * s[:-1] + a * s[1:]) / (a + b), atol=1e-15)
    p1, p2 = logs(Q[0], Q[1]), logs(Q[0], Q[2])
    first = p1 * (h[0] + h[1]) / (h[0] * h[1]) - p2 * h[0] / (h[1] * (h[0] + h[1]))
    np.testing.assert_allclose(v[0], first, atol=1e-15)
    secant = chart_velocities(Q, h, False, 1.0, 3, SECANT)
    np.testing.assert_allclose(secant[[0, -1]], s[[0, -1]], atol=1e-15)
    np.testing.assert_array_equal(secant[1:-1], v[1:-1])


@pytest.mark.parametrize("window", [3, 5])
def test_velocities_are_slopes_of_the_chart_polynomial(window):
    h = np.diff(T)
    v = chart_velocities(Q, h, False, 1.0, window, CHART)
    for i in range(5):
        lo = min(max(i - window // 2, 0), 5 - window)
        x = logs(Q[i], Q[lo : lo + window])
        slope = [np.polyfit(T[lo : lo + window] - T[i], c, window - 1)[-2] for c in x.T]
        np.testing.assert_allclose(v[i], slope, atol=1e-12)


@pytest.mark.parametrize("window", [3, 5])
def test_velocity_errors_fall_with_the_window(window):
    """O(h^2) from three points and O(h^4) from five, inside."""

    def motion(t):
        a = np.stack([0.8 * np.sin(1.1 * t), 0.6 * np.cos(0.7 * t), 0.5 * np.sin(1.7 * t + 1)], -1)
        return quaternion.exp(a)

    exact = stencil.rates(motion, np.array([5.0]), np.array([0.0, 10.0]))[0][0]
    errors = []
    for count in (81, 161):
        t = np.linspace(0.0, 10.0, count)
        v = chart_velocities(motion(t), np.diff(t), False, 1.0, window, CHART)
        errors.append(np.abs(2.0 * v[count // 2] - exact).max())
    assert math.log2(errors[0] / errors[1]) == pytest.approx(window - 1, abs=0.25)


@pytest.mark.parametrize("window", [3, 5])
def test_interior_order_is_three_whatever_the_window(window):
    def motion(t):
        a = [0.8 * np.sin(1.1 * t), 0.6 * np.cos(0.7 * t + 0.3), 0.5 * np.sin(1.7 * t + 1.0)]
        a = np.stack(a, axis=-1)
        b = np.stack([0.3 * t, 0.0 * t, 0.2 * np.cos(t)], -1)
        return quaternion.mul(quaternion.exp(a), quaternion.exp(b))

    t, errors = np.linspace(3.0, 7.0, 1601), []
    for count in (161, 321):
        times = np.linspace(0.0, 10.0, count)
        curve = qs.build("hermite", times, motion(times), window=window)
        errors.append(quaternion.distance(curve(t), motion(t)).max())
    assert math.log2(errors[0] / errors[1]) == pytest.approx(curve.order, abs=0.25)


@pytest.mark.parametrize("window", [3, 5])
@pytest.mark.parametrize("degrees", [20.0, 100.0, 170.0])
def test_a_constant_spin_stays_constant(window, degrees):
    """At large steps the far points of a window lie past -1: the chart is carried on."""
    times = np.array([0.0, 1.0, 1.7, 2.6, 3.2, 4.2, 4.9])
    rate = math.radians(degrees)
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    q = quaternion.mul(Q[2], quaternion.exp(np.outer(times, 0.5 * rate * axis)))
    curve = qs.build("hermite", times, q, window=window)
    t = np.linspace(0.0, 4.9, 99)
    np.testing.assert_allclose(curve(t, 1), np.tile(rate * axis, (99, 1)), atol=1e-9)


@pytest.mark.parametrize("window", [3, 5])
@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("count", [2, 3, 4])
def test_few_keyframes(count, closed, window):
    curve = qs.build("hermite", None, Q[:count], closed=closed, window=window)
    t = np.linspace(*curve.domain, 50)
    assert all(np.isfinite(curve(t, order)).all() for order in (0, 1, 2))
    np.testing.assert_allclose(curve(np.arange(count)), Q[:count], atol=1e-14)
    if count == 2 and not closed:
        np.testing.assert_allclose(curve(t), qs.build("slerp", None, Q[:2])(t), atol=1e-14)


@pytest.mark.parametrize("window", [3, 5])
def test_two_keyframes_close_through_a_full_turn(window):
    """A spin in two half turns, the far points of a window exactly at -1."""
    q = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]
    curve = qs.scheme("hermite")(None, q, closed=True, align=False, closing_sign=-1, window=window)
    t = np.linspace(0.0, 2.0, 30)
    np.testing.assert_allclose(curve(t, 1), np.tile([0.0, math.pi, 0.0], (30, 1)), atol=1e-14)


def test_support():
    """A keyframe moves the segments that it shapes and no other."""
    q = wound(14, 2.0)
    moved = q.copy()
    moved[6] = quaternion.mul(q[6], quaternion.exp([0.1, -0.05, 0.2]))
    for window, support in ((3, 4), (5, 6)):
        before = qs.build("hermite", None, q, window=window)
        after = qs.build("hermite", None, moved, window=window)
        changed = np.flatnonzero(
            np.abs(before(np.arange(13) + 0.4) - after(np.arange(13) + 0.4)).max(axis=1) > 1e-15
        )
        assert before.support == support
        assert changed.tolist() == list(range(6 - support // 2, 6 + support // 2))


def test_it_is_not_symmetric_in_time():
    """The factors do not commute: the reversed keyframes make another curve."""
    t = np.linspace(0.0, 4.0, 201)
    forth = qs.build("hermite", T, Q)(t)
    back = qs.build("hermite", 4.0 - T[::-1], Q[::-1])(4.0 - t)
    assert quaternion.distance(forth, back).max() > 1e-3


def test_tracks_are_fitted_apart():
    tracks = np.stack([wound(6, k / 2, seed=k) for k in range(1, 4)], axis=1)
    curve = qs.build("hermite", None, tracks, window=5)
    t = np.linspace(0.0, 5.0, 17)
    for order in (0, 1, 2):
        single = qs.build("hermite", None, tracks[:, 2], window=5)
        np.testing.assert_array_equal(curve(t, order)[:, 2], single(t, order))


def test_refused_options():
    with pytest.raises(ValueError, match="window"):
        qs.build("hermite", T, Q, window=4)
    with pytest.raises(ValueError, match="ends"):
        qs.build("hermite", T, Q, ends="natural")
