"""The least-torque reference: golden energies, the equation of Riemannian cubics, its reports."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import quatspline as qs
from quatspline.curve import Curve
from walks import spin, uneven, walk

GOLDEN = json.loads((Path(__file__).parent / "data" / "golden.json").read_text())
KEYFRAMES = np.array(GOLDEN["meta"]["q"], dtype=float)
TIMES = np.array(GOLDEN["meta"]["t_nonuniform"], dtype=float)
LEAST = GOLDEN["schemes"]["min_torque"]


@pytest.mark.parametrize("subintervals", [1, 2, 4, 8, 16, 32])
def test_golden_energies(subintervals: int) -> None:
    curve = qs.build("min-torque", TIMES, KEYFRAMES, subintervals=subintervals, tolerance=1e-9)
    assert curve.energy[0] == pytest.approx(LEAST["E_by_m"][str(subintervals)], abs=2e-10)
    assert curve.solve_report.iterations <= 12


def test_golden_velocities() -> None:
    """The golden run stopped some 1e-8 from its minimum, whose energy is flat there."""
    curve = qs.build("min-torque", TIMES, KEYFRAMES, subintervals=32, tolerance=1e-10)
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
    other = energy(qs.build(name, TIMES, KEYFRAMES, **given))
    assert other > qs.build("min-torque", TIMES, KEYFRAMES).energy[0]
    if golden:
        assert other == pytest.approx(GOLDEN["energies_nonuniform_K5"][golden], abs=1e-6)


def test_it_is_a_riemannian_cubic() -> None:
    """omega''' = omega'' x omega inside intervals, and no torque at the ends."""
    curve = qs.build("min-torque", TIMES, KEYFRAMES, subintervals=32, tolerance=1e-9)
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


def test_closed_is_refused() -> None:
    with pytest.raises(ValueError, match="closed=True"):
        qs.build("min-torque", None, walk(5, 40.0), closed=True)
