"""Spherical averages: the mean itself, the published numbers, the solve and its report."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import quatspline as qs
from golden import GOLDEN, KNOTS, Q, assert_golden
from quatspline import quaternion
from quatspline.families import means
from quatspline.kernels.values import Quat
from quatspline.quaternion import FloatArray
from smoothness import assert_joined, assert_own_rates, motion
from walks import apart, apart_up_to_sign, inside, spin, uneven, walk

TIGHT = 1e-12


def build(times: Any, q: FloatArray, **given: Any) -> Any:
    return qs.build("spherical-average", times, q, **{"tolerance": TIGHT, **given})


def test_golden() -> None:
    golden = GOLDEN["schemes"]["buss_fillmore_natural"]
    curve = build(KNOTS[golden["knots"]], Q)
    assert_golden(curve, "buss_fillmore_natural", (1e-10, 1e-10, 1e-8))
    controls = curve.segments[0, :, :16].reshape(-1, 4, 4)
    d = np.array(golden["d"], float)
    for i, four in enumerate(controls):
        assert apart(four, d[i : i + 4]) < 1e-10


def test_mean_solves_its_equation() -> None:
    rng = np.random.default_rng(1)
    for spread in (1e-6, 0.3, 1.0):
        for _ in range(20):
            v = rng.normal(size=(4, 3))
            v *= spread / np.linalg.norm(v, axis=1)[:, None]
            p = quaternion.mul(walk(2, 90.0)[1], quaternion.exp(v))
            w = rng.uniform(size=4)
            w /= w.sum()
            q = np.array(means.mean(tuple(Quat(*x) for x in p), tuple(w)))
            left = w @ quaternion.log(quaternion.mul(quaternion.conj(q), p))
            assert np.abs(left).max() < 1e-15
            assert abs(np.linalg.norm(q) - 1.0) < 1e-15


def case(kind: str) -> tuple[FloatArray, FloatArray, dict[str, Any]]:
    ends = kind in ("natural", "clamped")
    knots, q, given = motion("open" if ends else kind, 9, 60.0)
    return knots, q, {"ends": kind} if ends else given


KINDS = ["natural", "clamped", "closed +", "closed -"]


@pytest.mark.parametrize("kind", KINDS)
def test_rates_and_joins(kind: str) -> None:
    knots, q, given = case(kind)
    curve = build(knots, q, **given)
    assert apart(curve(knots[: len(q)]), curve.quaternions) < 1e-11
    assert_own_rates(curve, inside(knots, 6), (1e-8, 1e-6))
    assert_joined(curve)


def test_ends() -> None:
    knots, q, _ = case("natural")
    natural, clamped = build(knots, q), build(knots, q, ends="clamped")
    assert np.abs(natural(knots[[0, -1]], 2)).max() < 1e-11
    assert np.linalg.norm(clamped(knots[[0, -1]], 2), axis=1).min() > 1e-2
    assert np.linalg.norm(clamped(knots[[0, -1]], 1), axis=1).min() > 1e-2


def test_clamped_ends_keep_the_order() -> None:
    def motion(t: FloatArray) -> FloatArray:
        a = np.stack([0.8 * np.sin(1.1 * t), 0.6 * np.cos(0.7 * t + 0.3), 0.5 * np.sin(1.7 * t)], 1)
        return quaternion.exp(a)

    errors = []
    for count in (81, 161):
        knots = np.linspace(0.0, 10.0, count)
        curve = build(knots, motion(knots), ends="clamped")
        t = inside(knots, 5)
        errors.append(apart_up_to_sign(curve(t), motion(t)))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.3)


def test_time_runs_backwards_as_well() -> None:
    knots, q, _ = case("natural")
    t = inside(knots, 3)
    backward = build(knots[-1] - knots[::-1], q[::-1])
    assert apart_up_to_sign(backward(knots[-1] - t), build(knots, q)(t)) < 1e-11


def test_a_spin_stays_a_spin() -> None:
    knots = uneven(7)
    curve = build(knots, spin(knots, (1.0, 2.0, -2.0), 1.5))
    t = inside(knots, 5)
    assert np.abs(np.linalg.norm(curve(t, 1), axis=1) - 1.5).max() < 1e-11
    assert np.abs(curve(t, 2)).max() < 1e-9


@pytest.mark.parametrize(("degrees", "most"), [(20.0, 3), (90.0, 4), (120.0, 5)])
def test_iterations(degrees: float, most: int) -> None:
    """Newton converges as measured for the specification, 100 keyframes at even times."""
    for seed in range(5):
        report = build(None, walk(100, degrees, seed), tolerance=1e-10).solve_report
        assert report.converged
        assert report.iterations <= most
        assert report.residual <= 1e-10


def test_report_of_both_rules() -> None:
    q = walk(12, 80.0)
    loose, tight = (build(None, q, tolerance=t).solve_report for t in (1e-2, 1e-11))
    assert loose.iterations < tight.iterations
    assert tight.residual <= 1e-11
    assert (tight.method, tight.stop, tight.tolerance) == ("newton", "residual", 1e-11)
    change = build(None, q, stop="change", tolerance=1e-6).solve_report
    assert change.stop == "change"
    assert change.change <= 1e-6
    assert change.converged


def test_failure_is_not_silent() -> None:
    """Steps of 165 degrees at very uneven times: no solution on principal logarithms is found."""
    q = walk(30, 165.0)
    knots = np.cumsum(np.resize([1.0, 0.05, 0.6], 30))
    with pytest.raises(qs.ConvergenceError, match="spherical-average") as caught:
        build(knots, q)
    assert not caught.value.report.converged
    curve = build(knots, q, on_failure="return")
    assert not curve.solve_report.converged
    t = inside(knots, 5)
    assert np.abs(np.linalg.norm(curve(t), axis=1) - 1.0).max() < 1e-13
    assert np.isfinite(curve(t, 2)).all()


def test_no_unknowns() -> None:
    """Two keyframes: slerp, nothing to iterate."""
    q = walk(2, 100.0)
    curve = build([0.0, 2.0], q)
    assert curve.solve_report.iterations == 0
    t = np.linspace(0.0, 2.0, 9)
    assert apart(curve(t), quaternion.slerp(q[0], curve.quaternions[1], t / 2.0)) < 1e-13
    assert math.isclose(np.linalg.norm(curve(1.0, 1)), math.radians(50.0), rel_tol=1e-12)


def test_tracks() -> None:
    knots = uneven(7)
    q = np.stack([walk(7, 40.0 + 10 * seed, seed) for seed in range(6)], axis=1).reshape(7, 2, 3, 4)
    curve = build(knots, q)
    t = inside(knots, 3)
    single = build(knots, q[:, 1, 2])
    for order in range(3):
        assert np.array_equal(curve(t, order)[:, 1, 2], single(t, order))
    assert curve.solve_report.iterations.shape == (2, 3)
