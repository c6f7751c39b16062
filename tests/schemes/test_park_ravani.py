"""Park & Ravani's march: golden numbers, scipy's RotationSpline from its own start, the growth that ends it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, RotationSpline

import quatspline as qs
from golden import assert_golden_new, new_entries
from quatspline import quaternion
from quatspline.families.rotation_vector import PHI
from quatspline.fitting.tangents import CHART, chart_velocities
from smoothness import assert_own_rates
from walks import apart, inside, spin, uneven, walk


@pytest.mark.parametrize("entry", new_entries("park-ravani"))
def test_golden(entry: str) -> None:
    assert_golden_new("park-ravani", entry, start=entry.split()[1])


@pytest.mark.parametrize("start", ["chord", "zero", "parabola", (0.3, -0.2, 0.5)])
def test_start(start: Any) -> None:
    t, q = uneven(4), walk(4, 40.0)
    curve = qs.build("park-ravani", t, q, start=start)
    h = np.diff(t)
    step = quaternion.log(quaternion.mul(quaternion.conj(q[0]), q[1]))
    chart = chart_velocities(q, h, False, 1.0, 3, CHART)[0]
    wanted = {"chord": 2.0 * step / h[0], "zero": np.zeros(3), "parabola": 2.0 * chart}
    assert apart(curve(t[0], 1), wanted[start] if isinstance(start, str) else start) < 1e-12
    assert apart(curve(t[0], 2), np.zeros(3)) < 1e-12
    assert_own_rates(curve, inside(t, 5), (1e-7, 1e-5))


def test_c2_at_keyframes() -> None:
    t, q = uneven(5), walk(5, 40.0)
    curve = qs.build("park-ravani", t, q)
    for order, bound in ((0, 1e-13), (1, 1e-11), (2, 1e-9)):
        assert apart(curve(t[1:-1], order), curve(np.nextafter(t[1:-1], 0.0), order)) < bound


def test_from_scipys_rates_it_is_scipys_spline() -> None:
    """RotationSpline solves for what the march needs: from its rates at the start both are one curve."""
    t = np.arange(5.0)
    rotations = Rotation.from_quat(walk(5, 20.0), scalar_first=True)
    solved = RotationSpline(t, rotations)
    start = np.stack([solved(0.0, 1), solved(0.0, 2)])
    curve = qs.build("park-ravani", t, rotations, start=start)
    s = inside(t, 9)
    assert (curve.rotation(s).inv() * solved(s)).magnitude().max() < 1e-7
    assert apart(curve(s, 1), solved(s, 1)) < 1e-6


def test_an_error_grows_as_on_a_straight_line() -> None:
    """Of c, from one keyframe to the next: by -2 - sqrt(3) in the long run."""
    rate, error = 0.01, 1e-6
    curve = qs.build(
        "park-ravani", None, spin(np.arange(9.0), (0, 0, 1), rate), start=[0, 0, rate + error]
    )
    phi = curve.segments[0, :, PHI + 12 :]
    off = 2.0 * (phi[:, 1] + phi[:, 2]) - rate  # the slope at u = 0 is rise + g_0
    assert off[0] == pytest.approx(error)
    assert off[-1] / off[-2] == pytest.approx(-2.0 - np.sqrt(3.0), rel=1e-3)


@pytest.mark.parametrize("start", ["chord", "zero", "parabola"])
def test_what_leaves_float64_is_refused_with_the_keyframe(start: str) -> None:
    q = walk(21, 60.0)
    with pytest.raises(ValueError, match=r"^quaternions\[\d+\]: the march brings rates") as refused:
        qs.build("park-ravani", None, q, start=start)
    first = int(str(refused.value).split("[")[1].split("]")[0])
    assert 5 < first < 20
    curve = qs.build(
        "park-ravani", None, q[: first + 1], start=start
    )  # that keyframe begins no segment
    t = inside(curve.times, 5)
    assert all(np.isfinite(curve(t, order)).all() for order in range(3))


def test_the_refusal_names_the_track() -> None:
    q = np.stack([spin(np.arange(21.0), (0, 0, 1), 0.0), walk(21, 60.0)], axis=1)
    with pytest.raises(ValueError, match=r"^quaternions\[\d+, 1\]: the march"):
        qs.build("park-ravani", None, q)


@pytest.mark.parametrize(
    ("start", "message"),
    [
        ("parabolic", r"^start='parabolic': expected 'chord', 'zero', 'parabola' or rates"),
        ([1.0, 2.0], r"^start has shape \(2,\): expected \(3,\), or \(2, 3\)"),
        ([0.0, np.inf, 0.0], r"^start\[1\] = inf"),
        ([0.0, 1e9, 0.0], r"^start: more than 1e\+06 rad on the first segment of 1"),
    ],
)
def test_bad_start(start: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        qs.build("park-ravani", None, walk(4, 30.0), start=start)
