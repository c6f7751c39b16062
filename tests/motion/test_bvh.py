"""BVH: the values of the specification, what files are like, and the way back."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from clips import BVH, angles, figure, put

import quatspline as qs
from quatspline.motion import MotionFileWarning, euler
from quatspline.motion.files.bvh import nominal_rate


def test_the_values_of_the_specification(tmp_path: Path) -> None:
    motion = qs.read_motion(put(tmp_path / "a.bvh", BVH))
    assert motion.tracks == ["Hips", "Arm"]
    root = [0.943714364, 0.144878125, 0.268535823, 0.127679441]
    np.testing.assert_allclose(motion.quaternions[0, 0], root, atol=1e-9)
    turns, places = motion.world()
    np.testing.assert_allclose(places[0, 1], [3.12833555, 3.555006548, 5.65558702], atol=1e-8)
    end = [6.991517251, 2.598890871, 5.253504994]
    np.testing.assert_allclose(motion.ends()["Arm"][0], end, atol=1e-8)
    assert turns.shape == (2, 2, 4)
    assert motion.skeleton is not None
    assert motion.skeleton.orders == ("ZXY", "XYZ")
    assert motion.skeleton.parents.tolist() == [-1, 0]
    np.testing.assert_allclose(motion.times, [0, 1 / 120])


def test_positions_replace_offsets(tmp_path: Path) -> None:
    text = BVH.replace("OFFSET 0 0 0", "OFFSET 7 8 9")
    motion = qs.read_motion(put(tmp_path / "a.bvh", text))
    assert motion.positions is not None
    np.testing.assert_array_equal(motion.positions[0], [[1, 2, 3], [1, 2, 3]])


@pytest.mark.parametrize(
    ("printed", "rate"),
    [
        (".0083333", 120),
        ("0.008333", 120),
        (".03333", 30),
        ("0.033333", 30),
        ("0.0333333", 30),
        ("0.008342", 120000 / 1001),
        ("0.016683", 60000 / 1001),
        ("0.041708", 24000 / 1001),
        ("0.016666", 60),
        ("0.0166667", 60),
        ("0.01", 100),
        ("0.04", 25),
        ("1.6666667e-2", 60),
        ("1", 1),
        ("0.008333333333", 120),
    ],
)
def test_a_rounded_frame_time_tells_its_rate(printed: str, rate: float) -> None:
    assert nominal_rate(printed) == pytest.approx(rate, rel=1e-15)


@pytest.mark.parametrize("printed", ["0.0123467", "0.0087", "0.13"])
def test_another_frame_time_is_taken_as_it_is(printed: str) -> None:
    assert nominal_rate(printed) == pytest.approx(1 / float(printed), rel=1e-15)


def test_what_files_are_like(tmp_path: Path) -> None:
    """CR alone, tabs, names with blanks, braces beside words, a leaf without end site, two roots."""
    text = """hierarchy
ROOT Left  hip {
\toffset 0 0 0
\tCHANNELS 1 zROTATION
\tJOINT upper leg
\t{ OFFSET 0 1 0
\t\tCHANNELS 0
\t}}
ROOT Other
{
OFFSET 1e0 0 0
CHANNELS 2 Yposition Xrotation
JOINT Hand
{
OFFSET 0 0 1
CHANNELS 4 Yrotation Zposition Xrotation Zrotation
End Site the tip
{
OFFSET 0 0 2
}
}
}

MOTION
Frames:  2
Frame Time:\t0.04

90 5 90 1 2 3 4

90 6 90 1 2 3 4
"""
    motion = qs.read_motion(put(tmp_path / "a.bvh", "\ufeff" + text.replace("\n", "\r")))
    assert motion.tracks == ["Left hip", "upper leg", "Other", "Hand"]
    assert motion.skeleton is not None
    assert motion.skeleton.parents.tolist() == [-1, 0, -1, 2]
    assert motion.skeleton.orders == ("Z", "", "X", "YXZ")
    half = np.sqrt(0.5)
    np.testing.assert_allclose(motion.quaternions[0, 0], [half, 0, 0, half], atol=1e-15)
    np.testing.assert_allclose(motion.world()[1][1, 1], [-1, 0, 0], atol=1e-15)
    assert motion.positions is not None
    np.testing.assert_array_equal(motion.positions[:, 2], [[1, 5, 0], [1, 6, 0]])
    np.testing.assert_array_equal(motion.positions[0, 3], [0, 0, 2])
    assert set(motion.ends()) == {"upper leg", "Hand"}


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    motion = qs.read_motion(put(tmp_path / "a.bvh", BVH))
    qs.write_motion(tmp_path / "b.bvh", motion)
    again = qs.read_motion(tmp_path / "b.bvh")
    assert angles(motion.quaternions, again.quaternions) < 1e-12
    np.testing.assert_array_equal(motion.positions, again.positions)
    np.testing.assert_array_equal(motion.times, again.times)
    np.testing.assert_array_equal(motion.ends()["Arm"], again.ends()["Arm"])
    assert (motion.tracks, motion.skeleton.orders) == (again.tracks, again.skeleton.orders)
    text = (tmp_path / "b.bvh").read_text()
    assert "Frame Time: 0.008333333333\n" in text
    qs.write_motion(tmp_path / "c.bvh", again)
    assert (tmp_path / "c.bvh").read_text() == text


def test_what_was_resampled_is_read_back_to_its_decimals(tmp_path: Path) -> None:
    motion = figure().resample(144, "squad")
    qs.write_motion(tmp_path / "a.bvh", motion)
    again = qs.read_motion(tmp_path / "a.bvh")
    assert angles(motion.quaternions, again.quaternions) < 1e-6
    np.testing.assert_allclose(motion.positions, again.positions, atol=5.1e-7)
    np.testing.assert_allclose(motion.times, again.times, atol=1e-9)


def test_written_angles_have_no_leaps(tmp_path: Path) -> None:
    turn = np.radians(np.arange(0, 1080, 6.0))
    q = euler.from_angles(np.stack([0.2 + 0 * turn, turn, 0.1 * turn], axis=1), "ZXY")
    motion = qs.Motion(np.arange(len(turn)) / 30, q)
    qs.write_motion(tmp_path / "a.bvh", motion)
    rows = (tmp_path / "a.bvh").read_text().split("Frame Time:")[1].split("\n")[1:-1]
    table = np.array([row.split() for row in rows], dtype=float)
    assert np.abs(np.diff(table, axis=0)).max() < 7
    assert angles(qs.read_motion(tmp_path / "a.bvh").quaternions, q[:, None]) < 1e-6


def test_a_hinge_stays_one_and_what_leaves_its_axes_gets_three(tmp_path: Path) -> None:
    frames = (("0 0 0 10", "20 150"), ("0 0 0 20", "30 160"), ("0 0 0 40", "60 100"))
    rows = "".join(f"{root} {arm}\n" for root, arm in frames)
    text = BVH.replace("CHANNELS 3 Xrotation Yrotation Zrotation", "CHANNELS 2 Xrotation Zrotation")
    six = "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
    text = text.replace(six, "4 Xposition Yposition Zposition Zrotation")
    text = text.split("Frames:")[0] + f"Frames: 3\nFrame Time: 0.1\n{rows}"
    motion = qs.read_motion(put(tmp_path / "a.bvh", text))
    qs.write_motion(tmp_path / "b.bvh", motion)
    assert "CHANNELS 2 Xrotation Zrotation" in (tmp_path / "b.bvh").read_text()
    assert "Zposition Zrotation\n" in (tmp_path / "b.bvh").read_text()
    assert angles(qs.read_motion(tmp_path / "b.bvh").quaternions, motion.quaternions) < 1e-12
    qs.write_motion(tmp_path / "c.bvh", motion.resample(50, "slerp"))
    assert "CHANNELS 3 Xrotation Zrotation Yrotation" in (tmp_path / "c.bvh").read_text()


def test_an_added_pose_is_told_and_skipped(tmp_path: Path) -> None:
    motion = figure(20)
    q = motion.quaternions.copy()
    q[0] = [1, 0, 0, 0]
    q[0, 2] = [0, 1, 0, 0]
    qs.write_motion(tmp_path / "a.bvh", motion.moved(motion.stamps, q, motion.positions))
    with pytest.warns(MotionFileWarning, match=r"joint 'joint 2' turns .* skip=1 leaves out"):
        whole = qs.read_motion(tmp_path / "a.bvh")
    rest = qs.read_motion(tmp_path / "a.bvh", skip=1)
    np.testing.assert_array_equal(rest.quaternions, whole.quaternions[1:])
    assert (rest.start, rest.times[0]) == (whole.stamps[1], 0.0)


def test_rate_and_times_of_ones_own(tmp_path: Path) -> None:
    path = put(tmp_path / "a.bvh", BVH)
    np.testing.assert_allclose(qs.read_motion(path, rate=25).times, [0, 0.04])
    np.testing.assert_array_equal(qs.read_motion(path, times=[1.0, 5.0]).stamps, [1, 5])


@pytest.mark.parametrize(
    ("motion", "what"),
    [
        (qs.Motion(np.array([0, 1, 3.0]), np.tile([1.0, 0, 0, 0], (3, 1))), "resample it first"),
        (qs.Motion(np.array([0.0]), np.array([[1.0, 0, 0, 0]])), "at least two"),
        (
            qs.Motion(np.arange(2.0), np.tile([1.0, 0, 0, 0], (2, 2, 1)), None, ["a", "b"]),
            "needs a skeleton",
        ),
        (
            qs.Motion(np.arange(2.0), np.tile([1.0, 0, 0, 0], (2, 1, 1)), None, ["a{"]),
            "cannot hold a joint called 'a{'",
        ),
    ],
)
def test_what_bvh_cannot_hold_is_refused(tmp_path: Path, motion: qs.Motion, what: str) -> None:
    with pytest.raises(qs.MotionFileError, match=re.escape(what)):
        qs.write_motion(tmp_path / "a.bvh", motion)
    assert not list(tmp_path.iterdir())
