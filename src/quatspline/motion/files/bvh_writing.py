"""Motions written as BVH: Euler channels in the order of the file they came from, without leaps."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from quatspline.motion import euler
from quatspline.motion.motion import Motion
from quatspline.motion.skeleton import ROOT, Skeleton
from quatspline.quaternion import FloatArray

DEFAULT = "ZXY"
"""The order of joints whose file has none: that of most files."""

STILL = 1e-9
"""An angle (rad) or a share of the largest offset that is nothing but rounding."""

UNEVEN = 1e-6
"""Steps of frames equal to this share of their mean are of one rate."""


def write_bvh(path: Path, motion: Motion) -> None:
    """Write a motion with six decimals, its frame time with ten digits.

    A joint keeps the order of its channels; one that turns about more axes than its file had gets
    three.  Roots, and joints that leave their offsets, get channels of positions.
    """
    period = _period(motion)
    columns, channels = [], {}
    skeleton = _skeleton(motion)
    for joint in skeleton.outward:
        named, values = _channels(motion, skeleton, joint)
        channels[joint] = named
        columns.append(values)
    table = np.concatenate(columns, axis=1)
    with path.open("w", encoding="utf-8", newline="\n") as stream:
        stream.writelines(f"{line}\n" for line in _hierarchy(motion, skeleton, channels))
        stream.write(f"MOTION\nFrames: {len(table)}\nFrame Time: {period:.10g}\n")
        form = " ".join(["%.6f"] * table.shape[1]) + "\n"
        stream.writelines(form % tuple(row) for row in table.tolist())


def _skeleton(motion: Motion) -> Skeleton:
    """The skeleton; a body is one joint at the origin."""
    if motion.skeleton is None:
        if len(motion.tracks) > 1:
            raise ValueError("BVH needs a skeleton: which track hangs on which is not known")
        return Skeleton(np.array([ROOT]), np.zeros((1, 3)), ("",))
    if motion.skeleton.mounts is not None:
        raise ValueError(
            "BVH cannot hold turns that are fixed between joints, as this glTF has them: write .glb"
        )
    return motion.skeleton


def _period(motion: Motion) -> float:
    """The time between frames, which must be one."""
    steps = np.diff(motion.times)
    if motion.closed or not len(steps):
        raise ValueError("BVH holds the frames of one rate: at least two, of an open motion")
    mean = float(motion.times[-1]) / len(steps)
    off = np.abs(steps - mean)
    if off.max() > UNEVEN * mean + 4 * float(np.spacing(np.abs(motion.stamps).max())):
        raise ValueError(
            f"BVH has one rate, but frame {int(off.argmax()) + 1} comes {steps[off.argmax()]:.6g} s after "
            f"the one before it, {mean:.6g} s on average: resample it first"
        )
    return mean


def _channels(motion: Motion, skeleton: Skeleton, joint: int) -> tuple[list[str], FloatArray]:
    """Names and values (n, k) of the channels of a joint, positions first."""
    names, values = [], np.empty((len(motion.quaternions), 0))
    offset = skeleton.offsets[joint]
    x = (
        np.broadcast_to(offset, (len(values), 3))
        if motion.positions is None
        else motion.positions[:, joint]
    )
    scale = max(float(np.abs(skeleton.offsets).max()), float(np.abs(x).max()))
    if skeleton.parents[joint] == ROOT or np.abs(x - offset).max() > STILL * scale:
        names = [f"{axis}position" for axis in euler.AXES]
        values = x
    order, angles = _turns(motion.quaternions[:, joint], skeleton.orders[joint])
    return [*names, *(f"{axis}rotation" for axis in order)], np.hstack([values, np.degrees(angles)])


def _turns(q: FloatArray, order: str) -> tuple[str, FloatArray]:
    """The order of a joint's channels, and its angles (n, k): as few axes as its file has, if they do."""
    whole = _completed(order)
    angles = euler.continuous_angles(q, whole)
    for branch in (angles, euler.mirrored(angles)):
        idle = np.abs(euler.wrapped(branch[:, len(order) :]))
        if (idle <= STILL).all():
            return order, branch[:, : len(order)]
    return whole, angles


def _completed(order: str) -> str:
    """An order of three axes that begins as given."""
    if not order:
        return DEFAULT
    return order + "".join(axis for axis in euler.AXES if axis not in order)


def _hierarchy(motion: Motion, skeleton: Skeleton, channels: dict[int, list[str]]) -> Iterator[str]:
    """The lines of the hierarchy."""
    yield "HIERARCHY"
    depth: list[int] = []
    for joint in skeleton.outward:
        parent = int(skeleton.parents[joint])
        while depth and depth[-1] != parent:
            yield from _closed(skeleton, depth)
        tabs = "\t" * len(depth)
        word = "JOINT" if depth else "ROOT"
        yield f"{tabs}{word} {_named(motion.tracks[joint])}"
        yield f"{tabs}{{"
        yield f"{tabs}\tOFFSET {_decimals(skeleton.offsets[joint])}"
        yield " ".join([f"{tabs}\tCHANNELS", str(len(channels[joint])), *channels[joint]])
        depth.append(joint)
    while depth:
        yield from _closed(skeleton, depth)


def _closed(skeleton: Skeleton, depth: list[int]) -> Iterator[str]:
    joint = depth.pop()
    tabs = "\t" * len(depth)
    if joint in skeleton.ends:
        yield f"{tabs}\tEnd Site"
        yield f"{tabs}\t{{"
        yield f"{tabs}\t\tOFFSET {_decimals(skeleton.ends[joint])}"
        yield f"{tabs}\t}}"
    yield f"{tabs}}}"


def _named(name: str) -> str:
    """A name in one line."""
    plain = " ".join(name.split())
    if not plain or "{" in plain or "}" in plain:
        raise ValueError(f"BVH cannot hold a joint called {name!r}")
    return plain


def _decimals(vector: FloatArray) -> str:
    return " ".join(f"{value:.6f}" for value in vector)
