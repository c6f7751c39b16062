"""Curvature energy: how much the path on S^3 bends, however fast it is run.

The path of unit quaternions has the speed |omega|/2 and, since |omega x alpha|/4 is the area of its body
velocity with the derivative, the curvature

    kappa = 2 |omega x alpha| / |omega|^3                                                        (1)

within S^3: 0 on great circles, the cotangent of the radius on small ones.  By arc length s,

    E = integral kappa^2 ds = integral 2 |omega x alpha|^2 / |omega|^5 dt,                       (2)

in rad^-1.  Panels are halved until two levels agree, as those of `fairness`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quatspline.curve import Curve
from quatspline.inputs.arrays import BoolArray
from quatspline.instruments.continuity import AT_REST, rounding
from quatspline.instruments.derivatives import closed_forms, rates_since
from quatspline.instruments.node_rates import NodeRates
from quatspline.instruments.panels import (
    HALVINGS,
    MOST,
    STENCIL_HALVINGS,
    STENCIL_MOST,
    Panels,
    around,
    gauss,
    whole,
)
from quatspline.quaternion import FloatArray

AGREE = 1e-7
"""Two levels agree to this share; what is left is less, as the finer level counts."""

SHARPER = 8
"""Times as many panels as torque may take: beside a near stop the curvature is a narrow peak."""

DIVERGES = 0.01
"""An integral that two levels still disagree on by this share, at the last, is infinite."""

STILL = 1e-6
"""A speed below this share of the mean is none; differences of a library leave 1e-9."""

GRID, SLOWEST, ZOOMS = 9, 8, 30
"""Samples of a panel in search of a stop, the panels that it is looked for in at most, and how often an interval is
halved: the speed beside a stop is linear in time, and is then found to 1e-9."""

STEEPER = 4.0
"""An interval is searched while its speed would fall to 0 at so many times the largest |alpha| seen in it."""


class Bending(NamedTuple):
    """A curvature energy in rad^-1, and why it is infinite where it is."""

    energy: float
    reason: str | None = None


def curvature_energy(curve: Curve, rates: NodeRates | None = None) -> Bending:
    """The integral (2) over a single-track curve as it runs between keyframes; lower bends less.

    Infinite where the curve stops on its way: beside an instant of rest, kappa^2 ds goes as dt/t unless
    alpha keeps its direction, and what rests has no direction to bend from.  A jump of the velocity at
    a keyframe is a corner, whose energy is infinite, too; it is not looked for here (see `jumps`).
    ``rates`` of the curve, given, are shared with other integrals over it.
    """
    rates = rates or NodeRates(curve)
    stop = _stop(curve, rates)
    if stop is not None:
        return Bending(np.inf, stop)
    energy, off, worst = _integral(curve, rates)
    if off > DIVERGES * energy:
        return Bending(np.inf, f"the curvature grows without bound near t = {_told(curve, worst)}")
    return Bending(energy)


# -- stops --------------------------------------------------------------------------------------


def _stop(curve: Curve, rates: NodeRates) -> str | None:
    """Where a curve stops, or None."""
    panels = whole(curve.keyframes).halves()
    omega, alpha = rates(panels)
    speeds = np.linalg.norm(omega, axis=-1)
    mean = float(speeds.mean())
    if mean * float(curve.keyframes.knots[-1]) <= AT_REST:
        return "the curve rests"
    likely = np.flatnonzero(_may_stop(speeds, alpha, panels.width))
    likely = likely[np.argsort(speeds[likely].min(axis=1))[:SLOWEST]]
    at, speed = _slowest(curve, panels.picked(likely))
    if speed > STILL * mean:
        return None
    return f"the curve stops at t = {_told(curve, at)}"


def _may_stop(speeds: FloatArray, alpha: FloatArray, width: FloatArray) -> BoolArray:
    """Which intervals may hold a stop, by speeds (p, k), alpha (p, k, 3) and widths (p,) of them."""
    fall = np.linalg.norm(alpha, axis=-1).max(axis=1) * width
    return np.asarray(speeds.min(axis=1) <= STEEPER * fall, dtype=bool)


def _slowest(curve: Curve, panels: Panels) -> tuple[float, float]:
    """The time of the least speed in panels and that speed, as far as an interval may still hold a stop."""
    grid, at, least = panels.times(np.linspace(0.0, 1.0, GRID)), np.nan, np.inf
    grid[:, -1] = np.nextafter(grid[:, -1], 0.0)  # of this panel's segment, not of the next
    for _ in range(1 + ZOOMS):
        if not len(grid):
            break
        omega, alpha = (x.reshape(*grid.shape, 3) for x in rates_since(curve, grid.reshape(-1)))
        speeds = np.linalg.norm(omega, axis=-1)
        if speeds.min() < least:
            at, least = float(grid.reshape(-1)[speeds.argmin()]), float(speeds.min())
        low, high = around(grid, -speeds)
        left = _may_stop(speeds, alpha, high - low)
        grid = np.linspace(low[left], high[left], 5, axis=1)
    return at, least


def _told(curve: Curve, since: float) -> str:
    """A time in the user's clock, or since the first keyframe where that is no number."""
    begin = curve.domain[0]
    return f"{begin + since:.6g}" if isinstance(begin, float) else f"{since:.6g} after the first"


# -- the integral -------------------------------------------------------------------------------


def _integral(curve: Curve, rates: NodeRates) -> tuple[float, float, float]:
    """The integral, what its last two levels disagree by, and where they do most."""
    halvings, most = (
        (HALVINGS, SHARPER * MOST) if closed_forms(curve) else (STENCIL_HALVINGS, STENCIL_MOST)
    )
    span, budget = curve.keyframes.knots[-1], most * curve.keyframes.spacings.size
    coarse, done = whole(curve.keyframes), 0.0
    before = _measured(curve, rates, coarse)[0]
    for level in range(halvings + 1):
        fine = coarse.halves()
        integrals, noise = (x.reshape(-1, 2) for x in _measured(curve, rates, fine))
        sums, floor = integrals.sum(axis=1), noise.sum(axis=1)
        total = done + float(sums.sum())
        off = np.abs(sums - before) - floor - 2.0 * np.sqrt(sums * floor)
        unsettled = off > AGREE * total * coarse.width / span
        left = float(off[unsettled].sum())
        budget -= len(fine.left)
        if left <= AGREE * total or level == halvings or budget < 0:
            break
        done += float(sums[~unsettled].sum())
        coarse, before = fine.picked(np.repeat(unsettled, 2)), integrals[unsettled].reshape(-1)
    return total, max(left, 0.0), float(coarse.left[off.argmax()])


def _measured(curve: Curve, rates: NodeRates, panels: Panels) -> tuple[FloatArray, FloatArray]:
    """Integrals (p,) over panels, and what rounding of alpha makes of a straight path there (p,)."""
    weights = gauss()[1]
    omega, alpha = rates(panels)
    speed = np.linalg.norm(omega, axis=-1)
    bent = np.linalg.norm(np.cross(omega, alpha), axis=-1)
    noise = (rounding(curve, 2) / panels.spacing**2)[:, None]
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        integrand = 2.0 * (bent / speed**2.5) ** 2
        rough = 2.0 * (noise / speed**1.5) ** 2
    return panels.width * (integrand @ weights), panels.width * (rough @ weights)
