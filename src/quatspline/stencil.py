"""Rates of any curve from its orientations alone: the shared numerical fallback.

Nine orientations around t, all inside t's own segment (one-sided near a knot), are taken to the
tangent space at t: x_j = log(q(t)^-1 q(t + c_j h)).  There omega = 2 x' and alpha = 2 x'' exactly
(the chart's Christoffel terms vanish at its centre), and a stencil gives both derivatives.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from quatspline import quaternion
from quatspline.inputs.arrays import FloatArray, IntArray
from quatspline.keyframes import segment_of

if TYPE_CHECKING:
    from quatspline.curve import Curve

POINTS = 9
STEP = 6e-3
"""Stencil step as a share of the segment: truncation (h^7 one-sided) and the rounding of second
differences (1e-16/h^2) both stay near 1e-10 of the segment's own scale."""
TURN = 0.1
"""... and a step turns by no more than this in rad: the chart folds where eight of them reach half a turn."""
PROBE, PROBES = 2.0**-20, 8
"""Share of the segment over which the speed is read that shortens its steps, told apart up to a million turns, and
at how many places: a turning point's own speed is 0, where a few steps on it is not."""
TICKS = 16
"""Ulps of time that this distance has at least."""


@cache
def _stencils() -> tuple[FloatArray, FloatArray]:
    """Weights (shift, node) of the first and the second derivative at 0 for shifted nodes."""
    first, second = [], []
    for shift in range(-(POINTS // 2), POINTS // 2 + 1):
        nodes = np.arange(POINTS) - POINTS // 2 + shift
        vandermonde = np.vander(nodes.astype(float), increasing=True).T
        inverse = np.linalg.inv(vandermonde)
        first.append(inverse[:, 1])
        second.append(2.0 * inverse[:, 2])
    return np.array(first), np.array(second)


def rates(
    orientation: Callable[[FloatArray], FloatArray], t: FloatArray, knots: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Body angular velocity and acceleration (m, 3) at t (m,) of a curve smooth between knots."""
    segment = segment_of(knots, t)
    lo, hi = knots[segment], knots[segment + 1]
    step = np.minimum(STEP * (hi - lo), TURN / _speed(orientation, segment, knots))
    reach = POINTS // 2
    below = np.maximum(reach - np.floor((t - lo) / step), 0.0)
    above = np.maximum(reach - np.floor((hi - t) / step), 0.0)
    off = np.nan_to_num(below - above)  # NaN where orientations are, and then so are their rates
    shift = np.clip(off, -reach, reach).astype(int)
    nodes = np.arange(POINTS) - reach + shift[:, None]
    samples = np.clip(t[:, None] + nodes * step[:, None], lo[:, None], hi[:, None])
    q = orientation(samples.reshape(-1)).reshape(len(t), POINTS, 4)
    centre = q[np.arange(len(t)), reach - shift]
    x = quaternion.log(quaternion.mul(quaternion.conj(centre)[:, None], q))
    first, second = _stencils()
    velocity = 2.0 * np.einsum("mj,mji->mi", first[shift + reach], x) / step[:, None]
    acceleration = 2.0 * np.einsum("mj,mji->mi", second[shift + reach], x) / step[:, None] ** 2
    return velocity, acceleration


def rates_of(curve: Curve, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The same of a single-track curve at times since its first keyframe, whatever rates it reports."""
    return rates(lambda s: curve.inner(s)[:, 0], t, curve.keyframes.knots)


def _speed(
    orientation: Callable[[FloatArray], FloatArray], segment: IntArray, knots: FloatArray
) -> FloatArray:
    """The largest angular speed (m,) in the segments (m,) of samples, roughly, and never 0."""
    used, of = np.unique(segment, return_inverse=True)
    lo, hi = knots[used], knots[used + 1]
    apart = np.maximum(PROBE * (hi - lo), TICKS * np.spacing(hi))[:, None]
    t = lo[:, None] + (hi - lo)[:, None] * np.linspace(0.0, 1.0, PROBES)
    other = np.where(np.arange(PROBES) < PROBES // 2, t + apart, t - apart)
    t[:, -1], other[:, -1] = (
        np.nextafter(hi, lo),
        hi - apart[:, 0],
    )  # of this segment, not of the next
    q = orientation(np.concatenate([t, other], axis=None)).reshape(2, *t.shape, 4)
    speeds = quaternion.distance(q[0], q[1]) / np.abs(other - t)
    return np.asarray(np.maximum(speeds.max(axis=1), np.finfo(float).tiny)[of], dtype=float)
