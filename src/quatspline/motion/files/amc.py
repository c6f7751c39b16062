"""Acclaim's AMC: values of the bones of an ASF, frame by frame.  It is read, not written.

A bone's values turn it about fixed axes of its own frame C: L = C M C^-1.  A bone of two degrees of
freedom turns about two axes only, which interpolated orientations leave: so no AMC is written.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PureWindowsPath

import numpy as np

from quatspline import quaternion
from quatspline.motion.errors import MotionFileError, warn
from quatspline.motion.files.asf import ROOT_NAME, Bones, fixed_turns, read_asf
from quatspline.motion.files.opening import is_whole, lines_of
from quatspline.motion.files.reading import Reading
from quatspline.motion.files.scripts import Line, matrix, refusal
from quatspline.motion.motion import Motion

RATE = 120.0
"""Frames a second of CMU's clips: an AMC does not say."""


def read_amc(path: Path, reading: Reading) -> Motion:
    """Read an AMC with its ASF: positions in metres, by CMU's factor unless ``units="spec"``."""
    lines = lines_of(path)
    bones = read_asf(_skeleton_of(path, lines, reading))
    degrees, frames = _frames(path, lines, bones)
    scale = bones.metres(reading.units or "cmu")
    count = len(frames[ROOT_NAME])
    skeleton, names = bones.skeleton(scale), bones.names
    q, x = np.empty((count, len(names), 4)), np.tile(skeleton.offsets, (count, 1, 1))
    for joint, name in enumerate(names):
        bone, frame = bones.bones[name], bones.frame(name)
        values = matrix(path, frames[name]) if bone.dof else np.empty((count, 0))
        turning = [k for k, dof in enumerate(bone.dof) if dof[0] == "r"]
        angles = np.radians(values[:, turning]) if degrees else values[:, turning]
        turn = fixed_turns(angles, bone.order)
        q[:, joint] = quaternion.mul(quaternion.mul(frame, turn), quaternion.conj(frame))
        for k, dof in enumerate(bone.dof):
            if dof[0] == "t":
                x[:, joint, "xyz".index(dof[1])] += scale * values[:, k]
    if skeleton.offsets[0].any():
        warn(path, "the root of its skeleton has a position, which is added to the root's path")
    times = reading.frame_times(path, count, RATE)
    return Motion(times, q, x, names, skeleton, "m")


def _skeleton_of(path: Path, lines: Sequence[str], reading: Reading) -> Path:
    """The ASF: as given; the one that the first comment names; by the name of the AMC."""
    if reading.skeleton is not None:
        return Path(reading.skeleton)
    comment = next((line for line in lines if line.strip()), "")
    named = comment.split()[-1:] if comment.startswith("#") else []
    names = [PureWindowsPath(name).name for name in named if name.lower().endswith(".asf")]
    stems = dict.fromkeys([path.stem, path.stem.rpartition("_")[0]])
    names += [f"{stem}{end}" for stem in stems if stem for end in (".asf", ".ASF")]
    beside = [path.with_name(name) for name in names]
    for candidate in beside:
        if candidate.is_file():
            return candidate
    looked = ", ".join(dict.fromkeys(name for name in names if not name.endswith(".ASF")))
    given = reading.named("skeleton")
    what = f"no skeleton beside it (looked for {looked}): give {given}"
    raise MotionFileError(f"{path}: {what}")


def _frames(path: Path, lines: Sequence[str], bones: Bones) -> tuple[bool, dict[str, list[Line]]]:
    """Whether values are degrees, and each bone's rows of values, one per frame."""
    degrees, number, last, first = bones.degrees, 0, 0, 1
    moving = {name: len(bone.dof) for name, bone in bones.bones.items() if bone.dof}
    moving.setdefault(ROOT_NAME, 0)
    found: dict[str, list[Line]] = {name: [] for name in moving}
    for number, line in enumerate(lines, 1):
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if words[0].startswith(":"):
            degrees = {":DEGREES": True, ":RADIANS": False}.get(words[0].upper(), degrees)
        elif len(words) == 1 and is_whole(words[0]):
            _check_frame(path, number, found, last)
            shown = int(words[0][:18])
            first = first if last else shown
            if shown != first + last:
                raise refusal(path, number, f"frame {shown} follows frame {first + last - 1}")
            last += 1
        else:
            _take(path, number, words, moving, found, last)
    _check_frame(path, number, found, last)
    if not last:
        raise MotionFileError(f"{path}: no frames in it")
    return degrees, found


def _take(
    path: Path,
    number: int,
    words: list[str],
    moving: dict[str, int],
    found: dict[str, list[Line]],
    frame: int,
) -> None:
    """The values of one bone."""
    name = words[0]
    if name not in moving:
        raise refusal(path, number, f"no bone that moves is called {name!r}")
    if len(words) - 1 != moving[name]:
        what = f"{name}: {moving[name]} values expected, found {len(words) - 1}"
        raise refusal(path, number, what)
    rows = found[name]
    if len(rows) != frame - 1:
        place = "stands before the first frame" if not frame else f"comes twice in frame {frame}"
        raise refusal(path, number, f"{name} {place}")
    rows.append((number, words[1:]))


def _check_frame(path: Path, number: int, found: dict[str, list[Line]], frame: int) -> None:
    """Refuse a frame that lacks a bone, where the next begins or the file ends."""
    for name, rows in found.items():
        if len(rows) < frame:
            raise refusal(path, number, f"frame {frame} has no values of {name!r}")
