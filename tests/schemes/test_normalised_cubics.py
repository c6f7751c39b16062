"""Cubics in R^4, normalised: golden numbers, scipy's splines, glTF's formula with its tangents."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline, CubicSpline

import quatspline as qs
from golden import assert_golden_new, new_entries
from quatspline import quaternion
from quatspline.quaternion import FloatArray
from smoothness import assert_own_rates
from walks import apart, inside, loop, spin, uneven, walk

SCHEMES = ("normalised-cubic", "gltf-cubic")


@pytest.mark.parametrize("entry", [e for name in SCHEMES for e in new_entries(name)])
def test_golden(entry: str) -> None:
    assert_golden_new(entry.split()[0], entry)


@pytest.mark.parametrize("count", [2, 3, 4, 9])
def test_normalised_cubic_is_the_natural_spline(count: int) -> None:
    t, q = uneven(count), walk(count, 100.0)
    curve = qs.build("normalised-cubic", t, q)
    s = inside(t, 9)
    spline = CubicSpline(t, curve.quaternions, bc_type="natural")
    assert apart(curve(s), quaternion.normalise(spline(s))) < 1e-14
    assert_own_rates(curve, inside(t, 5), (1e-8, 1e-6))


@pytest.mark.parametrize("count", [2, 3, 8])
@pytest.mark.parametrize("turns", [0, 1])
def test_normalised_cubic_closes_with_its_sign(count: int, turns: int) -> None:
    """The closed spline is periodic over two turns where it returns as -q."""
    t = uneven(count + 1)
    curve = qs.build("normalised-cubic", t, loop(t, turns), closed=True)
    sign = curve.keyframes.sign
    assert count == 2 or sign == (-1.0) ** turns
    q = curve.quaternions
    both = np.concatenate([q, sign * q, q[:1]])
    spline = CubicSpline(np.append(t, t[1:] + t[-1]), both, bc_type="periodic")
    s = inside(t, 9)
    assert apart(curve(s), quaternion.normalise(spline(s))) < 1e-13


def hermite(
    t: FloatArray, q: FloatArray, arriving: FloatArray, leaving: FloatArray, s: FloatArray
) -> FloatArray:
    """The formula of glTF, segment by segment, of an open curve."""
    i = np.clip(np.searchsorted(t, s, "right") - 1, 0, len(t) - 2)
    h = np.diff(t)[i]
    u, h = ((s - t[i]) / h)[:, None], h[:, None]
    x = (2 * u**3 - 3 * u**2 + 1) * q[i] + h * (u**3 - 2 * u**2 + u) * leaving[i]
    x += (3 * u**2 - 2 * u**3) * q[i + 1] + h * (u**3 - u**2) * arriving[i + 1]
    return quaternion.normalise(x)


def tangents(count: int, *tracks: int) -> tuple[FloatArray, FloatArray]:
    a, b = np.random.default_rng(5).normal(size=(2, count, *tracks, 4))
    return a, b


def test_parabolas_are_the_default_tangents() -> None:
    t, q = uneven(9), walk(9, 100.0)
    q = quaternion.align(q)
    v = np.gradient(q, t, axis=0, edge_order=2)
    curve, given = (
        qs.build("gltf-cubic", t, q, **options)
        for options in ({}, {"in_tangents": v, "out_tangents": v})
    )
    s = inside(t, 9)
    assert apart(curve(s), quaternion.normalise(CubicHermiteSpline(t, q, v)(s))) < 1e-14
    for order in range(3):
        assert apart(given(s, order), curve(s, order)) < 1e-11
    assert (curve.support, given.support, given.continuity) == (4, 2, 1)


def test_given_tangents_are_gltf() -> None:
    t, q = uneven(6), quaternion.align(walk(6, 100.0))
    arriving, leaving = tangents(6)
    curve = qs.build("gltf-cubic", t, q, in_tangents=arriving, out_tangents=leaving)
    s = inside(t, 9)
    assert apart(curve(s), hermite(t, q, arriving, leaving, s)) < 1e-14
    assert curve.continuity == 0
    assert_own_rates(curve, inside(t, 5), (1e-7, 1e-5))


@pytest.mark.parametrize("side", ["in_tangents", "out_tangents"])
def test_one_side_alone_leaves_the_other_to_the_parabola(side: str) -> None:
    t, q = uneven(6), quaternion.align(walk(6, 100.0))
    v = np.gradient(q, t, axis=0, edge_order=2)
    a, _ = tangents(6)
    curve = qs.build("gltf-cubic", t, q, **{side: a})
    both = (a, v) if side == "in_tangents" else (v, a)
    s = inside(t, 9)
    assert apart(curve(s), hermite(t, q, *both, s)) < 1e-14
    assert curve.support == 4


@pytest.mark.parametrize("closed", [False, True])
def test_tangents_change_sign_with_their_keyframes(closed: bool) -> None:
    """Negating a keyframe with its tangents changes nothing, tracks and copies included."""
    t = uneven(8 + closed)
    q = np.stack([loop(uneven(9), 1), loop(uneven(9), 0)], axis=1)
    a, b = tangents(8, 2)
    flips = np.where(np.random.default_rng(3).random((8, 2, 1)) < 0.5, -1.0, 1.0)
    flips[0] = 1.0  # the curve has the sign of its first keyframe
    given: dict[str, Any] = {"closed": closed}
    curve = qs.build("gltf-cubic", t, q, in_tangents=a, out_tangents=b, **given)
    flipped = qs.build(
        "gltf-cubic", t, flips * q, in_tangents=flips * a, out_tangents=flips * b, **given
    )
    s = inside(t, 5)
    assert (curve.keyframes.signs < 0.0).tolist() == ([True, False] if closed else [False, False])
    for order in range(3):
        assert np.array_equal(flipped(s, order), curve(s, order))
        assert np.array_equal(pickle.loads(pickle.dumps(flipped))(s, order), curve(s, order))
    for k in range(2):
        own = qs.build("gltf-cubic", t, q[:, k], in_tangents=a[:, k], out_tangents=b[:, k], **given)
        assert apart(curve(s)[:, k], own(s)) < 1e-15


def test_the_closing_segment_arrives_with_the_sign_of_the_return() -> None:
    t = uneven(7)
    q = loop(t, 1)
    a, b = tangents(6)
    curve = qs.build("gltf-cubic", t, q, closed=True, in_tangents=a, out_tangents=b)
    q, sign = curve.quaternions, curve.keyframes.sign
    assert sign == -1.0
    around, arriving, leaving = (np.append(x, sign * x[:1], axis=0) for x in (q, a, b))
    s = inside(t, 9)
    assert apart(curve(s), hermite(t, around, arriving, leaving, s)) < 1e-14


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (np.zeros((5, 4)), r"^in_tangents has shape \(5, 4\): expected \(6, 4\)"),
        (np.full((6, 4), np.nan), r"^in_tangents\[0, 0\] = nan"),
        (np.full((6, 4), 1e9), r"^in_tangents\[0, 0\] = 1e\+09: more than"),
        ("parabola", r"^in_tangents: not real numbers"),
    ],
)
def test_tangents_that_are_none(given: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        qs.build("gltf-cubic", None, walk(6, 50.0), in_tangents=given)


def test_a_constant_spin_makes_gltf_cubic_nlerp() -> None:
    """f and g are multiples of the segment's ends: the cubic runs along the chord, and only its length varies."""
    q = spin(np.arange(9.0), (1.0, 2.0, -1.0), 1.9)
    cubic, chord = (qs.build(name, None, q) for name in ("gltf-cubic", "nlerp"))
    s = np.linspace(1.0, 7.0, 91)
    assert apart(cubic(s), chord(s)) < 1e-14


@pytest.mark.parametrize(("degrees", "share"), [(60.0, 0.0005), (150.0, 0.02)])
def test_the_ripple_of_a_constant_spin(degrees: float, share: float) -> None:
    """How far the speed of the normalised spline is off, as the page says."""
    rate = np.radians(degrees)
    curve = qs.build("normalised-cubic", None, spin(np.arange(21.0), (0.6, 0.0, 0.8), rate))
    speed = np.linalg.norm(curve(np.linspace(8.0, 12.0, 401), 1), axis=1) / rate
    assert np.abs(speed - 1.0).max() == pytest.approx(share, rel=0.25)


def test_a_point_without_a_direction_has_one_all_the_same() -> None:
    q = np.array([[1.0, 0, 0, 0], [-1.0, 1e-9, 0, 0]])
    curve = qs.build("normalised-cubic", None, q, align=False)
    t = np.array([0.0, 0.5, 0.5 + 1e-12, 1.0])
    assert np.abs(np.linalg.norm(curve(t), axis=1) - 1.0).max() < 1e-12
