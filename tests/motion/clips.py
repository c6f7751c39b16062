"""Small motions and files of every format, written for these tests."""

from __future__ import annotations

import base64
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.motion import Skeleton

BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Arm
  {
    OFFSET 1 2 3
    CHANNELS 3 Xrotation Yrotation Zrotation
    End Site
    {
      OFFSET 0 0 4
    }
  }
}
MOTION
Frames: 2
Frame Time: .0083333
1 2 3 10 20 30 40 50 60
1 2 3 11 20 30 40 50 60
"""

ASF = """# made for tests
:version 1.10
:name made
:units
  mass 1.0
  length 0.45
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name hip
     direction 0 1 0
     length 2
     axis 0 0 0  XYZ
  end
  begin
     id 2
     name lhumerus
     direction 1 0 0
     length 3
     axis 180 30 -90  XYZ
    dof rx ry rz
    limits (-60.0 90.0)
           (-90.0 90.0)
           (-90.0 90.0)
  end
:hierarchy
  begin
    root hip
    hip lhumerus
  end
"""

AMC = """#!OML:ASF C:\\clips\\made.asf
:FULLY-SPECIFIED
:DEGREES
1
root 1 2 3 10 20 30
lhumerus 40 50 60
2
root 1 2 3 10 20 30
lhumerus 40 50 61
"""

STORED = {"rotation": "VEC4", "translation": "VEC3", "input": "SCALAR"}


def gltf(
    samplers: list[dict[str, Any]], nodes: list[dict[str, Any]], **more: Any
) -> dict[str, Any]:
    """A glTF of one animation; each sampler has node, path, times, values and perhaps a mode."""
    data, views, accessors, told, channels = b"", [], [], [], []

    def put(values: Any, kind: str) -> int:
        nonlocal data
        small = np.asarray(values, "<f4")
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": small.nbytes})
        accessors.append(
            {
                "bufferView": len(views) - 1,
                "componentType": 5126,
                "count": len(small),
                "type": STORED[kind],
            }
        )
        data += small.tobytes()
        return len(accessors) - 1

    for sampler in samplers:
        ports = {"input": put(sampler["times"], "input")}
        ports["output"] = put(sampler["values"], sampler["path"])
        told.append({**ports, "interpolation": sampler.get("mode", "LINEAR")})
        target = {"node": sampler["node"], "path": sampler["path"]}
        channels.append({"sampler": len(told) - 1, "target": target})
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    return {
        "asset": {"version": "2.0"},
        "nodes": nodes,
        "animations": [{"name": "move", "samplers": told, "channels": channels}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": uri}],
    } | more


def put(path: Path, content: Any) -> Path:
    """A file of text, of bytes, or of JSON."""
    if isinstance(content, bytes):
        path.write_bytes(content)
    else:
        text = content if isinstance(content, str) else json.dumps(content)
        path.write_text(text, encoding="utf-8", newline="")
    return path


def refusal(path: Path, read: Callable[..., Any] = qs.read_motion, **options: Any) -> str:
    """What is said of a file, in one line, after its name."""
    with pytest.raises(qs.MotionFileError) as caught:
        read(path, **options)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 400
    assert message.startswith(str(path.parent)), message
    return message.removeprefix(str(path))


def angles(a: np.ndarray, b: np.ndarray) -> float:
    """The largest angle in degrees between orientations."""
    return float(np.degrees(quaternion.distance(a, b)).max())


def figure(frames: int = 120, joints: int = 5, rate: float = 60.0, noise: float = 0.0) -> qs.Motion:
    """A chain of joints that swing, the root along a path, with a fork and an end site."""
    t = np.arange(frames) / rate
    rng = np.random.default_rng(0)
    phase = rng.uniform(0, 6, (joints, 3))
    swing = 0.4 * np.sin(2 * np.pi * (0.5 + 0.2 * np.arange(3)) * t[:, None, None] + phase)
    swing += noise * rng.normal(size=swing.shape)
    q = quaternion.exp(swing)
    parents = np.array([-1, *range(joints - 1)])
    parents[-1] = joints - 3
    offsets = rng.normal(size=(joints, 3)).round(3)
    x = np.tile(offsets, (frames, 1, 1))
    x[:, 0] += np.stack([t, np.sin(t), 0 * t], axis=1)
    skeleton = Skeleton(parents, offsets, ("ZXY",) * joints, {joints - 1: np.array([0, 0.5, 0.0])})
    names = [f"joint {k}" for k in range(joints)]
    return qs.Motion(t, q, x, names, skeleton)


def recorded() -> list[Path]:
    """The clips that QUATSPLINE_MOTIONS names, if it does."""
    folder = os.environ.get("QUATSPLINE_MOTIONS")
    kinds = (".amc", ".bvh", ".txt")
    return sorted(p for p in Path(folder).iterdir() if p.suffix in kinds) if folder else []
