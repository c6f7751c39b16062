"""Recorded clips to measure on: the files of a folder, or the figure that the project makes walk.

The folder is named by the environment variable ``QUATSPLINE_MOTIONS``.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from quatspline import quaternion
from quatspline.motion import Motion, MotionFileWarning, read_motion
from quatspline.options import nearest
from quatspline.trajectories.figure_walk import RATE, SEED, figure_walk
from quatspline.trajectories.smooth import SPAN, tumble

FOLDER = "QUATSPLINE_MOTIONS"

OWN = "figure-walk"
"""The clip of the project's own."""

SUFFIXES = (".amc", ".bvh", ".csv", ".glb", ".gltf", ".npz", ".tum", ".txt")
"""Files of a folder that are clips."""

ADDED = "skip=1"
"""In the reader's warning of a pose that a converter added before the motion."""


def names() -> list[str]:
    """The clips: files of the folder, or the project's own where none is named.

    Raises
    ------
    ValueError
        A folder that is not there, or holds no clip.
    """
    return sorted(files()) or [OWN]


def each_kind() -> list[str]:
    """The first clip of a skeleton and the first of one body, as far as there are such."""
    found: dict[bool, str] = {}
    for name in names():
        found.setdefault(clip(name).skeleton is not None, name)
        if len(found) == 2:
            break
    return [found[kind] for kind in (True, False) if kind in found]


def files() -> dict[str, Path]:
    """The files of the folder by name; none where no folder is named."""
    found = {path.name: path for path in contents() if path.suffix.lower() in SUFFIXES}
    if not found and (named := os.environ.get(FOLDER)):
        raise ValueError(f"{FOLDER}={named}: no folder with motion files")
    return found


def contents() -> list[Path]:
    """All files of the folder, clips or what clips need; none where no folder is named or there."""
    named = os.environ.get(FOLDER)
    folder = Path(named) if named else None
    return sorted(folder.iterdir()) if folder is not None and folder.is_dir() else []


def clip(name: str) -> Motion:
    """A clip or a control by name; of a file, without a pose that was added before the motion.

    Raises
    ------
    ValueError
        No such clip, or a file that cannot be read.
    """
    made = {OWN: figure_walk, **CONTROLS}
    if name in made:
        return made[name]()
    known = files()
    if name not in known:
        raise ValueError(f"clip {name!r}: {nearest(name, [*known, *made])}")
    return _read(known[name])


def middle(motion: Motion, frames: int) -> Motion:
    """So many frames from the middle of a motion, or all of a shorter one."""
    first = max(0, (len(motion.times) - frames) // 2)
    return motion.frames(slice(first, first + frames))


@cache
def _read(path: Path) -> Motion:
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", MotionFileWarning)
        motion = read_motion(path)
    return motion.frames(slice(1, None)) if any(ADDED in str(w.message) for w in told) else motion


def tumbling() -> Motion:
    """The analytic motion that accuracy is measured on, at the rate of recordings: nothing is noise."""
    t = np.arange(SPAN * RATE + 1) / RATE
    return Motion(t, tumble(t))


def white_noise(tracks: int = 20, frames: int = 600) -> Motion:
    """Tracks at rest with white noise alone: nothing is motion."""
    rng = np.random.default_rng(SEED)
    turns = np.radians(DEGREES) * rng.normal(size=(frames, tracks, 3))
    names = [f"track {k}" for k in range(tracks)]
    return Motion(np.arange(frames) / RATE, quaternion.exp(turns / 2), tracks=names)


DEGREES = 1.0
"""Standard deviation of white noise about each axis: small enough that schemes are linear in it."""

CONTROLS: dict[str, Callable[[], Motion]] = {"tumble": tumbling, "white noise": white_noise}
"""Clips on which it is known what schemes do: motion without noise, noise without motion."""
