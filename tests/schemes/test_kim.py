"""The interpolating B-spline of Kim, Kim & Shin, and the block-tridiagonal solver behind it."""

from typing import Any

import numpy as np
import pytest

import quatspline as qs
from golden import GOLDEN, KNOTS, Q, assert_golden
from powers import powers
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.families.cumulative import ANGLES
from quatspline.fitting.block_tridiagonal import backward, forward, workspace
from quatspline.kernels.values import Mat, Vec
from quatspline.quaternion import FloatArray
from walks import walk

UNEVEN = KNOTS["nonuniform"]


def kim(times: Any, quaternions: Any, **given: Any) -> Curve:
    return qs.build("kim", times, quaternions, **given)


def miss(curve: Curve) -> float:
    """The largest miss at a keyframe, a rotation angle in rad, sign included."""
    q = curve.quaternions
    met = curve(curve.times[: len(q)])
    return float(
        2.0 * np.linalg.norm(quaternion.log(quaternion.mul(quaternion.conj(q), met)), axis=-1).max()
    )


@pytest.mark.parametrize("method", ["newton", "fixed-point"])
@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("kim_uniform_natural", {}),
        ("kim_nonuniform_natural", {}),
        ("kim_nonuniform_clamped_4pt", {"ends": "clamped"}),
        ("kim_closed", {"closed": True}),
    ],
)
def test_golden(name: str, given: dict[str, Any], method: str) -> None:
    knots = KNOTS[GOLDEN["schemes"][name]["knots"]]
    curve = kim(knots, Q, method=method, tolerance=1e-13, **given)
    assert_golden(curve, name, (1e-12, 1e-12, 1e-9))


def jumps(curve: Curve, order: int, h: float) -> float:
    """Largest difference across a knot, h before to h after; a closed curve's seam included."""
    t = curve.times[(0 if curve.closed else 1) : -1]
    return float(np.abs(curve(t + h, order) - curve(t - h, order)).max())


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-13])
@pytest.mark.parametrize("sign", [None, 1, -1])
@pytest.mark.parametrize("uniform", [True, False])
def test_twice_continuous_whatever_the_tolerance(
    tolerance: float, sign: int | None, uniform: bool
) -> None:
    n = 7 + (sign is not None)
    times = np.arange(float(n)) if uniform else np.cumsum([0, 1, 0.4, 0.9, 1.5, 0.6, 1.1, 0.8][:n])
    keys = walk(7, 50.0, seed=3)
    if sign is None:
        curve = kim(times, keys, tolerance=tolerance)
    else:
        curve = kim(times, keys, closed=True, align=False, closing_sign=sign, tolerance=tolerance)
    for order in range(3):
        assert jumps(curve, order, 1e-7) < 1e-4
        assert jumps(curve, order, 1e-10) < 1e-7
    # the control: what follows the acceleration does jump
    t = curve.times[2]
    before, at, after = (curve(t + s, 2) for s in (-1e-5, 0.0, 1e-5))
    assert np.abs(after - 2.0 * at + before).max() > 1e-6


@pytest.mark.parametrize("sign", [1, -1])
def test_closed_curve_returns_with_its_sign(sign: int) -> None:
    keys = walk(2, 80.0)
    for q in (keys, walk(3, 80.0), walk(6, 80.0)):
        times = np.cumsum(np.linspace(0.0, 2.0, len(q) + 1))
        curve = kim(times, q, closed=True, align=False, closing_sign=sign, tolerance=1e-12)
        assert miss(curve) < 1e-11
        np.testing.assert_allclose(curve(times[-1]), sign * q[0], atol=1e-11)


def test_natural_ends_have_no_acceleration() -> None:
    curve = kim(UNEVEN, Q, tolerance=1e-13)
    assert np.abs(curve(curve.times[[0, -1]], 2)).max() < 1e-11


def test_two_keyframes_make_a_slerp() -> None:
    t = np.linspace(1.0, 3.0, 9)
    for given in ({}, {"ends": "clamped"}):
        curve = kim([1.0, 3.0], Q[:2], **given)
        expected = quaternion.slerp(Q[0], Q[1], (t - 1.0) / 2.0)
        np.testing.assert_allclose(curve(t), expected, atol=1e-15)


def test_a_constant_spin_stays_one() -> None:
    axis = np.array([0.6, 0.0, 0.8])
    for times in (np.arange(6.0), np.array([0.0, 0.3, 1.7, 2.0, 3.5, 3.9])):
        q = quaternion.exp(0.5 * 1.1 * times[:, None] * axis)
        for ends in ("natural", "clamped"):
            curve = kim(times, q, ends=ends, tolerance=1e-13)
            t = np.linspace(0.0, times[-1], 57)
            np.testing.assert_allclose(
                curve(t, 1), np.broadcast_to(1.1 * axis, (57, 3)), atol=1e-11
            )
            assert np.abs(curve(t, 2)).max() < 1e-10


def test_clamped_ends_have_the_given_velocities() -> None:
    keys = np.stack([walk(6, 60.0, seed) for seed in (1, 2)], axis=1)
    start, end = np.array([0.3, -1.0, 0.4]), np.array([[0.1, 0.2, -0.5], [1.0, 0.0, 0.3]])
    times = np.array([0.0, 0.7, 1.9, 2.6, 4.0, 4.5])
    curve = kim(
        times, keys, ends="clamped", start_velocity=start, end_velocity=end, tolerance=1e-13
    )
    np.testing.assert_allclose(curve(0.0, 1), np.broadcast_to(start, (2, 3)), atol=1e-12)
    np.testing.assert_allclose(curve(4.5, 1), end, atol=1e-12)
    assert miss(curve) < 1e-12
    alone = kim(
        times,
        keys[:, 1],
        ends="clamped",
        start_velocity=start,
        end_velocity=end[1],
        tolerance=1e-13,
    )
    np.testing.assert_array_equal(curve(1.3)[1], alone(1.3))


def test_tracks_are_those_of_single_curves() -> None:
    keys = np.stack([walk(9, 70.0, seed) for seed in range(3)], axis=1)
    curve = kim(None, keys)
    assert curve.solve_report is not None
    assert curve.solve_report.iterations.shape == (3,)
    for k in range(3):
        np.testing.assert_array_equal(curve(2.3)[k], kim(None, keys[:, k])(2.3))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"start_velocity": [0.0, 0.0, 1.0]}, "start_velocity: only with ends='clamped'"),
        ({"ends": "clamped", "end_velocity": [0.0, 1.0]}, "end_velocity has shape"),
        ({"ends": "clamped", "end_velocity": [0.0, np.nan, 1.0]}, "end_velocity.1. = nan"),
        ({"ends": "clamped", "closed": True}, "ends='clamped': a closed curve"),
        ({"ends": "free"}, "ends='free'"),
        ({"max_iterations": 0}, "max_iterations=0"),
    ],
)
def test_refusals(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        kim(None, Q, **given)


# -- convergence --------------------------------------------------------------------------------

# medians of the specification's tables, where a longer list of trials gave them
NEWTON = {9: (3, 4, 5, 5, 5, 6, 6), 100: (4, 4, 5, 6, 6, 7, 8), 10_000: (4, 5, 6, 7, 8, 8, 10)}
DEGREES = (20.0, 60.0, 90.0, 120.0, 135.0, 150.0, 165.0)


@pytest.mark.parametrize("n", NEWTON)
def test_newton_converges_on_every_walk(n: int) -> None:
    trials = {9: 40, 100: 20, 10_000: 1}[n]
    for degrees, expected in zip(DEGREES, NEWTON[n], strict=True):
        counts = []
        for seed in range(trials):
            curve = kim(None, walk(n, degrees, seed), align=False, tolerance=2e-12)
            assert curve.solve_report is not None
            assert miss(curve) <= 2.1e-12
            counts.append(curve.solve_report.iterations)
        assert abs(np.median(counts) - expected) <= 1 + (n == 10_000)


@pytest.mark.parametrize(("n", "degrees", "expected"), [(5, 60, 21), (9, 60, 26), (100, 60, 29)])
def test_fixed_point_takes_the_published_number_of_iterations(
    n: int, degrees: float, expected: int
) -> None:
    counts = []
    for seed in range(20):
        curve = kim(None, walk(n, degrees, seed), method="fixed-point", tolerance=2e-10)
        assert curve.solve_report is not None
        counts.append(curve.solve_report.iterations)
    assert abs(np.median(counts) - expected) <= 2


def test_both_methods_find_one_curve() -> None:
    q, t = walk(12, 60.0), np.linspace(0.0, 11.0, 101)
    newton = kim(None, q, tolerance=1e-13)
    published = kim(None, q, tolerance=1e-13, method="fixed-point")
    np.testing.assert_allclose(newton(t, 2), published(t, 2), atol=1e-10)


def test_a_hundred_thousand_keyframes() -> None:
    curve = kim(None, walk(100_000, 60.0), tolerance=1e-12)
    assert curve.solve_report is not None
    assert curve.solve_report.iterations <= 6
    assert miss(curve) <= 1e-12


def test_what_is_reported_is_what_evaluation_gives() -> None:
    q = walk(200, 100.0)
    for tolerance in (1e-2, 1e-6, 1e-9, 1e-13):
        curve = kim(None, q, tolerance=tolerance)
        assert curve.solve_report is not None
        assert curve.solve_report.converged
        assert curve.solve_report.residual <= tolerance
        assert curve.solve_report.residual == pytest.approx(miss(curve), rel=1e-3, abs=3e-14)


def test_increments_may_exceed_half_a_turn() -> None:
    """Where the logarithms of the controls could not follow, the curve is as smooth as elsewhere."""
    curve = kim(None, walk(100, 165.0, seed=4), align=False, tolerance=1e-12)
    angles = curve.segments[0, :, ANGLES + 12 :]  # type: ignore[attr-defined]
    last = powers(angles)[:, 3]  # |w| u^3 / 6
    assert 6.0 * last[:-1].max() > np.pi
    assert miss(curve) < 1e-11
    for order in range(3):
        assert jumps(curve, order, 1e-9) < 1e-6


def test_uneven_knots_converge_where_a_solution_is_near() -> None:
    for ratio, degrees, least in ((3.0, 120.0, 10), (10.0, 60.0, 10), (30.0, 30.0, 9)):
        done = 0
        for seed in range(10):
            h = np.exp(np.random.default_rng(seed).uniform(0.0, np.log(ratio), 49))
            times = np.concatenate([[0.0], np.cumsum(h)])
            try:
                curve = kim(times, walk(50, degrees, seed), align=False, tolerance=1e-12)
            except qs.ConvergenceError:
                continue
            assert miss(curve) < 1e-11
            done += 1
        assert done >= least


def test_stop_by_change() -> None:
    q = walk(30, 60.0)
    for method in ("newton", "fixed-point"):
        curve = kim(None, q, stop="change", tolerance=1e-8, method=method)
        report = curve.solve_report
        assert report is not None
        assert report.stop == "change"
        assert 0.0 < report.change <= 1e-8
        assert miss(curve) < 1e-7


@pytest.mark.parametrize(
    ("n", "given"),
    [
        (100, {"method": "fixed-point", "max_iterations": 200}),
        (100, {"max_iterations": 2}),
        (100, {"max_iterations": 2, "stop": "change"}),
        (9, {"tolerance": 1e-18}),
    ],
)
def test_no_convergence_is_never_silent(n: int, given: dict[str, Any]) -> None:
    q = walk(n, 150.0)
    with pytest.raises(qs.ConvergenceError, match="did not converge") as caught:
        kim(None, q, align=False, **given)
    report = caught.value.report
    assert not report.converged
    assert report.iterations <= given.get("max_iterations", 200)
    curve = kim(None, q, align=False, on_failure="return", **given)
    assert curve.solve_report == report
    assert report.residual == pytest.approx(miss(curve), rel=1e-6, abs=1e-14)
    norms = np.linalg.norm(curve(np.linspace(0.0, n - 1.0, 50)), axis=1)
    np.testing.assert_allclose(norms, 1.0, atol=1e-12)


# -- the solver ---------------------------------------------------------------------------------


def dense(blocks: tuple[FloatArray, FloatArray, FloatArray], cyclic: bool) -> FloatArray:
    n = len(blocks[0])
    matrix = np.zeros((n, 3, n, 3))
    for k in range(n):
        for shift, block in zip((-1, 0, 1), blocks, strict=True):
            if cyclic or 0 <= k + shift < n:
                matrix[k, :, (k + shift) % n] += block[k]
    return matrix.reshape(3 * n, 3 * n)


@pytest.mark.parametrize(
    ("n", "cyclic"),
    [(1, False), (2, False), (3, False), (40, False)] + [(n, True) for n in (2, 3, 4, 40)],
)
def test_block_tridiagonal(n: int, cyclic: bool) -> None:
    rng = np.random.default_rng(n)
    lower, diagonal, upper = rng.normal(size=(3, n, 3, 3))
    # dominant after a permutation of each block's rows: without pivoting, zero pivots
    diagonal = 0.3 * diagonal + 6.0 * np.eye(3)[[1, 2, 0]]
    diagonal[:, 0, 0] = 0.0
    rhs = rng.normal(size=(n, 3))
    work = workspace(n, cyclic)
    for k in range(n):
        row = (Mat(*(Vec(*c) for c in m[k].T)) for m in (lower, diagonal, upper))
        forward(k, n, cyclic, *row, Vec(*rhs[k]), work)
    backward(n, cyclic, work)
    x = work[3]
    expected = np.linalg.solve(dense((lower, diagonal, upper), cyclic), rhs.reshape(-1))
    np.testing.assert_allclose(x.reshape(-1), expected, rtol=0, atol=1e-12 * np.abs(expected).max())
