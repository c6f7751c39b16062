"""Own rates: whether the angular velocity and acceleration a library publishes are those of its curve."""

from __future__ import annotations

import numpy as np

from quatspline import stencil
from quatspline.curve import Curve
from quatspline.instruments.trials import Row
from quatspline.peers.wrapping import PeerCurve
from quatspline.quaternion import FloatArray

SAMPLES = 4
"""Samples per segment, inside."""

RATES = {1: "omega", 2: "alpha"}


def own_rates(curve: Curve) -> list[Row]:
    """One row for every rate that the curve, or the library behind it, publishes.

    quantity; miss: the largest difference in rad/t or rad/t^2 from the derivative of the orientations
    inside segments (lower is better; stencils are good to 1e-9 / h and 1e-7 / h^2); relative: its share
    of the largest rate, for accelerations at least that of a speed gained in one spacing.
    """
    keyframes = curve.keyframes
    t = keyframes.inside(SAMPLES)
    truth = stencil.rates(curve.orientations, t, keyframes.knots)
    speed, gain = (float(np.linalg.norm(x, axis=-1).max()) for x in truth)
    sizes = (speed, max(gain, speed / float(keyframes.spacings.mean())))
    rows = []
    for order, quantity in RATES.items():
        own = _published(curve, t, order)
        if own is not None:
            miss = float(np.linalg.norm(own - truth[order - 1], axis=-1).max())
            rows.append({"quantity": quantity, "miss": miss, "relative": miss / sizes[order - 1]})
    return rows


def _published(curve: Curve, t: FloatArray, order: int) -> FloatArray | None:
    """Rates that are not the shared fallback's, at times since the first keyframe; None without any."""
    if order in curve.orders and order not in curve.numeric_orders:
        return curve(t + curve.domain[0], order)
    return curve._published(t, order) if isinstance(curve, PeerCurve) else None
