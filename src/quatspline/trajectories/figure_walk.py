"""A figure that walks: a recording that the project makes itself, for where no recorded clips are at hand.

Channels follow the gait cycle: two harmonics of a phase whose pace and size waver from stride to stride.
Knees, elbows and toes are hinges that reverse.  Upon each channel lies noise whose spectrum falls with a
power of frequency, as that of recorded joints does; its size and power are such that schemes differ about as
little as on recorded walks.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quatspline.motion import Motion, Skeleton, euler
from quatspline.quaternion import FloatArray

SEED = 1873
RATE = 120.0
"""Frames a second, as most optical systems record."""

CADENCE, PACE = 0.9, 1.25
"""Strides and metres a second."""

WAVER = 0.06
"""Standard deviation of a channel's size and of the phase in strides, about once in two strides."""

NOISE, FALL = 1.5, 1.2
"""Standard deviation of a channel's noise (degrees); its amplitudes fall with this power of frequency ..."""
KNEE = 0.5
"""... above this (Hz)."""

Wave = tuple[float, float, float, float, float]
"""Mean, then size and lead in cycles of two harmonics: degrees and shares of a turn."""


class Joint(NamedTuple):
    """A joint of the figure: y is up, z ahead, x to its left; metres."""

    parent: str
    offset: tuple[float, float, float]
    channels: dict[str, Wave]
    end: tuple[float, float, float] | None = None


HIPS = {
    "hips": Joint("", (0.0, 0.95, 0.0), {
        "Y": (0.0, 5.0, 0.10, 1.0, 0.30), "X": (4.0, 1.0, 0.20, 1.5, 0.60),
        "Z": (0.0, 4.0, 0.75, 1.0, 0.10)}),
}  # fmt: skip
LEG = {
    "thigh": Joint("hips", (0.09, -0.04, 0.0), {
        "X": (-8.0, 22.0, 0.00, 4.0, 0.30), "Y": (4.0, 4.0, 0.10, 2.0, 0.40),
        "Z": (2.0, 5.0, 0.60, 2.0, 0.10)}),
    "shin": Joint("thigh", (0.0, -0.42, 0.0), {"X": (25.0, 20.0, 0.70, 15.0, 0.05)}),
    "foot": Joint("shin", (0.0, -0.41, 0.0), {
        "X": (-2.0, 8.0, 0.40, 8.0, 0.75), "Z": (1.0, 3.0, 0.20, 2.0, 0.60)}),
    "toes": Joint("foot", (0.0, -0.06, 0.14), {"X": (-10.0, 9.0, 0.55, 7.0, 0.20)}, (0.0, 0.0, 0.07)),
}  # fmt: skip
SPINE = {
    "spine": Joint("hips", (0.0, 0.12, 0.0), {
        "X": (3.0, 0.5, 0.00, 1.5, 0.15), "Y": (0.0, 4.0, 0.60, 0.5, 0.00),
        "Z": (0.0, 4.0, 0.25, 0.5, 0.50)}),
    "chest": Joint("spine", (0.0, 0.20, 0.0), {
        "X": (2.0, 0.5, 0.30, 1.0, 0.40), "Y": (0.0, 5.0, 0.62, 0.5, 0.20),
        "Z": (0.0, 2.0, 0.30, 0.5, 0.00)}),
    "head": Joint("chest", (0.0, 0.30, 0.0), {
        "X": (-6.0, 1.0, 0.80, 1.5, 0.70), "Y": (0.0, 4.0, 0.10, 0.5, 0.50),
        "Z": (0.0, 1.5, 0.80, 0.5, 0.00)}, (0.0, 0.20, 0.02)),
}  # fmt: skip
ARM = {
    "upper arm": Joint("chest", (0.18, 0.20, 0.0), {
        "X": (6.0, 17.0, 0.50, 2.0, 0.10), "Y": (5.0, 4.0, 0.45, 1.0, 0.00),
        "Z": (8.0, 3.0, 0.20, 2.0, 0.50)}),
    "forearm": Joint("upper arm", (0.0, -0.29, 0.0), {"X": (-28.0, 12.0, 0.55, 3.0, 0.30)}),
    "hand": Joint("forearm", (0.0, -0.25, 0.0), {
        "X": (-4.0, 4.0, 0.30, 2.0, 0.80), "Z": (3.0, 3.0, 0.10, 1.0, 0.60)}, (0.0, -0.18, 0.0)),
}  # fmt: skip
"""Limbs are the left ones; the right ones are their mirror images, half a stride later."""


def figure_walk(frames: int = 600, seed: int = SEED, noise: float = NOISE) -> Motion:
    """The figure walking, the same for the same seed; see the module.

    Parameters
    ----------
    frames : at 120 Hz
    seed : of what wavers, and of the noise
    noise : standard deviation (degrees) of each channel's noise
    """
    rng = np.random.default_rng(seed)
    joints = _joints()
    names = list(joints)
    t = np.arange(frames) / RATE
    cycles = CADENCE * t + WAVER * _wandering(rng, frames, 2.0)
    q = np.empty((frames, len(names), 4))
    for k, (joint, side) in enumerate(joints.values()):
        waves = [_channel(rng, cycles, side, *item) for item in joint.channels.items()]
        angles = np.stack(waves, axis=1) + noise * _noise(rng, frames, len(waves))
        q[:, k] = euler.from_angles(np.radians(angles), "".join(joint.channels))
    skeleton = _skeleton(joints)
    x = np.tile(skeleton.offsets, (frames, 1, 1))
    x[:, 0] += _path(t, cycles)
    return Motion(t, q, x, names, skeleton, "m")


def _joints() -> dict[str, tuple[Joint, int]]:
    """All joints by name, with the side: 1 left, -1 right, 0 neither."""
    joints: dict[str, tuple[Joint, int]] = {}
    for trunk, limb in ((HIPS, LEG), (SPINE, ARM)):
        joints |= {name: (joint, 0) for name, joint in trunk.items()}
        for word, side in (("left", 1), ("right", -1)):
            for name, joint in limb.items():
                parent = joint.parent if joint.parent in trunk else f"{word} {joint.parent}"
                joints[f"{word} {name}"] = joint._replace(parent=parent), side
    return joints


def _skeleton(joints: dict[str, tuple[Joint, int]]) -> Skeleton:
    names = list(joints)
    across = [np.array([side or 1, 1, 1]) for _, side in joints.values()]
    parents = [names.index(j.parent) if j.parent else -1 for j, _ in joints.values()]
    offsets = [flip * j.offset for flip, (j, _) in zip(across, joints.values(), strict=True)]
    ends = {k: np.array(j.end) for k, (j, _) in enumerate(joints.values()) if j.end}
    orders = tuple("".join(j.channels) for j, _ in joints.values())
    return Skeleton(np.array(parents), np.array(offsets), orders, ends)


def _channel(
    rng: np.random.Generator, cycles: FloatArray, side: int, axis: str, wave: Wave
) -> FloatArray:
    """Degrees (n,) of a channel; turns about y and z change their sign from left to right."""
    mean, first, lead, second, other = wave
    phase = cycles + (0.5 if side < 0 else 0.0)
    turns = 2 * np.pi * np.stack([phase + lead, 2 * (phase + other)])
    swing = np.array([first, second]) @ np.sin(turns)
    sizes = 1.0 + WAVER * _wandering(rng, len(cycles), 2.0)
    return (-1.0 if side < 0 and axis != "X" else 1.0) * (mean + sizes * swing)


def _wandering(rng: np.random.Generator, frames: int, seconds: float) -> FloatArray:
    """A smooth random function (n,) of unit size: independent values so far apart, a spline through them."""
    from scipy.interpolate import CubicSpline

    knots = seconds * np.arange(np.ceil(frames / RATE / seconds) + 1)
    spline = CubicSpline(knots, rng.normal(size=len(knots)), bc_type="natural")
    return np.asarray(spline(np.arange(frames) / RATE))


def _noise(rng: np.random.Generator, frames: int, channels: int) -> FloatArray:
    """Noise (n, channels) of unit size whose amplitudes fall with a power of frequency."""
    frequencies = np.fft.rfftfreq(frames, 1.0 / RATE)[:, np.newaxis]
    shape = (1.0 + (frequencies / KNEE) ** 2) ** (-FALL / 2)
    shaped = np.fft.irfft(
        shape * np.fft.rfft(rng.normal(size=(frames, channels)), axis=0), frames, axis=0
    )
    return shaped / np.sqrt(np.mean(shaped**2, axis=0))


def _path(t: FloatArray, cycles: FloatArray) -> FloatArray:
    """Where the hips are (n, 3) besides their height: ahead, up and down twice a stride, side to side."""
    turns = 2 * np.pi * cycles
    return np.stack([0.025 * np.sin(turns), 0.02 * np.cos(2 * turns), PACE * t], axis=1)
