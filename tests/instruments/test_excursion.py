"""The excursion instrument on curves whose way is known, and the sets that it is run on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.instruments.excursion import HOLD, SAMPLES, excursion
from quatspline.quaternion import FloatArray
from quatspline.trajectories.holds import axis_sets, hold_sets
from toys import AXIS, Toy
from walks import uneven, walk

SAME, STEP = 1e-12, 0.5
ACROSS = np.array([-0.8, 0.0, 0.6])
BASE = quaternion.normalise(np.array([0.3, -0.5, 0.7, 0.2]))


def through(angle: Any, aside: Any = lambda u: 0.0 * u, times: Any = (0.0, 2.0)) -> Toy:
    """One segment, angle(u) on S^3 along a great circle and aside(u) away from it, from 0 to angle(1)."""

    class Known(Toy):
        def _orientation(self, t: FloatArray) -> FloatArray:
            u = t / self.keyframes.knots[-1]
            along = quaternion.mul(BASE, quaternion.exp(angle(u)[:, None] * AXIS))
            away = quaternion.mul(BASE, np.array([0.0, *ACROSS]))
            return np.cos(aside(u))[:, None] * along + np.sin(aside(u))[:, None] * away

    ends = quaternion.mul(BASE, quaternion.exp(np.array([[0.0], [angle(1.0)]]) * AXIS))
    return Known(np.asarray(times), ends, align=False)


def of(curve: Any) -> dict[str, float]:
    return {name: float(x[0]) for name, x in excursion(curve)._asdict().items()}


def test_slerp_keeps_to_its_arcs() -> None:
    t, q = uneven(9), walk(9, 100.0)
    found = excursion(qs.build("slerp", t, q))
    assert found.step == pytest.approx(np.full(8, np.radians(100.0)), abs=SAME)
    assert max(found.off.max(), found.over.max(), found.back.max()) < 1e-14


@pytest.mark.parametrize("size", [1e-6, 0.1, 1.5])
def test_beyond_the_end_of_a_great_circle(size: float) -> None:
    """2 B u + 4 B u (1 - u) is largest at u = 3/4, a sample, and B/4 beyond its end there."""
    found = of(through(lambda u: size * (2.0 * u + 4.0 * u * (1.0 - u))))
    assert found["over"] == pytest.approx(size / 2.0, rel=1e-9)  # as a rotation
    assert found["back"] == pytest.approx(size / 2.0, rel=1e-9)
    assert found["off"] == pytest.approx(size / 2.0, rel=1e-9)
    assert found["step"] == pytest.approx(4.0 * size, rel=1e-9)


def test_behind_the_start_of_a_great_circle() -> None:
    found = of(through(lambda u: 0.1 * (2.0 * u - 4.0 * u * (1.0 - u))))
    assert found["over"] == found["back"] == pytest.approx(0.05, rel=1e-9)
    assert found["off"] == pytest.approx(0.05, rel=1e-9)


def test_back_and_forth_within_the_arc() -> None:
    """Progress rises to 3/4, falls to 1/4 and rises to 1: nothing over, half the step back."""
    found = of(
        through(lambda u: STEP * np.interp(u, [0.0, 0.25, 0.75, 1.0], [0.0, 0.75, 0.25, 1.0]))
    )
    assert found["back"] == pytest.approx(STEP, rel=1e-9)  # half, on S^3; as a rotation twice that
    assert (found["over"], found["off"]) == pytest.approx((0.0, 0.0), abs=1e-14)


def test_to_the_side_of_the_arc() -> None:
    found = of(through(lambda u: STEP * u, lambda u: 0.2 * np.sin(np.pi * u)))
    assert found["off"] == pytest.approx(0.4, rel=1e-9)
    assert (found["over"], found["back"]) == pytest.approx((0.0, 0.0), abs=1e-12)


def test_once_round_counts_as_far_and_not_as_near() -> None:
    """Progress goes on past half a turn and past a whole one; the arc itself is never half a sphere away."""
    found = of(through(lambda u: STEP * u + 28.0 * u * (1.0 - u)))
    top = (STEP + 28.0) / 56.0
    assert found["over"] == pytest.approx(2.0 * (28.0 * top**2 - STEP), rel=2.0 / SAMPLES**2)
    assert np.pi < found["off"] <= 2.0 * np.pi


@pytest.mark.parametrize("reach", [1e-9, 0.3, 3.0])
def test_a_hold_that_wanders(reach: float) -> None:
    """Also by more than half a turn: 344 degrees from the keyframe, which is 16 as rotations go."""
    found = of(through(lambda u: reach * np.sin(np.pi * u) * np.where(u == 1.0, 0.0, 1.0)))
    assert found["step"] < HOLD
    assert [found[name] for name in ("off", "over", "back")] == pytest.approx(
        [2.0 * reach] * 3, rel=1e-6
    )


def test_signs_of_samples_do_not_matter() -> None:
    curve = qs.build("kim", uneven(9), walk(9, 100.0))
    wanted = excursion(curve)

    class Flipping(Toy):
        def _orientation(self, t: FloatArray) -> FloatArray:
            flips = np.random.default_rng(1).choice([-1.0, 1.0], (t.size, 1))
            return flips * curve.inner(t)[:, 0]

    for one, two in zip(wanted, excursion(Flipping(curve.times, curve.quaternions)), strict=True):
        assert np.array_equal(one, two)


@pytest.mark.parametrize("closed", [False, True])
def test_tracks_are_single_curves_at_any_time(closed: bool) -> None:
    t = uneven(7 + closed)
    q = np.stack([walk(7, 60.0, seed) for seed in range(6)], axis=1).reshape(7, 3, 2, 4)
    found = excursion(qs.build("squad", t + 1.7e9, q, closed=closed))
    assert found.off.shape == (6 + closed, 3, 2)
    for i in np.ndindex(3, 2):
        single = excursion(qs.build("squad", t, q[:, *i], closed=closed))
        for one, two in zip(found, single, strict=True):
            assert one[:, *i] == pytest.approx(
                two, abs=1e-6
            )  # times have 2e-7 left of their digits


def test_what_a_known_scheme_does_on_one_axis() -> None:
    """The natural cubic spline through angles 0, 0, 1, 1 leaves them by what scipy's does."""
    from scipy.interpolate import CubicSpline

    t, angles = np.arange(4.0), np.array([0.0, 0.0, 1.0, 1.0])
    spline = CubicSpline(t, angles, bc_type="natural")
    q = quaternion.exp(0.5 * angles[:, None] * AXIS)
    found = excursion(qs.build("min-torque", t, q, subintervals=1, tolerance=1e-11))
    far = np.abs(spline(np.linspace(0.0, 1.0, SAMPLES + 1))).max()
    assert found.off[[0, 2]] == pytest.approx([far, far], rel=1e-6)
    assert list(found.hold) == [True, False, True]


# -- sets -----------------------------------------------------------------------------------------


def test_sets_hold_where_they_say() -> None:
    for times, q in hold_sets(10, 20):
        same = np.all(q[1:] == q[:-1], axis=1)
        assert same.sum() == 1
        assert 0 < np.argmax(same) < len(same) - 1
        assert np.diff(times)[same] == pytest.approx(100.0)
        steps = quaternion.distance(q[1:], q[:-1])[~same]
        assert steps == pytest.approx(np.full(len(steps), np.pi / 2.0))


def test_sets_turn_about_one_axis() -> None:
    for times, q in axis_sets(20):
        assert (np.diff(times) > 0.0).all()
        steps = quaternion.log(quaternion.mul(quaternion.conj(q[:-1]), q[1:]))
        sizes = np.degrees(2.0 * np.linalg.norm(steps, axis=1))
        assert sizes.min() > 4.999
        assert sizes.max() < 110.001
        assert np.linalg.matrix_rank(steps, tol=1e-12) == 1


def test_fewer_sets_are_the_first_of_more() -> None:
    for few, more in ((hold_sets(1, 2), hold_sets(1, 5)), (axis_sets(2), axis_sets(5))):
        for one, two in zip(few, more, strict=False):
            assert all(map(np.array_equal, one, two))
