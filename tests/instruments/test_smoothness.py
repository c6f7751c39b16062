"""Smoothness inside segments: breaks of known order, analytic curves, and schemes of either kind."""

from __future__ import annotations

import math

import numpy as np
import pytest

import quatspline as qs
from quatspline.claims import probes
from quatspline.claims.claim import HOLDS, judged
from quatspline.claims.published import published
from quatspline.instruments.smoothness import ORDERS, inner_jumps, inner_smoothness
from quatspline.trajectories.walks import walk
from toys import Turn, turned

TIMES = np.array([0.0, 1.0, 2.0])


class Breaking(Turn):
    """A cubic angle whose derivative of an order m jumps by 0.2 m! at a time."""

    order, at = 3, 0.5

    def theta(self, t):
        late = np.maximum(t - self.at, 0.0)
        bump = 0.2 * late**self.order
        return 0.3 * t + 0.2 * t**2 - 0.05 * t**3 + bump, 0.0 * t, 0.0 * t


def breaking(order: int, at: float):
    return inner_jumps(
        turned(type("_", (Breaking,), {"order": order, "at": at, "name": "b"}), TIMES)
    )


@pytest.mark.parametrize("at", [0.5, 1.5])
@pytest.mark.parametrize("order", ORDERS)
def test_a_break_at_a_place_that_is_looked_at_is_told_by_its_order(order, at):
    table = breaking(order, at)
    assert inner_smoothness(table) == order - 1
    jumps = table[table["order"] == order]["jump"]
    assert jumps.min() == pytest.approx(0.2 * math.factorial(order), rel=0.05)


@pytest.mark.parametrize("at", [0.1, 0.37, 0.93, 1.3, 1.71])
@pytest.mark.parametrize("order", ORDERS[:-1])
def test_a_break_anywhere_is_found(order, at):
    assert inner_smoothness(breaking(order, at)) < order


class Smooth(Turn):
    def theta(self, t):
        return np.sin(1.3 * t) + 0.2 * t**3, 0.0 * t, 0.0 * t


def test_an_analytic_curve_is_smooth_and_its_derivatives_are_right():
    """exp of an angle in t, whose derivatives follow from the series of cos and sin by numpy's polynomials."""

    class Cubic(Turn):
        def theta(self, t):
            return 0.3 + t - 0.4 * t**2, 0.0 * t, 0.0 * t

    table = inner_jumps(turned(Cubic, [0.0, 1.0]))
    assert inner_smoothness(table) == 6
    sizes = [max(size(k, t) for t in (0.25, 0.5, 0.75)) for k in ORDERS]
    np.testing.assert_allclose(table[table["width"] == 0.25]["size"], sizes, rtol=1e-3)
    assert inner_smoothness(inner_jumps(turned(Smooth, TIMES))) == 6


def size(order: int, at: float) -> float:
    """|d^k exp(i theta)/dt^k| = |p| with p' + i theta' p from one order to the next."""
    slope, p = np.polynomial.Polynomial([1.0, -0.8]), np.polynomial.Polynomial([1.0 + 0.0j])
    for _ in range(order):
        p = p.deriv() + 1j * slope * p
    return float(abs(p(at)))


def test_rest_is_smooth():
    assert (
        inner_smoothness(inner_jumps(qs.build("quartic", None, np.tile(np.eye(4)[0], (4, 1))))) == 6
    )


@pytest.mark.parametrize(
    "name", ["quartic", "quintic", "local-quintic", "kim", "circular-blend", "slerp"]
)
@pytest.mark.parametrize("degrees", [20.0, 60.0, 120.0])
def test_schemes_of_one_formula_a_segment_are_smooth_inside(name, degrees):
    keyframes = walk(np.random.default_rng(5), 6, degrees)[:, 0]
    times = np.array([0.0, 1.0, 1.4, 3.0, 3.5, 5.0]) + 1e6
    for given in (None, times):
        assert inner_smoothness(inner_jumps(qs.build(name, given, keyframes))) == 6


def test_schemes_with_joints_inside_are_not():
    """Arcs that meet, with a jump of the acceleration; sub-intervals that meet, with one of its slope."""
    keyframes = walk(np.random.default_rng(5), 6, 60.0)[:, 0]
    assert inner_smoothness(inner_jumps(qs.build("biarc", None, keyframes))) == 1
    assert inner_smoothness(inner_jumps(qs.build("min-torque", None, keyframes))) == 2
    one = qs.build("min-torque", None, keyframes, subintervals=1)
    assert inner_smoothness(inner_jumps(one)) == 6


def test_what_the_paper_says_of_its_quartic_holds_and_the_control_breaks():
    rows = {
        name: [judged(claim) for claim in published(name) if "inside" in claim.text]
        for name in ("quartic", "biarc")
    }
    assert [len(found) for found in rows.values()] == [1, 1]
    assert [found[0]["verdict"] for found in rows.values()] == [HOLDS, HOLDS]
    assert [found[0]["measured"] for found in rows.values()] == ["6", "1"]
    assert probes.inner_continuity("quartic", 5, 60.0, uneven=True) == 6
