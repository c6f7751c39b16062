"""What a scheme makes of every so many-th frame of a motion, measured at the frames left out."""

from __future__ import annotations

import time
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.inputs.arrays import BoolArray, FloatArray
from quatspline.motion.motion import Motion
from quatspline.motion.motion_curve import MotionCurve

MOVES = np.radians(1.0)
"""A joint that turns less than this from its first pose says nothing of a scheme."""


def left_out(motion: Motion, every: int) -> BoolArray:
    """Which frames (n,) are no keyframes of `Motion.curve` with this ``every``.

    Raises
    ------
    ValueError
        Where none is left out.
    """
    out = np.ones(len(motion.quaternions), dtype=bool)
    for a, b in pairwise(motion.edges):
        out[a:b:every] = out[b - 1] = False
    if not out.any():
        raise ValueError(f"--keep {every}: leaves out none of {len(out)} frames")
    return out


def moving(motion: Motion) -> list[int]:
    """Joints that turn; all where none does."""
    q = quaternion.normalise(motion.quaternions)
    ranges = quaternion.distance(q, q[:1]).max(axis=0)
    return np.flatnonzero(ranges > MOVES).tolist() or list(range(len(motion.tracks)))


def errors(
    motion: Motion, curve: MotionCurve, out: BoolArray
) -> tuple[FloatArray, FloatArray | None]:
    """Angles (m, J) in rad at frames left out, and errors (m, ends) of end effectors in the motion's unit."""
    q, _ = curve(motion.times[out])
    angles = quaternion.distance(q, quaternion.normalise(motion.quaternions[out]))
    if motion.skeleton is None or curve.failures:
        return angles, None
    source = motion.frames(np.flatnonzero(out))
    rebuilt = source.moved(source.stamps, q, source.positions)  # on the true path of the root
    ends, found = source.ends(), rebuilt.ends()
    off = [np.linalg.norm(found[name] - place, axis=-1) for name, place in ends.items()]
    return angles, np.stack(off, axis=1)


def row(motion: Motion, scheme: str, every: int, options: Mapping[str, Any]) -> dict[str, Any]:
    """Errors of one scheme over the joints that turn: medians and the worst, by name; all under "by_joint"."""
    began = time.perf_counter()
    curve = motion.curve(scheme, every=every, **options)
    seconds = time.perf_counter() - began
    angles, ends = errors(motion, curve, left_out(motion, every))
    joints = [k for k in moving(motion) if motion.tracks[k] not in curve.failures]
    rms = np.sqrt((angles[:, joints] ** 2).mean(axis=0))
    largest = angles[:, joints].max(axis=0)
    worst, farthest = int(rms.argmax()), int(largest.argmax())
    return {
        "joints": len(joints),
        "rms_median": float(np.median(rms)),
        "rms_worst": float(rms[worst]),
        "worst_joint": motion.tracks[joints[worst]],
        "largest": float(largest[farthest]),
        "largest_joint": motion.tracks[joints[farthest]],
        "end_rms": None if ends is None else float(np.sqrt((ends**2).mean())),
        "seconds": seconds,
        "by_joint": [
            {"joint": motion.tracks[k], "rms": a, "largest": b}
            for k, a, b in zip(joints, rms.tolist(), largest.tolist(), strict=True)
        ],
        "failed_joints": "; ".join(f"{name}: {why}" for name, why in curve.failures.items())
        or None,
    }
