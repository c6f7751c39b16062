"""Denoising: dense motion, rebuilt from every n-th of its frames, to which white noise was added.

What is held out are the frames left out, without noise: they judge every curve, whether through its keyframes or
near them, and no parameter is chosen by them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.catalogue import version
from quatspline.fitting.noise_level import noise_level
from quatspline.instruments.reconstruction import keyframes, measured
from quatspline.instruments.summary import LISTS
from quatspline.instruments.trials import Row
from quatspline.motion import Motion
from quatspline.quaternion import FloatArray

KNOWN = "noise"
"""The option of schemes that can be told the noise."""


def disturbed(motion: Motion, degrees: float, rng: np.random.Generator) -> Motion:
    """A motion with rotation errors of a standard deviation about every axis of each track."""
    errors = np.radians(degrees) * rng.normal(size=(*motion.quaternions.shape[:2], 3))
    q = quaternion.mul(motion.quaternions, quaternion.exp(0.5 * errors))
    return Motion(motion.stamps, q, None, motion.tracks, per_second=motion.per_second)


def denoising(
    true: Motion,
    noisy: Motion,
    scheme: str,
    every: int,
    omega: FloatArray | None = None,
    **options: Any,
) -> Row:
    """Errors of a scheme through or near every n-th noisy frame; failed joints count in ``failed_joints`` alone.

    rms_degrees, worst_degrees: of the joints' rms angles to the truth at the frames left out the median and the
    largest; keyframes_degrees: the median of their rms angles at the keyframes themselves; told_degrees: what
    `noise_level` says of the keyframes, median; omega: rms error in degrees per second, where the true velocities
    (n, 3) are given; by_joint: the joints' rms angles, None of those that failed.
    """
    t, inside = true.times, measured(len(true.times), every)
    kept = np.zeros(len(t), bool)
    kept[keyframes(len(t), every)] = True
    curve = noisy.curve(scheme, every, **options)
    angles = np.degrees(quaternion.distance(curve(t)[0], true.quaternions))
    rms = _rms(angles[inside])
    own = curve.orientation
    row = {
        "keyframes": int(kept.sum()),
        "joints": rms.size,
        "rms_degrees": float(np.nanmedian(rms)),
        "worst_degrees": float(np.nanmax(rms)),
        "keyframes_degrees": float(np.nanmedian(_rms(angles[kept]))),
        "told_degrees": float(np.degrees(np.median(noise_level(own.keyframes)))),
        "failed_joints": int(np.isnan(rms).sum()),
        "version": version(scheme),
        LISTS: [None if np.isnan(value) else float(value) for value in rms],
    }
    if omega is not None:
        off = np.linalg.norm(own(t[inside], 1) - omega[inside, np.newaxis], axis=-1)
        row["omega"] = float(np.degrees(np.sqrt(np.mean(off**2))))
    return row


def _rms(angles: FloatArray) -> FloatArray:
    """Of every joint."""
    return np.sqrt(np.mean(angles**2, axis=0))
