"""Reports of solves say what the finished curve misses, whatever the iteration says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.quaternion import FloatArray
from walks import inside, loop, uneven, walk

SOLVED = ("nielson", "spherical-average", "min-torque", "kim")


def apart(a: FloatArray, b: FloatArray) -> Any:
    """The angle in rad between quaternions, signs kept."""
    return 4.0 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))


def miss(curve: Curve) -> float:
    """The largest angle at a keyframe, from either side."""
    before = curve(np.nextafter(curve.times[1:], -np.inf))
    last = curve.quaternions[1:]
    if curve.closed:
        last = np.concatenate([last, curve.keyframes.sign * curve.quaternions[:1]])
    at = curve(curve.times[: len(curve.quaternions)])
    return float(max(apart(at, curve.quaternions).max(), apart(before, last).max()))


def rounding(curve: Curve) -> float:
    """How far the curve turns at keyframes within the rounding of their times."""
    before = np.nextafter(curve.times[1:], -np.inf)
    speeds = np.linalg.norm(curve(np.append(before, curve.times), 1), axis=-1)
    return float(4.0 * np.spacing(curve.times[-1]) * speeds.max())


def near_full_turns(seed: int) -> tuple[FloatArray, FloatArray]:
    """Keyframes with steps just below 360 degrees, signs as they are."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 6))
    axes = rng.normal(size=(n - 1, 3))
    axes *= (np.pi - 10.0 ** rng.uniform(-9, -1)) / np.linalg.norm(axes, axis=-1, keepdims=True)
    q = [quaternion.normalise(rng.normal(size=4))]
    for step in quaternion.exp(axes):
        q.append(quaternion.mul(q[-1], step))
    return np.concatenate([[0.0], np.cumsum(rng.uniform(1.0, 10.0, n - 1))]), np.array(q)


@pytest.mark.parametrize("name", SOLVED)
def test_no_miss_is_larger_than_reported(name: str) -> None:
    for seed in range(25):
        times, q = near_full_turns(seed)
        curve = qs.build(name, times, q, align=False, on_failure="return")
        report = curve.solve_report
        if report.converged:
            assert miss(curve) <= max(1e-9, 2.0 * report.residual) + rounding(curve)
            assert report.residual <= report.tolerance
        else:
            assert report.residual > report.tolerance or report.change > report.tolerance


@pytest.mark.parametrize("name", ["spherical-average", "min-torque"])
def test_residual_is_the_miss(name: str) -> None:
    times, q = uneven(9), walk(9, 120.0)
    for tolerance in (1e-2, 1e-6):
        curve = qs.build(name, times, q, tolerance=tolerance)
        assert curve.solve_report.residual == pytest.approx(miss(curve), rel=1e-6, abs=1e-13)


def test_residual_of_closed_curves_takes_the_seam_in() -> None:
    times = uneven(10)
    for turns in (1, 2):
        q = loop(times, turns, wobble=0.4)
        curve = qs.build("spherical-average", times, q, closed=True, tolerance=1e-2)
        assert curve.solve_report.residual == pytest.approx(miss(curve), rel=1e-6, abs=1e-13)


class Careless(qs.scheme("slerp")):  # type: ignore[misc]
    """Slerp whose report claims that nothing is missed, with constants that are spoilt."""

    iterative = True
    spoilt = 1e-3

    def _fit(self, keyframes: Any, *, on_failure: str = "raise") -> None:
        super()._fit(keyframes)
        report = np.zeros((keyframes.tracks.shape[0], 4))
        self.segments[-1, 1, 8] += self.spoilt
        self._report("guess", "residual", 1e-6, report, on_failure)


def test_a_scheme_cannot_report_what_it_does_not_write() -> None:
    q = np.stack([walk(4, 60.0), walk(4, 60.0, seed=2)], axis=1)
    with pytest.raises(qs.ConvergenceError, match=r"track \[1\]"):
        Careless(None, q)
    report = Careless(None, q, on_failure="return").solve_report
    assert report.converged.tolist() == [True, False]
    assert report.residual[0] < 1e-14
    assert report.residual[1] == pytest.approx(2e-3, rel=1e-9)


class Lost(Careless):
    """The same with a constant that is no number."""

    spoilt = np.nan


def test_what_is_no_number_is_infinitely_far() -> None:
    report = Lost(None, walk(4, 60.0), on_failure="return").solve_report
    assert report.residual == np.inf
    assert not report.converged


class Undecided(qs.scheme("slerp")):  # type: ignore[misc]
    """An iteration whose own numbers are lost while the curve happens to be right."""

    iterative = True

    def _fit(self, keyframes: Any, *, on_failure: str = "raise") -> None:
        super()._fit(keyframes)
        report = np.full((keyframes.tracks.shape[0], 4), np.nan)
        report[:, 0] = 3.0
        self._report("guess", "change", 1e-6, report, on_failure)


def test_a_lost_iteration_has_not_converged() -> None:
    report = Undecided(None, walk(4, 60.0), on_failure="return").solve_report
    assert (report.change, report.residual) == (np.inf, np.inf)
    assert not report.converged


def test_means_that_are_not_unique_are_told() -> None:
    """Two keyframes all but antipodal: the mean halfway may go anywhere."""
    for gap in (1e-8, 1e-3, 1.0):
        half = np.radians(180.0 - 0.5 * gap)
        q = [[1.0, 0.0, 0.0, 0.0], [np.cos(half), 0.6 * np.sin(half), 0.0, 0.8 * np.sin(half)]]
        with pytest.raises(qs.ConvergenceError, match="spherical-average"):
            qs.build("spherical-average", None, q, align=False)


def test_means_that_leap_are_told() -> None:
    """Means walk back and forth between fixed points in the narrowest of intervals; most are found."""
    leaping = converged = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        axes = rng.normal(size=(4, 3))
        axes *= np.radians(rng.uniform(60, 130, (4, 1))) / np.linalg.norm(axes, axis=1)[:, None]
        q = [np.array([1.0, 0.0, 0.0, 0.0])]
        for step in quaternion.exp(axes):
            q.append(quaternion.mul(q[-1], step))
        curve = qs.build("spherical-average", None, q, align=False, on_failure="return")
        points = curve(inside(curve.times, 2000))
        leap = apart(points[1:], points[:-1]).max() > 0.2
        converged += int(curve.solve_report.converged)
        leaping += int(leap and curve.solve_report.converged)
    assert converged > 10
    assert leaping <= 1


def test_least_torque_hits_or_tells() -> None:
    """A turn of nearly 360 degrees between nodes magnifies rounding: up to 1e-4 rad were missed."""
    for seed in range(12):
        times, q = near_full_turns(seed)
        curve = qs.build(
            "min-torque", times, q, align=False, on_failure="return", max_iterations=20
        )
        if curve.solve_report.converged:
            assert miss(curve) <= 1e-6 + rounding(curve)
