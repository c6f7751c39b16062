"""Reconstruction: a dense recorded motion, rebuilt from every n-th of its frames.

Errors are angles between the local orientations of a joint, at the frames left out and more than two
keyframes from either end, where a scheme has neighbours on both sides.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quatspline import quaternion
from quatspline.catalogue import version
from quatspline.instruments.derivatives import analytic
from quatspline.instruments.summary import LISTS
from quatspline.instruments.trials import Row
from quatspline.motion import Motion, euler
from quatspline.quaternion import FloatArray

STILL = 1.0
"""A joint that never turns so far (degrees) from its first orientation is left out."""

POP = 1800.0
"""A joint that turns faster somewhere (degrees a second) pops: its recording, not its motion, is at fault."""

FINGERS = ("finger", "thumb", "index1")
"""In names of joints that optical recordings do not resolve, and CMU says to ignore."""

ORDER = 2
"""Of the Butterworth filter, which runs forward and backward: 4 in all."""

MARGIN = 2
"""Keyframes at either end near which nothing is measured."""

EULER: dict[str, str] = {"euler-linear": "linear", "euler-cubic": "cubic"}
"""What animation systems do, as controls: Euler channels in the file's order, each interpolated alone."""

UNNAMED = "ZYX"
"""The order of joints whose file has none of three axes."""

DENSE = "local-quintic"
"""The scheme through all frames whose rates are the truth's: order 4, nothing to be solved."""


class Rebuilt(NamedTuple):
    """Orientations (n, J, 4) at the frames, and where there are some the rates (n, J, 3); failed joints are NaN."""

    quaternions: FloatArray
    rates: tuple[FloatArray, ...] = ()
    facts: Row = {}


@dataclass(frozen=True, eq=False)
class Truth:
    """What is rebuilt.

    Attributes
    ----------
    motion : with all its tracks
    compared : the indices of the tracks that are measured
    pops : names of those that pop, which are not
    """

    motion: Motion
    compared: NDArray[np.intp]
    pops: list[str]

    @cached_property
    def tracks(self) -> Motion:
        """The tracks that are measured, alone."""
        m, names = self.motion, [self.motion.tracks[k] for k in self.compared.tolist()]
        return Motion(
            m.stamps, m.quaternions[:, self.compared], None, names, per_second=m.per_second
        )

    @cached_property
    def rates(self) -> tuple[FloatArray, FloatArray]:
        """Body angular velocity and acceleration (n, J, 3) of the tracks."""
        dense = self.tracks.curve(DENSE).orientation
        return dense(self.tracks.times, 1), dense(self.tracks.times, 2)


def truth(motion: Motion, cutoff: float | None = None) -> Truth:
    """A recorded motion as the truth, low-pass filtered where a frequency (Hz) is given.

    Raises
    ------
    ValueError
        Where no joint moves, or the motion is too slow or too short for the filter.
    """
    q, t = motion.quaternions, motion.times
    range_ = np.degrees(quaternion.distance(q, q[:1]).max(axis=0))
    speed = np.degrees((quaternion.distance(q[1:], q[:-1]) / np.diff(t)[:, np.newaxis]).max(axis=0))
    named = [any(part in name.lower() for part in FINGERS) for name in motion.tracks]
    moving = (range_ > STILL) & ~np.array(named)
    compared = np.flatnonzero(moving & (speed <= POP))
    if not compared.size:
        raise ValueError("no joint moves")
    pops = [motion.tracks[k] for k in np.flatnonzero(moving & (speed > POP)).tolist()]
    return Truth(motion if cutoff is None else filtered(motion, cutoff), compared, pops)


def filtered(motion: Motion, cutoff: float) -> Motion:
    """A motion without what is faster than a frequency (Hz): a zero-phase Butterworth filter of its steps.

    The rotation vectors from frame to frame are filtered and chained again: no chart, no signs.

    Raises
    ------
    ValueError
        A frequency that the frame rate does not hold, too few frames.
    """
    from scipy.signal import butter, sosfiltfilt

    q = motion.quaternions
    rate = (len(q) - 1) / float(motion.times[-1])
    sections = butter(ORDER, cutoff, fs=rate, output="sos")
    steps = quaternion.log(quaternion.mul(quaternion.conj(q[:-1]), q[1:]))
    calm = quaternion.exp(sosfiltfilt(sections, steps, axis=0))
    chained = [q[0]]
    for step in calm:
        chained.append(quaternion.mul(chained[-1], step))
    return motion.moved(motion.stamps, quaternion.normalise(np.array(chained)), motion.positions)


# -- what rebuilds ------------------------------------------------------------------------------


def by_scheme(tracks: Motion, scheme: str, every: int, rates: bool) -> Rebuilt:
    """By a scheme, with its rates if asked for and it has them."""
    curve = tracks.curve(scheme, every)
    q, _ = curve(tracks.times)
    own = curve.orientation
    facts = {"rates": "analytic" if analytic(own) else "numeric", "version": version(scheme)}
    if not rates or not {1, 2} <= set(own.orders):
        return Rebuilt(q, (), facts)
    good = [name not in curve.failures for name in tracks.tracks]
    found = np.full((2, *q.shape[:2], 3), np.nan)
    found[:, :, good] = own(tracks.times, 1), own(tracks.times, 2)
    return Rebuilt(q, tuple(found), facts)


def by_channels(truth: Truth, kind: str, every: int) -> Rebuilt:
    """By a spline through each Euler channel, "linear" or "cubic"."""
    from scipy.interpolate import make_interp_spline

    q, t = truth.tracks.quaternions, truth.tracks.times
    keys = keyframes(len(t), every)
    skeleton, degree = truth.motion.skeleton, {"linear": 1, "cubic": 3}[kind]
    rebuilt = np.empty_like(q)
    for k, joint in enumerate(truth.compared):
        own = "" if skeleton is None else skeleton.orders[joint]
        order = own if len(own) == 3 else UNNAMED
        angles = euler.continuous_angles(q[keys, k], order)
        rebuilt[:, k] = euler.from_angles(make_interp_spline(t[keys], angles, degree)(t), order)
    return Rebuilt(rebuilt)


def rebuild(truth: Truth, name: str, every: int, *, rates: bool = False) -> Rebuilt:
    """The truth's tracks, rebuilt by a scheme or by Euler channels from every n-th frame and the last.

    Raises
    ------
    Exception
        Whatever a scheme raises that it raises on every track.
    """
    if name in EULER:
        return by_channels(truth, EULER[name], every)
    return by_scheme(truth.tracks, name, every, rates)


# -- what is measured ---------------------------------------------------------------------------


def keyframes(frames: int, every: int) -> NDArray[np.intp]:
    """The frames that are kept: every n-th and the last."""
    return np.unique(np.append(np.arange(0, frames, every), frames - 1))


def measured(frames: int, every: int) -> NDArray[np.bool_]:
    """Which frames (n,) are left out and away from the ends.

    Raises
    ------
    ValueError
        Where there are none.
    """
    keys = keyframes(frames, every)
    inside = np.ones(frames, bool)
    inside[keys] = False
    inside[: MARGIN * every] = inside[max(frames - MARGIN * every, 0) :] = False
    if not inside.any():
        raise ValueError(f"{len(keys)} keyframes: none of their segments is away from the ends")
    return inside


def reconstruction(truth: Truth, rebuilt: Rebuilt, every: int) -> Row:
    """Errors of what was rebuilt; failed joints count in ``failed_joints`` alone.

    rms_degrees, worst_degrees, worst_joint: of the joints' rms angles the median and the largest, with its
    joint; largest_degrees: the largest angle of all; end_cm, end_largest_cm: rms and largest distance of end
    effectors, the root's path being the true one; omega, alpha: rms error of angular velocity and
    acceleration over the rms of the truth's; by_joint: the joints' rms angles in degrees, None of those that
    failed.
    """
    inside = measured(len(truth.tracks.times), every)
    angles = np.degrees(quaternion.distance(rebuilt.quaternions, truth.tracks.quaternions))[inside]
    rms = np.sqrt(np.mean(angles**2, axis=0))
    worst = int(np.nanargmax(rms))
    return {
        "frames": int(inside.sum()),
        "joints": rms.size,
        "rms_degrees": float(np.nanmedian(rms)),
        "worst_degrees": float(rms[worst]),
        "worst_joint": truth.tracks.tracks[worst],
        "largest_degrees": float(np.nanmax(angles)),
        **_ends(truth, rebuilt.quaternions, inside),
        **_relative(truth, rebuilt.rates, inside),
        "failed_joints": int(np.isnan(rms).sum()),
        "pops": ", ".join(truth.pops) or None,
        **rebuilt.facts,
        LISTS: [None if np.isnan(value) else float(value) for value in rms],
    }


def _ends(truth: Truth, q: FloatArray, inside: NDArray[np.bool_]) -> Row:
    """Distances of end effectors in cm, where lengths are metres; joints not rebuilt are the truth's."""
    m = truth.motion
    if m.skeleton is None or m.unit != "m":
        return {"end_cm": np.nan, "end_largest_cm": np.nan}
    whole = m.quaternions.copy()
    whole[:, truth.compared] = np.where(np.isnan(q), whole[:, truth.compared], q)
    there, here = m.ends(), m.moved(m.stamps, whole, m.positions).ends()
    apart = [np.linalg.norm(here[name] - there[name], axis=-1)[inside] for name in there]
    return {
        "end_cm": 100 * float(np.sqrt(np.mean(np.square(apart)))),
        "end_largest_cm": 100 * float(np.max(apart)),
    }


def _relative(truth: Truth, rates: tuple[FloatArray, ...], inside: NDArray[np.bool_]) -> Row:
    found: dict[str, Any] = {"omega": np.nan, "alpha": np.nan}
    for name, own, true in zip(found, rates, truth.rates if rates else (), strict=False):
        good = ~np.isnan(own).any(axis=(0, 2))
        error, size = (own - true)[inside][:, good], true[inside][:, good]
        found[name] = float(np.sqrt(np.sum(error**2) / np.sum(size**2)))
    return found
