"""Excursion: how far a curve leaves the arcs between its keyframes, to the side, beyond their ends and back.

Slerp runs along the arc from one keyframe to the next; every smoother curve leaves it.  To the side it
must, to turn a corner; beyond the arc's ends it goes on where its velocity cannot stop in time, which one
sees as an overshoot, and, where two keyframes are the same, as a body that wanders while it should hold.

Angles are taken on S^3 and given as rotations, twice as large, up to 360 degrees: a curve half a turn away
from a keyframe and one that has gone once round are told apart.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.inputs.arrays import BoolArray
from quatspline.quaternion import FloatArray

SAMPLES = 64
"""Equal parts of a segment between samples; a smooth peak between two is missed by its curvature times 1/128^2 / 2."""

BLOCK = 1 << 16
"""Samples, of all tracks together, that are held at a time: memory does not grow with the motion."""

HOLD = 1e-12
"""A step below this, in rad, is a hold: rounding has no direction."""


class Excursion(NamedTuple):
    """Of every segment, (segments, *K), in rad of rotation.

    step: the angle between its keyframes; off: the largest distance of the curve to the arc between them; with
    psi the angle of the curve along that arc's great circle, over: the largest way beyond either end,
    max(psi - step, -psi), and back: the largest fall of psi from its running maximum.  A hold, whose step is
    0, has no arc: all three are the largest angle from its keyframe.
    """

    step: FloatArray
    off: FloatArray
    over: FloatArray
    back: FloatArray

    @property
    def hold(self) -> BoolArray:
        """Which segments are holds."""
        return self.step < HOLD


def excursion(curve: Curve) -> Excursion:
    """Excursions of a curve's segments, of each of its tracks."""
    start, stop = _ends(curve)
    since = _since(curve)
    few = max(1, BLOCK // since.shape[1] // start.shape[1])
    blocks = [slice(a, a + few) for a in range(0, len(since), few)]
    parts = [_measured(_sampled(curve, since[b]), start[b], stop[b]) for b in blocks]
    shape = (-1, *curve.keyframes.track_shape)
    return Excursion(*(np.concatenate(x).reshape(shape) for x in zip(*parts, strict=True)))


def _ends(curve: Curve) -> tuple[FloatArray, FloatArray]:
    """The keyframes (segments, K, 4) at both ends of segments."""
    frames = curve.keyframes
    q = frames.tracks.transpose(1, 0, 2)
    if frames.closed:
        q = np.concatenate([q, frames.signs[:, None] * q[:1]])
    return q[:-1], q[1:]


def _since(curve: Curve) -> FloatArray:
    """Times from each segment's start to just before its end, (segments, SAMPLES + 1)."""
    knots = curve.keyframes.knots
    since = curve.keyframes.inside(np.linspace(0.0, 1.0, SAMPLES + 1)).reshape(-1, SAMPLES + 1)
    since[:, -1] = np.nextafter(knots[1:], 0.0)
    return since


def _sampled(curve: Curve, since: FloatArray) -> FloatArray:
    """The curve at times (segments, m), (segments, m, K, 4)."""
    return curve.inner(since.reshape(-1)).reshape(*since.shape, -1, 4)


def _measured(x: FloatArray, start: FloatArray, stop: FloatArray) -> list[FloatArray]:
    """Step, off, over, back of samples (segments, m, K, 4), whatever their signs."""
    x = quaternion.align(np.concatenate([start[None], x.swapaxes(0, 1)]))[1:]
    chord = quaternion.log(quaternion.mul(quaternion.conj(start), stop))
    length = np.linalg.norm(chord, axis=-1)
    hold = 2.0 * length < HOLD
    axis = chord / np.where(hold, 1.0, length)[..., None]
    side = quaternion.mul(start, np.concatenate([np.zeros_like(axis[..., :1]), axis], axis=-1))
    along, across = (np.einsum("n...i,...i->n...", x, y) for y in (start, side))
    psi = np.unwrap(np.arctan2(across, along), axis=0)
    over = np.maximum(psi - length, -psi).max(axis=0)
    back = (np.maximum.accumulate(psi, axis=0) - psi).max(axis=0)
    off = _from_arc(x, start, side, psi, length).max(axis=0)
    away = _apart(x[:, hold], start[hold]).max(axis=0)
    found = [off, np.maximum(over, 0.0), back]
    for each in found:
        each[hold] = away
    return [2.0 * y for y in (length, *found)]


def _from_arc(
    x: FloatArray, start: FloatArray, side: FloatArray, psi: FloatArray, length: FloatArray
) -> FloatArray:
    """Angles on S^3 from points to the nearest one of arcs: abreast of them, or an arc's nearer end."""
    middle = 0.5 * length
    turns = np.mod(psi - middle + np.pi, 2.0 * np.pi) - np.pi  # seen from the middle of the arc
    nearest = (middle + np.clip(turns, -middle, middle))[..., None]
    return _apart(x, np.cos(nearest) * start + np.sin(nearest) * side)


def _apart(a: FloatArray, b: FloatArray) -> FloatArray:
    """Angles on S^3 between unit quaternions, 0 to pi: not of rotations, for which a and -a are one."""
    angle = 2.0 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1))
    return np.asarray(angle, dtype=float)
