"""The least-torque reference: golden energies, the equation of Riemannian cubics, its reports."""

from typing import Any

import numpy as np
import pytest

import quatspline as qs
from golden import GOLDEN, KNOTS, Q
from quatspline.curve import Curve
from quatspline.trajectories.sets import step_sets
from walks import spin, uneven, walk

TIMES = KNOTS["nonuniform"]
LEAST = GOLDEN["schemes"]["min_torque"]


@pytest.mark.parametrize("subintervals", [1, 2, 4, 8, 16, 32])
def test_golden_energies(subintervals: int) -> None:
    curve = qs.build("min-torque", TIMES, Q, subintervals=subintervals, tolerance=1e-9)
    assert curve.energy[0] == pytest.approx(LEAST["E_by_m"][str(subintervals)], abs=2e-10)
    assert curve.solve_report.iterations <= 12


def test_golden_velocities() -> None:
    """The golden run stopped some 1e-8 from its minimum, whose energy is flat there."""
    curve = qs.build("min-torque", TIMES, Q, subintervals=32, tolerance=1e-10)
    assert np.abs(curve(TIMES, 1) - np.array(LEAST["omega_knots"])).max() < 2e-7
    wanted = [0.901148534, 0.392833103, -0.033305734, -0.180289216]
    assert np.abs(curve(1.2) - wanted).max() < 3e-8


def test_energy_is_that_of_the_curve() -> None:
    t, q = uneven(7), walk(7, 80.0)
    curve = qs.build("min-torque", t, q)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    knots = curve.segment_knots
    lo, h = knots[:-1, None], np.diff(knots)[:, None]
    alpha = curve(lo + 0.5 * h * (nodes + 1), 2)
    total = np.sum(0.5 * h * weights * np.sum(alpha**2, axis=-1))
    assert total == pytest.approx(curve.energy[0], rel=1e-12)


def energy(curve: Curve) -> float:
    """The integral of |alpha|^2 by Gauss quadrature between keyframes."""
    nodes, weights = np.polynomial.legendre.leggauss(16)
    lo, h = curve.times[:-1, None], np.diff(curve.times)[:, None]
    alpha = curve(lo + 0.5 * h * (nodes + 1), 2)
    return float(np.sum(0.5 * h * weights * np.sum(alpha**2, axis=-1)))


@pytest.mark.parametrize(
    ("name", "given", "golden"),
    [
        ("nielson", {"tolerance": 1e-12}, "niel_nat"),
        ("kim", {"tolerance": 1e-12}, "cumB_nat"),
        ("squad", {"ends": "secant"}, "squad"),
        ("hermite", {}, "kks3"),
        ("local-quintic", {}, None),
    ],
)
def test_no_other_curve_has_less(name: str, given: dict[str, Any], golden: str | None) -> None:
    other = energy(qs.build(name, TIMES, Q, **given))
    assert other > qs.build("min-torque", TIMES, Q).energy[0]
    if golden:
        assert other == pytest.approx(GOLDEN["energies_nonuniform_K5"][golden], abs=1e-6)


def test_it_is_a_riemannian_cubic() -> None:
    """omega''' = omega'' x omega inside intervals, and no torque at the ends."""
    curve = qs.build("min-torque", TIMES, Q, subintervals=32, tolerance=1e-9)
    assert np.abs(curve(TIMES[[0, -1]], 2)).max() < 1e-4
    h = 0.02
    stencil = np.arange(-4, 5)
    for t in 0.5 * (TIMES[1:] + TIMES[:-1]):
        omega = curve(t + h * stencil, 1)
        fit = np.polynomial.polynomial.polyfit(h * stencil, omega, 5)
        left, right = 6.0 * fit[3], np.cross(2.0 * fit[2], fit[0])
        assert np.abs(left - right).max() < 0.02 * np.abs(right).max()


@pytest.mark.parametrize("degrees", [30.0, 120.0, 160.0])
def test_c2_and_interpolation(degrees: float) -> None:
    t, q = uneven(9), walk(9, degrees)
    curve = qs.build("min-torque", t, q)
    knots = curve.segment_knots[1:-1]
    for order in (0, 1, 2):
        jump = curve(knots, order) - curve(np.nextafter(knots, 0.0), order)
        assert np.abs(jump).max() < 1e-11 * max(1.0, np.abs(curve(knots, 2)).max())
    assert np.abs(curve(t) - curve.quaternions).max() < 1e-14


def test_constant_spin_costs_nothing() -> None:
    t = uneven(8)
    curve = qs.build("min-torque", t, spin(t, [1.0, 2.0, 2.0], 1.5))
    s = np.linspace(t[0], t[-1], 301)
    assert curve.energy[0] < 1e-20
    assert np.abs(curve(s, 1) - 0.5 * np.array([1.0, 2.0, 2.0])).max() < 1e-12


def test_two_keyframes_are_an_arc() -> None:
    curve = qs.build("min-torque", [0.0, 2.0], [[1.0, 0.0, 0.0, 0.0], [0.8, 0.6, 0.0, 0.0]])
    assert np.abs(curve(np.linspace(0.0, 2.0, 9), 2)).max() < 1e-12


def test_tracks_are_single_curves() -> None:
    t = uneven(6)
    q = np.stack([walk(6, 70.0, seed) for seed in range(4)], axis=1).reshape(6, 2, 2, 4)
    curve = qs.build("min-torque", t, q)
    s = np.linspace(t[0], t[-1], 40)
    assert curve.solve_report.iterations.shape == (2, 2)
    for index in np.ndindex(2, 2):
        single = qs.build("min-torque", t, q[:, *index])
        assert single.solve_report.iterations == curve.solve_report.iterations[index]
        assert np.abs(curve(s)[:, *index] - single(s)).max() < 1e-12


def test_too_few_iterations_are_told() -> None:
    t, q = uneven(9), walk(9, 120.0)
    with pytest.raises(qs.ConvergenceError) as caught:
        qs.build("min-torque", t, q, max_iterations=2)
    assert caught.value.report.iterations == 2
    curve = qs.build("min-torque", t, q, max_iterations=2, on_failure="return")
    assert not curve.solve_report.converged
    assert curve.solve_report.change > curve.solve_report.tolerance


def test_large_steps_converge() -> None:
    for degrees in (150.0, 170.0):
        for seed in range(5):
            curve = qs.build("min-torque", None, walk(20, degrees, seed))
            assert curve.solve_report.converged


@pytest.mark.parametrize("degrees", [60.0, 120.0, 170.0])
@pytest.mark.parametrize("count", [5, 9, 20])
def test_a_change_that_stalls_at_rounding_is_an_end(count: int, degrees: float) -> None:
    """With one sub-interval the change stalls at 1e-11: at a tolerance of 1e-12 updates ran out."""
    t, q = uneven(count), walk(count, degrees)
    curve = qs.build("min-torque", t, q, subintervals=1, tolerance=1e-12)
    report = curve.solve_report
    assert report.converged
    assert report.change < 1e-10
    assert report.iterations < 100
    near = qs.build("min-torque", t, q, subintervals=1, tolerance=1e-9)
    assert curve.energy[0] == pytest.approx(near.energy[0], rel=1e-13)


def test_one_that_does_not_stall_there_is_none() -> None:
    """Few updates, all of which fall: the end is that of the limit."""
    t, q = uneven(9), walk(9, 120.0)
    options = {"subintervals": 1, "tolerance": 1e-12, "on_failure": "return"}
    assert not qs.build("min-torque", t, q, max_iterations=6, **options).solve_report.converged


def test_tracks_may_rest_or_converge() -> None:
    t = uneven(9)
    q = np.stack([walk(9, 120.0), spin(t, [1.0, 2.0, 2.0], 1.5)], axis=1)
    report = qs.build("min-torque", t, q, subintervals=1, tolerance=1e-12).solve_report
    assert report.converged.tolist() == [True, True]
    assert report.change[1] <= 1e-12


def test_a_track_that_fails_is_named_by_its_index() -> None:
    t = uneven(9)
    still = np.broadcast_to([1.0, 0.0, 0.0, 0.0], (9, 2, 3, 4)).copy()
    still[:, 1, 2] = walk(9, 120.0)
    with pytest.raises(qs.ConvergenceError, match=r"did not converge on track \[1, 2\]: after 2 "):
        qs.build("min-torque", t, still, max_iterations=2)
    with pytest.raises(qs.ConvergenceError, match=r"did not converge on track \[4\]: after 2 "):
        qs.build("min-torque", t, still.reshape(9, 6, 4)[:, 1:], max_iterations=2)
    with pytest.raises(qs.ConvergenceError, match=r"did not converge: after 2 "):
        qs.build("min-torque", t, still[:, 1, 2], max_iterations=2)


@pytest.mark.parametrize(("degrees", "within"), [(50, 3e-5), (110, 4e-4), (150, 3e-3), (170, 7e-3)])
def test_one_subinterval_is_near(degrees: int, within: float) -> None:
    """The docstring's numbers, on sets of one step angle."""
    worst = 0.0
    for t, q in step_sets(degrees, 10):
        one, four = (
            qs.build("min-torque", t, q, subintervals=m, tolerance=1e-9).energy[0] for m in (1, 4)
        )
        worst = max(worst, one / four - 1.0)
    assert 0.3 * within < worst < within


def test_closed_is_refused() -> None:
    with pytest.raises(ValueError, match="closed=True"):
        qs.build("min-torque", None, walk(5, 40.0), closed=True)
