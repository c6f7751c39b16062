"""Curves that hold: the first and last pose outside an open domain, at rest."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import quatspline as qs
from walks import walk

SCHEMES = ("slerp", "quartic", "kim", "scipy-slerp", "splines-squad")
"""Compiled, iterative, a peer, a peer whose rates are numerical."""


@pytest.mark.parametrize("name", SCHEMES)
def test_the_ends_are_held_at_rest(name: str) -> None:
    if name not in qs.schemes():
        pytest.skip(f"{name} is not installed")
    q = walk(8, 40.0, seed=1)
    t = 5.0 + np.arange(8.0)
    bare, held = qs.build(name, t, q), qs.build(name, t, q, hold=True)
    inside = np.linspace(5, 12, 33)
    outside = np.array([[-1e9, 4.9], [12.1, 1e300]])
    for order in bare.orders:
        np.testing.assert_array_equal(held(inside, order), bare(inside, order))
        if order:
            np.testing.assert_array_equal(held(outside, order), np.zeros((2, 2, 3)))
            np.testing.assert_array_equal(held(outside, order, frame="world"), 0.0)
    ends = bare(np.array([[5.0, 5.0], [12.0, 12.0]]))
    np.testing.assert_array_equal(held(outside), ends)
    np.testing.assert_array_equal(held(4), ends[0, 0])
    np.testing.assert_allclose(held.log([4.0, 13.0]), bare.log([5.0, 12.0]))
    np.testing.assert_array_equal(held.rotation(13.0).as_matrix(), bare.rotation(12.0).as_matrix())
    for bad in (4.9, 12.1):
        with pytest.raises(ValueError, match="outside the domain"):
            bare(bad)


def test_what_is_no_time_is_refused_all_the_same() -> None:
    curve = qs.build("slerp", None, walk(4, 40.0, seed=0), hold=True)
    for bad in (np.nan, np.inf, -np.inf):
        with pytest.raises(ValueError, match=r"t\[1\].*not a finite number"):
            curve([0.0, bad])


def test_stamps_of_other_kinds() -> None:
    q = walk(4, 40.0, seed=0)
    days = np.array(["2020-01-01", "2020-01-02", "2020-01-03", "2020-01-05"], "datetime64[D]")
    held = qs.build("squad", days, q, hold=True)
    np.testing.assert_array_equal(held(np.datetime64("2019-05-05")), held(days[0]))
    np.testing.assert_array_equal(held(np.datetime64("2021-05-05"), 1), 0.0)
    ticks = 2**60 + np.array([0, 10, 20, 30])
    held = qs.build("squad", ticks, q, hold=True)
    np.testing.assert_array_equal(held(2**60 - 3), held(ticks[0]))


def test_tracks_memory_and_pickles() -> None:
    q = np.stack([walk(5, 40.0, seed=s) for s in (0, 1)], axis=1)
    held = qs.build("local-quintic", None, q, hold=True)
    out = np.full((3, 2, 3), 7.0)
    assert held([-1.0, 2.0, 9.0], 1, out=out) is out
    np.testing.assert_array_equal(out[[0, 2]], 0.0)
    assert np.abs(out[1]).max() > 0
    again = pickle.loads(pickle.dumps(held))
    np.testing.assert_array_equal(again(9.0), held(4.0))
    assert again.options == held.options == {}
    spread = np.full((3, 8), 7.0)[:, ::2]
    single = qs.build("local-quintic", None, q[:, 0], hold=True)
    single([-1.0, 2.0, 9.0], out=spread)
    np.testing.assert_array_equal(spread, held([-1.0, 2.0, 9.0])[:, 0])


def test_closed_curves_wrap_instead() -> None:
    q = walk(5, 40.0, seed=2)
    wrapping, held = (qs.build("squad", None, q, closed=True, hold=h) for h in (False, True))
    t = np.linspace(-7, 13, 20)
    np.testing.assert_array_equal(held(t), wrapping(t))


@pytest.mark.parametrize("hold", [None, 2, "yes"])
def test_other_values_are_refused(hold: object) -> None:
    with pytest.raises(ValueError, match=r"hold=.*expected True or False"):
        qs.build("slerp", None, walk(3, 40.0, seed=0), hold=hold)
