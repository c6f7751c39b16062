"""Other readers of BVH agree: pybvh in forward kinematics, bvhio (float32) where joints have six channels."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from clips import BVH, figure, put, recorded

import quatspline as qs
from quatspline.motion import MotionFileWarning

FLOAT32 = 1e-5

SIX = BVH.replace(
    "CHANNELS 3 Xrotation Yrotation Zrotation",
    "CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation",
).replace("40 50 60", "1.5 2.5 3.5 40 50 60")


def made(folder: Path) -> list[Path]:
    """A chain that swings, the specification's file, recorded clips."""
    chain = figure(40)
    chain = replace(chain, tracks=[name.replace(" ", "_") for name in chain.tracks])
    qs.write_motion(folder / "figure.bvh", chain)
    clips = [path for path in recorded() if path.suffix == ".bvh"]
    return [folder / "figure.bvh", put(folder / "given.bvh", BVH), *clips]


def read(path: Path) -> qs.Motion:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionFileWarning)
        return qs.read_motion(path)


def test_pybvh_finds_joints_at_the_same_places(tmp_path: Path) -> None:
    pybvh = pytest.importorskip("pybvh")
    for path in made(tmp_path):
        motion, other = read(path), pybvh.read_bvh_file(str(path))
        _, places = motion.world()
        found = pybvh.frames_to_node_positions(other)
        names = [node.name for node in other.nodes]
        size = np.abs(places).max()
        for joint, name in enumerate(motion.tracks):
            theirs = found[:, names.index(name)]
            np.testing.assert_allclose(theirs, places[:, joint], atol=1e-12 * size)
        assert other.frame_count == len(motion.times)


def test_bvhio_finds_the_same_local_poses_and_places(tmp_path: Path) -> None:
    bvhio = pytest.importorskip("bvhio")
    path = put(tmp_path / "six.bvh", SIX)
    motion = read(path)
    _, places = motion.world()
    hung = bvhio.readAsHierarchy(str(path))
    joints = [joint for joint, _, _ in bvhio.readAsBvh(str(path)).Root.layout()]
    assert [joint.Name for joint in joints] == motion.tracks
    for frame in range(len(motion.times)):
        hung.loadPose(frame)
        for track, joint in enumerate(joints):
            pose = joint.Keyframes[frame]
            q = [pose.Rotation.w, pose.Rotation.x, pose.Rotation.y, pose.Rotation.z]
            dot = np.dot(q, motion.quaternions[frame, track])
            assert abs(dot) == pytest.approx(1, abs=FLOAT32)
            x = motion.positions[frame, track]
            np.testing.assert_allclose(pose.Position, x, atol=FLOAT32)
            (found,) = [it for it, _, _ in hung.layout() if it.Name == joint.Name]
            np.testing.assert_allclose(found.PositionWorld, places[frame, track], atol=FLOAT32)
