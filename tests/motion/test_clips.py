"""Recorded clips, where QUATSPLINE_MOTIONS names a folder of them: read, written back, measured."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from clips import angles, recorded

import quatspline as qs
from quatspline.motion import MotionFileWarning

CLIPS = recorded()
each_clip = pytest.mark.parametrize("path", CLIPS, ids=[path.stem for path in CLIPS])


def read(path: Path) -> qs.Motion:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionFileWarning)
        return qs.read_motion(path)


@each_clip
def test_every_clip_is_written_and_read_back(path: Path, tmp_path: Path) -> None:
    motion = read(path)
    even = np.ptp(np.diff(motion.times)) < 1e-6
    motion = motion if even else motion.resample(100, "slerp")
    for name, bound in {"a.bvh": 1e-6, "a.glb": 1e-4, "a.npz": 0}.items():
        qs.write_motion(tmp_path / name, motion)
        again = read(tmp_path / name)
        assert again.tracks == motion.tracks
        assert angles(again.quaternions, motion.quaternions) <= max(bound, 1e-5)
        np.testing.assert_allclose(again.positions, motion.positions, rtol=1e-5, atol=1e-5)


@each_clip
def test_every_clip_is_rebuilt_from_some_of_its_frames(path: Path) -> None:
    motion = read(path)
    curve = motion.curve("local-quintic", every=8)
    q, x = curve(motion.times)
    assert not curve.failures
    assert angles(q[::8], motion.quaternions[::8]) < 1e-6
    assert np.isfinite(x).all()


@pytest.mark.skipif(not CLIPS, reason="QUATSPLINE_MOTIONS names no clips")
def test_a_bvh_of_others_round_trips_to_rounding(tmp_path: Path) -> None:
    path = next(path for path in CLIPS if path.suffix == ".bvh")
    motion = read(path)
    qs.write_motion(tmp_path / "a.bvh", motion)
    again = read(tmp_path / "a.bvh")
    assert angles(again.quaternions, motion.quaternions) < 1e-12
    np.testing.assert_array_equal(again.positions, motion.positions)
    np.testing.assert_array_equal(again.times, motion.times)
