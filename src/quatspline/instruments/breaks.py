"""Breaks inside segments, where no keyframe is: leaps of the orientation, and corners of the path.

A window [lo, hi] of a segment has the chord rates of its two halves.  On a smooth curve their difference falls
with the window's width; where the velocity breaks it stays, where the orientation leaps it grows.  Windows are
shrunk towards the largest difference until only a break can be left of it.  Orientations alone decide: rates of
closed forms do not see a leap, and stencils smear a corner.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.instruments.derivatives import closed_forms
from quatspline.quaternion import FloatArray, IntArray

WINDOWS = 7
"""Windows of a segment, each overlapping the next by half."""

SUSPECTS = 8
"""Windows searched for a break: as many of the largest difference, and as many of those that differ most
from their neighbours, as a break in a slow segment does."""

HALVINGS, SHARPER = 20, 10
"""Of a window, and of one that holds a leap beyond that, so that only the leap is left."""
CORNER = 1e-7
"""A break of the velocity is told above this share of a turn by 1 rad a spacing: ten times what rounding of
orientations leaves of a velocity over the last window; ..."""
LEAP = 1e-6
"""... one of the orientation above this angle in rad ..."""
FASTER = 100.0
"""... and both above this multiple of what a curve leaves that is smooth on the first window's scale."""
ROUGH = 10
"""So many halvings on, and at all that follow, the curve of a library has to show a break of the velocity: some
of them take arc cosines, whose noise of 1e-8 rad grows over smaller windows, where a break stays."""


class Breaks(NamedTuple):
    """The largest of a curve: ``leap`` of the orientation (rad), ``corner`` of the velocity (rad/t), and the
    latter ``scaled`` by the spacing of its segment's keyframes (rad); 0 where there is none."""

    leap: float
    corner: float
    scaled: float


UNBROKEN = Breaks(0.0, 0.0, 0.0)


def breaks(curve: Curve) -> Breaks:
    """The breaks of a single-track curve inside its segments."""
    nodes, q, h = _windows(curve)
    first = _corner(nodes, q)
    picked = _suspects(first * h)
    nodes, q, h, first = nodes[picked], q[picked], h[picked], first[picked]
    speed = _turn(q) / _width(nodes)
    corner, broken = first, np.ones(len(h), dtype=bool)
    for level in range(1, HALVINGS + 1):
        nodes, q = _shrunk(curve, nodes, q)
        corner = _corner(nodes, q)
        if level >= (HALVINGS if closed_forms(curve) else ROUGH):
            broken &= corner > CORNER / h + FASTER * first / 2.0**level
    leaps = _turn(q) > LEAP + FASTER * speed * _width(nodes)
    broken &= ~leaps
    corners = _across(curve, nodes[broken])
    return Breaks(
        _leap(curve, nodes[leaps], q[leaps]),
        float(np.max(corners, initial=0.0)),
        float(np.max(corners * h[broken], initial=0.0)),
    )


def _leap(curve: Curve, nodes: FloatArray, q: FloatArray) -> float:
    """The largest angle of leaps, each in a window."""
    if not len(nodes):
        return 0.0
    for _ in range(SHARPER):
        nodes, q = _shrunk(curve, nodes, q)
    return float(_turn(q).max())


def _windows(curve: Curve) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Ends and middles (w, 3) of all windows, orientations there (w, 3, 4), spacings of keyframes (w,)."""
    knots = curve.keyframes.knots
    h = np.diff(knots)
    t = knots[:-1, None] + h[:, None] * (np.arange(WINDOWS + 2) / (WINDOWS + 1))
    t[:, -1] = np.nextafter(knots[1:], 0.0)  # of this segment, not of the next
    q = curve._orientation(t.reshape(-1)).reshape(*t.shape, 4)
    of = np.arange(WINDOWS)[:, None] + np.arange(3)
    return t[:, of].reshape(-1, 3), q[:, of].reshape(-1, 3, 4), np.repeat(h, WINDOWS)


def _shrunk(curve: Curve, nodes: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The half of every window, in its left, middle or right, whose halves' rates differ most."""
    quarters = 0.5 * (nodes[:, :-1] + nodes[:, 1:])
    inner = curve._orientation(quarters.reshape(-1)).reshape(*quarters.shape, 4)
    order = [0, 3, 1, 4, 2]
    t = np.concatenate([nodes, quarters], axis=1)[:, order]
    q = np.concatenate([q, inner], axis=1)[:, order]
    of = np.arange(3)[:, None] + np.arange(3)
    best = np.argmax(_corner(t[:, of], q[:, of]), axis=1)
    rows = np.arange(len(t))[:, None]
    return t[rows, of[best]], q[rows, of[best]]


def _corner(nodes: FloatArray, q: FloatArray) -> FloatArray:
    """How far the chord rates of both halves of windows (..., 3) are apart, in rad/t."""
    rates = _rates(nodes, q)
    return np.asarray(np.linalg.norm(rates[..., 1, :] - rates[..., 0, :], axis=-1), dtype=float)


def _rates(t: FloatArray, q: FloatArray) -> FloatArray:
    """Velocities (..., k - 1, 3) at which orientations (..., k, 4) follow one another at times (..., k)."""
    steps = quaternion.mul(quaternion.conj(q[..., :-1, :]), q[..., 1:, :])
    steps = np.where(steps[..., :1] < 0.0, -steps, steps)  # q and -q are one orientation
    return np.asarray(2.0 * quaternion.log(steps) / np.diff(t, axis=-1)[..., None], dtype=float)


def _across(curve: Curve, nodes: FloatArray) -> FloatArray:
    """How far the rates before and after windows are apart: a break inside one halves its own."""
    low, high, width = nodes[:, 0], nodes[:, -1], _width(nodes)
    t = np.stack([low - width, low, high, high + width], axis=1)
    t = np.clip(t, 0.0, curve.keyframes.knots[-1])
    q = curve._orientation(t.reshape(-1)).reshape(*t.shape, 4)
    rates = _rates(t, q)
    return np.asarray(np.linalg.norm(rates[:, 2] - rates[:, 0], axis=-1), dtype=float)


def _turn(q: FloatArray) -> FloatArray:
    return quaternion.distance(q[:, 0], q[:, -1])


def _width(nodes: FloatArray) -> FloatArray:
    return nodes[:, -1] - nodes[:, 0]


def _suspects(corner: FloatArray) -> IntArray:
    around = np.pad(corner, 1, mode="reflect")
    relative = corner / (around[:-2] + around[2:] + LEAP)
    return np.union1d(np.argsort(relative)[-SUSPECTS:], np.argsort(corner)[-SUSPECTS:])
