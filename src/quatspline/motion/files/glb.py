"""Motions written as GLB: one node for each track, rotations and translations LINEAR at its frames."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from quatspline.motion.files.buffers import BINARY, JSON, MAGIC
from quatspline.motion.files.nodes import END, IDENTITY
from quatspline.motion.motion import Motion
from quatspline.motion.skeleton import ROOT
from quatspline.quaternion import FloatArray, align, normalise

FLOAT = 5126


def write_glb(path: Path, motion: Motion) -> None:
    """Write a motion as a binary glTF 2.0: numbers are float32, times count from the start."""
    if motion.closed:
        raise ValueError("GLB holds an open motion: --closed has no place in it")
    packed = _Packed()
    nodes, index = _nodes(motion)
    samplers, channels = _animation(packed, motion, index)
    if motion.skeleton is None:
        roots = list(index)
    else:
        hung = {child for node in nodes for child in node.get("children", [])}
        roots = [i for i in range(len(nodes)) if i not in hung]
    document = {
        "asset": {"version": "2.0", "generator": "quatspline"},
        "scene": 0,
        "scenes": [{"nodes": roots}],
        "nodes": nodes,
        "animations": [{"name": "motion", "samplers": samplers, "channels": channels}],
        "accessors": packed.accessors,
        "bufferViews": packed.views,
        "buffers": [{"byteLength": len(packed.data)}],
    }
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    chunks = _chunk(JSON, text, b" ") + _chunk(BINARY, bytes(packed.data), b"\0")
    path.write_bytes(struct.pack("<4sII", MAGIC, 2, 12 + len(chunks)) + chunks)


class _Packed:
    """Numbers in one buffer, and what says where they are."""

    def __init__(self) -> None:
        self.data, self.views, self.accessors = bytearray(), [], []  # type: ignore[var-annotated]

    def add(self, values: FloatArray, kind: str, bounds: bool = False) -> int:
        """Append numbers (n, width); the index of their accessor."""
        small = np.ascontiguousarray(values, dtype="<f4")
        if not np.isfinite(small).all():
            raise ValueError("a number is too large for float32, which GLB has")
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": small.nbytes}
        accessor = {
            "bufferView": len(self.views),
            "componentType": FLOAT,
            "count": len(small),
            "type": kind,
        }
        if bounds:
            accessor |= {"min": [float(small.min())], "max": [float(small.max())]}
        self.data += small.tobytes()
        self.views.append(view)
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def _nodes(motion: Motion) -> tuple[list[dict[str, Any]], list[int]]:
    """Nodes, and the index of the node of each track."""
    skeleton = motion.skeleton
    nodes: list[dict[str, Any]] = [{"name": name} for name in motion.tracks]
    index = list(range(len(nodes)))
    if skeleton is None:
        return nodes, index
    for joint, parent in enumerate(skeleton.parents.tolist()):
        node = nodes[joint]
        if skeleton.offsets[joint].any():
            node["translation"] = skeleton.offsets[joint].tolist()
        hanging = _mounted(motion, joint, nodes)
        if parent != ROOT:
            nodes[parent].setdefault("children", []).append(hanging)
    for joint, place in skeleton.ends.items():
        nodes[joint].setdefault("children", []).append(len(nodes))
        name = f"{motion.tracks[joint]} end"
        extras = {"quatspline": END}
        nodes.append({"name": name, "translation": place.tolist(), "extras": extras})
    return nodes, index


def _mounted(motion: Motion, joint: int, nodes: list[dict[str, Any]]) -> int:
    """The node that hangs on the parent: the joint's own, or one that is fixed and bears it."""
    assert motion.skeleton is not None
    mounts = motion.skeleton.mounts
    if mounts is None:
        return joint
    turn, place = mounts.turns[joint], mounts.places[joint]
    if np.array_equal(turn, IDENTITY) and not place.any():
        return joint
    fixed = {
        "name": f"{motion.tracks[joint]} mount",
        "rotation": np.roll(turn, -1).tolist(),
        "translation": place.tolist(),
        "children": [joint],
    }
    nodes.append(fixed)
    return len(nodes) - 1


def _animation(
    packed: _Packed, motion: Motion, index: list[int]
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Samplers and channels: of every rotation, and of translations that leave the offset."""
    times = packed.add(motion.times[:, np.newaxis], "SCALAR", bounds=True)
    if (np.diff(motion.times.astype(np.float32)) <= 0.0).any():
        raise ValueError("frames are too close together for float32, which GLB has")
    q = normalise(align(motion.quaternions))
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []

    def move(node: int, kind: str, values: FloatArray, width: str) -> None:
        output = packed.add(values, width)
        channels.append({"sampler": len(samplers), "target": {"node": node, "path": kind}})
        samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})

    for track, node in enumerate(index):
        move(node, "rotation", np.roll(q[:, track], -1, axis=1), "VEC4")
        if motion.positions is None:
            continue
        x = motion.positions[:, track]
        rest = np.zeros(3) if motion.skeleton is None else motion.skeleton.offsets[track]
        if not np.array_equal(x, np.broadcast_to(rest, x.shape)):
            move(node, "translation", x, "VEC3")
    return samplers, channels


def _chunk(kind: int, data: bytes, fill: bytes) -> bytes:
    data += fill * (-len(data) % 4)
    return struct.pack("<II", len(data), kind) + data
