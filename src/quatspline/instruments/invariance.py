"""Invariance: what a change of frames, of clock or of key signs does to a curve beyond that change.

A change of the keyframes has a change of the curve that should follow from it; the largest angle
between that and the curve that does follow is the deviation.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from quatspline import quaternion
from quatspline.instruments.trials import Build, Row, attempted
from quatspline.quaternion import FloatArray
from quatspline.trajectories.walks import directions

Map = Callable[[FloatArray], FloatArray]

TRIALS = 3
"""Random changes a property."""

SAMPLES = 8
"""Samples per segment, all inside: ends and keyframes are met by construction."""

SCALES = (1e-3, 4.0, 1e6)
SHIFT = 2.0**20
"""A power of two: times that are multiples of 2^-20 are shifted without rounding."""

SHELL = (170.0, 175.0, 179.0, 180.0, 181.0, 185.0, 190.0)
"""Angles in degrees at which a key is put from the frame of reference: there log charts fold."""

INVARIANT = 1e-7
"""Deviations below this share of the largest step are none: a decade above the rounding of libraries
that take angles by acos (1e-8), many above that of others."""


def _same(x: FloatArray) -> FloatArray:
    return x


class Change(NamedTuple):
    """Changed keyframes, and what should follow.

    The time at which their curve is where the first is at t, and the turn that the orientations should
    have made.
    """

    times: FloatArray
    keyframes: FloatArray
    clock: Map = _same
    turn: Map = _same


def invariance(
    build: Build, times: FloatArray, keyframes: FloatArray, rng: np.random.Generator
) -> list[Row]:
    """One row a property, for times (n,) and keyframes (n, 4).

    property; deviation: the largest angle in rad (lower is better); relative: its share of the largest
    step between keyframes; invariant: the verdict, `relative` <= 1e-7; or the reason of a failure.
    """
    curve = build(times, keyframes)
    t = times[0] + curve.keyframes.inside(SAMPLES)
    orientations = curve(t)
    largest = float(quaternion.distance(keyframes[1:], keyframes[:-1]).max())

    def measured(changes: list[Change]) -> list[Row]:
        angles = [
            quaternion.distance(
                build(change.times, change.keyframes)(change.clock(t)), change.turn(orientations)
            )
            for change in changes
        ]
        deviation = float(np.max(angles))  # NaN where a curve is
        relative = deviation / largest
        return [{"deviation": deviation, "relative": relative, "invariant": relative <= INVARIANT}]

    return [
        {"property": name, **row}
        for name, changes in PROPERTIES.items()
        for row in attempted(partial(measured, changes(times, keyframes, rng)))
    ]


def _left(times: FloatArray, q: FloatArray, rng: np.random.Generator) -> list[Change]:
    return [_based(times, q, p) for p in _units(rng)]


def _based(times: FloatArray, q: FloatArray, p: FloatArray) -> Change:
    return Change(times, quaternion.mul(p, q), turn=lambda x: quaternion.mul(p, x))


def _right(times: FloatArray, q: FloatArray, rng: np.random.Generator) -> list[Change]:
    return [
        Change(times, quaternion.mul(q, r), turn=lambda x, r=r: quaternion.mul(x, r))  # type: ignore[misc]
        for r in _units(rng)
    ]


def _shell(times: FloatArray, q: FloatArray, rng: np.random.Generator) -> list[Change]:
    """Base frames in which a random keyframe lies at every angle of `SHELL`, about random axes."""
    half = np.radians(SHELL)[:, None] / 2.0
    goals = quaternion.exp(half * directions(rng, (len(SHELL),)))
    keys = q[rng.integers(len(q), size=len(SHELL))]
    return [_based(times, q, p) for p in quaternion.mul(goals, quaternion.conj(keys))]


def _reversal(times: FloatArray, q: FloatArray, rng: np.random.Generator) -> list[Change]:
    around = times[0] + times[-1]
    return [Change(around - times[::-1], q[::-1], clock=lambda t: around - t)]


def _scale(times: FloatArray, q: FloatArray, rng: np.random.Generator) -> list[Change]:
    return [Change(c * times, q, clock=lambda t, c=c: c * t) for c in SCALES]  # type: ignore[misc]


def _shift(times: FloatArray, q: FloatArray, rng: np.random.Generator) -> list[Change]:
    return [Change(times + SHIFT, q, clock=lambda t: t + SHIFT)]


def _signs(times: FloatArray, q: FloatArray, rng: np.random.Generator) -> list[Change]:
    flips = rng.choice([-1.0, 1.0], size=(TRIALS, len(q), 1))
    return [Change(times, s * q) for s in flips]


def _units(rng: np.random.Generator) -> FloatArray:
    return quaternion.normalise(rng.normal(size=(TRIALS, 4)))


PROPERTIES: dict[str, Callable[[FloatArray, FloatArray, np.random.Generator], list[Change]]] = {
    "left multiplication": _left,
    "right multiplication": _right,
    "half-turn shell": _shell,
    "time reversal": _reversal,
    "time scale": _scale,
    "time shift": _shift,
    "key signs": _signs,
}
