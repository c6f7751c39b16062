"""Least squares on fewer knots: scipy's spline on one axis, curves of the space, knots and what they need."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import BSpline, make_lsq_spline
from test_claims import smooth_motion

import quatspline as qs
from quatspline import quaternion
from quatspline.findings.candidates import near
from quatspline.fitting.knots import knots_of
from quatspline.quaternion import FloatArray
from quatspline.trajectories.figure_walk import figure_walk
from walks import apart, apart_up_to_sign, inside, random_units, spin, uneven, walk

SMOOTH = ("smoothing-spline", "least-squares")

AXIS = np.array([0.6, 0.0, 0.8])


def fit(times: Any, q: Any, **options: Any) -> Any:
    return qs.build("least-squares", times, q, **options)


def about_axis(angles: FloatArray) -> FloatArray:
    return quaternion.exp(0.5 * angles[:, None] * AXIS)


def clamped(knots: FloatArray) -> FloatArray:
    return np.concatenate([[knots[0]] * 3, knots, [knots[-1]] * 3])


# -- one axis -----------------------------------------------------------------------------------


@pytest.mark.parametrize("inner", [[], [9.0], [2.0, 5.0, 6.0, 9.3, 15.0, 20.0]], ids=len)
@pytest.mark.parametrize("weighted", [False, True])
def test_scipys_on_one_axis(inner: list[float], weighted: bool) -> None:
    rng = np.random.default_rng(1)
    t = uneven(41)
    angles = 0.4 * np.sin(t) + 0.05 * rng.normal(size=41)
    w = rng.uniform(0.5, 2.0, 41) if weighted else np.ones(41)
    curve = fit(t, about_axis(angles), knots=inner, weights=w)
    knots = np.concatenate([t[:1], inner, t[-1:]])
    theirs = make_lsq_spline(t, angles, clamped(knots), w=np.sqrt(w))
    x = np.linspace(t[0], t[-1], 301)
    assert np.abs(2.0 * quaternion.log(curve(x)) @ AXIS - theirs(x)).max() < 4e-15
    for order in (1, 2):
        assert np.abs(curve(x, order) - theirs(x, order)[:, None] * AXIS).max() < 2e-14
    assert np.abs(2.0 * quaternion.log(curve.controls) @ AXIS - theirs.c).max() < 4e-15
    assert np.array_equal(curve.knots, knots - t[0])


@pytest.mark.parametrize("degrees", [40.0, 120.0, 170.0])
@pytest.mark.parametrize("knots", [0, 3, None])
def test_a_spin_is_kept_whatever_it_turns_between_knots(degrees: float, knots: Any) -> None:
    """Up to 16 steps of 170 degrees on one segment: controls are two and a half turns apart."""
    t = np.arange(17.0)
    q = spin(t, (1.0, 2.0, -1.0), np.radians(degrees), random_units(1, 3)[0])
    curve = fit(t, q, knots=knots)
    assert apart(curve(t), q) < 1e-12
    speed = np.linalg.norm(curve(np.linspace(0.0, 16.0, 99), 1), axis=1)
    assert np.abs(speed - np.radians(degrees)).max() < 1e-11


# -- rotations ----------------------------------------------------------------------------------


def misses(curve: Any, q: FloatArray, t: FloatArray) -> float:
    return float(np.sum(quaternion.distance(curve(t), q) ** 2))


def test_a_curve_of_the_space_is_recovered() -> None:
    t, x = uneven(13), np.linspace(0.0, uneven(13)[-1], 60)
    original = fit(t, walk(13, 50.0), knots=4)
    again = fit(x, original(x), knots=original.knots[1:-1])
    s = np.linspace(0.0, t[-1], 200)
    assert apart(again(s), original(s)) < 1e-13
    assert apart(again.controls, original.controls) < 1e-12


def test_as_many_controls_as_keyframes_interpolate() -> None:
    for n in (4, 5, 9, 20):
        t = np.linspace(0.0, 0.4 * n, n)
        curve = fit(t, smooth_motion(t), knots=n - 4)
        assert apart(curve(curve.times), curve.quaternions) < 1e-12


def control_turned(curve: Any, j: int, turn: FloatArray, t: FloatArray) -> FloatArray:
    """The curve with a control turned, written once more from scipy's basis functions."""
    d = curve.controls.copy()
    d[j] = quaternion.mul(d[j], quaternion.exp(turn))
    basis = BSpline(clamped(curve.knots), np.eye(len(d)), 3)(t)
    share = np.cumsum(basis[:, ::-1], axis=1)[:, ::-1]
    q = np.broadcast_to(d[0], (len(t), 4))
    for k in range(1, len(d)):
        w = quaternion.log(quaternion.mul(quaternion.conj(d[k - 1]), d[k]))
        q = quaternion.mul(q, quaternion.exp(share[:, k, None] * w))
    return q


def test_no_turn_of_a_control_is_better() -> None:
    t, q, step = uneven(15), walk(15, 40.0), 1e-4
    weights = np.random.default_rng(5).uniform(0.5, 2.0, 15)
    curve = fit(t, q, knots=4, weights=weights)
    assert apart(control_turned(curve, 0, np.zeros(3), t), curve(t)) < 1e-13

    def cost(j: int, turn: FloatArray) -> float:
        gaps = quaternion.distance(control_turned(curve, j, turn, t), q)
        return float(np.sum(weights * gaps**2))

    least = cost(0, np.zeros(3))
    assert least > 0.01
    for j in range(len(curve.controls)):
        for axis in np.eye(3):
            low, high = cost(j, -step * axis), cost(j, step * axis)
            assert min(low, high) > least
            assert abs(high - low) < 1e-8 * step * least + 1e-13


def test_more_knots_miss_less() -> None:
    t, q = uneven(33), walk(33, 20.0)
    nested = [misses(fit(t, q, knots=t[k:-1:k]), q, t) for k in (16, 8, 4, 2)]
    assert np.all(np.diff(nested) < 0.0)


def test_what_it_is_for() -> None:
    """Of a walking figure's frames one in four: nearer than a curve through those, not so if fitted to those."""
    motion = figure_walk(97)
    t, q = motion.times, motion.quaternions
    kept = slice(None, None, 4)
    through = qs.build("local-quintic", t[kept], q[kept])
    of_all, of_kept = fit(t, q, knots=t[kept][1:-1]), fit(t[kept], q[kept])
    assert misses(of_all, q, t) < misses(through, q, t) < misses(of_kept, q, t)


def test_the_order_of_finer_knots() -> None:
    errors = []
    for size in (321, 641, 1281):
        knots = np.linspace(0.0, 10.0, size)
        curve = fit(knots, smooth_motion(knots))
        t = inside(knots, 4)
        t = t[(t > 3.0) & (t < 7.0)]
        errors.append(apart_up_to_sign(curve(t), smooth_motion(t)))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(3.0, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(3.0, abs=0.1)


def test_backwards_it_is_another_near_one() -> None:
    t, q = uneven(15), walk(15, 20.0)
    there, back = (
        fit(t, q, knots=t[3:12:4]),
        fit(t[-1] - t[::-1], q[::-1], knots=t[-1] - t[11:2:-4]),
    )
    gap = apart_up_to_sign(there(t), back(t[-1] - t))
    assert 1e-4 < gap < 0.1 * apart_up_to_sign(there(t), q)


def test_a_keyframe_of_little_weight_is_left_out() -> None:
    t, q = uneven(15), walk(15, 30.0)
    weights = np.ones(15)
    weights[7] = 1e-9
    inner = t[[3, 7, 11]]
    without = fit(np.delete(t, 7), np.delete(q, 7, axis=0), knots=inner)
    assert apart(fit(t, q, knots=inner, weights=weights)(t), without(t)) < 1e-7


def test_tracks_and_engines_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    t, q = uneven(21), np.stack([walk(21, 40.0, seed) for seed in range(2)], axis=1)
    curves = []
    for engine in ("python", "compiled"):
        monkeypatch.setenv("QUATSPLINE_ENGINE", engine)
        curves.append(fit(t, q, knots=6))
    assert curves[0].controls.shape == (10, 2, 4)
    assert apart(curves[0].controls, curves[1].controls) < 1e-11
    assert curves[0].solve_report.converged.shape == (2,)


def test_what_does_not_converge_is_told() -> None:
    t, q = uneven(16), walk(16, 120.0)
    with pytest.raises(qs.ConvergenceError, match=r"^least-squares \(levenberg\) did not converge"):
        fit(t, q, max_iterations=3)
    curve = fit(t, q, max_iterations=3, on_failure="return")
    assert (curve.solve_report.iterations, curve.solve_report.converged) == (3, False)


# -- knots --------------------------------------------------------------------------------------


@pytest.mark.parametrize("n", [4, 5, 6, 11, 50])
def test_any_number_of_knots_serves(n: int) -> None:
    frames = qs.build("slerp", uneven(n), walk(n, 30.0)).keyframes
    for count in range(n - 3):
        knots = knots_of(frames, count)
        assert knots.size == count + 2
        assert np.isin(knots, frames.knots).all()
        assert np.array_equal(knots_of(frames, knots[1:-1]), knots)  # they meet the condition
    assert knots_of(frames, None).size == max((n - 1) // 2, 1) + 1


def test_knots_in_the_unit_of_the_times() -> None:
    seconds = np.arange(13.0)
    q = walk(13, 30.0)
    wanted = fit(seconds, q, knots=[3.0, 7.0])
    start = np.datetime64("2026-01-01T00:00:00", "ns")
    moments = start + (seconds * 1e9).astype("timedelta64[ns]")
    dated = fit(moments, q, knots=moments[[3, 7]])
    assert np.array_equal(dated.knots, wanted.knots)
    assert apart(dated(moments), wanted(seconds)) < 1e-12
    late = fit(seconds + 1e9, q, knots=np.array([3.0, 7.0]) + 1e9)
    assert apart(late(seconds + 1e9), wanted(seconds)) < 1e-12


@pytest.mark.parametrize(
    ("knots", "message"),
    [
        (10, r"^knots=10: 13 keyframes take from 0 to 9 inside"),
        (-1, r"^knots=-1: 13 keyframes take from 0 to 9 inside"),
        (True, r"^knots"),
        ("many", r"^knots"),
        (2.5, r"^knots has shape \(\): expected times inside the domain"),
        ([[1.0, 2.0]], r"^knots has shape \(1, 2\): expected times inside"),
        ([1.0, np.nan], r"^knots\[1\] = nan"),
        ([3.0, 3.0], r"^knots\[1\] = 3.0: knots must increase"),
        ([0.0, 3.0], r"^knots\[0\] = 0.0: knots must increase"),
        ([3.0, 12.0], r"^knots\[1\] = 12.0: knots must increase"),
        (
            [4.1, 4.2, 4.3, 4.4, 4.5, 8.0],
            r"^knots: too many for the keyframes from 4.1 to 4.5 after the first",
        ),
        ([np.datetime64("2026-01-01")], r"^knots: datetime64\[D\], but the keyframes' times are"),
    ],
)
def test_refused(knots: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        fit(np.arange(13.0), walk(13, 30.0), knots=knots)


def test_the_condition_of_schoenberg_and_whitney_is_scipys() -> None:
    """What is refused has no unique solution, as scipy says of it; all else is fitted."""
    rng = np.random.default_rng(7)
    t, q = np.arange(10.0), walk(10, 20.0)
    refused = 0
    for _ in range(60):
        inner = np.sort(rng.uniform(0.0, 9.0, rng.integers(1, 7)))
        knots = clamped(np.concatenate([[0.0], inner, [9.0]]))
        least = np.linalg.svd(BSpline.design_matrix(t, knots, 3).toarray())[1].min()
        if least > 1e-2:
            fit(t, q, knots=inner, on_failure="return")
        elif least < 1e-14:
            refused += 1
            with pytest.raises(ValueError, match=r"^knots: too many"):
                fit(t, q, knots=inner)
    assert 5 < refused < 55


def test_it_is_not_taken_for_what_smooths_noise() -> None:
    """Fewer knots lessen noise whatever its size: `compare` advises what is told it."""
    rows = [{"failure": None, "noise": 0.01, "continuity": 2, "scheme": name} for name in SMOOTH]
    assert near(pd.DataFrame(rows), {}).tolist() == [True, False]
