"""What the contract asks of every scheme, checked on every scheme that is discovered."""

import itertools
import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import quatspline as qs
from quatspline import quaternion, segments, stencil
from quatspline.curve import Curve
from quatspline.options import nearest
from walks import (
    apart,
    apart_up_to_sign,
    applies,
    checks_in,
    count_of,
    curve_of,
    excused,
    inside,
    knots_of,
    loop,
    random_units,
    runs_somewhere,
    spin,
    uneven,
    walk,
)

UNIT = 1e-13
"""How far from length one rounding may take a product of a few quaternions."""
LONG_UNIT = 1e-11
"""The same where arcs near a full turn magnify rounding."""
SAME = 1e-9
"""Two ways to one curve, solves to TIGHT included."""
HIT = 1e-9
"""A keyframe counts as hit within this angle."""
HALF_TURN_HIT = 1e-7
"""The same beside half turns, where a peer's acos loses half the digits."""
RATES = 1e-7
"""Agreement of analytic rates with the numerical fallback, in units of the segment's own scale."""
BAD_SHARE = 0.15
"""Share of samples whose stencil may straddle a break inside a segment (a biarc's joint)."""
SPIN = 1e-7
"""A constant rate is kept within this share of it."""
SENSITIVE = 1e4
"""No keyframe moves a curve by more than this many times its own motion."""

Scheme = type[Curve]


def closable(scheme: Scheme) -> bool:
    return scheme.closable


def rated(scheme: Scheme) -> bool:
    return 1 in scheme.orders


def example(scheme: Scheme, **given: Any) -> Curve:
    """A curve through a walk with steps of 60 degrees."""
    n = count_of(scheme)
    return curve_of(scheme, knots_of(scheme, n), walk(n, 60.0), **given)


def closed_example(scheme: Scheme, turns: int = 0) -> Curve:
    """A closed curve with closing sign (-1)^turns."""
    n = count_of(scheme)
    times = knots_of(scheme, n + 1)
    return curve_of(scheme, times, loop(times, turns), closed=True)


def dense(curve: Curve) -> np.ndarray:
    """Times all over the domain, knots and ends included."""
    return np.unique(np.concatenate([curve.times, inside(curve.times, 7)]))


# -- evaluation ---------------------------------------------------------------------------------


def test_unit_norm(scheme: Scheme) -> None:
    curve = example(scheme)
    assert np.abs(np.linalg.norm(curve(dense(curve)), axis=-1) - 1.0).max() < UNIT


@pytest.mark.parametrize("tracks", [(), (3,), (2, 2)])
def test_shapes(scheme: Scheme, tracks: tuple[int, ...]) -> None:
    n = count_of(scheme)
    knots = knots_of(scheme, n)
    count = math.prod(tracks)
    q = np.stack([walk(n, 50.0, seed) for seed in range(count)], axis=1).reshape(n, *tracks, 4)
    curve = curve_of(scheme, knots, q)
    samples = inside(knots)[:12]
    for order in scheme.orders:
        width = (*tracks, 3 if order else 4)
        flat = curve(samples, order)
        assert flat.dtype == np.float64
        assert flat.shape == (12, *width)
        for shape in ((3, 4), (2, 1, 6)):
            shaped = curve(samples.reshape(shape), order)
            assert shaped.shape == (*shape, *width)
            assert np.array_equal(shaped.reshape(flat.shape), flat)
        assert curve(samples.tolist(), order).shape == (12, *width)
        assert curve(np.empty((0,)), order).shape == (0, *width)
        assert curve(np.empty((2, 0)), order).shape == (2, 0, *width)
        for scalar in (float(samples[5]), np.float64(samples[5]), np.array(samples[5])):
            assert curve(scalar, order).shape == width
            assert apart(curve(scalar, order), flat[5]) < SAME


def test_tracks_are_single_curves(scheme: Scheme) -> None:
    n = count_of(scheme)
    knots = knots_of(scheme, n)
    q = np.stack([walk(n, 50.0, seed) for seed in range(4)], axis=1).reshape(n, 2, 2, 4)
    curve = curve_of(scheme, knots, q)
    samples = inside(knots)
    assert apart(curve.quaternions, quaternion.align(q)) < UNIT
    for i in np.ndindex(2, 2):
        single = curve_of(scheme, knots, q[(slice(None), *i)])
        for order in scheme.orders:
            assert apart(curve(samples, order)[(slice(None), *i)], single(samples, order)) < SAME


@applies(lambda scheme: scheme.peer is None)
def test_a_sample_does_not_depend_on_its_neighbours(scheme: Scheme) -> None:
    """To the last digit: alone, among others, in any order."""
    curve = example(scheme)
    t = np.random.default_rng(3).permutation(dense(curve))
    for order in scheme.orders:
        together = curve(t, order)
        assert np.array_equal(together, [curve(float(x), order) for x in t])
        assert np.array_equal(np.sort(together, axis=0), np.sort(curve(np.sort(t), order), axis=0))


@applies(lambda scheme: scheme.iterative and scheme.interpolates)
def test_the_residual_is_what_the_curve_misses(scheme: Scheme) -> None:
    curve = curve_of(scheme, None, walk(count_of(scheme), 90.0), tolerance=1e-8)
    report = curve.solve_report
    assert report is not None
    miss = quaternion.distance(curve(curve.times), curve.quaternions).max()
    assert miss <= report.residual + 1e-14


@applies(lambda scheme: scheme.iterative)
def test_reports_have_the_shape_of_the_tracks(scheme: Scheme) -> None:
    n = count_of(scheme)
    q = np.stack([walk(n, 50.0, seed) for seed in range(6)], axis=1).reshape(n, 2, 3, 4)
    report = curve_of(scheme, knots_of(scheme, n), q).solve_report
    single = curve_of(scheme, knots_of(scheme, n), q[:, 1, 2]).solve_report
    for field in ("iterations", "change", "residual", "converged"):
        assert np.shape(getattr(report, field)) == (2, 3)
        assert np.shape(getattr(single, field)) == ()
    assert np.all(report.converged)
    assert report.iterations[1, 2] == single.iterations
    assert report.stop != "residual" or np.all(report.residual <= report.tolerance)


@applies(lambda scheme: not scheme.iterative)
def test_nothing_solved_nothing_reported(scheme: Scheme) -> None:
    assert example(scheme).solve_report is None


def test_out_is_filled_and_returned(scheme: Scheme) -> None:
    curve = example(scheme)
    samples = inside(curve.times)[:12].reshape(3, 4)
    for order in scheme.orders:
        wanted = curve(samples, order)
        width = wanted.shape[-1]
        buffers = [
            np.full(wanted.shape, np.nan),
            np.full((3, 4, 2 * width), np.nan)[..., ::2],
            np.full((width, 4, 3), np.nan).T,
            np.full((3, 8, width), np.nan)[::-1, ::-2],
        ]
        for out in buffers:
            assert curve(samples, order, out=out) is out
            assert np.array_equal(out, wanted)


def test_wrong_out_is_refused(scheme: Scheme) -> None:
    curve = example(scheme)
    samples = inside(curve.times)[:6]
    frozen = np.empty((6, 4))
    frozen.setflags(write=False)
    single = np.empty((6, 4), np.float32)
    for out in (np.empty((6, 3)), np.empty((5, 4)), single, frozen, [[0.0] * 4] * 6):
        with pytest.raises(ValueError, match=r"^out"):
            curve(samples, out=out)


@applies(lambda scheme: scheme.interpolates)
def test_hits_its_keyframes(scheme: Scheme) -> None:
    curve = example(scheme)
    assert apart_up_to_sign(curve(curve.times), curve.quaternions) < HIT
    assert apart(curve(curve.times), curve.quaternions) < HIT  # with the sign they were given


@applies(lambda scheme: scheme.interpolates)
def test_keeps_given_signs(scheme: Scheme) -> None:
    """align=False: a step of 40 - 360 degrees is taken the long way round."""
    n = count_of(scheme, 6)
    q = walk(n, 40.0)
    q[n // 2 :] *= -1.0
    knots = knots_of(scheme, n)
    curve = curve_of(scheme, knots, q, align=False, **excused(scheme))
    assert apart(curve.quaternions, q) < UNIT
    assert apart(curve(knots), q) < HIT
    assert np.abs(np.linalg.norm(curve(dense(curve)), axis=-1) - 1.0).max() < LONG_UNIT
    middle = 0.5 * (knots[n // 2 - 1] + knots[n // 2])
    assert apart_up_to_sign(curve(middle), curve_of(scheme, knots, q)(middle)) > 0.1


# -- invariance ---------------------------------------------------------------------------------


def test_key_signs_do_not_matter(scheme: Scheme) -> None:
    curve = example(scheme)
    t = dense(curve)
    for seed in range(4):
        signs = np.random.default_rng(seed).choice([-1.0, 1.0], size=len(curve.quaternions))
        other = curve_of(scheme, curve.times, curve.quaternions * signs[:, None])
        assert apart(other(t), signs[0] * curve(t)) < SAME


def test_equivariance(scheme: Scheme) -> None:
    """Keyframes p q_i r give the curve p Q r: no frame of reference is privileged."""
    curve = example(scheme)
    t = dense(curve)
    one = np.array([1.0, 0.0, 0.0, 0.0])
    for p, r in [*((p, one) for p in random_units(3, 5)), *((one, r) for r in random_units(3, 6))]:

        def turned(q: np.ndarray, p: np.ndarray = p, r: np.ndarray = r) -> np.ndarray:
            return quaternion.mul(quaternion.mul(p, q), r)

        other = curve_of(scheme, curve.times, turned(curve.quaternions))
        assert apart(other(t), turned(curve(t))) < SAME, "left" if r is one else "right"


def test_time_shift(scheme: Scheme) -> None:
    curve = example(scheme)
    shift = 1e9
    other = curve_of(scheme, curve.times + shift, curve.quaternions)
    t = inside(curve.times, 4)
    for order in scheme.orders:
        assert apart(other(t + shift, order), curve(t, order)) < SAME
    assert other.domain == (curve.domain[0] + shift, curve.domain[1] + shift)


def test_time_scale(scheme: Scheme) -> None:
    """Seconds, nanoseconds or years: a curve is a function of its keyframes, not of a unit."""
    curve = example(scheme)
    t = inside(curve.times, 4)
    for scale in (1e-9, 1e-6, 1e-3, 4.0, 1e6, 1e9):
        other = curve_of(scheme, curve.times * scale, curve.quaternions)
        for order in scheme.orders:
            scaled = other(t * scale, order) * scale**order
            assert apart(scaled, curve(t, order)) < 100 * SAME, f"scale {scale}, order {order}"


def test_unix_times(scheme: Scheme) -> None:
    """Ten milliseconds apart in 2011: the work is done in time since the first keyframe."""
    n = count_of(scheme)
    times = 1.3e9 + 0.01 * np.arange(n)
    q = walk(n, 20.0)
    curve = curve_of(scheme, times, q)
    inner = curve_of(scheme, times - times[0], q)
    t = inside(times - times[0])
    for order in scheme.orders:
        # samples are rounded to 2.4e-7 s, 2.4e-5 of a segment: compare at the rounded times
        moved = (t + times[0]) - times[0]
        scale = 0.01**-order
        assert apart(curve(t + times[0], order) / scale, inner(moved, order) / scale) < SAME
    assert apart(curve(times), curve.quaternions) < HIT or not scheme.interpolates


def test_continuous_in_the_keyframes(scheme: Scheme) -> None:
    curve = example(scheme)
    t = dense(curve)
    for i in range(len(curve.quaternions)):
        moved = curve.quaternions.copy()
        moved[i] = quaternion.mul(moved[i], quaternion.exp([3e-10, -4e-10, 0.0]))
        other = curve_of(scheme, curve.times, moved)
        assert apart(other(t), curve(t)) < SENSITIVE * 1e-9 * 0.5


@applies(lambda scheme: not scheme.iterative)
def test_no_jump_along_a_family_of_keyframes(scheme: Scheme) -> None:
    """Steps that grow from 5 to 115 degrees: bisect on the largest change, it must melt away."""
    n = count_of(scheme, 4)
    knots = knots_of(scheme, n)
    t = inside(knots, 2)
    tilt = quaternion.exp(0.1 * np.random.default_rng(8).normal(size=(n, 3)))

    def at(degrees: float) -> np.ndarray:
        turned = spin(np.arange(n), (1.0, 2.0, 2.0), np.radians(degrees))
        return curve_of(scheme, knots, quaternion.mul(turned, tilt))(t)

    grid = np.linspace(5.0, min(115.0, 345.0 / (n - 1)), 45)
    curves = [at(degrees) for degrees in grid]
    change = [apart(a, b) for a, b in itertools.pairwise(curves)]
    i = int(np.argmax(change))
    lo, hi, low, high = grid[i], grid[i + 1], curves[i], curves[i + 1]
    while hi - lo > 1e-7:
        middle = 0.5 * (lo + hi)
        between = at(middle)
        if apart(low, between) > apart(between, high):
            hi, high = middle, between
        else:
            lo, low = middle, between
    assert apart(low, high) < 1e-5


# -- hard keyframes -----------------------------------------------------------------------------


def test_repeated_keyframes(scheme: Scheme) -> None:
    n = count_of(scheme)
    knots = knots_of(scheme, n)
    for repeated in ((2,), (1, 2, 3), (0,), (n - 2,), tuple(range(n - 1))):
        q = walk(n, 60.0)
        for i in repeated:
            q[i + 1] = q[i]
        curve = curve_of(scheme, knots, q, **excused(scheme))
        t = dense(curve)
        assert np.abs(np.linalg.norm(curve(t), axis=-1) - 1.0).max() < UNIT, repeated
        assert all(np.isfinite(curve(t, order)).all() for order in scheme.orders), repeated
        assert apart(curve(knots), q) < HIT or not scheme.interpolates, repeated
    assert apart(curve(t), np.broadcast_to(q[0], (len(t), 4))) < HIT  # all of them one


def test_half_turns(scheme: Scheme) -> None:
    """Steps of half a turn less a little, about one axis there and back and about others."""
    n = count_of(scheme, 5)
    axes = np.resize([[1.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], (n - 1, 3))
    axes[1::2] *= -1.0
    for short in (1e-3, 1e-6, 1e-9, 0.0):
        q = [np.array([0.5, 0.5, -0.5, 0.5])]
        for step in quaternion.exp((0.5 * np.pi - short) * axes):
            q.append(quaternion.mul(q[-1], step))
        curve = curve_of(scheme, knots_of(scheme, n), np.array(q), **excused(scheme))
        t = dense(curve)
        assert np.abs(np.linalg.norm(curve(t), axis=-1) - 1.0).max() < UNIT, short
        solved = curve.solve_report is None or curve.solve_report.converged
        if scheme.interpolates and solved:
            assert apart_up_to_sign(curve(curve.times), curve.quaternions) < HALF_TURN_HIT, short


EXACT_TURNS = {
    "halves about x": (2, (1.0, 0.0, 0.0)),
    "halves about (3, 4, 0)": (2, (3.0, 4.0, 0.0)),
    "thirds about (1, 1, 1)": (3, (1.0, 1.0, 1.0)),
    "quarters about -y": (4, (0.0, -1.0, 0.0)),
    "sixths about z": (6, (0.0, 0.0, 1.0)),
}


def exact_turn(parts: int, axis: tuple[float, ...], count: int, base: Any = None) -> np.ndarray:
    """Steps of a whole share of a turn in exact numbers where there are such: -1 is met exactly."""
    n = np.array(axis) / math.hypot(*axis)
    half = math.pi / parts
    cosine = {2: 0.0, 3: 0.5}.get(parts, math.cos(half))
    step = np.array([cosine, *(0.5 * np.ones(3) if parts == 3 else math.sin(half) * n)])
    q = [np.array([1.0, 0.0, 0.0, 0.0] if base is None else base)]
    for _ in range(count - 1):
        q.append(quaternion.mul(q[-1], step))
    return np.array(q)


@applies(lambda scheme: scheme.constant_rate != "no" and rated(scheme))
@pytest.mark.parametrize("turns", EXACT_TURNS)
def test_exact_turns(scheme: Scheme, turns: str) -> None:
    """A spin by halves, thirds, quarters of a turn: its logarithm passes -1, which has no direction."""
    parts, axis = EXACT_TURNS[turns]
    rate = 2.0 * math.pi / parts
    for n in {max(4, scheme.min_keyframes), max(8, scheme.min_keyframes)}:
        for base in (None, random_units(1, 4)[0]):
            curve = curve_of(scheme, None, exact_turn(parts, axis, n, base))
            lo, hi = (1.0, n - 2.0) if scheme.constant_rate == "interior" else (0.0, n - 1.0)
            speed = np.linalg.norm(curve(np.linspace(lo, hi, 61)[1:-1], 1), axis=-1)
            assert np.abs(speed - rate).max() < SPIN * rate, n


@applies(lambda scheme: scheme.closable and scheme.constant_rate != "no" and rated(scheme))
@pytest.mark.parametrize("turns", EXACT_TURNS)
def test_exact_turns_closed(scheme: Scheme, turns: str) -> None:
    parts, axis = EXACT_TURNS[turns]
    n = parts * -(-max(4, scheme.min_keyframes) // parts)
    q = exact_turn(parts, axis, n, random_units(1, 4)[0])
    curve = curve_of(scheme, None, q, closed=True)
    speed = np.linalg.norm(curve(np.linspace(0.0, n, 61)[1:-1], 1), axis=-1)
    assert np.abs(speed - 2.0 * math.pi / parts).max() < SPIN * 2.0 * math.pi / parts


def test_equivariance_at_half_turns(scheme: Scheme) -> None:
    """Steps of exactly half a turn: no rounding decides which way round, from whatever frame."""
    n = count_of(scheme, 5)
    quarter = exact_turn(2, (1.0, 0.0, 0.0), n)
    one = np.array([1.0, 0.0, 0.0, 0.0])
    wanted = curve_of(scheme, None, quarter, **excused(scheme))
    t = inside(wanted.times, 5)
    for p in random_units(4, 11):
        for left, right in ((p, one), (one, p)):

            def turned(q: np.ndarray, a: np.ndarray = left, b: np.ndarray = right) -> np.ndarray:
                return quaternion.mul(quaternion.mul(a, q), b)

            other = curve_of(scheme, None, turned(quarter), **excused(scheme))
            assert apart_up_to_sign(other(t), turned(wanted(t))) < HALF_TURN_HIT


@applies(lambda scheme: scheme.interpolates)
def test_rounded_holds(scheme: Scheme) -> None:
    """A pose held, but written with rounding: the direction from one to the next means nothing."""
    rng = np.random.default_rng(5)
    n = count_of(scheme)
    for size in (1e-16, 1e-15, 1e-13, 1e-10):
        for held in ((2,), (1, 2), (0,), (n - 2,), (1, 4)):
            q = walk(n, 170.0, seed=len(held))
            for i in held:
                q[i + 1] = q[i]
            q = q + size * rng.normal(size=q.shape)
            curve = curve_of(scheme, knots_of(scheme, n), q, **excused(scheme))
            t = dense(curve)
            assert np.abs(np.linalg.norm(curve(t), axis=-1) - 1.0).max() < LONG_UNIT, (size, held)
            assert all(np.isfinite(curve(t, order)).all() for order in scheme.orders), (size, held)
            if curve.solve_report is None or curve.solve_report.converged:
                assert apart_up_to_sign(curve(curve.times), curve.quaternions) < HIT, (size, held)


@applies(lambda scheme: scheme.non_uniform and scheme.interpolates)
def test_spacing_ratios(scheme: Scheme) -> None:
    """One spacing up to a thousand million times its neighbour: keyframes are met all the same."""
    n = count_of(scheme)
    ratios = (1e3, 1e6, 1e9)
    patterns = [p for r in ratios for p in ([1.0, r], [r, 1.0], [1.0, 1.0, r], [r, r, 1.0])]
    for pattern in patterns:
        knots = np.concatenate([[0.0], np.cumsum(np.resize(pattern, n - 1))])
        for last in (n, max(3, scheme.min_keyframes)):
            q = walk(last, 60.0)
            curve = curve_of(scheme, knots[:last], q, **excused(scheme))
            t = dense(curve)
            assert np.abs(np.linalg.norm(curve(t), axis=-1) - 1.0).max() < LONG_UNIT, pattern
            assert all(np.isfinite(curve(t, order)).all() for order in scheme.orders), pattern
            if curve.solve_report is None or curve.solve_report.converged:
                assert apart_up_to_sign(curve(curve.times), curve.quaternions) < HIT, pattern


def test_tiny_steps(scheme: Scheme) -> None:
    """Steps of 1e-9 rad: the curve stays between its neighbours, nothing divides by zero."""
    n = count_of(scheme)
    q = walk(n, math.degrees(1e-9))
    curve = curve_of(scheme, knots_of(scheme, n), q, **excused(scheme))
    t = dense(curve)
    assert apart_up_to_sign(curve(t), np.broadcast_to(q[0], (len(t), 4))) < 1e-7
    assert all(np.isfinite(curve(t, order)).all() for order in scheme.orders)


@applies(lambda scheme: scheme.non_uniform)
def test_very_uneven_times(scheme: Scheme) -> None:
    """Spacings in the ratio 1000 with steps in proportion."""
    n = count_of(scheme)
    knots = np.concatenate([[0.0], np.cumsum(np.resize([1.0, 1e-3, 0.5], n - 1))])
    q = spin(knots, (1.0, 0.5, -1.0), 0.6)
    curve = curve_of(scheme, knots, q, **excused(scheme))
    t = dense(curve)
    assert np.abs(np.linalg.norm(curve(t), axis=-1) - 1.0).max() < UNIT
    assert all(np.isfinite(curve(t, order)).all() for order in scheme.orders)


# -- counts and ends ----------------------------------------------------------------------------


def test_fewest_keyframes(scheme: Scheme) -> None:
    n = scheme.min_keyframes
    assert n >= 1
    curve = curve_of(scheme, None, walk(n, 50.0))
    t = np.linspace(*curve.domain, 9)
    assert np.abs(np.linalg.norm(curve(t), axis=-1) - 1.0).max() < UNIT
    assert all(np.isfinite(curve(t, order)).all() for order in scheme.orders)
    if scheme.interpolates:
        assert apart(curve(curve.times), curve.quaternions) < HIT
    fewer = walk(n, 50.0)[: n - 1]
    for build in builders(scheme):
        with pytest.raises(ValueError, match=rf"^quaternions has {n - 1} keyframes?.*{n}"):
            build(None, fewer)


@applies(closable)
def test_fewest_keyframes_closed(scheme: Scheme) -> None:
    n = scheme.min_keyframes
    curve = curve_of(scheme, None, walk(n, 50.0), closed=True, **excused(scheme))
    assert curve.domain == (0.0, float(n))
    t = np.linspace(-1.0, n + 1.0, 13)
    assert np.abs(np.linalg.norm(curve(t), axis=-1) - 1.0).max() < UNIT


def test_attributes(scheme: Scheme) -> None:
    curve = example(scheme)
    n = count_of(scheme)
    assert np.array_equal(curve.times, knots_of(scheme, n))
    assert curve.quaternions.shape == (n, 4)
    assert curve.closed is False
    assert curve.domain == (curve.times[0], curve.times[-1])
    assert isinstance(curve, qs.Curve)
    assert scheme.name in repr(curve)
    for array in (curve.times, curve.quaternions):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_input_is_not_touched(scheme: Scheme) -> None:
    n = count_of(scheme)
    times, q = knots_of(scheme, n), walk(n, 60.0) * 1.0002
    q[2] *= -1.0
    copies = times.copy(), q.copy()
    curve = curve_of(scheme, times, q)
    before = curve(inside(times))
    assert np.array_equal(times, copies[0])
    assert np.array_equal(q, copies[1])
    times += 1.0
    q *= -1.0
    assert np.array_equal(curve(inside(copies[0])), before)


def test_edge_rule(scheme: Scheme) -> None:
    """Four ulp of an end count as the end; a little further is refused."""
    n = count_of(scheme)
    for first in (8.25, 8.0 + 0.1):
        times = first + (knots_of(scheme, n) - 0.0) / 2.0
        curve = curve_of(scheme, times, walk(n, 60.0))
        for end, outwards in ((times[0], -math.inf), (times[-1], math.inf)):
            t = end
            for _ in range(4):
                t = np.nextafter(t, outwards)
                for order in scheme.orders:
                    assert np.array_equal(curve(t, order), curve(end, order))
            for _ in range(4):
                t = np.nextafter(t, outwards)
            for bad in (t, end + math.copysign(0.5, outwards), outwards, math.nan):
                with pytest.raises(ValueError, match=rf"^t = {number(bad)}"):
                    curve(bad)
                with pytest.raises(ValueError, match=rf"^t\[1, 1\] = {number(bad)}"):
                    curve([[end, end], [end, bad]])


def number(value: float) -> str:
    return str(float(value)).replace("+", r"\+")


# -- rates --------------------------------------------------------------------------------------


@applies(lambda scheme: any(k in scheme.orders for k in (1, 2)))
def test_rates_are_the_curves_own(scheme: Scheme) -> None:
    """Angular velocity and acceleration against stencils on the orientations alone."""
    for curve in (example(scheme), *([closed_example(scheme, 1)] if scheme.closable else [])):
        knots = curve.times - curve.times[0]
        t = np.unique(np.concatenate([inside(knots, 9), knots[:-1]]))
        measured = stencil.rates_of(curve, t)
        h = np.diff(knots).min()
        for order in set(scheme.orders) - {0} - set(curve.numeric_orders):
            gap = np.linalg.norm(curve(t, order) - measured[order - 1], axis=1) * h**order
            assert np.quantile(gap, 1.0 - BAD_SHARE) < RATES, f"order {order} of {curve}"


@applies(rated)
def test_rates_against_scipy_differences(scheme: Scheme) -> None:
    """The body frame, and not the world's: q(t + h) = q(t) exp(h omega / 2)."""
    curve = example(scheme)
    t = inside(curve.times, 3)
    h = 1e-5
    step = quaternion.log(quaternion.mul(quaternion.conj(curve(t - h)), curve(t + h)))
    gap = np.linalg.norm(step / h - curve(t, 1), axis=1)
    assert np.quantile(gap, 1.0 - BAD_SHARE) < 1e-5


@applies(rated)
def test_world_frame(scheme: Scheme) -> None:
    curve = example(scheme)
    t = inside(curve.times)[:6].reshape(2, 3)
    for order in scheme.orders[1:]:
        body = curve(t, order)
        turned = curve.rotation(t.reshape(-1)).apply(body.reshape(-1, 3)).reshape(body.shape)
        out = np.empty_like(body)
        assert apart(curve(t, order, frame="world"), turned) <= SAME * np.abs(body).max()
        assert curve(t, order, frame="world", out=out) is out
        assert np.array_equal(out, curve(t, order, frame="world"))
        assert np.array_equal(curve(t, order, frame="body"), body)
    assert np.array_equal(curve(t, frame="world"), curve(t))


def spin_error(scheme: Scheme, degrees: float, n: int, interior: bool, tail: bool = False) -> float:
    """The largest departure from a spin, an angle in rad (at the ends alone, with `tail`)."""
    knots = knots_of(scheme, n)
    rate = np.radians(degrees) / np.diff(knots).max()
    base = random_units(1, seed=3)[0]
    curve = curve_of(scheme, knots, spin(knots, (2.0, -1.0, 2.0), rate, base), **excused(scheme))
    ends = 1 if scheme.support is not None and scheme.support <= 4 else 2
    lo, hi = (knots[ends], knots[-1 - ends]) if interior or tail else (knots[0], knots[-1])
    t = inside(knots, 8)
    t = t[(t < lo) | (t > hi)] if tail else t[(t >= lo) & (t <= hi)]
    return apart_up_to_sign(curve(t), spin(t, (2.0, -1.0, 2.0), rate, base))


SPINS = [(40.0, 9), (75.0, 6)]


@applies(lambda scheme: scheme.constant_rate != "no")
def test_constant_rate_is_kept(scheme: Scheme) -> None:
    interior = scheme.constant_rate == "interior"
    for degrees, n in SPINS:
        n = count_of(scheme, n)
        assert spin_error(scheme, degrees, n, interior) < SPIN
        if interior:
            assert spin_error(scheme, degrees, n, interior, tail=True) > 1e-3


@applies(lambda scheme: scheme.constant_rate == "no")
def test_constant_rate_is_not_kept(scheme: Scheme) -> None:
    spins = [*SPINS, (120.0, 5), (170.0, 9)]
    n = count_of(scheme, 0)
    assert max(spin_error(scheme, d, max(n, m), interior=True) for d, m in spins) > 10 * SPIN


# -- closed curves ------------------------------------------------------------------------------


@applies(closable)
@pytest.mark.parametrize("turns", [0, 1, 2, 3])
def test_closed_curves_wrap(scheme: Scheme, turns: int) -> None:
    """Both closing signs, over many periods."""
    n = count_of(scheme, 10)
    times = knots_of(scheme, n + 1) + 2.0
    q = loop(times, turns)
    curve = curve_of(scheme, times, q, closed=True)
    sign = float(np.sign(np.dot(curve.quaternions[-1], curve.quaternions[0])))
    assert sign == (-1.0) ** turns
    assert curve.closed is True
    assert len(curve.times) == len(curve.quaternions) + 1
    first, last = curve.domain
    period = last - first
    t = np.concatenate([inside(times), times[:-1]])
    for k in (-1000, -3, -2, -1, 1, 2, 5, 1001):
        assert apart(curve(t + k * period), sign**k * curve(t)) < SAME * 1e3
        for order in scheme.orders[1:]:
            scale = max(1.0, np.abs(curve(t, order)).max())
            inner = inside(times)
            assert apart(curve(inner + k * period, order), curve(inner, order)) < 1e-6 * scale
    if scheme.interpolates:
        assert apart(curve(last), sign * curve.quaternions[0]) < HIT
        assert apart(curve(times[:-1]), curve.quaternions) < HIT


@applies(closable)
def test_closed_curves_do_not_care_where_they_start(scheme: Scheme) -> None:
    n = count_of(scheme)
    times = knots_of(scheme, n + 1)
    q = loop(times, 1)
    curve = curve_of(scheme, times, q, closed=True)
    later = np.append(times[2:], times[1:3] + times[-1])
    other = curve_of(scheme, later, np.concatenate([q[2:], -q[:2]]), closed=True)
    t = inside(times)
    assert apart(other(t), curve(t)) < SAME * 10


@applies(closable)
@pytest.mark.parametrize("closing_sign", [1, -1, None])
def test_closing_sign(scheme: Scheme, closing_sign: int | None) -> None:
    """align=False: s = +1 unless closing_sign=-1, whatever the keyframes suggest."""
    n = count_of(scheme, 9)
    times = knots_of(scheme, n + 1)
    sign = closing_sign or 1
    q = loop(times, 2 if sign > 0 else 1)
    curve = curve_of(scheme, times, q, closed=True, align=False, closing_sign=closing_sign)
    t, period = inside(times), times[-1]
    assert apart(curve(t + period), sign * curve(t)) < SAME * 10


@applies(closable)
def test_closed_refuses_what_is_no_time(scheme: Scheme) -> None:
    curve = closed_example(scheme)
    for bad in (math.nan, math.inf, -math.inf):
        with pytest.raises(ValueError, match=rf"^t\[1\] = {bad}"):
            curve([0.0, bad])


@applies(lambda scheme: not scheme.closable)
def test_closed_is_refused(scheme: Scheme) -> None:
    n = count_of(scheme)
    for build in builders(scheme):
        with pytest.raises(ValueError, match=r"^closed=True"):
            build(None, walk(n, 50.0), closed=True)


@applies(lambda scheme: not scheme.non_uniform)
def test_uneven_times_are_refused(scheme: Scheme) -> None:
    n = count_of(scheme)
    for build in builders(scheme):
        with pytest.raises(ValueError, match=r"^times\[1\] to times\[2\] is 0\.75, not 0\.375"):
            build(uneven(n), walk(n, 50.0))


# -- other forms of a curve ---------------------------------------------------------------------


def test_log_is_the_logarithm(scheme: Scheme) -> None:
    n = count_of(scheme)
    q = np.stack([walk(n, 60.0, seed) for seed in range(2)], axis=1)
    curve = curve_of(scheme, knots_of(scheme, n), q)
    t = dense(curve)[:12].reshape(3, 4)
    assert curve.log(t).shape == (3, 4, 2, 3)
    assert curve.log(0.5).shape == (2, 3)
    assert apart(quaternion.exp(curve.log(t)), curve(t)) < SAME
    assert np.linalg.norm(curve.log(t), axis=-1).max() <= np.pi + UNIT
    assert apart(curve.log(t)[1, 2], curve.log(t[1, 2])) < UNIT  # a function of t alone


@applies(lambda scheme: scheme.interpolates)
def test_log_of_a_spin_goes_on(scheme: Scheme) -> None:
    """About one axis the logarithm is an angle: two turns and more, no fold at pi."""
    n = count_of(scheme, 9)
    knots = knots_of(scheme, n)
    axis = np.array([0.6, 0.0, 0.8])
    for start in (0.4, -0.7):
        angle = start + 0.3 * np.pi * np.arange(n)
        curve = curve_of(scheme, knots, quaternion.exp(angle[:, None] * axis))
        t = np.linspace(*curve.domain, 400)
        log = curve.log(t)
        assert apart(quaternion.exp(log), curve(t)) < SAME
        follows = apart(curve.log(knots), angle[:, None] * axis) < 1e-8
        assert follows or scheme.constant_rate == "no"  # some turn back beyond a full turn
        assert np.abs(np.diff(log @ axis)).max() < 1.0  # continuous: no step near 2 pi
        assert apart(log[137], curve.log(t[137])) < UNIT


@applies(lambda scheme: scheme.closable and scheme.interpolates)
def test_log_of_a_closed_spin_goes_on(scheme: Scheme) -> None:
    n = count_of(scheme, 7)
    times = 0.5 * np.arange(n + 1)
    angle = 0.2 + 3 * np.pi * np.arange(n + 1) / n  # three half turns of S^3: s = -1
    q = quaternion.exp(angle[:-1, None] * [0.0, 1.0, 0.0])
    curve = curve_of(scheme, times, q, closed=True)
    for k in (-3, 0, 4):
        wanted = angle + 3 * np.pi * k
        assert apart(curve.log(times + k * times[-1])[:, 1:2], wanted[:, None]) < 1e-8
    t = np.linspace(-5.0, 9.0, 50)
    assert apart(quaternion.exp(curve.log(t)), curve(t)) < SAME


def test_rotation(scheme: Scheme) -> None:
    from scipy.spatial.transform import Rotation

    curve = example(scheme)
    t = inside(curve.times)
    assert apart_up_to_sign(curve.rotation(t).as_quat(scalar_first=True), curve(t)) < UNIT
    assert curve.rotation(0.5).single
    same = curve_of(scheme, curve.times, Rotation.from_quat(curve.quaternions, scalar_first=True))
    assert apart_up_to_sign(same(t), curve(t)) < SAME


def test_pickling(scheme: Scheme) -> None:
    curve = closed_example(scheme, turns=1) if scheme.closable else example(scheme)
    copy = pickle.loads(pickle.dumps(curve))
    t = inside(curve.times)
    assert type(copy) is scheme
    assert copy.closed == curve.closed
    assert copy.solve_report == curve.solve_report
    for order in scheme.orders:
        assert np.array_equal(copy(t, order), curve(t, order))


def test_threads_change_nothing(scheme: Scheme) -> None:
    """Bit for bit, whatever the number of threads; the first bad sample is the one reported."""
    curve = example(scheme)
    compiled = issubclass(scheme, segments.SegmentCurve)
    t = np.linspace(*curve.domain, 3 * segments.THREAD_MINIMUM + 77 if compiled else 301)
    np.random.default_rng(0).shuffle(t[: t.size // 3])
    for order in scheme.orders:
        once = curve(t, order)
        for threads in (2, 3) if compiled else (2,):
            assert np.array_equal(curve(t, order, threads=threads), once), f"{threads} threads"
    bad = t.size - 120
    t[bad], t[bad + 50] = curve.domain[1] + 1.0, math.nan
    with pytest.raises(ValueError, match=rf"^t\[{bad}\] = "):
        curve(t, threads=3)
    for threads in (0, -1, 1.5, "2"):
        with pytest.raises(ValueError, match=r"^threads="):
            curve(0.5, threads=threads)


# -- refusals -----------------------------------------------------------------------------------


def builders(scheme: Scheme) -> list[Callable[..., Curve]]:
    """Both ways to a curve."""
    return [scheme, lambda *given, **options: qs.build(scheme.name, *given, **options)]


KEYS = walk(12, 50.0)


def replaced(array: Any, index: Any, value: Any, dtype: Any = float) -> Any:
    array = np.array(array, dtype)
    array[index] = value
    return array


def with_antipode(count: int) -> np.ndarray:
    q = walk(count, 50.0)
    q[2] = -q[1]
    return q


INPUT = {
    "one row": (None, KEYS[0], {}, r"^quaternions has shape \(4,\)"),
    "three columns": (None, KEYS[:, :3], {}, r"^quaternions has shape \(12, 3\)"),
    "no track": (None, np.empty((12, 0, 4)), {}, r"^quaternions has shape \(12, 0, 4\)"),
    "ragged": (None, [[1, 0, 0, 0], [1, 0, 0]], {}, r"^quaternions"),
    "masked": (
        None,
        np.ma.array(KEYS, mask=KEYS[3] == KEYS),
        {},
        r"^quaternions\[3, 0\] is masked",
    ),
    "masked times": (
        np.ma.array(range(12), mask=np.arange(12) == 5),
        KEYS,
        {},
        r"^times\[5\] is masked",
    ),
    "homogeneous": (
        None,
        np.tile([[0.0, -1, 0, 3], [1, 0, 0, 2], [0, 0, 1, 1], [0, 0, 0, 1]], (12, 1, 1)),
        {},
        r"^quaternions has shape \(12, 4, 4\) .*Rotation\.from_matrix",
    ),
    "matrices": (None, np.tile(np.eye(3), (12, 1, 1)), {}, r"Rotation\.from_matrix"),
    "closed": (None, KEYS, {"closed": 2}, r"^closed=2: expected True or False"),
    "closed far": (None, KEYS, {"closed": 3000000}, r"^closed=3000000: expected True or False"),
    "align": (None, KEYS, {"align": "yes"}, r"^align='yes': expected True or False"),
    "denormal": (
        replaced(range(12), 1, 5e-324),
        KEYS,
        {},
        r"^times\[0\] to times\[1\] is 5e-324, shorter than .*float64 cannot carry",
    ),
    "no digits": (
        replaced(range(12), 1, 1e-40),
        KEYS,
        {},
        r"^times\[0\] to times\[1\] is 1e-40, below",
    ),
    "long": (
        replaced(range(12), 11, 1e300),
        KEYS,
        {},
        r"^times\[10\] to times\[11\] is 1e\+300, longer",
    ),
    "no time": (np.array(["NaT"] * 12, "datetime64[s]"), KEYS, {}, r"^times\[0\] is not a time"),
    "complex": (None, KEYS + 0j, {}, r"^quaternions: complex"),
    "text": (None, [["a"] * 4] * 12, {}, r"^quaternions: not real numbers"),
    "objects": (None, [[None] * 4] * 12, {}, r"^quaternions: not real numbers"),
    "NaN": (None, replaced(KEYS, (5, 2), np.nan), {}, r"^quaternions\[5, 2\] = nan"),
    "infinity": (None, replaced(KEYS, (3, 0), -np.inf), {}, r"^quaternions\[3, 0\] = -inf"),
    "norm": (None, replaced(KEYS, 4, 1.002 * KEYS[4]), {}, r"^quaternions\[4\] = .* norm 1\.002"),
    "zero": (None, replaced(KEYS, 6, 0.0), {}, r"^quaternions\[6\] = .* norm 0"),
    "huge": (None, replaced(KEYS, 7, 1e200), {}, r"^quaternions\[7\] = .* norm inf"),
    "norm in a track": (
        None,
        replaced(np.stack([KEYS, KEYS], 1), (3, 1), 2.0),
        {},
        r"^quaternions\[3, 1\] = .* norm 4",
    ),
    "too few times": (np.arange(11.0), KEYS, {}, r"^times has shape \(11,\).*\(12,\)"),
    "times of two axes": (np.zeros((12, 1)), KEYS, {}, r"^times has shape \(12, 1\)"),
    "scalar times": (3.0, KEYS, {}, r"^times has shape \(\)"),
    "times complex": (np.arange(12) * 1j, KEYS, {}, r"^times: complex"),
    "times text": (list("abcdefghijkl"), KEYS, {}, r"^times: not real numbers"),
    "times NaN": (replaced(range(12), 4, np.nan), KEYS, {}, r"^times\[4\] = nan"),
    "times infinite": (replaced(range(12), 11, np.inf), KEYS, {}, r"^times\[11\] = inf"),
    "times repeat": (
        replaced(range(12), 7, 6.0),
        KEYS,
        {},
        r"^times\[7\] = 6\.0 does not exceed times\[6\] = 6\.0",
    ),
    "times fall": (
        replaced(range(12), 3, 1.5),
        KEYS,
        {},
        r"^times\[3\] = 1\.5 does not exceed times\[2\] = 2\.0",
    ),
    "times span": (
        1.7e308 * np.linspace(-1.0, 1.0, 12),
        KEYS,
        {},
        r"^times",
    ),
    "antipodes": (
        None,
        with_antipode(12),
        {"align": False},
        r"^quaternions\[1\] and quaternions\[2\] are exact antipodes",
    ),
    "option": (None, KEYS, {"tollerance": 1e-3}, r"no option 'tollerance'"),
    "closing sign": (None, KEYS, {"closing_sign": -1}, r"^closing_sign=-1"),
}


@pytest.mark.parametrize("case", INPUT)
def test_bad_input_is_refused(scheme: Scheme, case: str) -> None:
    times, q, options, message = INPUT[case]
    for build in builders(scheme):
        with pytest.raises(ValueError, match=message):
            build(times, q, **options)


@applies(closable)
def test_bad_closed_input_is_refused(scheme: Scheme) -> None:
    around = replaced(KEYS, -1, -KEYS[0])
    for build in builders(scheme):
        with pytest.raises(ValueError, match=r"^times has shape \(12,\): expected \(13,\)"):
            build(np.arange(12.0), KEYS, closed=True)
        with pytest.raises(ValueError, match=r"^times\[12\] = 11\.0 does not exceed"):
            build(replaced(range(13), 12, 11.0), KEYS, closed=True)
        with pytest.raises(ValueError, match=r"^quaternions\[11\] and quaternions\[0\]"):
            build(None, around, closed=True, align=False)
        for sign in (0, 2, "plus"):
            with pytest.raises(ValueError, match=r"^closing_sign="):
                build(None, KEYS, closed=True, align=False, closing_sign=sign)
        with pytest.raises(ValueError, match=r"^closing_sign=-1"):
            build(None, KEYS, closed=True, closing_sign=-1)


def test_bad_options_are_refused(scheme: Scheme) -> None:
    from quatspline.options import declared_by

    known = declared_by(scheme)
    for name in known:
        misspelt = name[:-1] + name[-1] * 2
        message = f"{scheme.name} has no option '{misspelt}': {nearest(misspelt, known)}"
        assert repr(name) in message
        for build in builders(scheme):
            with pytest.raises(ValueError, match=message):
                build(None, KEYS, **{misspelt: 1})
            with pytest.raises(ValueError, match=name):
                build(None, KEYS, **{name: object()})


def test_bad_evaluation_is_refused(scheme: Scheme) -> None:
    curve = example(scheme)
    for order in (3, -1, 1.0, "1", None):
        with pytest.raises(ValueError, match=r"^order="):
            curve(0.5, order)
    for order in {0, 1, 2} - set(scheme.orders):
        with pytest.raises(ValueError, match=rf"^order={order}.*{scheme.name}"):
            curve(0.5, order)
    for frame in ("World", None, 1):
        with pytest.raises(ValueError, match=r"^frame="):
            curve(0.5, frame=frame)
    for t in ("a", None, 1j, [0.0, [1.0]], [None], np.array([True])):
        with pytest.raises(ValueError, match=r"^t: "):
            curve(t)


def test_unit_norm_is_restored(scheme: Scheme) -> None:
    """Within 1e-3 of the unit sphere keyframes are normalised."""
    n = count_of(scheme)
    q = walk(n, 60.0)
    scaled = q * (1.0 + 9e-4 * np.resize([1.0, -1.0, 0.5], n))[:, None]
    curve = curve_of(scheme, knots_of(scheme, n), scaled)
    assert apart(curve.quaternions, q) < UNIT
    t = dense(curve)
    assert apart(curve(t), example(scheme)(t)) < SAME


STAMPS = 1_650_000_000_000_000_000
"""Nanoseconds since 1970: float64 tells those of today apart by 256."""


@applies(lambda scheme: scheme.non_uniform)
def test_integer_stamps_are_subtracted_as_integers(scheme: Scheme) -> None:
    n = count_of(scheme)
    knots = np.cumsum(np.resize([10_000_000, 10_000_100, 9_999_900, 1_000_001], n)) - 10_000_000
    curve, inner = (curve_of(scheme, t, walk(n, 20.0)) for t in (STAMPS + knots, knots))
    t = np.round(inside(knots.astype(float))).astype(np.int64)
    for order in scheme.orders:
        assert np.array_equal(curve(STAMPS + t, order), inner(t, order))
        assert np.array_equal(
            curve((STAMPS + t).astype("datetime64[ns]").astype(int), order), inner(t, order)
        )
    assert curve.domain == (STAMPS, STAMPS + int(knots[-1]))
    moments = (STAMPS + knots).astype("datetime64[ns]")
    timed, seconds = (curve_of(scheme, x, walk(n, 20.0)) for x in (moments, knots / 1e9))
    assert apart(timed(moments), seconds(knots / 1e9)) < SAME


# -- the tests of the tests ---------------------------------------------------------------------


CHECKS = checks_in(__name__)

NOT_NEEDED = {"test_uneven_times_are_refused"}
"""Of those that are installed every scheme may take uneven times; test_keyframes has one that does not."""


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_every_check_runs_somewhere(check: Any) -> None:
    assert runs_somewhere(check) or check.__name__ in NOT_NEEDED


MAY_DEPART = {
    "test_keeps_given_signs",
    "test_order",
    "test_support",
    "test_lookahead",
    "test_continuity_holds",
    "test_spacing_ratios",
    "test_log_of_a_spin_goes_on",
}
"""Not every construction can go the long way round: rotation matrices do not tell q from -q.  The others
are for one that marches from keyframe to keyframe: many keyframes, or uneven ones, are beyond it."""


def test_departures_name_checks_and_only_peers_have_others_than_these(scheme: Scheme) -> None:
    import test_claims

    names = {check.__name__ for check in [*CHECKS, *test_claims.CHECKS]}
    assert scheme.peer is not None or set(scheme.departs) <= MAY_DEPART
    assert set(scheme.departs) <= names
