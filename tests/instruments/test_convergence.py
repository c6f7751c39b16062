"""Rates of iterations against theory, kinds of failure, and what the experiment makes of them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import BSpline

from quatspline.catalogue import scheme
from quatspline.curve import Curve
from quatspline.discovery import shipped
from quatspline.instruments import convergence
from quatspline.instruments.continuity import jumps
from quatspline.runs.experiment import Run
from quatspline.solving import SolveReport
from quatspline.system.loading import load
from quatspline.trajectories.walks import walk

UNEVEN = np.array([0.0, 1.0, 1.3, 3.3, 4.0, 4.2, 6.0])
LINEAR = [("nielson", "jacobi"), ("nielson", "gauss-seidel"), ("kim", "fixed-point")]


# -- theory -------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [3, 5, 17, 60])
def test_uniform_knots_have_the_rate_in_closed_form(count):
    times = 0.7 * np.arange(count)
    jacobi = 0.5 * np.cos(np.pi / (count - 1))
    assert convergence.theoretical_rate("jacobi", times) == pytest.approx(jacobi, abs=1e-12)
    # eigenvalues near 0 of a matrix with Jordan blocks are found to the root of the rounding only
    got = convergence.theoretical_rate("gauss-seidel", times)
    assert got == pytest.approx(jacobi**2, abs=1e-7)


def test_gauss_seidel_is_the_square_of_jacobi_for_tridiagonal_equations():
    jacobi, seidel = (convergence.theoretical_rate(m, UNEVEN) for m in ("jacobi", "gauss-seidel"))
    assert seidel == pytest.approx(jacobi**2, rel=1e-9)


def test_flat_equations_are_the_collocation_of_the_b_spline():
    h = np.diff(UNEVEN)
    before, after = np.cumsum(h[:3][[0, 1, 2]]), np.cumsum(h[::-1][:3])
    knots = np.concatenate([UNEVEN[0] - before[::-1], UNEVEN, UNEVEN[-1] + after])
    design = BSpline.design_matrix(UNEVEN[1:-1], knots, 3).toarray()
    inner = design[:, 2:-2]  # less the controls d_0, d_{n-1} and those beyond
    np.testing.assert_allclose(convergence.flat_equations(UNEVEN), inner, atol=1e-15)


def test_other_iterations_have_no_theory():
    assert np.isnan(convergence.theoretical_rate("newton", UNEVEN))
    assert np.isnan(convergence.theoretical_rate(None, UNEVEN))


# -- measured -----------------------------------------------------------------------------------


class Halving(Curve):
    """Its iteration reduces the change by a known factor a track, down to rounding."""

    title, reference, order, continuity = "Halving", "none", 1, 0
    support, constant_rate, iterative = None, "no", True
    batched = True
    factors = np.array([0.9, 0.5, 0.01, 1.5])

    def _fit(self, keyframes, *, tolerance=1e-6, max_iterations=9, on_failure="raise"):
        change = 0.1 * self.factors**max_iterations + 1e-16
        done = change < tolerance
        report = SolveReport("h", "change", max_iterations, change, change, done, tolerance)
        self._conclude(report, on_failure)

    def _orientation(self, t):
        raise NotImplementedError


def test_a_known_rate_is_measured():
    q = walk(np.random.default_rng(0), 5, 30.0, 4)
    rates = convergence.measured_rate(Halving, np.arange(5.0), q, None)
    np.testing.assert_allclose(rates, [0.9, 0.5, 0.01, np.nan], rtol=1e-6)


@pytest.mark.parametrize("times", [np.arange(7.0), UNEVEN], ids=["uniform", "uneven"])
@pytest.mark.parametrize(("name", "method"), LINEAR)
def test_small_steps_converge_at_the_theoretical_rate(name, method, times):
    q = walk(np.random.default_rng(1), 7, 1.0, 3)
    rates = convergence.measured_rate(scheme(name), times, q, method)
    np.testing.assert_allclose(rates, convergence.theoretical_rate(method, times), rtol=0.02)


def test_newton_is_faster_than_linear():
    q = walk(np.random.default_rng(1), 7, 60.0, 3)
    assert (convergence.measured_rate(scheme("kim"), UNEVEN, q, "newton") < 0.02).all()


def test_failures_are_told_by_kind():
    report = SolveReport(
        method="m",
        stop="residual",
        iterations=np.array([5, 20, 7, 9, 3, 20]),
        change=np.array([1e-7, 1e-2, 1e-9, 0.1, np.nan, np.inf]),
        residual=np.array([1e-8, 0.1, 0.2, 0.3, np.nan, np.inf]),
        converged=np.array([True, False, False, False, False, False]),
        tolerance=1e-6,
    )
    counts = {"limit": 1, "wrong": 1, "gave_up": 1, "not_finite": 2}
    assert convergence.failures(report, 20) == counts


def test_solvers_are_found_by_what_a_scheme_declares():
    assert convergence.methods(scheme("nielson")) == ("jacobi", "gauss-seidel", "newton")
    assert convergence.methods(scheme("min-torque")) == (None,)


def test_jumps_of_one_order_are_those_of_the_whole_table():
    curve = scheme("nielson")(UNEVEN, walk(np.random.default_rng(2), 7, 40.0)[:, 0])
    whole = jumps(curve).query("order == 2").reset_index(drop=True)
    assert jumps(curve, orders=[2]).equals(whole)


# -- the experiment -----------------------------------------------------------------------------


def measured(name: str, method: str | None = None, **cell) -> dict:
    module = load(shipped("experiments") / "convergence.py", "experiment")
    cell = {"step_degrees": 60, "unevenness": 1, "keyframes": 5} | cell
    return module.measure_cell(Run(quick=True), name, method, **cell)


def test_a_cell_counts_every_set_once():
    row = measured("nielson", "jacobi", step_degrees=170, unevenness=10)
    failed = sum(row[f"failed_{kind}"] for kind in convergence.FAILURES)
    assert row["sets"] == 20
    assert round(row["share_converged"] * 20) + failed == 20
    assert failed > 0
    assert row["failure"] is None


def test_what_takes_too_long_is_over_budget():
    row = measured("min-torque", keyframes=1000)
    assert row["failure"].startswith("over budget")
    assert row["sets"] == 0


def test_the_silent_stop_shows_as_a_jump():
    calm = measured("scipy-rotation-spline")
    hard = measured("scipy-rotation-spline", step_degrees=170, unevenness=10, keyframes=9)
    assert calm["share_jumping"] == 0.0
    assert calm["jump_worst"] < 1e-6
    assert hard["share_jumping"] > 0.0
    assert hard["jump_worst"] > 1e-4


def test_cells_hold_what_iterates_and_what_solves_silently():
    module = load(shipped("experiments") / "convergence.py", "experiment")
    names = {cell["scheme"] for cell in module.cells(Run(quick=True))}
    assert {"nielson", "kim", "spherical-average", "min-torque", "scipy-rotation-spline"} <= names
    assert not names & {"slerp", "quartic", "splines-squad"}
