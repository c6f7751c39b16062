"""The claims of every scheme against measurement, read off its orientations alone."""

import math
from typing import Any

import numpy as np
import pytest

from quatspline import quaternion, stencil
from quatspline.curve import Curve
from quatspline.instruments.accuracy import measured_order
from quatspline.quaternion import FloatArray
from walks import (
    apart,
    apart_up_to_sign,
    applies,
    checks_in,
    count_of,
    curve_of,
    inside,
    loop,
    runs_somewhere,
    uneven,
    walk,
)

NEAR, FAR = 1e-4, 1e-2
"""Distances from a knot, in segments, between which a jump that is none must have melted."""
MELTED = 0.05
"""A factor of 0.01 in the distance, with room for terms of higher order."""
NOISE = (1e-13, 1e-8, 1e-6)
"""What the stencils leave of derivatives 0, 1, 2, in units of the segment's own scale."""
STAYS = 1e-4
"""A jump that stays is this large at least, in units of the segment's own scale."""
STEADY = 0.5
"""And does not shrink: from FAR to NEAR it keeps this much."""
UNCHANGED = 1e-13
ORDER = 0.3

Scheme = type[Curve]


def taylor(curve: Curve, t: FloatArray, h: float, order: int) -> FloatArray:
    """Derivatives 0 ... 3 at times t: orientation, omega, alpha and a one-sided slope of alpha.

    Everything from stencils within the segment of t; derivative 3 by a quotient of step h away
    from the nearer knot.
    """
    knots = curve.times - curve.times[0]
    if order == 0:
        return curve.inner(t)[:, 0]
    if order < 3:
        return stencil.rates_of(curve, t)[order - 1]
    nearest = knots[np.argmin(np.abs(t[:, None] - knots), axis=1)]
    away = np.sign(t - nearest) * h
    alpha = [stencil.rates_of(curve, s)[1] for s in (t, t + away, t + 2 * away)]
    return (-1.5 * alpha[0] + 2.0 * alpha[1] - 0.5 * alpha[2]) / away[:, None]


def jumps(curve: Curve, order: int, distance: float) -> FloatArray:
    """Jumps of a derivative across inner knots and a closed curve's seam, in segments' scale."""
    knots = curve.times - curve.times[0]
    h = float(np.diff(knots).min())
    before, after = knots[1:-1] - distance * h, knots[1:-1] + distance * h
    if curve.closed:
        before, after = np.append(before, knots[-1] - distance * h), np.append(after, distance * h)
    left, right = taylor(curve, before, FAR * h, order), taylor(curve, after, FAR * h, order)
    if curve.closed and order == 0:
        right[-1] *= curve.keyframes.sign
    return np.linalg.norm(right - left, axis=1) * h**order


KINDS = ["uniform", "uneven", "closed"]


def curve_through(scheme: Scheme, kind: str) -> Curve:
    """Steps of about 60 degrees on uniform or uneven knots, or closed with s = -1."""
    n = count_of(scheme, 8)
    if kind == "closed" and scheme.closable:
        knots = uneven(n + 1) if scheme.non_uniform else np.arange(n + 1.0)
        return curve_of(scheme, knots, loop(knots, 1, wobble=0.5), closed=True)
    knots = uneven(n) if kind == "uneven" and scheme.non_uniform else np.arange(float(n))
    return curve_of(scheme, knots, walk(n, 60.0, seed=4))


def kinds_of(scheme: Scheme) -> list[str]:
    takes = {"uniform": True, "uneven": scheme.non_uniform, "closed": scheme.closable}
    return [kind for kind in KINDS if takes[kind]]


def test_continuity_holds(scheme: Scheme) -> None:
    """Jumps of orders 0 ... k across a knot fall with the distance from it."""
    for kind in kinds_of(scheme):
        curve = curve_through(scheme, kind)
        for order in range(min(scheme.continuity, 2) + 1):
            near, far = (jumps(curve, order, distance) for distance in (NEAR, FAR))
            assert near.max() < MELTED * far.max() + NOISE[order], f"{kind}, order {order}"


@applies(lambda scheme: scheme.continuity < 3)
def test_continuity_is_not_more(scheme: Scheme) -> None:
    """The jump of order k + 1 stays where it is: the measurement can tell."""
    order = scheme.continuity + 1
    largest = 0.0
    for kind in kinds_of(scheme):
        curve = curve_through(scheme, kind)
        near, far = jumps(curve, order, NEAR), jumps(curve, order, FAR)
        largest = max(largest, near[near > STEADY * far].max(initial=0.0))
    assert largest > STAYS


@applies(lambda scheme: scheme.interpolates)
def test_interpolates(scheme: Scheme) -> None:
    for kind in kinds_of(scheme):
        curve = curve_through(scheme, kind)
        keys = curve.quaternions
        assert apart_up_to_sign(curve(curve.times[: len(keys)]), keys) < 1e-9


@applies(lambda scheme: not scheme.interpolates)
def test_does_not_interpolate(scheme: Scheme) -> None:
    curve = curve_through(scheme, "uniform")
    assert apart_up_to_sign(curve(curve.times), curve.quaternions) > 1e-6


def changed(scheme: Scheme, closed: bool, moved: int) -> FloatArray:
    """How far each segment moves when one keyframe does."""
    n = count_of(scheme, 16)
    q = walk(n, 30.0, seed=6)
    knots = np.arange(n + closed, dtype=float)
    if closed:
        q = loop(knots, 0, wobble=0.6)
    other = q.copy()
    other[moved] = quaternion.mul(other[moved], quaternion.exp([0.03, -0.02, 0.04]))
    t = inside(knots, 5)
    a, b = (curve_of(scheme, knots, keys, closed=closed)(t) for keys in (q, other))
    return np.linalg.norm(a - b, axis=1).reshape(-1, 5).max(axis=1)


def test_support(scheme: Scheme) -> None:
    """A keyframe moves as many segments, side by side, as keyframes shape one."""
    for closed, moved in [(False, 8), (True, 8), (True, 0)][: 3 if scheme.closable else 1]:
        moves = changed(scheme, closed, moved)
        touched = set(np.flatnonzero(moves > UNCHANGED).tolist())
        if scheme.support is None:
            assert len(touched) == len(moves)
        else:
            first = moved - scheme.support // 2
            wanted = {i % len(moves) for i in range(first, first + scheme.support)}
            assert touched == wanted, f"closed {closed}, keyframe {moved}"


def felt_ahead(scheme: Scheme, closed: bool, moves: range | tuple[int, ...]) -> int:
    """The farthest keyframe after a segment's own two that moves it, of some that are moved."""
    farthest = 0
    for moved in moves:
        touched = changed(scheme, closed, moved) > UNCHANGED
        ahead = moved - np.flatnonzero(touched) - 1
        if closed:  # counted the shorter way round
            ahead = (ahead + len(touched) // 2) % len(touched) - len(touched) // 2
        farthest = max(farthest, *ahead)
    return int(farthest)


def test_lookahead(scheme: Scheme) -> None:
    """A segment feels so many keyframes ahead, at open ends and over a closed curve's seam too."""
    n = count_of(scheme, 16)
    claimed = scheme.lookahead
    assert felt_ahead(scheme, False, range(n)) == (n - 2 if claimed is None else claimed)
    if scheme.closable:
        wanted = n // 2 - 1 if claimed is None else claimed
        assert felt_ahead(scheme, True, (0, 8)) == wanted


def smooth_motion(t: FloatArray) -> FloatArray:
    """Q(t) = exp(a) exp(b): the motion of the specification, in log units."""
    a = np.stack([0.8 * np.sin(1.1 * t), 0.6 * np.cos(0.7 * t + 0.3), 0.5 * np.sin(1.7 * t + 1)], 1)
    b = np.stack([0.3 * t, 0.0 * t, 0.2 * np.cos(t)], axis=1)
    return quaternion.mul(quaternion.exp(a), quaternion.exp(b))


def test_order(scheme: Scheme) -> None:
    """The slope of the largest interior error over two halvings of the spacing."""
    sizes = np.array([81, 161, 321])
    errors = []
    for size in sizes:
        knots = np.linspace(0.0, 10.0, size)
        curve = curve_of(scheme, knots, smooth_motion(knots))
        t = inside(knots, 4)
        t = t[(t > 3.0) & (t < 7.0)]
        errors.append(apart_up_to_sign(curve(t), smooth_motion(t)))
    slope = measured_order(1.0 / (sizes - 1), errors)
    assert math.isclose(slope, scheme.order, abs_tol=ORDER), f"order {slope:.2f}, errors {errors}"


def test_claims_are_of_their_kind(scheme: Scheme) -> None:
    assert isinstance(scheme.interpolates, bool)
    assert scheme.continuity in range(7)
    assert scheme.order in range(1, 9)
    assert scheme.support is None or scheme.support >= 2
    assert scheme.lookahead is None or scheme.lookahead >= 0
    assert scheme.constant_rate in ("everywhere", "interior", "no")
    assert all(isinstance(x, bool) for x in (scheme.non_uniform, scheme.closable, scheme.iterative))
    assert scheme.min_keyframes >= 1
    assert scheme.peer is None or isinstance(scheme.peer, str)
    assert scheme.title
    assert scheme.reference
    assert scheme.orders[0] == 0
    assert scheme.__doc__


def test_reference_is_in_the_bibliography(scheme: Scheme) -> None:
    from quatspline.discovery import shipped

    entries = (shipped("references.bib").parent / "references.bib").read_text(encoding="utf-8")
    assert f"{{{scheme.reference}," in entries


# -- the instruments of this file, on curves that are known ------------------------------------


class Broken(Curve):
    """A cubic of the angle about one axis whose derivative of a given order jumps at 1."""

    title = reference = "-"
    continuity, order, support, constant_rate = 2, 2, None, "no"

    def _fit(self, keyframes: Any, *, jumps: int = 0) -> None:
        self.jumps = jumps

    def _orientation(self, t: FloatArray) -> FloatArray:
        late = np.maximum(t - 1.0, 0.0)
        bump = 0.01 * (t > 1.0) * late**self.jumps / math.factorial(self.jumps)
        angle = 0.2 * t + 0.05 * t**3 - 0.02 * t**4 + bump
        return quaternion.exp(angle[:, None] * [0.6, 0.8, 0.0])


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_jumps_are_told_apart(order: int) -> None:
    curve = Broken(None, walk(3, 20.0), jumps=order)
    for k in range(order):
        assert jumps(curve, k, NEAR).max() < MELTED * jumps(curve, k, FAR).max() + NOISE[k]
    near, far = jumps(curve, order, NEAR), jumps(curve, order, FAR)
    size = 0.01 * (1 if order == 0 else 2)
    assert near.max() == pytest.approx(size, rel=0.2)
    assert near.max() > STEADY * far.max()


CHECKS = checks_in(__name__)


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.__name__)
def test_every_claim_is_measured_somewhere(check: Any) -> None:
    assert runs_somewhere(check)


def test_apart_sees_what_is_no_number() -> None:
    assert apart(np.full((2, 4), np.nan), np.zeros((2, 4))) == math.inf
