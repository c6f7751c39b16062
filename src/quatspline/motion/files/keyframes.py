"""Keyframes of a reduction written by joint: each track has frames of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quatspline.motion import files
from quatspline.motion.errors import MotionFileError
from quatspline.motion.files.writing import write_track_rows
from quatspline.motion.motion import Motion
from quatspline.system.atomic import replacing

Frames = dict[str, NDArray[np.intp]]

BY_JOINT = (".csv", ".npz")


def check_keyframe_suffix(path: str | Path, motion: Motion) -> None:
    """Refuse formats that hold one set of frames for keyframes of several tracks."""
    suffix = Path(path).suffix.lower()
    if len(motion.tracks) > 1 and suffix not in BY_JOINT:
        what = f"keyframes by joint go into {' or '.join(BY_JOINT)}, the rebuilt motion into .bvh or .glb"
        raise MotionFileError(f"{path}: {what}")


def write_keyframes(path: str | Path, motion: Motion, frames: Frames) -> None:
    """Write the frames that a reduction keeps: a body's as a motion, those of joints below one another.

    NPZ has arrays ``tracks``, and one row for each keyframe: its ``track``, ``frame``, ``time`` and
    ``quaternion``.
    """
    check_keyframe_suffix(path, motion)
    if len(motion.tracks) == 1:
        files.write(path, motion.frames(frames[motion.tracks[0]]))
        return
    path = Path(path)
    try:
        with replacing(path) as aside:
            write = _write_npz if path.suffix.lower() == ".npz" else write_track_rows
            write(aside, motion, frames)
    except OSError as error:
        raise MotionFileError(f"{path}: cannot be written: {error.strerror or error}") from None


def _write_npz(path: Path, motion: Motion, frames: Frames) -> None:
    index = [frames[name] for name in motion.tracks]
    rows = np.concatenate(index)
    track = np.repeat(np.arange(len(index)), [len(i) for i in index])
    arrays: dict[str, Any] = {
        "tracks": np.array(list(motion.tracks)),
        "track": track,
        "frame": rows,
        "time": motion.stamps[rows],
        "quaternion": motion.quaternions[rows, track],
    }
    with path.open("wb") as stream:
        np.savez(stream, **arrays)
