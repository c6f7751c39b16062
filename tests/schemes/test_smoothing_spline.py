"""The smoothing spline: golden numbers, scipy's on one axis, dense least squares, what invariance asks."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline

import quatspline as qs
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.fitting.noise_level import noise_level
from quatspline.fitting.smoothing_search import EXPONENTS
from quatspline.quaternion import FloatArray
from quatspline.trajectories.smooth import tumble
from walks import apart, apart_up_to_sign, inside, loop, random_units, spin, uneven, walk

GOLDEN = json.loads(
    (Path(__file__).parents[1] / "data" / "golden_smoothing_float64.json").read_text()
)
AXIS = np.array([0.6, 0.0, 0.8])
SIGMA = np.radians(1.0)


def smooth(times: Any, q: Any, **options: Any) -> Any:
    return qs.build("smoothing-spline", times, q, **options)


def noisy(q: FloatArray, sigma: float, seed: int = 0) -> FloatArray:
    """Rotation errors of a standard deviation about every axis."""
    errors = np.random.default_rng(seed).normal(scale=sigma, size=(*q.shape[:-1], 3))
    return quaternion.mul(q, quaternion.exp(0.5 * errors))


def keyframes_of(curve: Curve) -> FloatArray:
    """The smoothed keyframes r_i."""
    return curve(curve.times[: len(curve.quaternions)])


# -- golden numbers -----------------------------------------------------------------------------


@pytest.mark.parametrize("case", GOLDEN["cases"], ids=lambda case: f"lambda {case['lam']}")
def test_golden(case: Any) -> None:
    q = quaternion.normalise(np.array(GOLDEN["meta"]["raw_keyframes"], float))
    times = np.array(GOLDEN["meta"]["times"], float)
    curve = smooth(times, q, smoothing=case["lam"])
    assert apart(curve(times), np.array(case["r"])) < 1e-9
    for order, kind in enumerate(("q", "omega", "alpha")):
        assert apart(curve(np.array(case["x"]), order), np.array(case[kind])) < 1e-9, kind
    misses = quaternion.distance(curve(times), q)
    assert np.sum(misses**2) == pytest.approx(case["rss"], abs=1e-9)
    assert curve.freedom == pytest.approx(case["df"], abs=1e-12)


# -- one axis -----------------------------------------------------------------------------------


def one_axis(n: int = 41) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Uneven times, noisy angles, weights."""
    rng = np.random.default_rng(1)
    t = np.cumsum(rng.uniform(0.3, 1.5, n))
    return t, 0.8 * np.sin(t) + 0.1 * rng.normal(size=n), rng.uniform(0.5, 2.0, n)


def about_axis(angles: FloatArray) -> FloatArray:
    return quaternion.exp(0.5 * angles[:, None] * AXIS)


@pytest.mark.parametrize("weight", [1e-6, 1e-3, 1.0, 50.0])
def test_scipys_on_one_axis(weight: float) -> None:
    t, angles, w = one_axis()
    curve = smooth(t, about_axis(angles), smoothing=weight, weights=w)
    theirs = make_smoothing_spline(t, angles, w=w, lam=weight)
    x = np.linspace(t[0], t[-1], 301)
    assert np.abs(2.0 * quaternion.log(curve(x)) @ AXIS - theirs(x)).max() < 1e-12
    for order in (1, 2):
        assert np.abs(curve(x, order) - theirs(x, order)[:, None] * AXIS).max() < 1e-12


def influence(t: FloatArray, w: FloatArray, weight: float, closed: bool) -> FloatArray:
    """The influence matrix of the scalar spline, by dense least squares: lambda may be large."""
    h, n = np.diff(t), len(w)
    rows = np.arange(n) if closed else np.arange(1, n - 1)
    d, r = np.zeros((len(rows), n)), np.zeros((len(rows), len(rows)))
    for j, i in enumerate(rows):
        for k, x in ((i - 1, 1 / h[i - 1]), (i, -1 / h[i - 1] - 1 / h[i]), (i + 1, 1 / h[i])):
            d[j, k % n] += x
        r[j, j] = (h[i - 1] + h[i]) / 3
        if closed or j + 1 < len(rows):
            k = (j + 1) % len(rows)
            r[j, k] = r[k, j] = h[i] / 6
    root = np.linalg.solve(np.linalg.cholesky(r), d) * np.sqrt(weight)
    system = np.concatenate([np.diag(np.sqrt(w)), root])
    data = np.concatenate([np.diag(np.sqrt(w)), np.zeros((len(rows), n))])
    return np.linalg.lstsq(system, data)[0]


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("weight", [0.0, 1e-3, 1.0, 1e3, 1e8])
def test_dense_least_squares_on_one_axis(weight: float, closed: bool) -> None:
    """Values and the trace, strong smoothing included, where scipy's own loses digits."""
    t, angles, w = one_axis()
    t = np.append(t, t[-1] + 0.7) if closed else t
    curve = smooth(t, about_axis(angles), smoothing=weight, weights=w, closed=closed)
    matrix = influence(t, w, weight, closed)
    found = 2.0 * quaternion.log(keyframes_of(curve)) @ AXIS
    assert np.abs(found - matrix @ angles).max() < 1e-11
    # a closed curve's matrix has a condition number of lambda in its mean
    assert curve.freedom == pytest.approx(np.trace(matrix), abs=1e-11 + 1e-15 * closed * weight)


def test_a_closed_spin_that_winds() -> None:
    """An odd number of turns, s = -1: what is smoothed is the angle less its steady growth."""
    n = 24
    t = np.cumsum(np.random.default_rng(2).uniform(0.5, 1.5, n + 1))
    noise = 0.2 * np.random.default_rng(3).normal(size=n)
    steady = 2.0 * np.pi * (t[:-1] - t[0]) / (t[-1] - t[0])
    curve = smooth(t, about_axis(steady + noise), smoothing=2.0, closed=True)
    assert curve.keyframes.sign == -1.0
    wanted = steady + influence(t, np.ones(n), 2.0, closed=True) @ noise
    assert apart(keyframes_of(curve), about_axis(wanted)) < 1e-11


def test_cross_validation_finds_the_least() -> None:
    """Of the criterion by dense influence matrices, on a fine grid."""
    t, angles, w = one_axis(60)
    curve = smooth(t, about_axis(angles), smoothing="gcv", weights=w)

    def criterion(weight: float) -> float:
        matrix = influence(t, w, weight, closed=False)
        misses = angles - matrix @ angles
        return float(np.mean(w * misses**2) / (1.0 - np.trace(matrix) / len(t)) ** 2)

    least = min(criterion(10.0**x) for x in np.arange(-3.0, 1.0, 0.05))
    assert criterion(curve.smoothing) < 1.005 * least


# -- the minimum on rotations -------------------------------------------------------------------


def objective(curve: Curve, r: FloatArray, weight: float, w: FloatArray) -> float:
    """F of smoothed keyframes, written once more."""
    h, q = curve.keyframes.spacings, curve.quaternions
    closed, n = curve.closed, len(q)
    r = np.concatenate([r, curve.keyframes.sign * r[:1]]) if closed else r
    rates = 2.0 * quaternion.log(quaternion.mul(quaternion.conj(r[:-1]), r[1:])) / h[:, None]
    d = rates - np.roll(rates, 1, axis=0) if closed else np.diff(rates, axis=0)
    left = np.roll(h, 1) if closed else h[:-1]
    right = h if closed else h[1:]
    bands = np.diag((left + right) / 3)
    for j in range(len(d) if closed else len(d) - 1):
        k = (j + 1) % len(d)
        bands[j, k] = bands[k, j] = right[j] / 6
    e = 2.0 * quaternion.log(quaternion.mul(quaternion.conj(r[:n]), q))
    return float(np.sum(w * np.sum(e**2, axis=1)) + weight * np.sum(d * np.linalg.solve(bands, d)))


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("n", [3, 4, 5, 9])
def test_no_turn_of_a_keyframe_is_better(n: int, closed: bool) -> None:
    t = uneven(n + closed)
    q = loop(t, 1, wobble=0.6) if closed else walk(n, 50.0)
    w = np.random.default_rng(n).uniform(0.5, 2.0, n)
    weight = 0.02
    curve = smooth(t, q, smoothing=weight, weights=w, closed=closed)
    r, step = keyframes_of(curve), 1e-4
    assert apart_up_to_sign(r, q) > 0.02
    for i in range(n):
        for axis in np.eye(3):
            values = []
            for side in (-1.0, 0.0, 1.0):
                turned = r.copy()
                turned[i] = quaternion.mul(r[i], quaternion.exp(0.5 * side * step * axis))
                values.append(objective(curve, turned, weight, w))
            assert abs(values[2] - values[0]) < 1e-8 * step * max(values[1], 1.0)
            assert min(values) == values[1]


@pytest.mark.parametrize("closed", [False, True])
def test_nothing_interpolates_and_much_straightens(closed: bool) -> None:
    t = uneven(9 + closed)
    q = loop(t, 1, wobble=0.4) if closed else walk(9, 40.0)
    curve = smooth(t, q, smoothing=0.0, closed=closed)
    assert apart(keyframes_of(curve), q) < 1e-14
    assert curve.freedom == pytest.approx(9.0, abs=1e-13)
    misses = []
    for weight in (1e-8, 1e-7):
        misses.append(apart(keyframes_of(smooth(t, q, smoothing=weight, closed=closed)), q))
    assert misses[1] / misses[0] == pytest.approx(10.0, rel=1e-3)
    straight = smooth(t, q, smoothing=1e10, closed=closed)
    assert np.abs(straight(inside(t), 2)).max() < 1e-8
    assert straight.freedom == pytest.approx(1.0 if closed else 2.0, abs=1e-5)


def test_a_closed_curve_is_the_middle_of_a_long_open_one() -> None:
    t = uneven(9)
    q = loop(t, 1, wobble=0.4)
    closed = smooth(t, q, smoothing=0.05, closed=True)
    period, turns = t[-1], 11
    times = np.concatenate([t[:-1] + k * period for k in range(turns)])
    tiled = np.concatenate([(-1.0) ** k * q for k in range(turns)])
    longer = smooth(times, tiled, smoothing=0.05)
    x = inside(t)
    for order in (0, 1, 2):
        assert (
            apart(longer(x + 5 * period, order), (-1.0) ** (order == 0) * closed(x, order)) < 1e-9
        )


# -- invariance ---------------------------------------------------------------------------------


def test_backwards_it_smooths_alike() -> None:
    """The smoothed keyframes, and the rates there; inside, segments have a base at one end."""
    t, q = uneven(12), walk(12, 50.0)
    there, back = smooth(t, q, smoothing=0.1), smooth(t[-1] - t[::-1], q[::-1], smoothing=0.1)
    x = t[1:-1]
    for order, sign in ((0, 1.0), (1, -1.0), (2, 1.0)):
        assert apart_up_to_sign(there(t), back(t[-1] - t)) < 1e-9
        if order:
            assert apart(there(x, order), sign * back(t[-1] - x, order)) < 1e-8


def test_units_of_time_and_of_weights() -> None:
    """lambda has units of time cubed, and only its ratio to the weights counts."""
    t, q = uneven(9), walk(9, 50.0)
    curve = smooth(t, q, smoothing=0.1)
    for scale in (1e-9, 1e6):
        other = smooth(t * scale, q, smoothing=0.1 * scale**3)
        assert apart(other(inside(t) * scale), curve(inside(t))) < 1e-9
        assert smooth(t * scale, q).smoothing == pytest.approx(smooth(t, q).smoothing * scale**3)
    heavier = smooth(t, q, smoothing=0.7, weights=np.full(9, 7.0))
    assert apart(heavier(inside(t)), curve(inside(t))) < 1e-9


def test_a_keyframe_of_little_weight_is_left_out() -> None:
    t, q = uneven(9), walk(9, 30.0)
    q[4] = quaternion.mul(q[4], quaternion.exp([0.2, 0.1, 0.0]))
    weights = np.ones(9)
    weights[4] = 1e-9
    with_it = smooth(t, q, smoothing=0.05, weights=weights)
    without = smooth(np.delete(t, 4), np.delete(q, 4, axis=0), smoothing=0.05)
    near = np.abs(np.delete(t, 4) - t[4]) > 1.0
    gaps = quaternion.distance(with_it(np.delete(t, 4)), without(np.delete(t, 4)))
    assert gaps[near].max() < 2e-3  # a longer segment's energy is read from fewer turns


# -- how much -----------------------------------------------------------------------------------


@pytest.mark.parametrize("options", [{}, {"smoothing": "gcv"}, {"noise": SIGMA}], ids=str)
def test_a_noisy_tumble(options: Any) -> None:
    """401 keyframes with errors of 1 degree an axis: a third is left, and of slerp's velocity a tenth."""
    t, x = np.linspace(0.0, 10.0, 401), np.linspace(0.0, 10.0, 2001)
    squares = []
    for seed in range(6):
        curve = smooth(t, noisy(tumble(t), SIGMA, seed), **options)
        assert curve.noise == pytest.approx(SIGMA, rel=0.1)
        squares.append(np.mean(quaternion.distance(curve(x), tumble(x)) ** 2))
    assert np.degrees(np.sqrt(np.mean(squares))) <= 0.50


def test_the_search_finds_what_the_truth_would() -> None:
    t = np.linspace(0.0, 10.0, 201)
    q = noisy(tumble(t), SIGMA, 5)

    def error(**options: Any) -> float:
        return float(np.mean(quaternion.distance(smooth(t, q, **options)(t), tumble(t)) ** 2))

    scale = np.median(np.diff(t)) ** 3
    best = min(error(smoothing=scale * 10.0**x) for x in EXPONENTS[::2])
    for options in ({}, {"smoothing": "gcv"}, {"noise": SIGMA}):
        assert error(**options) < 1.1**2 * best


def test_auto_smooths_no_more_than_cross_validation() -> None:
    t = np.linspace(0.0, 10.0, 101)
    q = tumble(t)
    q[50] = quaternion.mul(q[50], quaternion.exp([0.05, 0.0, 0.0]))  # one glitch in clean data
    gcv, auto = smooth(t, q, smoothing="gcv"), smooth(t, q)
    assert auto.smoothing < 0.01 * gcv.smoothing
    away = np.abs(t - t[50]) > 1.0
    errors = [quaternion.distance(c(t), tumble(t))[away].max() for c in (gcv, auto)]
    assert errors[1] < 0.01 * errors[0]


@pytest.mark.parametrize("sigma", [1e-4, SIGMA, 0.1])
@pytest.mark.parametrize("closed", [False, True])
def test_the_noise_level_is_told(sigma: float, closed: bool) -> None:
    rng = np.random.default_rng(4)
    t = np.append(0.0, np.cumsum(rng.uniform(0.5, 1.5, 600 + closed - 1)))
    q = loop(t, 1) if closed else spin(t, (1.0, 2.0, 2.0), 0.1)
    q = noisy(q, sigma)
    for i in range(0, 600, 40):  # and outliers do not count
        q[i] = quaternion.mul(q[i], quaternion.exp([0.3, 0.0, 0.0]))
    curve = qs.build("slerp", t, q, closed=closed)
    assert noise_level(curve.keyframes) == pytest.approx(sigma, rel=0.15)
    p, r = random_units(2, 1)
    turned = qs.build("slerp", t, quaternion.mul(quaternion.mul(p, q), r), closed=closed)
    assert noise_level(turned.keyframes) == pytest.approx(noise_level(curve.keyframes), rel=1e-9)


def test_the_noise_level_of_little() -> None:
    few = qs.build("slerp", None, walk(3, 20.0)).keyframes
    assert noise_level(few) == 0.0
    still = qs.build("slerp", None, np.tile(walk(2, 20.0)[:1], (9, 1))).keyframes
    assert noise_level(still) == 0.0
    q = np.stack([noisy(np.tile(walk(2, 20.0)[:1], (99, 1)), s) for s in (0.01, 0.1)], axis=1)
    assert noise_level(qs.build("slerp", None, q).keyframes) == pytest.approx([0.01, 0.1], rel=0.2)


# -- reports and refusals -----------------------------------------------------------------------


def test_every_track_has_its_own_weight() -> None:
    t = np.linspace(0.0, 10.0, 61)
    q = np.stack([noisy(tumble(t), s, k) for k, s in enumerate((0.001, 0.01, 0.1))], axis=1)
    curve = smooth(t, q)
    assert curve.smoothing.shape == curve.freedom.shape == curve.noise.shape == (3,)
    assert np.all(np.diff(curve.smoothing) > 0.0)
    for k in range(3):
        assert curve.smoothing[k] == pytest.approx(smooth(t, q[:, k]).smoothing, rel=1e-9)


def test_what_does_not_converge_is_told() -> None:
    q = walk(201, 140.0)
    with pytest.raises(qs.ConvergenceError, match=r"^smoothing-spline \(gauss-newton\) did not"):
        smooth(None, q, smoothing=100.0)
    curve = smooth(None, q, smoothing=100.0, on_failure="return")
    assert curve.solve_report.converged is False
    assert np.abs(np.linalg.norm(curve(curve.times), axis=1) - 1.0).max() < 1e-13
    short = smooth(None, walk(9, 60.0), smoothing=1.0, max_iterations=2, on_failure="return")
    assert (short.solve_report.iterations, short.solve_report.converged) == (2, False)
    assert smooth(None, q).solve_report.converged  # the search ends where solves fail


def test_rest_at_rounding_counts_as_converged() -> None:
    t = np.linspace(0.0, 25.0, 1001)
    curve = smooth(t, noisy(tumble(t), SIGMA), smoothing=1e8 * 0.025**3)
    assert curve.solve_report.converged
    assert curve.solve_report.residual < 1e-7


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"smoothing": -1.0}, r"^smoothing=-1.0: must be at least 0"),
        ({"smoothing": np.inf}, r"^smoothing=inf: expected a finite number"),
        ({"smoothing": "most"}, r"^smoothing='most': expected one of 'gcv', 'auto'"),
        ({"noise": 0.0}, r"^noise=0.0: must be above 0"),
        ({"noise": 0.1, "smoothing": 2.0}, r"^noise=0.1: it chooses lambda, and so does smoothing"),
        ({"weights": [1.0, 2.0]}, r"^weights has shape \(2,\): expected a number or 5"),
        ({"weights": [1, 1, 0, 1, 1]}, r"^weights\[2\] = 0: must be above 0"),
        (
            {"weights": [1, 1, 1, 1, 1e-12]},
            r"^weights\[4\] = 1e-12: less than 1e-09 of the largest",
        ),
        ({"weights": [1, 1, 1, np.nan, 1]}, r"^weights\[3\] = nan: not a finite number"),
    ],
)
def test_refused(options: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        smooth(None, walk(5, 30.0), **options)
