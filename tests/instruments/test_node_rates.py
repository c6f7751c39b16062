"""Integrals that share rates: the values are those of each alone, and a library is asked less."""

import numpy as np
import pytest

from quatspline.instruments.curvature import curvature_energy
from quatspline.instruments.fairness import fairness
from quatspline.instruments.node_rates import NodeRates
from quatspline.instruments.panels import whole
from quatspline.instruments.trials import builder
from quatspline.trajectories.sets import torque_sets


@pytest.fixture(params=["kim", "scipy-rotation-spline"])
def curve(request):
    times, keyframes, _ = torque_sets(1)[0]
    return builder(request.param, 1e-9)(times, keyframes)


def test_shared_rates_change_no_value(curve):
    rates = NodeRates(curve)
    assert fairness(curve, rates) == fairness(curve)
    assert curvature_energy(curve, rates) == curvature_energy(curve)


def test_rates_come_back_in_the_order_of_the_panels_asked_for(curve):
    rates = NodeRates(curve)
    panels = whole(curve.keyframes).halves()
    rates(panels.picked(np.arange(0, len(panels.left), 3)))
    mixed = panels.picked(np.roll(np.arange(len(panels.left)), 5))
    for kept, fresh in zip(rates(mixed), NodeRates(curve)(mixed), strict=True):
        np.testing.assert_allclose(kept, fresh, rtol=0.0, atol=1e-7)


@pytest.fixture
def asked(monkeypatch):
    """How many orientations of a library's curve are asked for."""
    times, keyframes, _ = torque_sets(1)[0]
    library = builder("scipy-rotation-spline", 1e-9)(times, keyframes)
    count, orientations = [0], library.orientations

    def counted(t):
        count[0] += np.size(t)
        return orientations(t)

    monkeypatch.setattr(library, "orientations", counted)
    return library, count


def orientations_for(asked, *measures):
    library, count = asked
    before = count[0]
    for measure in measures:
        measure(library)
    return count[0] - before


def test_a_library_is_not_asked_twice_for_the_panels_that_two_integrals_share(asked):
    apart = orientations_for(asked, fairness, curvature_energy)
    rates = NodeRates(asked[0])
    shared = orientations_for(
        asked, lambda x: fairness(x, rates), lambda x: curvature_energy(x, rates)
    )
    assert shared < 0.75 * apart


def test_a_curve_that_goes_on_is_not_searched_for_stops_down_to_rounding(asked):
    """The integrals of curvature refine the panels of torque; the search for stops adds little to them."""
    assert orientations_for(asked, curvature_energy) < 2.0 * orientations_for(asked, fairness)
