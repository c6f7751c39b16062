"""The experiments on moving frames: the motion they differentiate, constants, ways to the nearest rotation."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

from quatspline.figures import style
from quatspline.instruments.frame_error import smooth_constant, worst_constant
from quatspline.runs.experiment import Run, files
from quatspline.system.loading import load
from quatspline.timing.nearest_rotation import by_svd, measured, noisy, walked
from quatspline.trajectories.rolling import PERIOD, rolling, rolling_matrices


def test_the_motion_is_closed_and_has_its_matrices() -> None:
    t = np.linspace(0.0, PERIOD, 9)
    turns = Rotation.from_quat(rolling(t), scalar_first=True)
    np.testing.assert_allclose(rolling_matrices(t), turns.as_matrix(), atol=1e-14)
    np.testing.assert_allclose(rolling_matrices(t[:1], 3), rolling_matrices(t[-1:], 3), atol=1e-12)


@pytest.mark.parametrize("order", [1, 2, 5, 10])
def test_its_derivatives_are_those_of_the_one_below(order: int) -> None:
    t, h = np.linspace(0.3, 5.9, 7), 1e-5
    quotient = (rolling_matrices(t + h, order - 1) - rolling_matrices(t - h, order - 1)) / (2 * h)
    np.testing.assert_allclose(rolling_matrices(t, order), quotient, atol=1e-6 * 3.0**order)


@pytest.mark.parametrize("degree", [3, 5, 7, 9])
def test_the_worst_constant_is_that_of_the_euler_spline(degree: int) -> None:
    """F^(k+1) = +-1 in turn from knot to knot: F is zero there, and so is the spline through it."""
    pieces = np.polynomial.Polynomial([1.0])  # on [0, 1], antisymmetric from piece to piece
    for _ in range((degree + 1) // 2):
        for _ in range(2):
            pieces = pieces.integ()
        pieces -= np.polynomial.Polynomial([pieces(0.0), pieces(1.0) - pieces(0.0)])
    largest = abs(pieces(0.5))
    assert worst_constant(degree) == pytest.approx(largest, rel=1e-12)


@pytest.mark.parametrize("degree", [3, 5, 7, 9])
def test_the_smooth_constant_is_that_of_a_power(degree: int) -> None:
    """The spline through t^(k+1) far from the ends, in the middle of a segment."""
    n = 60
    t = np.arange(-n, n + 1.0)
    x = t ** (degree + 1) / np.prod(np.arange(1.0, degree + 2))
    flat = [(m, _power(degree, m, float(n))) for m in range(1, (degree + 1) // 2)]
    flipped = [(m, _power(degree, m, -float(n))) for m in range(1, (degree + 1) // 2)]
    spline = make_interp_spline(t, x, degree, bc_type=(flipped, flat))
    error = abs(spline(0.5) - 0.5 ** (degree + 1) / np.prod(np.arange(1.0, degree + 2)))
    assert smooth_constant(degree) == pytest.approx(error, rel=1e-3)


def _power(degree: int, order: int, t: float) -> float:
    """Derivative of an order of t^(k+1) / (k+1)!."""
    left = degree + 1 - order
    return float(t**left / np.prod(np.arange(1.0, left + 1)))


@pytest.mark.parametrize("source", ["frames", "noise"])
def test_all_ways_lead_to_the_nearest_rotation(source: str) -> None:
    rng = np.random.default_rng(3)
    b = noisy(rng, 200) if source == "noise" else walked(rng, 200, 60.0)
    rows = pd.DataFrame(measured(b, 3, 0, 1e-4)).set_index("method")
    assert rows["error"].max() < 1e-11
    few = rows.loc[["order three", "order two"], ["systems_median", "systems_q95"]].to_numpy(float)
    assert np.array_equal(few[0], few[1])
    assert few.max() <= 6.0
    assert (rows["seconds_median"] > 0.0).all()
    c = by_svd(b)
    np.testing.assert_allclose(np.linalg.det(c), 1.0, atol=1e-12)
    better = Rotation.from_matrix(c) * Rotation.from_rotvec(1e-3 * rng.normal(size=(len(b), 3)))
    gain = np.einsum("nij,nij->n", c - better.as_matrix(), b)
    assert (gain > 0.0).all()


@pytest.mark.parametrize("name", ["frame-error", "nearest-rotation"])
def test_experiment(name: str) -> None:
    module: Any = load(files()[name], "experiment")
    run = Run(quick=True)
    cells = module.cells(run)[-5:] if name == "frame-error" else module.cells(run)[-1:]
    rows = [
        row for cell in cells for row in json.loads(json.dumps(module.measure_cell(run, **cell)))
    ]
    table = module.gather(run, pd.DataFrame(rows))
    assert {*module.KEYS, *module.FORMATS} <= set(table)
    assert not table.duplicated(module.KEYS).any()
    if hasattr(module, "draw"):
        with style.applied():
            assert len(module.draw(table).axes) == 3
        assert "spacing" in module.caption(table)
