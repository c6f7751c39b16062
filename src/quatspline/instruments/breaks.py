"""Breaks inside segments, where no keyframe is: leaps of the orientation, and corners of the path.

A window [lo, hi] of a segment has a turn, and the chord rates of its two halves have a difference.  Halving
the window halves both on a smooth curve, as soon as the window sees single turns; where the orientation leaps,
the turn stays put, and where the velocity breaks, the difference does.  Windows are therefore halved, towards the
largest difference, down to the rounding of time, and what stays put over many halvings is a break.  No scale of
the curve is needed: a segment may hold a million turns, or rest beside one that does not.  Orientations
alone decide: rates of closed forms do not see a leap, and stencils smear a corner.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.inputs.arrays import BoolArray, FloatArray, IntArray

WINDOWS = 7
"""Windows of a segment, each overlapping the next by half."""

SUSPECTS = 8
"""Windows searched for a break: as many of the largest difference, and as many of those that differ most
from their neighbours, as a break in a slow segment does."""

NARROWEST = 100
"""Windows are halved while they are wider than twice so many ulps of time: what a curve rounds of its time is then
a hundredth of their turn at most."""
RUN, ALIKE = 10, 3.0
"""What stays put does so to this factor over so many halvings, from its least on.  A corner seen by chords comes
out between its half and its whole.  Between falling with the window and growing with rounding, a smooth curve
stays within the factor for six halvings at most; rounding itself, of arc cosines say, doubles with each."""
STRAYS = 0.2
"""Share of windows around a leap whose turn may be smaller: at a leap itself a curve may take any value."""
CORNER = 1e-7
"""A break of the velocity is told above this share of a turn by 1 rad per spacing, ..."""
LEAP = 1e-6
"""... one of the orientation above this angle in rad: libraries round orientations to 1e-8."""


class Breaks(NamedTuple):
    """The largest breaks of a curve, 0 where there is none.

    ``leap`` of the orientation (rad), ``corner`` of the velocity (rad/t), and the latter ``scaled`` by the
    spacing of its segment's keyframes (rad).
    """

    leap: float
    corner: float
    scaled: float


UNBROKEN = Breaks(0.0, 0.0, 0.0)


def breaks(curve: Curve) -> Breaks:
    """The breaks of a single-track curve inside its segments."""
    nodes, q, h = _windows(curve)
    if not len(h):
        return UNBROKEN
    picked = _suspects(_corner(nodes, q) * h)
    h = h[picked]
    nodes, q = _halved(curve, nodes[picked], q[picked])
    turns = _turn(q)
    leaping, _ = _staying(turns, LEAP, strays=STRAYS)
    leaps = turns[np.isfinite(turns).sum(axis=0) - 1, np.arange(len(h))][
        leaping
    ]  # of the narrowest windows
    breaking, level = _staying(_corner(nodes, q), CORNER / h)
    breaking &= ~leaping
    at = level[breaking], np.flatnonzero(breaking)
    corners = _across(curve, nodes[at], q[at])
    found = leaps, corners, corners * h[breaking]
    return Breaks(*(float(np.max(sizes, initial=0.0)) for sizes in found))


def _windows(curve: Curve) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Ends and middles (w, 3) of all windows, orientations there (w, 3, 4), spacings of keyframes (w,)."""
    knots, h = curve.keyframes.knots, curve.keyframes.spacings
    t = curve.keyframes.inside(np.arange(WINDOWS + 2) / (WINDOWS + 1)).reshape(-1, WINDOWS + 2)
    t[:, -1] = np.nextafter(knots[1:], 0.0)  # of this segment, not of the next
    q = _orientations(curve, t)
    of = np.arange(WINDOWS)[:, None] + np.arange(3)
    windows = t[:, of].reshape(-1, 3), q[:, of].reshape(-1, 3, 4), np.repeat(h, WINDOWS)
    wide = _wide(curve, windows[0])
    return windows[0][wide], windows[1][wide], windows[2][wide]


def _wide(curve: Curve, nodes: FloatArray) -> FloatArray:
    """Which windows (w, 3) have halves that time tells apart."""
    ulp = np.spacing(curve.keyframes.knots[-1])
    return np.asarray(nodes[:, -1] - nodes[:, 0] >= 2 * NARROWEST * ulp)


def _halved(curve: Curve, nodes: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Windows (levels, w, 3) and orientations (levels, w, 3, 4), each level half as wide as the one before.

    NaN where a window would be too narrow.
    """
    every = [(nodes, q)]
    left = np.flatnonzero(_wide(curve, nodes))
    while left.size:
        nodes, q = np.full_like(nodes, np.nan), np.full_like(q, np.nan)
        nodes[left], q[left] = _half(curve, every[-1][0][left], every[-1][1][left])
        every.append((nodes, q))
        left = left[_wide(curve, nodes[left])]
    levels, orientations = zip(*every, strict=True)
    return np.stack(levels), np.stack(orientations)


def _half(curve: Curve, nodes: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The half of every window, in its left, middle or right, whose halves' rates differ most."""
    t, q = _quartered(curve, nodes, q)
    of = np.arange(3)[:, None] + np.arange(3)
    best = np.argmax(_corner(t[:, of], q[:, of]), axis=1)
    rows = np.arange(len(t))[:, None]
    return t[rows, of[best]], q[rows, of[best]]


def _quartered(curve: Curve, nodes: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Windows (w, 3) with the middles of their halves (w, 5), and orientations there (w, 5, 4)."""
    quarters = 0.5 * (nodes[:, :-1] + nodes[:, 1:])
    order = [0, 3, 1, 4, 2]
    t = np.concatenate([nodes, quarters], axis=1)[:, order]
    return t, np.concatenate([q, _orientations(curve, quarters)], axis=1)[:, order]


def _staying(
    values: FloatArray, floor: FloatArray | float, strays: float = 0.0
) -> tuple[BoolArray, IntArray]:
    """Which of values (levels, w) stay put above a floor, (w,), and a level (w,) at which they do.

    Values of a smooth curve fall and then grow with rounding.  So a level is sought from which on the least
    value, but for a share of strays, has RUN others within ALIKE of it; the level told is the middle of
    these, where neither what still falls nor what already grows counts for much.
    """
    values = np.where(np.isnan(values), np.inf, values)
    stays, level = np.zeros(values.shape[1], dtype=bool), np.zeros(values.shape[1], dtype=int)
    for start in reversed(range(max(len(values) - RUN, 0))):
        tail = values[start:]
        few = (strays * np.isfinite(tail).sum(axis=0)).astype(int)
        least = np.sort(tail, axis=0)[few, np.arange(tail.shape[1])]
        alike = (tail >= least) & (tail <= ALIKE * least) & (least > floor) & (least < np.inf)
        ranked = np.cumsum(alike, axis=0)
        run = ranked[-1] > RUN
        level = np.where(run, start + np.argmax(2 * ranked >= ranked[-1], axis=0), level)
        stays |= run
    return stays, level


def _across(curve: Curve, nodes: FloatArray, q: FloatArray) -> FloatArray:
    """How far the rates in the first and last quarter of windows (w, 3) are apart: a break is between them."""
    rates = _rates(*_quartered(curve, nodes, q))
    return np.asarray(np.linalg.norm(rates[:, -1] - rates[:, 0], axis=-1), dtype=float)


def _corner(nodes: FloatArray, q: FloatArray) -> FloatArray:
    """How far the chord rates of both halves of windows (..., 3) are apart, in rad/t."""
    rates = _rates(nodes, q)
    return np.asarray(np.linalg.norm(rates[..., 1, :] - rates[..., 0, :], axis=-1), dtype=float)


def _rates(t: FloatArray, q: FloatArray) -> FloatArray:
    """Velocities (..., k - 1, 3) at which orientations (..., k, 4) follow one another at times (..., k)."""
    steps = quaternion.mul(quaternion.conj(q[..., :-1, :]), q[..., 1:, :])
    steps = np.where(steps[..., :1] < 0.0, -steps, steps)  # q and -q are one orientation
    return np.asarray(2.0 * quaternion.log(steps) / np.diff(t, axis=-1)[..., None], dtype=float)


def _turn(q: FloatArray) -> FloatArray:
    return quaternion.distance(q[..., 0, :], q[..., -1, :])


def _orientations(curve: Curve, t: FloatArray) -> FloatArray:
    """At times of any shape since the first keyframe."""
    return curve.orientations(t.reshape(-1)).reshape(*t.shape, 4)


def _suspects(corner: FloatArray) -> IntArray:
    around = np.pad(corner, 1, mode="reflect")
    relative = corner / (around[:-2] + around[2:] + LEAP)
    return np.union1d(np.argsort(relative)[-SUSPECTS:], np.argsort(corner)[-SUSPECTS:])
