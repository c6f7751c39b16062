"""Fairness: torque energy, jerk energy, arc length and peak acceleration of a curve.

Every segment is cut into panels, and panels are halved until two levels agree: a curve that turns sharply
inside a segment needs panels there and nowhere else.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from quatspline.curve import Curve
from quatspline.instruments.continuity import rounding
from quatspline.instruments.derivatives import closed_forms, rates_since
from quatspline.instruments.node_rates import NodeRates
from quatspline.instruments.panels import (
    HALVINGS,
    MOST,
    POINTS,
    STENCIL_HALVINGS,
    STENCIL_MOST,
    Panels,
    around,
    gauss,
    whole,
)
from quatspline.quaternion import FloatArray

AGREE = np.array([1e-7, 1e-6, 1e-7])
"""Two levels agree to these shares of torque, jerk and length; what is left is less, as the finer level counts."""

DIVERGES = 0.1
"""A jerk that two levels still disagree on by this share, at the last, is infinite: alpha jumps in a segment."""

ESTIMATED, CANDIDATES, NEAR = 9, 8, 0.95
"""Places in a panel at which the peak is estimated, panels in which it is then looked for, and the share of the
largest estimate that such a panel has at least."""

GRID, ZOOMS = 5, 7
"""Samples of a search for the peak, and how often its interval is halved."""


_Level = tuple[Panels, FloatArray, FloatArray]
"""Panels, alpha at their nodes (p, POINTS, 3), and their integrals of torque, jerk and length (p, 3)."""


def fairness(curve: Curve, rates: NodeRates | None = None) -> dict[str, float]:
    """Integrals and peaks of a single-track curve as it runs between keyframes; lower is fairer.

    torque: integral of |alpha|^2 (rad^2/t^3), infinite in truth where the velocity jumps; jerk:
    integral of |alpha'|^2 (rad^2/t^5), infinite where alpha is seen to jump inside a segment; length:
    integral of |omega| (rad); peak: max |alpha| (rad/t^2), on both sides of every keyframe too.  Panels
    are halved until torque and length agree to 1e-7 and jerk to 1e-6, or as far as rounding of the rates
    lets them.  ``rates`` of the curve, given, are shared with other integrals over it.
    """
    panels, alpha, integrals = _gathered(list(_settled(curve, rates or NodeRates(curve))))
    torque, jerk, length = map(float, integrals.sum(axis=0))
    peak = max(_peak_at_knots(curve), _peak_inside(curve, panels, alpha))
    return {"torque": torque, "jerk": jerk, "length": length, "peak": peak}


def _gathered(levels: list[_Level]) -> _Level:
    """The settled panels of all levels as one."""
    panels, alpha, integrals = zip(*levels, strict=True)
    joined = Panels(*(np.concatenate(column) for column in zip(*panels, strict=True)))
    return joined, np.concatenate(alpha), np.concatenate(integrals)


# -- integrals ----------------------------------------------------------------------------------


def _settled(curve: Curve, rates: NodeRates) -> Iterator[_Level]:
    """Panels whose integrals (p, 3) agree with those of the level above, with alpha (p, POINTS, 3)."""
    knots = curve.keyframes.knots
    halvings, most = (HALVINGS, MOST) if closed_forms(curve) else (STENCIL_HALVINGS, STENCIL_MOST)
    span, budget = knots[-1], most * (len(knots) - 1)
    coarse = whole(curve.keyframes)
    before = _measured(rates, coarse)[1]
    done = np.zeros(3)
    for level in range(halvings + 1):
        fine = coarse.halves()
        alpha, integrals = _measured(rates, fine)
        sums = integrals.reshape(-1, 2, 3).sum(axis=1)
        total = done + sums.sum(axis=0)
        off = np.abs(sums - before) - _rounding(curve, coarse, sums)
        budget -= len(fine.left)
        unsettled = (off > AGREE * total * (coarse.width / span)[:, None]).any(axis=1)
        enough = (off[unsettled].sum(axis=0) <= AGREE * total).all()
        if enough or level == halvings or budget < 0:
            if closed_forms(curve) and off[unsettled, 1].sum() > DIVERGES * total[1]:
                integrals[:, 1] = np.inf
            unsettled[:] = False
        halves = np.repeat(unsettled, 2)
        yield fine.picked(~halves), alpha[~halves], integrals[~halves]
        if not unsettled.any():
            return
        done = done + sums[~unsettled].sum(axis=0)
        coarse, before = fine.picked(halves), integrals[halves]


def _measured(rates: NodeRates, panels: Panels) -> tuple[FloatArray, FloatArray]:
    """alpha at the nodes (p, POINTS, 3), and the integrals of torque, jerk and length (p, 3)."""
    weights = gauss()[1]
    omega, alpha = rates(panels)
    jerk = np.einsum("ij,pjk->pik", _derived(), alpha) / panels.width[:, None, None]
    squares = [np.einsum("pik,pik->pi", x, x) for x in (alpha, jerk, omega)]
    squares[2] = np.sqrt(squares[2])
    return alpha, np.stack([panels.width * (x @ weights) for x in squares], axis=1)


def _rounding(curve: Curve, panels: Panels, integrals: FloatArray) -> FloatArray:
    """What rounding of the rates may leave in integrals (p, 3) of panels."""
    h, width = panels.spacing, panels.width
    speed, torque = (rounding(curve, order) / h**order for order in (1, 2))
    jerk = torque * np.abs(_derived()).sum(axis=1).max() / width
    squared = np.stack([torque, jerk], axis=1) ** 2 * width[:, None]
    crossed = 2.0 * np.sqrt(integrals[:, :2] * squared)
    return np.column_stack([squared + crossed, speed * width])


# -- peaks --------------------------------------------------------------------------------------


def _peak_at_knots(curve: Curve) -> float:
    """The largest |alpha| on either side of a keyframe, where it is largest as a rule."""
    knots = curve.keyframes.knots
    return float(_sizes(curve, np.append(knots[:-1], np.nextafter(knots[1:], 0.0))).max())


def _peak_inside(curve: Curve, panels: Panels, alpha: FloatArray) -> float:
    """The largest |alpha| in panels, looked for where the polynomial through the nodes is largest."""
    estimates = np.linalg.norm(np.einsum("ij,pjk->pik", _estimating(), alpha), axis=-1)
    highest = estimates.max(axis=1)
    likely = np.argsort(highest)[-CANDIDATES:]
    likely = likely[highest[likely] >= NEAR * highest.max()]
    grid = panels.picked(likely).times(np.linspace(0.0, 1.0, ESTIMATED))
    grid[:, -1] = np.nextafter(grid[:, -1], 0.0)  # of this panel's segment, not of the next
    low, high = around(grid, estimates[likely])
    for _ in range(ZOOMS):
        grid = np.linspace(low, high, GRID, axis=1)
        sizes = _sizes(curve, grid.reshape(-1)).reshape(grid.shape)
        low, high = around(grid, sizes)
    return float(sizes.max(initial=0.0))


def _sizes(curve: Curve, since: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(rates_since(curve, since)[1], axis=-1), dtype=float)


# -- polynomials through the nodes of a panel ---------------------------------------------------


@cache
def _derived() -> FloatArray:
    """Slopes (POINTS, POINTS) at a unit panel's nodes of the quartic through values there."""
    u, powers = gauss()[0], np.arange(POINTS)
    derivatives = powers * u[:, None] ** np.maximum(powers - 1, 0)
    return np.asarray(derivatives @ _coefficients(), dtype=float)


@cache
def _estimating() -> FloatArray:
    """Values (ESTIMATED, POINTS) over a unit panel, its ends included, of the same quartic."""
    u = np.linspace(0.0, 1.0, ESTIMATED)
    return np.asarray(np.vander(u, POINTS, increasing=True) @ _coefficients(), dtype=float)


@cache
def _coefficients() -> FloatArray:
    return np.asarray(np.linalg.inv(np.vander(gauss()[0], increasing=True)), dtype=float)
