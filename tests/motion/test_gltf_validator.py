"""GLB files that are written pass Khronos's validator: no error, and no warning either.

It runs in node: ``npm ci --prefix tests/gltf`` installs it.  Where it is not there, these tests are skipped;
with QUATSPLINE_VALIDATOR=required they fail instead.
"""

from __future__ import annotations

import dataclasses
import json
import os
import shutil
import subprocess
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from clips import figure, recorded

import quatspline as qs
from quatspline import quaternion
from quatspline.cli import main
from quatspline.motion import MotionFileWarning
from quatspline.trajectories.figure_walk import figure_walk

BRIDGE = Path(__file__).parents[1] / "gltf" / "validate.mjs"

WELCOME = {"NODE_EMPTY"}
"""Hints that say what is so: the last joint of a limb bears nothing."""

Report = dict[str, Any]


@pytest.fixture(scope="module")
def node() -> str:
    found = shutil.which("node")
    installed = (BRIDGE.parent / "node_modules" / "gltf-validator").is_dir()
    if found is None or not installed:
        lacking = "node" if found is None else "gltf-validator: npm ci --prefix tests/gltf"
        (pytest.fail if os.environ.get("QUATSPLINE_VALIDATOR") else pytest.skip)(f"no {lacking}")
    return found


def reports(node: str, *paths: Path) -> list[Report]:
    call = [node, str(BRIDGE), *map(str, paths)]
    done = subprocess.run(call, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    found: list[Report] = json.loads(done.stdout)
    assert len(found) == len(paths)
    return found


def faults(report: Report) -> list[str]:
    """Errors and warnings, and hints of which we know nothing."""
    messages = report["issues"]["messages"]
    return [f"{m['code']}: {m['message']}" for m in messages if m["code"] not in WELCOME]


def trajectory() -> qs.Motion:
    t = 1.3e9 + np.arange(90) / 100  # Unix times
    v = np.stack([np.sin(t), np.cos(t), 0.1 * t % 1], axis=1)
    return qs.Motion(t, quaternion.exp(v / 2), np.cumsum(v, axis=0))


def renamed() -> qs.Motion:
    names = ["骨盤", 'Hüfte "links"', "膝\n", "🦶", ""]
    return dataclasses.replace(figure(20), tracks=names)


MOTIONS: dict[str, Callable[[], qs.Motion]] = {
    "walk": figure_walk,
    "resampled": lambda: figure().resample(240, "kim"),
    "reduced": lambda: figure().reduce("squad", error=np.radians(0.5)).motion,
    "trajectory": trajectory,
    "orientations": lambda: qs.Motion(np.arange(4.0), quaternion.exp(np.eye(4)[:, :3])),
    "unicode": renamed,
    "one frame": lambda: figure(5).frames(slice(0, 1)),
    "one frame of a body": lambda: trajectory().frames(slice(0, 1)),
}


@pytest.mark.parametrize("kind", MOTIONS)
def test_written_files_are_valid(kind: str, node: str, tmp_path: Path) -> None:
    motion = MOTIONS[kind]()
    qs.write_motion(tmp_path / "a.glb", motion)
    (report,) = reports(node, tmp_path / "a.glb")
    assert faults(report) == []
    assert report["mimeType"] == "model/gltf-binary"
    assert report["info"]["animationCount"] == 1
    assert report["info"]["resources"][0]["byteLength"] > 16 * motion.quaternions[..., 0].size


def test_commands_write_valid_files(node: str, tmp_path: Path) -> None:
    qs.write_motion(tmp_path / "walk.bvh", figure(64))
    outs = [tmp_path / "sampled.glb", tmp_path / "reduced.glb"]
    walk = str(tmp_path / "walk.bvh")
    assert main(["sample", walk, "--scheme", "squad", "--rate", "120", "-o", str(outs[0])]) == 0
    assert main(["reduce", walk, "--error", "1deg", "-o", str(outs[1])]) == 0
    assert [faults(report) for report in reports(node, *outs)] == [[], []]


def test_a_read_gltf_is_written_valid(node: str, tmp_path: Path) -> None:
    """With nodes between that nothing moves."""
    qs.write_motion(tmp_path / "a.glb", figure(12))
    qs.write_motion(tmp_path / "b.glb", qs.read_motion(tmp_path / "a.glb"))
    assert [faults(report) for report in reports(node, tmp_path / "b.glb")] == [[]]


@pytest.mark.skipif(not recorded(), reason="QUATSPLINE_MOTIONS names no clips")
def test_recorded_clips_are_written_valid(node: str, tmp_path: Path) -> None:
    outs = []
    for path in recorded():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", MotionFileWarning)
            motion = qs.read_motion(path)
        outs.append(tmp_path / f"{path.stem}.glb")
        qs.write_motion(outs[-1], motion.frames(slice(0, 200)))
    assert [faults(report) for report in reports(node, *outs)] == [[] for _ in outs]


def test_the_bridge_tells_errors(node: str, tmp_path: Path) -> None:
    """Written on purpose: a rotation that is none."""
    path = tmp_path / "a.glb"
    qs.write_motion(path, figure(5))
    content = path.read_bytes()
    half = np.float32(figure(5).quaternions[2, 1, 0]).tobytes()
    assert content.count(half) == 1
    path.write_bytes(content.replace(half, np.float32(7.0).tobytes()))
    (report,) = reports(node, path)
    assert report["issues"]["numErrors"] > 0
    assert any("NON_NORMALIZED_QUATERNION" in fault for fault in faults(report))
