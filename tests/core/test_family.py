"""Families: one function of a sample makes six kernels, and what would fail silently fails loudly."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import quatspline as qs
from quatspline.curve import Curve
from quatspline.engines import engine
from quatspline.families.arcs import ANGLE, ARC, along, set_arc
from quatspline.families.arcs import SIZE as ARC_SIZE
from quatspline.families.circles import biarc, biarc_jet, blend, blend_jet
from quatspline.families.means import point as mean
from quatspline.families.nested import squad, squad_jet, triangle, triangle_jet
from quatspline.kernels.family import family
from quatspline.kernels.jit import CONSTANTS, REACH, ROWS, called, fit_kernel, inlined
from quatspline.kernels.scalars import sincos
from quatspline.kernels.values import Vec, keyframe, vec
from quatspline.segments import SegmentCurve
from walks import uneven, walk

ENGINES = ("python", "compiled")
ROOM = ROWS - CONSTANTS
LAST = ROOM - ARC_SIZE
"""Where an arc's constants end with the sheet's room for them."""


@pytest.fixture(params=ENGINES)
def either(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """One engine, then the other."""
    monkeypatch.setenv(engine.VARIABLE, request.param)
    return str(request.param)


@fit_kernel
def SILENT(q, h, closed, sign, parameters, segments, report):
    """Reports no reach where the first keyframe has w < 0."""
    for i in range(h.size):
        set_arc(segments[i], 0, keyframe(q, i, sign), keyframe(q, i + 1, sign))
    if q[0, 0] >= 0.0:
        report[REACH] = 2.0


class Silent(SegmentCurve):
    title = reference = "-"
    name = "silent"
    continuity, order, support, constant_rate = 0, 2, 2, "no"
    family = ARC

    def _fit(self, keyframes: Any) -> None:
        self._solve(SILENT)


@pytest.mark.parametrize("signs", [(-1.0,), (1.0, -1.0), (-1.0, 1.0)])
def test_a_fit_that_reports_no_reach_is_refused(either: str, signs: tuple[float, ...]) -> None:
    """By default it would take the kernels for near angles, which are wrong for any other."""
    q = walk(4, 50.0)
    q = q * np.sign(q[0, 0])
    assert Silent(None, q).engine == either
    with pytest.raises(TypeError, match=r"silent: .* does not write report\[REACH\]"):
        Silent(None, np.stack([sign * q for sign in signs], axis=1))


@fit_kernel
def LONG(q, h, closed, sign, parameters, segments, report):
    """One number more than the family has constants."""
    for i in range(h.size):
        c = segments[i]
        set_arc(c, 0, keyframe(q, i, sign), keyframe(q, i + 1, sign))
        c[ARC_SIZE] = 1.0
    report[REACH] = 0.0


class Long(Silent):
    name = "long"

    def _fit(self, keyframes: Any) -> None:
        self._solve(LONG)


@pytest.mark.parametrize("tracks", [1, 3])
def test_a_fit_that_writes_beyond_its_constants_is_refused(either: str, tracks: int) -> None:
    q = np.stack([walk(4, 50.0)] * tracks, axis=1)
    told = {
        "compiled": (TypeError, f"long: .* beyond the {ARC_SIZE} constants"),
        "python": (IndexError, "9"),
    }
    error, message = told[either]
    with pytest.raises(error, match=message):
        Long(None, q)


def test_a_family_too_big_for_its_sheet_is_refused() -> None:
    """When it is made, before any engine has it."""
    assert family(ROOM, squad, jet=squad_jet).constants == ROOM
    with pytest.raises(ValueError, match=rf"{ROOM + 1} constants per segment: .* {ROOM} rows"):
        family(ROOM + 1, squad, jet=squad_jet)


@inlined
def last_arc(c, u):
    sine, cosine = sincos(u * c[LAST + ANGLE])
    return along(c, LAST, sine, cosine)


@inlined
def no_rate(c, u):
    return Vec(0.0, 0.0, 0.0)


@fit_kernel
def FILL(q, h, closed, sign, parameters, segments, report):
    for i in range(h.size):
        segments[i, :LAST] = np.nan
        set_arc(segments[i], LAST, keyframe(q, i, sign), keyframe(q, i + 1, sign))
    report[REACH] = 0.0


class Full(Silent):
    name = "full"
    family = family(ROOM, last_arc, velocity=no_rate, acceleration=no_rate)

    def _fit(self, keyframes: Any) -> None:
        self._solve(FILL)


def test_a_family_that_fills_its_sheet_works(either: str) -> None:
    q = walk(4, 50.0)
    curve, t = Full(None, q), np.linspace(0.0, 3.0, 61)
    assert curve.engine == either
    np.testing.assert_allclose(curve(t), qs.build("slerp", None, q)(t), atol=1e-15)


def test_a_family_without_rates_is_refused() -> None:
    with pytest.raises(TypeError, match="a jet, or a velocity and an acceleration"):
        family(9, squad)


def of(k: float, function: Any) -> Any:
    @inlined
    def made(c, u):
        return k * function(c, u)

    return made


def test_functions_of_one_code_have_names_of_their_own() -> None:
    """numba's cache goes by file, line and name: two functions of one name would share code."""
    made = [of(1.0, squad), of(2.0, squad), of(1.0, triangle), of(1.0, of(1.0, squad))]
    assert len({called(function) for function in made}) == len(made)
    assert called(made[0]) == called(of(1.0, squad))


JETS = {
    "squad": (squad, squad_jet),
    "catmull-rom": (triangle, triangle_jet),
    "biarc": (biarc, biarc_jet),
    "circular-blend": (blend, blend_jet),
}


@pytest.mark.parametrize("name", JETS)
def test_plain_python_gives_what_kernels_give(name: str) -> None:
    """A family's functions on one row of constants, one sample at a time."""
    knots = uneven(6)
    curve: Curve = qs.build(name, knots, walk(6, 70.0))
    assert isinstance(curve, SegmentCurve)
    point, jet = JETS[name]
    for i, h in enumerate(np.diff(knots)):
        for u in (0.0, 0.3, 0.85):
            t, c = float(knots[i] + u * h), curve.segments[0, i]
            q, q1, q2 = jet(c, u)
            rates = [(2.0 / h**k) * np.array(vec(~q * d)) for k, d in ((1, q1), (2, q2))]
            np.testing.assert_allclose(point(c, u), curve(t), atol=1e-13)
            np.testing.assert_allclose(q, curve(t), atol=1e-13)
            for order, rate in enumerate(rates, start=1):
                np.testing.assert_allclose(rate, curve(t, order), atol=1e-11)


def test_plain_python_gives_the_mean() -> None:
    curve = qs.build("spherical-average", None, walk(5, 60.0))
    np.testing.assert_allclose(mean(curve.segments[0, 2], 0.4), curve(2.4), atol=1e-13)  # type: ignore[attr-defined]
