"""What a smooth curve keeps: its rates are its orientations' own, and agree on both sides of a knot."""

from typing import Any

import numpy as np

from quatspline import stencil
from quatspline.curve import Curve
from quatspline.quaternion import FloatArray
from walks import apart, inside, loop, uneven, walk

JOINED = 1e-11
"""Of the largest rate, at a knot: what is left of equal numbers that were computed in two ways."""


def motion(kind: str, count: int, degrees: float) -> tuple[FloatArray, FloatArray, dict[str, Any]]:
    """Uneven times, keyframes and options: a walk that is "open", or a loop, "closed +" or "closed -"."""
    if kind == "open":
        return uneven(count), walk(count, degrees), {}
    knots = uneven(10)
    return knots, loop(knots, 1 if kind == "closed -" else 2, wobble=0.4), {"closed": True}


def assert_own_rates(curve: Curve, t: FloatArray, bounds: tuple[float, float]) -> None:
    """Orders 1 and 2 at times t, of a curve that begins at 0, within a share of the largest."""
    for order, wanted in enumerate(stencil.rates_of(curve, t), start=1):
        assert apart(curve(t, order), wanted) < bounds[order - 1] * np.abs(wanted).max()


def assert_joined(curve: Curve, *, seam: float = JOINED) -> None:
    """Orders 1 and 2 do not jump at inner knots, nor at a closed curve's seam; nor does the curve."""
    knots = curve.times
    pairs = [(np.nextafter(knots[1:-1], -1.0), knots[1:-1])]
    if curve.closed:
        last = np.nextafter(knots[-1:], 0.0)
        assert apart(curve(last), curve.keyframes.sign * curve.quaternions[:1]) < seam
        pairs.append((last, knots[:1]))
    for order in (1, 2):
        size = np.abs(curve(inside(knots, 6), order)).max()
        for left, right in pairs:
            assert apart(curve(left, order), curve(right, order)) < JOINED * size
