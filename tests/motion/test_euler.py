"""Euler angles in and out: every order, through the lock, without leaps."""

from __future__ import annotations

import numpy as np
import pytest

from quatspline import quaternion
from quatspline.motion import euler

ROUNDING = 1e-14


@pytest.mark.parametrize("order", euler.ORDERS)
def test_angles_are_intrinsic_and_come_back(order: str) -> None:
    from scipy.spatial.transform import Rotation

    given = np.random.default_rng(0).uniform(-1.5, 1.5, (500, 3))
    q = euler.from_angles(given, order)
    expected = Rotation.from_euler(order, given).as_quat(scalar_first=True)
    assert quaternion.distance(q, expected).max() < ROUNDING
    again = np.concatenate([euler.continuous_angles(row[None], order) for row in q])
    np.testing.assert_allclose(again, given, atol=1e-12)


@pytest.mark.parametrize("order", euler.ORDERS)
def test_angles_go_on_through_the_lock(order: str) -> None:
    """The middle angle passes every lock in three turns, sampled on it exactly."""
    middle = np.radians(np.arange(0, 1081, 5.0))
    given = np.stack([0.3 + 0.1 * middle, middle, 0.2 - 0.05 * middle], axis=1)
    q = euler.from_angles(given, order)
    found = euler.continuous_angles(q, order)
    assert quaternion.distance(euler.from_angles(found, order), q).max() < ROUNDING
    assert np.abs(np.diff(found, axis=0)).max() < np.radians(11)
    free = np.abs(np.cos(middle)) > 0.01
    np.testing.assert_allclose(found[free], given[free], atol=1e-10)


@pytest.mark.parametrize("middle", [90.0, -90.0])
def test_at_the_lock_an_angle_that_is_not_determined_stays(middle: float) -> None:
    turn = np.radians(np.arange(0, 720, 4.0))
    locked = np.full(turn.shape, np.radians(middle))
    q = euler.from_angles(np.stack([turn, locked, 0 * turn], axis=1), "ZXY")
    found = euler.continuous_angles(q, "ZXY")
    assert np.abs(np.diff(found, axis=0)).max() < np.radians(4.1)
    assert quaternion.distance(euler.from_angles(found, "ZXY"), q).max() < ROUNDING


def test_many_turns_are_kept() -> None:
    spin = np.radians(np.arange(0, 2000, 30.0))
    given = np.stack([spin, 0 * spin, 0 * spin], axis=1)
    found = euler.continuous_angles(euler.from_angles(given, "YXZ"), "YXZ")
    np.testing.assert_allclose(found, given, atol=1e-12)


@pytest.mark.parametrize(("order", "count"), [("", 0), ("Y", 1), ("XZ", 2), ("ZYXZ", 4)])
def test_any_number_of_turns_is_taken(order: str, count: int) -> None:
    q = euler.from_angles(np.full((3, count), 0.7), order)
    expected = np.tile([1.0, 0, 0, 0], (3, 1))
    for axis in order:
        half = np.zeros(3)
        half["XYZ".index(axis)] = 0.35
        expected = quaternion.mul(expected, quaternion.exp(half))
    np.testing.assert_allclose(q, expected, atol=ROUNDING)
