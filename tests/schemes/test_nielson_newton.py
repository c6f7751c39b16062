"""Nielson's control quaternions by Newton's method, and the fixed points of his own iteration."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.quaternion import FloatArray
from walks import inside, loop, spin, uneven, walk

FEW_TIMES = [0.0, 2.191666666666667, 2.3]
FEW = [
    [0.9637362546798864, 0.2507631539745078, 0.09127032389743336, 0.0],
    [1.0, 0.0, 0.0, 0.0],
    [0.9188656012898233, 0.37077513881124263, 0.1349549511341332, 0.0],
]
"""Of a recording: steps of 31 and 46 degrees to and fro, spacings of ratio 20."""


def nielson(times: Any, q: Any, **given: Any) -> Any:
    return qs.build("nielson", times, q, **{"method": "newton", "tolerance": 1e-12, **given})


def apart(a: FloatArray, b: FloatArray) -> Any:
    """The angle in rad between quaternions, signs kept."""
    return 4.0 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))


def controls(curve: Curve, i: int) -> FloatArray:
    """q_i, R_i, L_{i+1} of segment i: where its three arcs begin."""
    return np.array([curve.segments[0, i, 9 * k : 9 * k + 4] for k in range(3)])  # type: ignore[attr-defined]


def turn(curve: Curve) -> float:
    """The length of the curve in rad."""
    t = np.linspace(*curve.domain, 4001)
    return float(np.trapezoid(np.linalg.norm(curve(t, 1), axis=-1), t))


def test_the_published_iteration_rests_at_a_wrong_fixed_point() -> None:
    with pytest.raises(qs.ConvergenceError, match="nielson") as caught:
        qs.build("nielson", FEW_TIMES, FEW)
    assert caught.value.report.change < 1e-15
    assert caught.value.report.residual == pytest.approx(0.3108, abs=1e-3)
    report = qs.build("nielson", FEW_TIMES, FEW, stop="change", on_failure="return").solve_report
    assert not report.converged


def test_newton_finds_the_right_curve_there() -> None:
    curve = nielson(FEW_TIMES, FEW)
    report = curve.solve_report
    assert (report.method, report.stop, bool(report.converged)) == ("newton", "residual", True)
    assert report.iterations <= 4
    # The keyframes turn about one axis all but 1e-5: the curve is the natural cubic spline of the angle.
    assert turn(curve) == pytest.approx(turn(qs.build("kim", FEW_TIMES, FEW)), rel=1e-9)
    knot = FEW_TIMES[1]
    assert np.abs(curve(knot, 1) - curve(np.nextafter(knot, 0.0), 1)).max() < 1e-10
    assert np.abs(curve(knot, 2) - curve(np.nextafter(knot, 0.0), 2)).max() < 1e-3


CASES: dict[str, tuple[FloatArray, FloatArray, dict[str, Any]]] = {
    "natural": (uneven(9), walk(9, 80.0), {}),
    "three": (uneven(3), walk(3, 100.0), {}),
    "stationary": (uneven(9), walk(9, 80.0), {"ends": "stationary"}),
    "tension": (uneven(9), walk(9, 80.0), {"tension": np.linspace(0.0, 6.0, 9)}),
    "closed +": (uneven(9), loop(uneven(9), 2), {"closed": True}),
    "closed -": (uneven(10), loop(uneven(10), 1), {"closed": True, "tension": 1.0}),
    "closed pair": (uneven(3), walk(2, 50.0), {"closed": True}),
    "long": (np.arange(200.0), walk(200, 110.0), {}),
}


@pytest.mark.parametrize("case", CASES)
def test_all_methods_find_one_curve(case: str) -> None:
    times, q, given = CASES[case]
    newton = nielson(times, q, **given)
    t = inside(times, 4)
    for method in ("jacobi", "gauss-seidel"):
        other = nielson(times, q, method=method, **given)
        assert apart(newton(t), other(t)).max() < 1e-9
        size = np.abs(other(t, 2)).max()
        assert np.abs(newton(t, 2) - other(t, 2)).max() < 1e-9 * size


@pytest.mark.parametrize("case", CASES)
def test_keyframes_lie_between_the_legs(case: str) -> None:
    """q_i = slerp(L_i, R_i, delta_i), read off the arcs of the finished curve."""
    times, q, given = CASES[case]
    curve = nielson(times, q, **given)
    h = np.diff(times)
    for i in range(1, len(q) - 1):
        _, _, left = controls(curve, i - 1)
        key, right, _ = controls(curve, i)
        delta = h[i - 1] / (h[i - 1] + h[i])
        assert apart(quaternion.slerp(left, right, delta), key) < 1e-13


def test_it_converges_quadratically() -> None:
    q, misses = walk(30, 100.0), []
    for limit in (1, 2, 3):
        curve = nielson(None, q, max_iterations=limit, tolerance=1e-15, on_failure="return")
        assert curve.solve_report.iterations == limit
        misses.append(curve.solve_report.residual)
    assert misses[1] < 2.0 * misses[0] ** 2
    assert misses[2] < max(2.0 * misses[1] ** 2, 1e-14)


def test_an_unfinished_solve_is_told_and_returns_a_curve() -> None:
    q = walk(30, 100.0)
    with pytest.raises(qs.ConvergenceError):
        nielson(None, q, max_iterations=1)
    curve = nielson(None, q, max_iterations=1, on_failure="return")
    assert not curve.solve_report.converged
    assert apart(curve(np.arange(30.0)), curve.quaternions).max() < 1e-13


def test_stop_by_change() -> None:
    report = nielson(None, walk(12, 90.0), stop="change", tolerance=1e-6).solve_report
    assert report.converged
    assert report.change <= 1e-6


def test_two_keyframes_and_spins() -> None:
    assert nielson(None, walk(2, 100.0)).solve_report.iterations == 0
    t = uneven(8)
    curve = nielson(t, spin(t, (1.0, 2.0, -2.0), 1.5))
    assert np.abs(curve(inside(t, 5), 1) - 1.5 * np.array([1, 2, -2]) / 3).max() < 1e-11


def test_tracks_are_single_curves() -> None:
    times, q = uneven(7), np.stack([walk(7, 60.0 + 10 * k, k) for k in range(5)], axis=1)
    curve, t = nielson(times, q), inside(uneven(7), 3)
    for k in range(5):
        assert np.array_equal(curve(t)[:, k], nielson(times, q[:, k])(t))


def uneven_sets(closed: bool, degrees: float, ratio: float) -> tuple[int, int, int]:
    """(sets, jacobi's failures, newton's) on 20 times 20 sets of 3 to 40 keyframes.

    Steps up to `degrees` about random axes, logarithms of spacings even up to a ratio.
    """
    failed = [0, 0]
    for group in range(20):
        rng = np.random.default_rng([11, group])
        n = int(rng.integers(3, 41))
        times = np.concatenate([[0.0], np.cumsum(ratio ** rng.uniform(size=n - 1 + closed))])
        axes = rng.normal(size=(n - 1, 20, 3))
        axes *= rng.uniform(size=(n - 1, 20, 1)) / np.linalg.norm(axes, axis=-1, keepdims=True)
        q = [np.tile([1.0, 0.0, 0.0, 0.0], (20, 1))]
        for step in quaternion.exp(0.5 * np.radians(degrees) * axes):
            q.append(quaternion.mul(q[-1], step))
        solves = [
            nielson(
                times, np.array(q), closed=closed, method=m, tolerance=1e-11, on_failure="return"
            )
            for m in ("jacobi", "newton")
        ]
        met = [curve.solve_report.converged for curve in solves]
        failed = [count + int((~m).sum()) for count, m in zip(failed, met, strict=True)]
        both, t = met[0] & met[1], inside(times, 3)
        assert apart(solves[0](t), solves[1](t))[:, both].max(initial=0.0) < 1e-9
    return 400, failed[0], failed[1]


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize(("degrees", "ratio"), [(120.0, 1.0), (100.0, 5.0)])
def test_newton_does_not_fail(closed: bool, degrees: float, ratio: float) -> None:
    assert uneven_sets(closed, degrees, ratio)[2] == 0


@pytest.mark.parametrize("closed", [False, True])
def test_at_very_uneven_times_it_fails_less(closed: bool) -> None:
    """What is left has no curve: on the way from small steps the solution ends in a fold."""
    sets, jacobi, newton = uneven_sets(closed, 100.0, 20.0)
    assert jacobi > 0.6 * sets
    assert newton < 0.6 * jacobi
