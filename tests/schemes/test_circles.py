"""Biarcs and circular blending: the published numbers, and motion that turns back or rests."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import quatspline as qs
from golden import GOLDEN, KNOTS, Q, assert_golden
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.families.circles import BIARC, BLEND, SPLIT
from quatspline.quaternion import FloatArray
from smoothness import assert_own_rates, motion
from walks import apart, apart_up_to_sign, inside, spin, uneven, walk

NAMES = ["biarc", "circular-blend"]
ROUNDING = 1e-12
RATES = 1e-7
"""What the numerical fallback leaves, in the segment's own scale."""


def turn(degrees: float, axis: Any) -> FloatArray:
    return quaternion.exp(0.5 * np.radians(degrees) * np.asarray(axis, float))


ONE, X, Y = np.array([1.0, 0.0, 0.0, 0.0]), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
HARD = {
    "all one": [ONE] * 5,
    "to and fro": [ONE, turn(60, X), ONE, turn(60, X), ONE],
    "to and fro by half turns": [ONE, turn(180, X), ONE, turn(180, Y), ONE],
    "nearly to and fro": [ONE, turn(60, X), turn(1e-9, Y), turn(60, Y), turn(1e-12, X)],
    "repeated": [ONE, ONE, turn(40, X), turn(40, X), turn(80, Y)],
    "tiny": [turn(1e-7 * k, X) for k in range(5)],
    "tiny, turning": [turn(1e-7, X), ONE, turn(1e-7, Y), turn(2e-7, X), ONE],
    "two": [ONE, turn(50, X)],
    "two that are one": [ONE, ONE],
    "three, back again": [ONE, turn(90, X), ONE],
    "half turns on and on": [turn(180 * k, X) for k in range(5)],
}


@pytest.mark.parametrize(
    ("name", "key"),
    [("biarc", "biarc_3pt_chart_tangents"), ("circular-blend", "kimnam_smoothstep")],
)
def test_golden(name: str, key: str) -> None:
    knots = KNOTS[GOLDEN["schemes"][key]["knots"]]
    assert_golden(qs.build(name, knots, Q), key, (1e-10, 1e-10, 1e-8))


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", HARD)
@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_hard_keyframes(name: str, kind: str, closed: bool, seed: int) -> None:
    """Uneven times, motion that turns back or rests: on the sphere, through the keys, no NaN."""
    q = np.array(HARD[kind])
    times = np.cumsum(np.random.default_rng(seed).uniform(0.01, 2.0, len(q) + closed))
    curve = qs.build(name, times, q, closed=closed)
    t = np.linspace(times[0], times[-1], 301)
    assert np.abs(np.linalg.norm(curve(t), axis=1) - 1.0).max() < ROUNDING
    assert np.isfinite(curve(t, 1)).all()
    assert np.isfinite(curve(t, 2)).all()
    step = quaternion.distance(q[1:], q[:-1]).max()
    assert apart_up_to_sign(curve(times[: len(q)]), q) <= 1e-14 + 1e-9 * step


@pytest.mark.parametrize("kind", ["open", "closed +", "closed -"])
@pytest.mark.parametrize("blend", ["smooth", "linear"])
def test_blend_rates_and_joins(kind: str, blend: str) -> None:
    knots, q, given = motion(kind, 8, 70.0)
    curve = qs.build("circular-blend", knots, q, blend=blend, **given)
    assert curve.continuity == (2 if blend == "smooth" else 1)
    t = inside(knots, 7)
    assert_own_rates(curve, t, (RATES, RATES))
    left, right = np.nextafter(knots[1:-1], -1.0), knots[1:-1]
    size = np.abs(curve(t, 2)).max()
    assert apart(curve(left, 1), curve(right, 1)) < 1e-11
    assert (apart(curve(left, 2), curve(right, 2)) < 1e-10 * size) == (blend == "smooth")


@pytest.mark.parametrize("kind", ["open", "closed +", "closed -"])
def test_biarc_is_smooth_as_a_path(kind: str) -> None:
    """Constant speed on a segment, directions that agree at keyframes, speeds that do not."""
    knots, q, given = motion(kind, 8, 70.0)
    curve = qs.build("biarc", knots, q, **given)
    speed = np.linalg.norm(curve(inside(knots, 9), 1), axis=1).reshape(-1, 9)
    assert np.abs(speed - speed[:, :1]).max() < 1e-11
    before, after = curve(np.nextafter(knots[1:-1], -1.0), 1), curve(knots[1:-1], 1)
    slow, fast = np.linalg.norm(before, axis=1), np.linalg.norm(after, axis=1)
    assert apart(before / slow[:, None], after / fast[:, None]) < 1e-11
    assert np.abs(slow - fast).max() > 0.1


def test_biarc_joints() -> None:
    """Both arcs end in the joint with one tangent; what differs there is the curvature."""
    knots, q, _ = motion("open", 8, 70.0)
    curve = qs.build("biarc", knots, q)
    joints = knots[:-1] + curve.segments[0, :, SPLIT] * np.diff(knots)
    assert np.all((curve.segments[0, :, SPLIT] > 0.0) & (curve.segments[0, :, SPLIT] < 1.0))
    for order, largest in ((0, 1e-7), (1, 1e-6)):
        assert apart(curve(joints - 1e-9, order), curve(joints + 1e-9, order)) < largest
    t = inside(knots, 40)
    t = t[np.abs(t[:, None] - joints).min(axis=1) > 0.06]
    assert_own_rates(curve, t, (RATES, RATES))


def test_biarc_of_an_exact_return_is_a_cusp() -> None:
    """Out along an arc and back: no loop is put in, the way is as long as twice the arc."""
    curve = qs.build("biarc", None, np.array(HARD["three, back again"]))
    q = curve(np.linspace(0.0, 2.0, 2001))
    assert quaternion.distance(q[1:], q[:-1]).sum() == pytest.approx(np.pi, abs=1e-6)


def test_circles_are_circles() -> None:
    """Three keyframes: one circle, all of it in one plane of R^4."""
    q = walk(3, 50.0)
    curve = qs.build("circular-blend", [0.0, 0.7, 1.9], q)
    points = curve(np.linspace(0.0, 1.9, 40))
    values = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    assert values[2] < 1e-14
    assert values[1] > 0.1


@pytest.mark.parametrize("name", NAMES)
def test_a_spin_stays_a_spin(name: str) -> None:
    knots = uneven(7)
    q = spin(knots, (1.0, 2.0, -2.0), 1.5, base=walk(2, 40.0)[1])
    curve = qs.build(name, knots, q)
    t = inside(knots, 8)
    assert np.abs(np.linalg.norm(curve(t, 1), axis=1) - 1.5).max() < 1e-12
    assert np.abs(curve(t, 2)).max() < 1e-11


@pytest.mark.parametrize("name", NAMES)
def test_tracks(name: str) -> None:
    knots = uneven(6)
    q = np.stack([walk(6, 50.0, seed) for seed in range(3)], axis=1)
    curve = qs.build(name, knots, q)
    t = inside(knots, 3)
    for k in range(3):
        for order in range(3):
            assert np.array_equal(curve(t, order)[:, k], qs.build(name, knots, q[:, k])(t, order))


def test_constants_are_as_many_as_the_kernels_read() -> None:
    assert BIARC.constants == SPLIT + 1
    assert BLEND.constants == SPLIT + 3


def test_unknown_blend_is_refused() -> None:
    with pytest.raises(ValueError, match=r"blend='cubic': expected one of 'smooth', 'linear'"):
        qs.build("circular-blend", None, walk(4, 30.0), blend="cubic")


def test_both_are_curves() -> None:
    assert all(issubclass(qs.scheme(name), Curve) for name in NAMES)
