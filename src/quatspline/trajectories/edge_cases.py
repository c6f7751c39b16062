"""Edge cases: keyframes that interpolation schemes are known to stumble over, with their truth if any."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quatspline import quaternion
from quatspline.quaternion import FloatArray
from quatspline.trajectories.walks import walk

AXIS = np.array([2.0, -1.0, 2.0]) / 3.0
BASE = np.array([0.1, 0.7, -0.5, 0.5])
"""A unit quaternion far from the identity, whose scalar part is small: no chart is centred here."""

SEED = 1985
NEARLY = 1e-6
"""How far from half a turn the steps of `near half-turn` stay, in rad."""
TINY = 1e-7
"""The steps of `tiny rotations`, in rad: acos of a dot product sees 1e-8 and less as nothing."""


@dataclass(frozen=True)
class EdgeCase:
    """Keyframes with a difficulty.

    Attributes
    ----------
    name, difficulty : what it is called, and what is hard about it
    times : (n,), closed (n + 1,)
    keyframes : (n, 4), with the signs they are given with
    closed : whether the curve returns
    truth : the orientations (m, 4) at times (m,) that the keyframes suggest (a constant rate, rest), or
        None where only meeting them can be asked for
    """

    name: str
    difficulty: str
    times: FloatArray
    keyframes: FloatArray
    closed: bool = False
    truth: Callable[[FloatArray], FloatArray] | None = None


def edge_cases() -> dict[str, EdgeCase]:
    """The pack, by name."""
    return {case.name: case for case in (*_still(), *_spins(), *_walks())}


def spin(rate: float, t: FloatArray) -> FloatArray:
    """Orientations (m, 4) of a constant body rate in rad a time unit about `AXIS`, from `BASE`."""
    return quaternion.mul(BASE, quaternion.exp(0.5 * rate * np.asarray(t)[..., None] * AXIS))


def _case(
    name: str, difficulty: str, times: FloatArray, rate: float, closed: bool = False
) -> EdgeCase:
    """A constant spin."""
    since = times - times[0]
    keys = spin(rate, since[:-1] if closed else since)
    return EdgeCase(
        name, difficulty, times, keys, closed, lambda t: spin(rate, np.asarray(t) - times[0])
    )


def _still() -> list[EdgeCase]:
    """Keyframes of one orientation."""
    times, same = np.arange(6.0), np.tile(BASE, (6, 1))
    signs = np.array([1.0, -1.0, -1.0, 1.0, -1.0, 1.0])[:, None]
    return [
        EdgeCase("equal keys", "rest: no axis", times, same, truth=_rest),
        EdgeCase("antipodes", "q and -q are one orientation", times, signs * same, truth=_rest),
    ]


def _rest(t: FloatArray) -> FloatArray:
    return np.broadcast_to(BASE, (*np.shape(t), 4))


def _spins() -> list[EdgeCase]:
    """Keyframes of a constant rate."""
    even, flips = np.arange(6.0), np.array([1.0, 1.0, -1.0, 1.0, -1.0, -1.0])[:, None]
    spread = np.array([0.0, 1e-3, 1.0, 1.001, 10.0, 10.001, 11.0])
    flipped = _case("sign-flipped", "a library may take the long way", even, 0.8)
    return [
        _case("two keys", "no neighbours to take a rate from", np.array([0.0, 1.0]), 1.0),
        EdgeCase(**vars(flipped) | {"keyframes": flips * flipped.keyframes}),
        _case("near half-turn", "the short way is hard to tell", even, np.pi - NEARLY),
        _case("tiny rotations", "angles below what acos sees", even, TINY),
        _case("extreme uneven times", "spacings from 0.001 to 9", spread, 0.2),
        _case("Unix times", "1.3e9 s, 10 ms apart", 1.3e9 + np.arange(8.0) / 128.0, 20.0),
        _case("closed full turn", "returns as -q", even * 1.0, 2.0 * np.pi / 5.0, closed=True),
    ]


def _walks() -> list[EdgeCase]:
    """Keyframes without a truth."""
    rng = np.random.default_rng(SEED)
    times = np.arange(7.0)
    repeated = walk(rng, 7, 60.0)[:, 0]
    repeated[3] = repeated[2]
    turns = quaternion.exp(0.5 * np.pi * np.eye(3)[[0, 1, 2, 0, 1, 2]])
    half = [BASE]
    for turn in turns:
        half.append(quaternion.mul(half[-1], turn))
    back = np.where(np.arange(7)[:, None] % 2 == 0, BASE, spin(2.0, np.array(1.0)))
    return [
        EdgeCase("repeated key", "rest within a motion", times, repeated),
        EdgeCase("exact half-turns", "two shortest ways", times, np.array(half)),
        EdgeCase("there and back", "the velocity changes its sign at every key", times, back),
    ]
