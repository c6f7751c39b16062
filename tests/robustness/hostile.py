"""Files that no reader should trust: valid ones of every format altered, and streams of anything."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator
from pathlib import Path

import numpy as np

ROWS = "0,1,0,0,0\n1,0.8,0.6,0,0\n2,0.6,0.8,0,0\n"
BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  End Site
  {
    OFFSET 1 2 3
  }
}
MOTION
Frames: 2
Frame Time: 0.0083
1 2 3 10 20 30
1 2 3 20 30 40
"""
ODD = [
    b"",
    b"\0" * 5000,
    b"1," * 200_000,
    b"\xff\xfe" + "t,qw,qx,qy,qz\n".encode("utf-16-le"),
    b'"' * 999,
    b"t,qw,qx,qy,qz\n" + b"9" * 5000 + b",1,0,0,0\n",
    "t,qw,qx,qy,qz\n\u0660,1,0,0,0\n".encode(),
    b"t,qw,qx,qy,qz\nnan,1,0,0,0\ninf,1,0,0,0\n",
    b"\x1b]0;title\x07,\x1b[31m\n",
    b"{" * 10_000,
    b'{"asset":{"version":"2.0"},"nodes":' + b"[" * 5000,
    b"glTF\x02\0\0\0\xff\xff\xff\xff",
    b"PK\x03\x04" + b"\xff" * 200,
    b"HIERARCHY\n" + b"ROOT a\n{\n" * 3000,
]


def _valid(folder: Path) -> dict[str, bytes]:
    """A whole file of every format, by suffix."""
    packed = folder / "whole.npz"
    turn = np.array([[1.0, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0.8, 0, 0]])
    np.savez(packed, t=np.arange(3.0), q=turn)
    gltf = {
        "asset": {"version": "2.0"},
        "nodes": [{"name": "a"}],
        "animations": [{}],
        "accessors": [],
    }
    plain = [f"{t} 0 0 0 0 0 0 1" for t in range(3)]
    euroc = [f"{t}000000,0,0,0,1,0,0,0" for t in range(3)]
    texts = {
        ".csv": "t,qw,qx,qy,qz\n" + ROWS,
        ".tum": "\n".join(plain),
        ".txt": "\n".join(plain),
        ".euroc.csv": "#timestamp,px,py,pz,qw,qx,qy,qz\n" + "\n".join(euroc),
        ".kitti": "1 0 0 0 0 1 0 0 0 0 1 0\n" * 3,
        ".bvh": BVH,
        ".amc": ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n2\nroot 0 0 0 0 1 0\n",
        ".gltf": json.dumps(gltf),
    }
    made = {end: text.encode() for end, text in texts.items()}
    body = json.dumps(gltf).encode().ljust(124)
    head = b"glTF" + (2).to_bytes(4, "little") + (20 + len(body)).to_bytes(4, "little")
    glb = head + len(body).to_bytes(4, "little") + b"JSON" + body
    return made | {".npz": packed.read_bytes(), ".glb": glb}


def files(folder: Path, rng: random.Random, count: int, each: int) -> Iterator[Path]:
    """``count`` files of odd content and ``each`` altered ones of every format."""
    folder.mkdir()
    whole = _valid(folder)
    ends = list(whole)
    for i in range(count):
        content = ODD[i % len(ODD)] if i < 10 * len(ODD) else rng.randbytes(1000)
        yield _put(folder / f"odd{i}{ends[(i // len(ODD)) % len(ends)]}", content)
    for end, content in whole.items():
        for i in range(each):
            yield _put(folder / f"altered{i}{end}", _altered(bytearray(content), rng))


def _altered(content: bytearray, rng: random.Random) -> bytes:
    """A valid content with one to three bytes changed, cut out or written twice."""
    for _ in range(rng.randint(1, 3)):
        at = rng.randrange(len(content))
        how = rng.randrange(4)
        if how == 0:
            content[at] = rng.randrange(256)
        elif how == 1:
            del content[at : at + rng.randint(1, 40)]
        elif how == 2:
            content[at:at] = content[: rng.randint(1, 40)]
        else:
            content[at:at] = rng.choice([b"\0", b"1e999", b"-", b"\n", b'"', b"99999999999999"])
        content = content or bytearray(b"\n")
    return bytes(content)


def _put(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path
