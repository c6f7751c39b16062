"""What the page's player shows of a recorded motion: the truth, and what schemes make of every n-th frame.

Figures are points in the world that lines join: joints and end sites of a skeleton, the wires of one rigid body.
They are stored at frames of the motion as whole numbers of 16 bits, so that a clip is a small file.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quatspline import catalogue, quaternion
from quatspline.inputs.arrays import BoolArray, FloatArray
from quatspline.motion.keeping import left_out, moving
from quatspline.motion.motion import Motion
from quatspline.motion.skeleton import ROOT
from quatspline.solving import ConvergenceError
from quatspline.system.packing import packed

BUDGET = 31 * 500
"""Points times frames that are stored at most: 93 kB a figure."""

SMOOTH = 45.0
"""Frames a second that are enough to the eye ..."""
BETWEEN = 8
"""... and from keyframe to keyframe for an error to show its course."""

PLACES, ANGLES = 32767, 65535
"""The largest whole numbers that hold a place and an angle."""

WIRES: FloatArray = np.array(
    [(0, 0, 0), (-4, -3, 6), (4, -3, 6), (4, 3, 6), (-4, 3, 6), (0, -5, 6)]
) / np.sqrt(61.0)
"""A rigid body as cameras are drawn: z ahead from the apex, y down, a mark above; no longer than 1."""
WIRED = [(0, 1), (0, 2), (0, 3), (0, 4), (1, 2), (2, 3), (3, 4), (4, 1), (1, 5), (5, 2)]
WIRE_SCALE = 0.12
"""The body's length as a share of the extent of its path."""
APART = 2.5
"""Lengths of a body between bodies that stand side by side."""


PARTS = (
    *("title", "source", "refused", "pair"),
    *("every", "frames", "start", "times", "keyframes", "unit", "upright"),
    *("lines", "joints", "bases", "tips", "origin", "step", "truth", "schemes"),
)
"""What a motion for the player holds."""


class Wires(NamedTuple):
    """Points in the world (n, P, 3); pairs of them that lines join; for each track the point that it moves."""

    points: FloatArray
    lines: list[tuple[int, int]]
    tips: list[int]


def replay(
    motion: Motion,
    schemes: Sequence[str],
    every: int,
    *,
    title: str,
    source: str = "",
    joints: Sequence[int] | None = None,
) -> dict[str, Any]:
    """A motion and its rebuildings as JSON for the player.

    Skeletons are rebuilt on the true path of the root, so that they show errors of orientations alone.

    Parameters
    ----------
    motion : the truth
    schemes : names, the two that are shown at first leading; what one refuses, or fails on for a joint, is told
        instead
    every : keyframes are every n-th frame and the last, as in `Motion.curve`
    title, source : what a reader calls it, and where it comes from
    joints : whose errors are shown, by default of all that turn

    Raises
    ------
    ValueError
        Where no frame is left out, or no scheme rebuilds the motion.
    """
    picked = moving(motion) if joints is None else list(joints)
    shown = _shown(motion, every)
    rebuilt, refused = _rebuilt(motion, shown, schemes, every)
    if not rebuilt:
        raise ValueError(f"no scheme rebuilds it: {'; '.join(map(': '.join, refused.items()))}")
    told = {"title": title, "source": source, "refused": refused, "pair": list(rebuilt)[:2]}
    facts = _facts(motion, shown, every)
    return told | facts | _figures(motion, motion.frames(shown), rebuilt, picked)


def _facts(motion: Motion, shown: NDArray[np.intp], every: int) -> dict[str, Any]:
    """Which frames are shown, and when."""
    keys = ~left_out(motion, every)
    return {
        "every": every,
        "frames": [int(shown[0]), int(shown[-1]), len(keys)],
        "start": float(motion.times[shown[0]]),
        "times": packed(motion.times[shown] - motion.times[shown[0]]),
        "keyframes": np.flatnonzero(keys[shown]).tolist(),
        "unit": motion.unit,
        "upright": motion.skeleton is not None,
    }


def _figures(
    motion: Motion, true: Motion, rebuilt: Mapping[str, Motion], joints: list[int]
) -> dict[str, Any]:
    """Points of all figures, and the angles by which joints of the rebuilt ones are off."""
    size, q = body_size(motion), quaternion.normalise(true.quaternions)
    truth = wires(true, size)
    places = {name: wires(other, size).points for name, other in rebuilt.items()}
    angles = {name: quaternion.distance(o.quaternions, q)[:, joints] for name, o in rebuilt.items()}
    lattice = _Lattice.around([truth.points, *places.values()])
    return {
        "lines": truth.lines,
        "joints": [motion.tracks[k] for k in joints],
        "bases": list(joints),
        "tips": [truth.tips[k] for k in joints],
        "origin": lattice.origin.tolist(),
        "step": lattice.step,
        "truth": lattice.packed(truth.points),
        "schemes": {
            name: {
                "title": catalogue.scheme(name).title,
                "places": lattice.packed(places[name]),
                **_angles(angles[name]),
            }
            for name in rebuilt
        },
    }


class _Lattice(NamedTuple):
    """Places as whole steps from an origin."""

    origin: FloatArray
    step: float

    @classmethod
    def around(cls, figures: list[FloatArray]) -> _Lattice:
        """The finest that holds points (n, P, 3) of all figures."""
        ends = np.array([[f.min(axis=(0, 1)), f.max(axis=(0, 1))] for f in figures])
        low, high = ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)
        return cls((low + high) / 2, float((high - low).max()) / (2 * PLACES) or 1.0)

    def packed(self, points: FloatArray) -> str:
        return packed(np.rint((points - self.origin) / self.step), "<i2")


def _angles(angles: FloatArray) -> dict[str, Any]:
    """Angles (n, J) as multiples of a step, which is in degrees."""
    step = float(np.degrees(angles.max())) / ANGLES or 1.0
    return {"angles": packed(np.rint(np.degrees(angles) / step), "<u2"), "angle_step": step}


def _shown(motion: Motion, every: int) -> NDArray[np.intp]:
    """The frames that are stored: of a long motion those in its middle, of a dense one some."""
    count = len(motion.quaternions)
    stride = _stride(motion, every)
    size = len(motion.tracks) + (0 if motion.skeleton is None else len(motion.skeleton.ends))
    points = len(WIRES) if motion.skeleton is None else size
    most = max(2, BUDGET // points)
    first = max(0, (count - most * stride) // 2) // every * every
    frames = np.arange(first, count, stride)
    return frames[~_alone(motion)[frames]][:most]


def _alone(motion: Motion) -> BoolArray:
    """Which frames (n,) are pieces of their own, through which there is no curve."""
    edges = np.array(motion.edges)
    alone = np.zeros(len(motion.quaternions), bool)
    alone[edges[:-1][np.diff(edges) == 1]] = True
    return alone


def _stride(motion: Motion, every: int) -> int:
    """The largest part of ``every`` that leaves enough frames; 1 where pieces begin anywhere."""
    rate = 1.0 / float(np.median(np.diff(motion.times)))
    most = min(rate / SMOOTH, every / BETWEEN) if len(motion.edges) == 2 else 1
    return max(k for k in range(1, every + 1) if every % k == 0 and k <= max(most, 1))


def _rebuilt(
    motion: Motion, shown: NDArray[np.intp], schemes: Sequence[str], every: int
) -> tuple[dict[str, Motion], dict[str, str]]:
    """The stored frames as schemes rebuild them, and why others do not."""
    true, rebuilt, refused = motion.frames(shown), {}, {}
    for name in schemes:
        try:
            curve = motion.curve(name, every)
        except (ConvergenceError, ValueError) as error:
            refused[name] = str(error)
            continue
        if curve.failures:
            refused[name] = ": ".join(next(iter(curve.failures.items())))
            continue
        q, x = curve(motion.times[shown])
        rebuilt[name] = true.moved(true.stamps, q, x if motion.skeleton is None else true.positions)
    return rebuilt, refused


# -- figures ------------------------------------------------------------------------------------


def body_size(motion: Motion) -> float:
    """How long the wires of one rigid body are, by the extent of its path."""
    extent = 0.0 if motion.positions is None else float(np.ptp(motion.positions, axis=0).max())
    return WIRE_SCALE * extent or 1.0


def wires(motion: Motion, size: float = 1.0) -> Wires:
    """A motion as points that lines join: a skeleton's joints and end sites, or the wires of a body per track.

    The point that a joint moves is its end site, or else the first joint on it that is not at its place.
    """
    turns, places = motion.world()
    if motion.skeleton is None:
        return _bodies(turns, places, size, stays=motion.positions is None)
    parents, ends = motion.skeleton.parents.tolist(), motion.skeleton.ends
    lines = [(parent, joint) for joint, parent in enumerate(parents) if parent != ROOT]
    tips = list(range(len(parents)))
    for parent, joint in reversed(lines):
        if motion.skeleton.offsets[joint].any():
            tips[parent] = joint
    points = [places]
    for site, (joint, end) in enumerate(ends.items(), start=len(parents)):
        tips[joint] = site
        lines.append((joint, site))
        points.append((places[:, joint] + quaternion.rotate(turns[:, joint], end))[:, np.newaxis])
    return Wires(np.concatenate(points, axis=1), lines, tips)


def _bodies(turns: FloatArray, places: FloatArray, size: float, stays: bool) -> Wires:
    """The wires of a body per track; those that stay at one place stand side by side."""
    tracks, count = turns.shape[1], len(WIRES)
    if stays:
        places = places + np.arange(tracks)[:, np.newaxis] * [APART * size, 0.0, 0.0]
    arms = quaternion.rotate(turns[:, :, np.newaxis], size * WIRES)
    points = (places[:, :, np.newaxis] + arms).reshape(len(turns), -1, 3)
    firsts = range(0, tracks * count, count)
    tip = count - 1 if stays else 0  # what stays tells nothing
    lines = [(first + a, first + b) for first in firsts for a, b in WIRED]
    return Wires(points, lines, [first + tip for first in firsts])
