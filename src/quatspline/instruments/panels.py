"""Panels: pieces of segments that a quadrature halves where two levels do not agree yet."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np

from quatspline.inputs.arrays import BoolArray, IntArray
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray

PANELS, POINTS = 2, 5
"""Gauss-Legendre panels a segment to begin with, and points a panel."""

HALVINGS, MOST = 20, 64
"""Of a panel at most: what jumps inside a segment is then told to 1e-6 of the segment.  And panels a segment at
most, on average over the curve: more would be refining rounding."""

STENCIL_HALVINGS, STENCIL_MOST = 3, 16
"""The same of curves known by stencils on their orientations, which reach over 5 % of a segment: narrower panels
would not see more."""


class Panels(NamedTuple):
    """Pieces of segments, not across a keyframe.

    Times since the first keyframe at their left ends (p,), widths (p,), spacings of their keyframes (p,).
    """

    left: FloatArray
    width: FloatArray
    spacing: FloatArray

    def times(self, u: FloatArray) -> FloatArray:
        """Times (p, k) at shares u (k,) of the panels."""
        return self.left[:, None] + self.width[:, None] * u

    def picked(self, which: IntArray | BoolArray) -> Panels:
        """Those of a mask or index."""
        return Panels(self.left[which], self.width[which], self.spacing[which])

    def halves(self) -> Panels:
        """Twice as many, each pair in place of one."""
        width = np.repeat(0.5 * self.width, 2)
        left = np.repeat(self.left, 2)
        left[1::2] += width[1::2]
        return Panels(left, width, np.repeat(self.spacing, 2))


def whole(keyframes: Keyframes) -> Panels:
    """The panels to begin with."""
    left, h = keyframes.inside(np.arange(PANELS) / PANELS), np.repeat(keyframes.spacings, PANELS)
    return Panels(left, h / PANELS, h)


@cache
def gauss() -> tuple[FloatArray, FloatArray]:
    """Nodes and weights on the unit panel."""
    u, weights = np.polynomial.legendre.leggauss(POINTS)
    return 0.5 + 0.5 * u, 0.5 * weights


def around(grid: FloatArray, sizes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The neighbours (p,) of the largest of sizes in rows of a grid (p, k), or it itself at an end."""
    rows, best = np.arange(len(grid)), sizes.argmax(axis=1)
    low, high = np.maximum(best - 1, 0), np.minimum(best + 1, grid.shape[1] - 1)
    low, high = grid[rows, low], grid[rows, high]
    return low, high
