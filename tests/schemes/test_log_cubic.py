"""The log-space cubic: scipy's own spline in R^3, its golden value, its fold."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import quatspline as qs
from quatspline import quaternion
from walks import apart, spin, uneven, walk

NAMES = ("natural", "not-a-knot")


@pytest.mark.parametrize("ends", NAMES)
@pytest.mark.parametrize("reference", [0, 3, 6])
def test_is_the_spline_in_the_chart(ends: str, reference: int) -> None:
    t, q = uneven(7), walk(7, 30.0)
    curve = qs.build("log-cubic", t, q, reference=reference, ends=ends)
    base = curve.quaternions[reference]
    x = CubicSpline(
        t, quaternion.log(quaternion.mul(quaternion.conj(base), curve.quaternions)), bc_type=ends
    )
    s = np.linspace(t[0], t[-1], 200)
    assert np.abs(curve(s) - quaternion.mul(base, quaternion.exp(x(s)))).max() < 1e-14


def test_golden_value() -> None:
    raw = [[1, 0, 0, 0], [9, 3, -2, 1], [6, 5, 4, -3], [2, 7, 5, 4], [5, -1, 8, 3]]
    q = quaternion.normalise(np.array(raw, dtype=float))
    curve = qs.build("log-cubic", [0, 0.7, 1.9, 2.6, 4], q)
    wanted = [0.892897040072, 0.395941529588, 0.002292844486, -0.214382657514]
    assert np.abs(curve(1.2) - wanted).max() < 1e-12


@pytest.mark.parametrize("ends", NAMES)
@pytest.mark.parametrize("count", [2, 3, 4, 9])
def test_c2_and_interpolation(count: int, ends: str) -> None:
    t, q = uneven(count), walk(count, 40.0)
    curve = qs.build("log-cubic", t, q, ends=ends)
    assert np.abs(curve(t) - curve.quaternions).max() < 1e-14
    for order in (0, 1, 2):
        jump = curve(t[1:-1], order) - curve(np.nextafter(t[1:-1], 0.0), order)
        assert np.abs(jump).max(initial=0.0) < 1e-12


def test_natural_ends_have_no_acceleration() -> None:
    """In the chart: at the reference itself the chart's second derivative is the body's."""
    t, q = uneven(7), walk(7, 30.0)
    assert np.abs(qs.build("log-cubic", t, q)(t[0], 2)).max() < 1e-13
    assert np.abs(qs.build("log-cubic", t, q, reference=6)(t[-1], 2)).max() < 1e-12


def test_the_fold_is_shown() -> None:
    """Nine keyframes turning about z: 40 degrees per step stay in the chart, 50 leave it."""
    t = np.arange(9.0)
    tilt = quaternion.exp(0.05 * np.random.default_rng(1).normal(size=(9, 3)))
    s = np.linspace(0.0, 8.0, 401)
    errors = {}
    for degrees in (40, 50):
        q = quaternion.mul(spin(t, [0.0, 0.0, 1.0], np.radians(degrees)), tilt)
        smooth = qs.build("local-quintic", t, q)(s)
        for reference in (0, 4):
            curve = qs.build("log-cubic", t, q, reference=reference)
            errors[degrees, reference] = np.degrees(apart(curve(s), smooth))
    assert errors[40, 0] < 10.0
    assert errors[50, 0] > 90.0
    assert errors[50, 4] < 10.0


def test_tracks_are_single_curves() -> None:
    t = uneven(6)
    q = np.stack([walk(6, degrees, 4) for degrees in (10.0, 60.0, 120.0)], axis=1)
    s = np.linspace(t[0], t[-1], 50)
    curve = qs.build("log-cubic", t, q, reference=2)
    for k in range(3):
        single = qs.build("log-cubic", t, q[:, k], reference=2)
        for order in (0, 1, 2):
            assert np.abs(curve(s, order)[:, k] - single(s, order)).max() < 1e-11


@pytest.mark.parametrize("reference", [-1, 5])
def test_references_outside_are_refused(reference: int) -> None:
    with pytest.raises(ValueError, match=f"reference={reference}"):
        qs.build("log-cubic", None, walk(5, 40.0), reference=reference)


def test_closed_is_refused() -> None:
    with pytest.raises(ValueError, match="closed=True"):
        qs.build("log-cubic", None, walk(5, 40.0), closed=True)
