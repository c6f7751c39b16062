"""ASF/AMC: fixed axes, frames of bones, units, and where the skeleton is looked for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from clips import AMC, ASF, put, refusal

import quatspline as qs
from quatspline import quaternion
from quatspline.motion import MotionFileWarning


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    put(tmp_path / "made.asf", ASF)
    return put(tmp_path / "made_01.amc", AMC)


def turn(degrees: float, axis: str) -> np.ndarray:
    half = np.zeros(3)
    half["xyz".index(axis)] = np.radians(degrees) / 2
    return quaternion.exp(half)


def product(*turns: np.ndarray) -> np.ndarray:
    whole = turns[0]
    for one in turns[1:]:
        whole = quaternion.mul(whole, one)
    return whole


def test_turns_are_about_fixed_axes_of_the_bones_frame(clip: Path) -> None:
    """XYZ is Rz Ry Rx, of the frame C as of the values M; a bone turns by C M C^-1."""
    motion = qs.read_motion(clip)
    assert motion.tracks == ["root", "hip", "lhumerus"]
    root = product(turn(30, "z"), turn(20, "y"), turn(10, "x"))
    assert quaternion.distance(motion.quaternions[0, 0], root) < 1e-14
    frame = product(turn(-90, "z"), turn(30, "y"), turn(180, "x"))
    values = product(turn(60, "z"), turn(50, "y"), turn(40, "x"))
    expected = product(frame, values, quaternion.conj(frame))
    assert quaternion.distance(motion.quaternions[0, 2], expected) < 1e-14
    assert quaternion.distance(motion.quaternions[0, 1], [1, 0, 0, 0]) < 1e-14  # no dof: rigid
    given = product(turn(-90, "x"), turn(30, "y"), turn(180, "z"))
    wrong = product(given, values, quaternion.conj(given))
    assert quaternion.distance(motion.quaternions[0, 2], wrong) > 0.5  # the order decides


def test_lengths_become_metres(clip: Path) -> None:
    motion = qs.read_motion(clip)
    metre = 0.0254 / 0.45
    _, places = motion.world()
    np.testing.assert_allclose(places[0, 0], np.array([1, 2, 3]) * metre)
    np.testing.assert_array_equal(places[0, 1], places[0, 0])  # a child of the root sits on it
    hip = quaternion.rotate(motion.quaternions[0, 0], [0, 2 * metre, 0])
    np.testing.assert_allclose(places[0, 2], places[0, 0] + hip)
    arm = np.linalg.norm(motion.ends()["lhumerus"] - places[:, 2], axis=1)
    np.testing.assert_allclose(arm, 3 * metre)
    assert motion.unit == "m"
    spec = qs.read_motion(clip, units="spec")
    np.testing.assert_allclose(spec.positions[0, 0], np.array([1, 2, 3]) * 0.45 * 0.0254)


def test_radians_override_the_skeletons_unit(clip: Path) -> None:
    expected = qs.read_motion(clip).quaternions
    rows = AMC.replace(":DEGREES", ":RADIANS").splitlines()
    for i, row in enumerate(rows):
        words = row.split()
        if words[0] == "lhumerus":
            rows[i] = " ".join([words[0], *(repr(np.radians(float(w)).item()) for w in words[1:])])
        if words[0] == "root":
            rows[i] = " ".join(
                [*words[:4], *(repr(np.radians(float(w)).item()) for w in words[4:])]
            )
    put(clip, "\r\n".join(rows))
    assert quaternion.distance(qs.read_motion(clip).quaternions, expected).max() < 1e-14


def test_frames_come_at_120_hertz_unless_told(clip: Path) -> None:
    np.testing.assert_allclose(qs.read_motion(clip).times, [0, 1 / 120])
    np.testing.assert_allclose(qs.read_motion(clip, rate=60).times, [0, 1 / 60])
    put(clip, AMC.replace("\n1\n", "\n7\n").replace("\n2\n", "\n8\n"))
    assert len(qs.read_motion(clip).times) == 2


@pytest.mark.parametrize(
    ("amc", "asf", "comment"),
    [
        ("x_01.amc", "made.asf", "#!OML:ASF C:\\clips\\made.asf"),
        ("x_01.amc", "made.asf", "#!OML:ASF /some/where/made.asf"),
        ("x_01.amc", "x_01.asf", "# nothing"),
        ("x_01.amc", "x.asf", "# nothing"),
        ("x_01.amc", "x.ASF", "#!OML:ASF gone.asf"),
    ],
)
def test_where_the_skeleton_is(tmp_path: Path, amc: str, asf: str, comment: str) -> None:
    put(tmp_path / asf, ASF)
    path = put(tmp_path / amc, comment + "\n" + AMC.partition("\n")[2])
    assert qs.read_motion(path).skeleton is not None


def test_a_skeleton_that_is_not_found_is_told(tmp_path: Path) -> None:
    path = put(tmp_path / "x_01.amc", AMC)
    told = refusal(path)
    assert told == (
        ": no skeleton beside it (looked for made.asf, x_01.asf, x.asf): give skeleton="
    )
    other = put(tmp_path / "other.txt", ASF)
    assert qs.read_motion(path, skeleton=other).tracks == ["root", "hip", "lhumerus"]


def test_a_skeleton_alone_is_no_motion(tmp_path: Path) -> None:
    told = refusal(put(tmp_path / "made.asf", ASF))
    assert told == ": a skeleton without motion: name the .amc that moves it"


def test_a_place_of_the_root_is_told(clip: Path) -> None:
    put(clip.with_name("made.asf"), ASF.replace("position 0 0 0", "position 1 0 0"))
    with pytest.warns(MotionFileWarning, match="added to the root's path"):
        motion = qs.read_motion(clip)
    np.testing.assert_allclose(motion.positions[0, 0], np.array([2, 2, 3]) * 0.0254 / 0.45)


def test_no_amc_is_written(clip: Path, tmp_path: Path) -> None:
    motion = qs.read_motion(clip)
    with pytest.raises(qs.MotionFileError, match="is read and not written; written are"):
        qs.write_motion(tmp_path / "out.amc", motion)
