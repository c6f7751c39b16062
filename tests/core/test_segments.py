"""The driver of segment curves: blocks of every kind, long curves fitted in windows, threads, tracks."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import quatspline as qs
from quatspline.curve import Curve
from quatspline.engines.driver import BATCH
from quatspline.engines.locating import LONG
from quatspline.segments import CHUNK, LAZY, SegmentCurve
from walks import apart, applies, walk

ROUNDING = 1e-12
"""Kernels for any angle and for near ones agree to rounding, accelerations being the largest."""


def orders(curve: Curve, t: np.ndarray) -> list[np.ndarray]:
    return [curve(t, order) for order in (0, 1, 2)]


@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("a_segment", [1, 3, LONG - 1, LONG, 70, 500])
def test_blocks_of_every_kind_agree_with_single_samples(closed: bool, a_segment: int) -> None:
    """Few samples per segment make mixed blocks, many make long ones, both in one batch too."""
    rng = np.random.default_rng(a_segment)
    h = rng.uniform(0.5, 2.0, 40 + closed)
    times = np.concatenate([[0.0], np.cumsum(h)])
    curve = qs.build("quintic", times, walk(41, 50.0, seed=1), closed=closed)
    sparse = np.sort(rng.uniform(*curve.domain, 40 * a_segment))
    dense = np.linspace(times[7], times[8], 3 * LONG + 5)
    t = np.sort(np.concatenate([sparse, dense, times]))
    wide = t + (3 if closed else 0) * (times[-1] - times[0])
    for samples in (t, t[::-1], rng.permutation(t), wide):
        for order in (0, 1, 2):
            alone = np.array([curve(float(x), order) for x in samples[:: max(1, t.size // 300)]])
            together = curve(samples, order)[:: max(1, t.size // 300)]
            np.testing.assert_array_equal(together, alone)


def test_the_end_of_a_batch_may_fall_anywhere() -> None:
    curve = qs.build("slerp", None, walk(30, 50.0, seed=2))
    for count in (1, 2, LONG, BATCH - 1, BATCH, BATCH + 1, 3 * BATCH + 7):
        t = np.linspace(0.0, 29.0, count)
        reversed_ = curve(t[::-1].copy())[::-1]
        np.testing.assert_array_equal(curve(t), reversed_)


def test_the_first_bad_sample_is_named_wherever_it_lies() -> None:
    curve = qs.build("slerp", None, walk(30, 50.0, seed=2))
    t = np.linspace(0.0, 29.0, 3 * BATCH)
    for place in (0, 5, BATCH - 1, BATCH, 2 * BATCH + 100, 3 * BATCH - 1):
        for bad in (np.nan, np.inf, -np.inf, 29.5, -0.5):
            spoilt = t.copy()
            spoilt[place] = bad
            spoilt[place + 1 :: 7] = np.nan
            with pytest.raises(ValueError, match=rf"^t\[{place}\] = "):
                curve(spoilt)


def _local(scheme: type[Curve]) -> bool:
    return issubclass(scheme, SegmentCurve) and scheme.support is not None


@applies(_local)
def test_windows_of_a_long_curve_are_the_curve(scheme: type[Curve]) -> None:
    """A long curve is fitted where it is called: the same numbers as when it is fitted whole."""
    count = LAZY + CHUNK // 2 + 3
    rng = np.random.default_rng(3)
    for closed in {False, scheme.closable}:
        h = rng.uniform(0.5, 2.0, count - 1 + closed) if scheme.non_uniform else np.ones(count)
        times = np.concatenate([[0.0], np.cumsum(h)])[: count + closed]
        q = np.tile(walk(500, 40.0, seed=4), (count // 500 + 1, 1))[:count]
        lazy, whole = (scheme(times, q, closed=closed) for _ in range(2))
        orders(whole, times)
        period = times[-1] - times[0]
        windows = [times[CHUNK - 2 : CHUNK + 3], times[3 * CHUNK : 3 * CHUNK + 40], times[-9:]]
        for window in windows:
            t = np.linspace(window[0], window[-1], 99)
            for order, (a, b) in enumerate(zip(orders(lazy, t), orders(whole, t), strict=True)):
                assert apart(a, b) < ROUNDING * 10**order
        if closed:
            t = np.linspace(times[-3], times[-1] + times[3] - times[0], 50)
            assert apart(lazy(t), whole(t)) < ROUNDING
            assert apart(lazy(t[:1] - 2 * period), whole(t[:1] - 2 * period)) < ROUNDING


def test_a_long_curve_is_fitted_once_by_many_threads() -> None:
    q = np.tile(walk(500, 40.0, seed=6), (2 * LAZY // 500, 1))
    whole = qs.build("quartic", None, q)
    t = np.random.default_rng(0).uniform(*whole.domain, (64, 5))
    expected = np.array([whole(row) for row in t])
    for _ in range(3):
        shared = qs.build("quartic", None, q)
        with ThreadPoolExecutor(8) as pool:
            np.testing.assert_array_equal(np.array(list(pool.map(shared, t))), expected)


def test_the_samples_own_memory_may_receive_the_result() -> None:
    curve = qs.build("quartic", None, walk(30, 50.0, seed=2))
    memory = np.zeros((3000, 4))
    memory.reshape(-1)[:3000] = np.linspace(0.0, 29.0, 3000)
    t = memory.reshape(-1)[:3000]
    expected = curve(t.copy())
    np.testing.assert_array_equal(curve(t, out=memory), expected)


def test_a_long_curve_refuses_as_a_short_one() -> None:
    curve = qs.build("quartic", None, walk(LAZY + 2, 40.0, seed=5))
    for t, message in (([1.0, np.nan], r"t\[1\] = nan"), ([2.0, -1.0], r"t\[1\] = -1.0")):
        with pytest.raises(ValueError, match=message):
            curve(t)
    assert curve(np.empty(0)).shape == (0, 4)


@pytest.mark.parametrize("name", ["quartic", "catmull-rom", "nielson"])
def test_tracks_and_threads_change_nothing(name: str) -> None:
    """A skeleton of 31 joints: every track is the curve built of it alone."""
    q = np.stack([walk(60, 50.0, seed=k) for k in range(31)], axis=1)
    q *= np.where(np.einsum("nki,nki->nk", q, np.roll(q, 1, 0)) < 0, -1, 1)[..., None]
    curve = qs.build(name, None, q)
    t = np.linspace(0.0, 59.0, 2000)
    for order in (0, 1, 2):
        together = curve(t, order)
        for k in (0, 17, 30):
            alone = qs.build(name, None, q[:, k])(t, order)
            assert apart(together[:, k], alone) < ROUNDING * 10**order
    dense = np.linspace(0.0, 59.0, 90_000)
    np.testing.assert_array_equal(curve(dense, threads=2)[::97], curve(dense[::97]))


@pytest.mark.parametrize("closed", [False, True])
def test_few_samples_of_a_long_curve_fit_what_they_lie_in(closed: bool) -> None:
    """Chunks that hold a sample and no other, at knots and beside them, whatever their order."""
    q = np.tile(walk(500, 40.0, seed=6), (LAZY // 500 + 2, 1))
    knots = np.cumsum(np.random.default_rng(1).uniform(0.5, 2.0, len(q) + closed))
    lazy, whole = (qs.build("quartic", knots, q, closed=closed) for _ in range(2))
    whole(knots)
    for chunk in (40, 3, 17, 4):
        near = knots[chunk * CHUNK] + np.array([0.0, -1e-9, 0.3, 1e-9])
        np.testing.assert_array_equal(lazy(near), whole(near))
    scattered = np.random.default_rng(2).permutation(knots[[5, 20 * CHUNK - 1, -2]])
    np.testing.assert_array_equal(lazy(scattered), whole(scattered))
    fitted = np.flatnonzero(~lazy._waiting)
    last = (len(q) + closed - 2) // CHUNK
    assert fitted.tolist() == sorted({2, 3, 4, 16, 17, 39, 40, 0, 19, last})
    every = 0.5 * (knots[1:] + knots[:-1])
    np.testing.assert_array_equal(lazy(every), whole(every))
    assert lazy._waiting is None
