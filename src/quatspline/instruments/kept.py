"""What a scheme makes of every n-th frame of a motion: errors at the frames left out, and excursions of joints."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.inputs.arrays import BoolArray, FloatArray
from quatspline.instruments.extent import excursions
from quatspline.instruments.own_keyframes import reaches
from quatspline.instruments.trials import Row
from quatspline.motion.keeping import left_out, moving
from quatspline.motion.motion import Motion
from quatspline.motion.motion_curve import MotionCurve


def row(
    motion: Motion, scheme: str, every: int, options: Mapping[str, Any], *, arcs: bool = True
) -> Row:
    """Measurements of one scheme over the joints that turn: medians and the worst, by name; all under "by_joint".

    Parameters
    ----------
    motion, every : which keeps every so many frames
    options : of the scheme
    arcs : whether excursions are measured, for which every segment is sampled; else they are NaN
    """
    began = time.perf_counter()
    curve = motion.curve(scheme, every=every, **options)
    seconds = time.perf_counter() - began
    angles, ends = _errors(motion, curve, left_out(motion, every))
    joints = [k for k in moving(motion) if motion.tracks[k] not in curve.failures]
    rms = np.sqrt((angles[:, joints] ** 2).mean(axis=0))
    largest = angles[:, joints].max(axis=0)
    off = _excursions(curve)[joints] if arcs else np.full(len(joints), np.nan)
    return {
        **_over_joints([motion.tracks[k] for k in joints], rms, largest, off),
        **reaches(curve.pieces[0].orientation),
        "end_rms": None if ends is None else float(np.sqrt((ends**2).mean())),
        "seconds": seconds,
        "failed_joints": "; ".join(f"{name}: {why}" for name, why in curve.failures.items())
        or None,
    }


def _over_joints(
    names: Sequence[str], rms: FloatArray, largest: FloatArray, off: FloatArray
) -> Row:
    worst, farthest = int(rms.argmax()), int(largest.argmax())
    columns = (names, rms.tolist(), largest.tolist(), off.tolist())
    return {
        "joints": len(names),
        "rms_median": float(np.median(rms)),
        "rms_worst": float(rms[worst]),
        "worst_joint": names[worst],
        "largest": float(largest[farthest]),
        "largest_joint": names[farthest],
        "excursion": float(off.max()),
        "by_joint": [
            {"joint": name, "rms": a, "largest": b, "excursion": c}
            for name, a, b, c in zip(*columns, strict=True)
        ],
    }


def _excursions(curve: MotionCurve) -> FloatArray:
    """The largest excursion of every track (J,) in degrees, over all pieces; NaN of those without a curve."""
    off = np.full((len(curve.pieces), len(curve.motion.tracks)), np.nan)
    for row, piece in zip(off, curve.pieces, strict=True):
        row[piece.good] = excursions(piece.orientation)
    return np.asarray(off.max(axis=0), dtype=float)


def _errors(
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
