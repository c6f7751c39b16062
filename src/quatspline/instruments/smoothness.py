"""Smoothness inside segments: jumps of derivatives of orders 2 to 6, between keyframes.

A polynomial is fitted to orientations on either side of a place inside a segment, and both are
differentiated there.  On an analytic curve they agree to what rounding leaves, which grows by three or
four digits an order.  A break inside a window spoils the polynomial of that side wherever it lies, though
in lower orders, too: what is told is the order, or one below it.  Leaps and corners are found by `breaks`.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pandas as pd

from quatspline.curve import Curve
from quatspline.inputs.arrays import BoolArray
from quatspline.quaternion import FloatArray

ORDERS = np.arange(2, 7)
"""Rounding leaves the next no digit."""

WIDTHS = (0.25, 0.125, 0.0625)
"""Of windows, in segments, which cover a segment between the places where both sides are compared.  A polynomial
follows a curve that turns far in a segment on narrow ones only; rounding counts for less on wide ones."""

DEGREE, NODES = 12, 28
"""Of a window's polynomial, and orientations that it is fitted to."""

SHARES = 10.0 ** (ORDERS - 8.0)
"""Jumps below these shares of the derivative's largest size on the segment are none: what the polynomial does not
follow of an analytic curve grows by a factor of ten an order at least ..."""

ROUNDINGS = 50.0 * float(np.finfo(float).eps)
"""... nor one below what this error of every orientation makes of it."""


def inner_jumps(curve: Curve) -> pd.DataFrame:
    """Jumps of derivatives of a single-track curve inside its segments, a row an order and width of windows.

    Columns: order (2 to 6); width, of windows in segments; jump, the largest in R^4 by the segment's share
    of time; size, the largest of the derivative; smooth, whether on every segment a jump is within what the
    polynomial does not follow, on windows of this width or of another that rounding leaves a verdict.
    """
    levels = [_compared(curve, width) for width in WIDTHS]
    kept = np.any([fits for *_, fits in levels], axis=0).all(axis=1)
    rows = [
        {
            "order": order,
            "width": width,
            "jump": jump[k].max(),
            "size": size[k].max(),
            "smooth": kept[k],
        }
        for width, (jump, size, _) in zip(WIDTHS, levels, strict=True)
        for k, order in enumerate(ORDERS)
    ]
    return pd.DataFrame(rows)


def inner_smoothness(table: pd.DataFrame) -> int:
    """k of C^k inside segments by a table of `inner_jumps`: 6 where no derivative up to the sixth jumps, 1 at least."""
    broken = table.loc[~table["smooth"], "order"]
    return int(broken.min()) - 1 if len(broken) else int(ORDERS[-1])


def _compared(curve: Curve, width: float) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Jumps, sizes and whether both sides fit, (orders, segments) each."""
    sides = np.stack([_side(curve, sign, width) for sign in (1.0, -1.0)])
    jump = np.linalg.norm(sides[0] - sides[1], axis=-1).max(axis=-1)
    size = np.linalg.norm(sides, axis=-1).max(axis=(0, 3))
    noise = ROUNDINGS * np.abs(_differences(width)).sum(axis=1)[:, None]
    within = SHARES[:, None] * size
    tells = (noise <= within) | (width == WIDTHS[0])
    return jump, size, tells & (jump <= within + noise)


def _side(curve: Curve, sign: float, width: float) -> FloatArray:
    """Derivatives (orders, segments, places, 4) from the side of later or earlier times."""
    places = np.arange(width, 1.0, width)
    shares = np.add.outer(places, sign * width * _nodes())
    q = curve.inner(curve.keyframes.inside(shares.reshape(-1)))[:, 0]
    q = q.reshape(-1, *shares.shape, 4)
    return np.asarray(np.einsum("k,kj,spji->kspi", sign**ORDERS, _differences(width), q))


@cache
def _nodes() -> FloatArray:
    """Chebyshev's nodes on [0, 1]."""
    return np.asarray(0.5 + 0.5 * np.polynomial.chebyshev.chebpts1(NODES))


@cache
def _differences(width: float) -> FloatArray:
    """Weights (orders, NODES) of values on a window for derivatives at its beginning, by the segment's share."""
    # notation: T_n^(k)(-1) = (-1)^(n + k) prod_(j < k) (n^2 - j^2) / (2 j + 1)
    fit = np.linalg.pinv(np.polynomial.chebyshev.chebvander(2.0 * _nodes() - 1.0, DEGREE))
    n = np.arange(DEGREE + 1.0)
    slopes, rows = (-1.0) ** n, []
    for k in range(ORDERS[-1] + 1):
        rows.append((2.0 / width) ** k * slopes)
        slopes = -slopes * (n * n - k * k) / (2 * k + 1)
    return np.asarray(np.array(rows)[ORDERS] @ fit)
