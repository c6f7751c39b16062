"""Breaks on uneven times: segments of a million turns, rests beside turns, and times that few ulps tell apart."""

from __future__ import annotations

import numpy as np
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.instruments.breaks import UNBROKEN, breaks
from quatspline.instruments.continuity import jumps, measured_continuity
from quatspline.instruments.derivatives import rates_since
from quatspline.instruments.fairness import fairness
from quatspline.trajectories.walks import walk
from toys import AXIS, Turn, turned
from walks import applies

Scheme = type[Curve]

PLANE = [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0.8, 0, 0], [0, 1, 0, 0]]
SPACE = [[1, 0, 0, 0], [0.8, 0, 0.6, 0], [0.64, 0.48, 0.6, 0], [0.36, 0.48, 0.8, 0]]
RATIOS = [100, 200, 300, 500, 1e3, 1e4, 1e5, 1e6]

CONTROLLED = 1e4
"""Up to this ratio the third derivative's jump, in the units of the long segments, exceeds what an ulp of time
leaves of it in the short one: beyond, it is not told whether it is there."""


def between(ratio: float) -> list[float]:
    """A spacing of 1 between two that are so many times as long."""
    return [0.0, ratio, ratio + 1.0, 2.0 * ratio + 1.0]


UNEVEN = (
    [(between(ratio), keys) for ratio in RATIOS for keys in (PLANE, SPACE)]
    + [
        ([0.0, 1.0, 301.0], SPACE[:3]),
        ([0.0, 1e6, 1e6 + 1.0], SPACE[:3]),
        ([0.0, 10.0, 10.02, 20.0], [PLANE[0], PLANE[0], PLANE[1], PLANE[1]]),  # rests beside a turn
        ([0.0, 0.01, 0.0100001], PLANE[:3]),
    ]
)
EVEN = [([0.0, 1.0], [PLANE[0], PLANE[2]]), ([0.0, 1.0], SPACE[::2]), ([0.0, 1.0, 2.0], SPACE[:3])]


# -- smooth curves are not called broken --------------------------------------------------------


def smooth(scheme: Scheme) -> bool:
    departs = "test_continuity_holds" in scheme.departs
    return scheme.peer is None and scheme.continuity >= 1 and not departs


def built(scheme: Scheme, cases: list) -> list[Curve]:
    """Those that it makes: some iterations do not converge where spacings differ much."""
    curves = []
    for times, keyframes in cases:
        try:
            curves.append(scheme(times, keyframes))
        except qs.ConvergenceError:
            continue
    return curves


def breaks_openly(curve: Curve) -> bool:
    """Whether the public call shows the velocity to jump at a keyframe, or a leap by dense samples."""
    inner = curve.times[1:-1]
    after, before = curve(inner, 1), curve(np.nextafter(inner, 0.0), 1)
    speed = np.linalg.norm(np.stack([after, before]), axis=-1).max()
    return bool(np.linalg.norm(after - before, axis=-1).max() > 1e-2 * speed) or _leaps(curve)


def _leaps(curve: Curve) -> bool:
    for low, high in zip(curve.times[:-1], curve.times[1:], strict=True):
        t = np.linspace(low, high, 2_000_001)
        i = int(quaternion.distance(curve(t[1:]), curve(t[:-1])).argmax())
        a, b = t[i], t[i + 1]
        while b - a > 64 * np.spacing(b):
            middle = 0.5 * (a + b)
            first, second = (quaternion.distance(curve(x), curve(middle)) for x in (a, b))
            a, b = (a, middle) if first > second else (middle, b)
        if quaternion.distance(curve(a), curve(b)) > 0.1:
            return True
    return False


@applies(lambda scheme: smooth(scheme) and scheme.non_uniform)
def test_uneven_times_break_no_smooth_curve(scheme: Scheme) -> None:
    """What is claimed is measured, up to C2, or the curve breaks for everyone to see.

    Nested slerps do, whose control points lie beyond the antipode.
    """
    for curve in built(scheme, [(t, q) for t, q in UNEVEN if len(q) >= scheme.min_keyframes]):
        found = measured_continuity(jumps(curve, (0, 1, 2)))
        assert found >= scheme.continuity or breaks_openly(curve), curve


@applies(smooth)
def test_two_and_three_keyframes_break_no_smooth_curve(scheme: Scheme) -> None:
    """The middle window of one symmetric segment sees no difference at first."""
    cases = [(t, q) for t, q in EVEN if len(q) >= scheme.min_keyframes]
    curves = built(scheme, cases)
    assert len(curves) == len(cases)
    for curve in curves:
        assert measured_continuity(jumps(curve, (0, 1, 2))) >= scheme.continuity, curve
        assert breaks(curve) == UNBROKEN


@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize(
    "name", ["quartic", "quintic", "local-quintic", "log-cubic", "moving-frame"]
)
def test_c2_is_measured_at_any_ratio(name, ratio):
    for keys in (PLANE, SPACE):
        curve = qs.build(name, between(ratio), keys)
        table = jumps(curve)
        assert measured_continuity(table[table["order"] <= 2]) == 2
        if ratio <= CONTROLLED:  # the third derivative stays put
            assert measured_continuity(table) == 2
        assert breaks(curve) == UNBROKEN
        assert np.isfinite(fairness(curve)["torque"])


def test_compare_tells_smooth_curves_from_broken_ones():
    names = ["quartic", "local-quintic", "hermite", "slerp", "squad", "barry-goldman"]
    table = qs.compare(between(1000.0), PLANE, names).set_index("scheme")
    assert table["continuity"].reindex(names).tolist() == [2, 2, 1, 0, 0, -1]
    assert np.isfinite(table["torque"].reindex(names)).tolist() == [True] * 3 + [False] * 3


PEERS = [
    ("scipy-slerp", 0),
    ("rowan-slerp", 0),
    ("scipy-rotation-spline", 2),
    ("interpolatepy-log", 2),
]


@pytest.mark.parametrize("ratio", [300, 1e4, 1e5, 1e6])
@pytest.mark.parametrize(("name", "k"), PEERS)
def test_libraries_are_measured_at_any_ratio(name, k, ratio):
    """Their rates come from stencils, their orientations from times that an ulp moves."""
    if name not in qs.schemes():
        pytest.skip(f"{name}: its library is not installed")
    for keys in (PLANE, SPACE):
        assert measured_continuity(jumps(qs.build(name, between(ratio), keys), (0, 1, 2))) == k


def test_an_ulp_of_time_is_no_jump():
    """3000 keyframes 30 ms apart, far from the first: rounding of t turns a library's curve by 1e-12."""
    if "rowan-slerp" not in qs.schemes():
        pytest.skip("rowan is not installed")
    keys = walk(np.random.default_rng(2), 300, 40.0)[:, 0]
    times = 1e4 * (np.arange(300) > 0) + 0.01 * np.arange(300)
    assert measured_continuity(jumps(qs.build("rowan-slerp", times, keys), (0, 1))) == 0


@pytest.mark.parametrize("closed", [False, True])
def test_stamps_of_any_kind_give_the_same_jumps(closed):
    ticks = 10_000_000 * np.arange(4)
    keys = PLANE[: 3 if closed else 4]
    near = jumps(qs.build("quartic", ticks, keys, closed=closed))
    for times in (ticks + 1_650_000_000_000_000_000, 1e-2 * np.arange(4), ticks.astype("m8[ns]")):
        table = jumps(qs.build("quartic", times, keys, closed=closed))
        assert table["continuous"].tolist() == near["continuous"].tolist() == [True] * 3 + [False]
    epoch = jumps(qs.build("quartic", ticks + 1_650_000_000_000_000_000, keys, closed=closed))
    np.testing.assert_array_equal(epoch["jump"], near["jump"])


# -- breaks are still found ---------------------------------------------------------------------


class _Break(Turn):
    """A spin at `speed` rad/t, faster by `bend` every t, with a leap (rad) and a corner (rad/t) at `at`."""

    name, speed, bend, leap, corner, at = "break", 1.0, 0.0, 0.0, 0.0, 0.0

    def theta(self, t):
        after = t - self.at > 0.0
        return (
            0.5 * (self.speed * t + 0.5 * self.bend * t**2)
            + 0.5 * after * (self.leap + self.corner * (t - self.at)),
            0.5 * (self.speed + self.bend * t + self.corner * after),
            0.5 * self.bend + 0.0 * t,
        )


def planted(times: list[float], **more: float) -> Curve:
    return turned(type("_", (_Break,), more), times)


@pytest.mark.parametrize("ratio", [1, 10, 50, 100, 1e3, 1e4])
@pytest.mark.parametrize("bend", [0.0, 1e-3])
def test_leaps_and_corners_are_found_in_long_segments(ratio, bend):
    times = between(ratio)
    for at in np.random.default_rng(1).uniform(0.0, times[-1], 5):
        leap = breaks(planted(times, leap=0.5, at=at, bend=bend / ratio))
        assert leap.leap == pytest.approx(0.5, abs=1e-6)
        assert leap.corner == 0.0
        corner = breaks(planted(times, corner=0.3, at=at, bend=bend / ratio))
        assert corner.corner == pytest.approx(0.3, rel=1e-2)
        assert corner.leap == 0.0
        assert breaks(planted(times, at=at, bend=bend / ratio)) == UNBROKEN


@pytest.mark.parametrize("size", [1e-2, 1e-4, 1e-5])
@pytest.mark.parametrize("spacing", [1e-9, 1.0, 1e9])
def test_small_corners_are_found_whatever_the_unit_of_time(size, spacing):
    """Beside an acceleration of 1 rad a squared spacing."""
    curve = planted(
        [0.0, spacing, 2.0 * spacing],
        speed=1.0 / spacing,
        bend=1.0 / spacing**2,
        corner=size / spacing,
        at=1.3 * spacing,
    )
    assert breaks(curve).scaled == pytest.approx(size, rel=0.02)


@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-6, 1e-8])
def test_a_sharp_turn_is_no_corner(width):
    """The velocity changes by 1 rad/t within the width: a corner to whoever does not look closely."""

    class Sharp(Turn):
        name = "sharp"

        def theta(self, t):
            x = (t - 0.37) / width
            return (
                0.5 * t + 0.25 * width * np.logaddexp(x, -x),
                0.5 + 0.25 * np.tanh(x),
                0.25 / width / np.cosh(np.clip(x, -300.0, 300.0)) ** 2,
            )

    assert breaks(turned(Sharp, [0.0, 1.0, 2.0])) == UNBROKEN


@pytest.mark.parametrize("name", ["slerp", "biarc", "nlerp", "fast-slerp", "incremental-slerp"])
@pytest.mark.parametrize("ratio", RATIOS)
def test_what_is_c0_is_measured_so_at_any_ratio(name, ratio):
    for keys in (PLANE, SPACE):
        assert measured_continuity(jumps(qs.build(name, between(ratio), keys), (0, 1, 2))) == 0


def test_segments_that_time_hardly_tells_are_not_searched():
    """Spacings of a few ulps of the last time hold no window: nothing is told, and nothing warns."""
    tick = np.spacing(1e9)
    assert breaks(planted([0.0, 100.0 * tick, 1e9], speed=1e-9)) == UNBROKEN
    late = planted([1e9 - 3.0, 1e9 - 2.0, 1e9], corner=0.3, at=1.5)
    assert breaks(late).corner == pytest.approx(0.3, rel=1e-2)


# -- rates by stencils --------------------------------------------------------------------------


@pytest.mark.parametrize("turns", [1.0, 10.0, 100.0, 1e3, 1e4])
def test_stencils_follow_many_turns_a_segment(turns):
    """Eight steps of a fixed share of a segment would reach beyond half a turn, where logarithms fold."""
    speed = 2.0 * np.pi * turns
    curve = planted([0.0, 1.0, 2.0], speed=speed, bend=0.3 * speed)
    library = planted([0.0, 1.0, 2.0], speed=speed, bend=0.3 * speed, peer="numpy")
    noise = (
        1e-9 + 3e-11 * speed
    )  # of an angle's ulp, over the square of a step that turns by 0.1 rad
    t = np.concatenate([np.linspace(0.0, 1.999, 41), np.nextafter([1.0, 2.0], 0.0)])
    for known, measured, power in zip(
        (curve.inner(t, 1)[:, 0], curve.inner(t, 2)[:, 0]),
        rates_since(library, t),
        (1, 2),
        strict=True,
    ):
        np.testing.assert_allclose(measured, known, atol=noise * speed**power)
    np.testing.assert_allclose(curve.inner(t, 1)[:, 0] @ AXIS, speed * (1.0 + 0.3 * t), rtol=1e-12)


def test_stencils_of_a_curve_at_rest_are_zero():
    rest = planted([0.0, 1.0], speed=0.0, peer="numpy")
    for rate in rates_since(rest, np.linspace(0.0, 1.0, 5)):
        np.testing.assert_array_equal(rate, 0.0)


def test_stencils_stay_short_where_a_fast_curve_turns_back():
    """At t = 0.5 its speed is 0, and eight steps of a fixed share on it turns by several radians."""
    bend = 4e3
    measured = rates_since(
        planted([0.0, 1.0], speed=-0.5 * bend, bend=bend, peer="numpy"), np.array([0.0, 0.5, 0.9])
    )
    np.testing.assert_allclose(measured[0] @ AXIS, bend * np.array([-0.5, 0.0, 0.4]), atol=1e-5)
    np.testing.assert_allclose(measured[1] @ AXIS, bend, rtol=1e-4)
