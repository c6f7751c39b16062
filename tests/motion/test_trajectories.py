"""Trajectories of bodies: EuRoC, KITTI, matrices and angles in CSV, tracks, what to do with doubtful rows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from clips import angles, figure, put, refusal

import quatspline as qs
from quatspline.motion import MotionFileWarning, euler

EPOCH = 1_403_636_580_838_555_648
EUROC = (
    "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
    "v_RS_R_x [m s^-1]\n"
    f"{EPOCH},1,2,3,0.8,0.6,0,0,9\n{EPOCH + 5_000_001},4,5,6,0.6,0.8,0,0,9\n"
)


def test_euroc_counts_nanoseconds_and_has_w_first(tmp_path: Path) -> None:
    motion = qs.read_motion(put(tmp_path / "data.csv", EUROC))
    assert motion.start == EPOCH
    assert isinstance(motion.start, int)
    np.testing.assert_array_equal(motion.times, [0, 0.005000001])
    np.testing.assert_array_equal(motion.quaternions[:, 0], [[0.8, 0.6, 0, 0], [0.6, 0.8, 0, 0]])
    np.testing.assert_array_equal(motion.positions[0, 0], [1, 2, 3])
    assert motion.unread == ("v_RS_R_x [m s^-1]",)
    qs.write_motion(tmp_path / "out.euroc.csv", motion)
    lines = (tmp_path / "out.euroc.csv").read_text().splitlines()
    assert lines[0].startswith("#timestamp,p_RS_R_x [m],")
    assert lines[1] == f"{EPOCH},1.0,2.0,3.0,0.8,0.6,0.0,0.0"
    bare = put(tmp_path / "bare.euroc.csv", "\n".join(lines[1:]) + "\n")
    again = qs.read_motion(bare)
    np.testing.assert_array_equal(again.stamps, motion.stamps)
    np.testing.assert_array_equal(again.quaternions, motion.quaternions)
    np.testing.assert_array_equal(again.times, motion.times)


def test_nanoseconds_are_seconds_in_tum_to_the_last_digit(tmp_path: Path) -> None:
    motion = qs.read_motion(put(tmp_path / "data.csv", EUROC))
    qs.write_motion(tmp_path / "out.tum", motion)
    lines = (tmp_path / "out.tum").read_text().splitlines()
    assert lines[1] == "1403636580.838555648 1.0 2.0 3.0 0.6 0.0 0.0 0.8"
    assert all(line == line.rstrip() and "  " not in line for line in lines)


def test_decimal_seconds_are_nanoseconds_in_euroc(tmp_path: Path) -> None:
    path = put(tmp_path / "a.tum", "1305031098.6659 0 0 0 0 0 0 1\n1305031098.6758 0 0 0 0 0 0 1\n")
    motion = qs.read_motion(path)
    assert motion.unit == "m"
    qs.write_motion(tmp_path / "out.euroc.csv", motion)
    stamps = [line.split(",")[0] for line in (tmp_path / "out.euroc.csv").read_text().splitlines()]
    assert stamps[1:] == ["1305031098665900000", "1305031098675800000"]


def test_a_resampled_euroc_keeps_whole_stamps(tmp_path: Path) -> None:
    motion = qs.read_motion(put(tmp_path / "data.csv", EUROC)).resample(1000, "slerp")
    assert motion.stamps.dtype == np.int64
    assert (motion.stamps - EPOCH).tolist() == [k * 1_000_000 for k in range(6)]


@pytest.mark.parametrize(
    ("name", "seconds"),
    [("timestamp_ns", 1e-9), ("t [us]", 1e-6), ("time_ms", 1e-3), ("t [s]", 1), ("time", 1)],
)
def test_a_unit_of_time_that_is_named_counts(tmp_path: Path, name: str, seconds: float) -> None:
    text = f"{name},qw,qx,qy,qz\n1000,1,0,0,0\n4000,1,0,0,0\n"
    motion = qs.read_motion(put(tmp_path / "a.csv", text))
    np.testing.assert_allclose(motion.times, [0, 3000 * seconds], rtol=1e-15)
    assert motion.start == 1000
    qs.write_motion(tmp_path / "b.csv", motion)
    again = qs.read_motion(tmp_path / "b.csv")
    np.testing.assert_array_equal(again.times, motion.times)


def test_a_nanosecond_that_is_not_whole_is_refused(tmp_path: Path) -> None:
    told = refusal(put(tmp_path / "a.csv", EUROC.replace(str(EPOCH), "1403636580.8", 1)))
    assert "line 2: t = 1403636580.8 is no whole nanosecond" in told


KITTI = (
    "1 0 0 0 0 1 0 0 0 0 1 0\n"
    "9.999978e-01 5.272628e-04 -2.066935e-03 -4.690294e-02 -5.296506e-04 9.999992e-01 "
    "-1.154865e-03 -2.839928e-02 2.066324e-03 1.155958e-03 9.999971e-01 8.586941e-01\n"
)


@pytest.mark.parametrize("name", ["00.txt", "00.kitti"])
def test_kitti_is_a_matrix_by_rows(tmp_path: Path, name: str) -> None:
    path = put(tmp_path / name, KITTI)
    assert refusal(path) == ": has no times of its own: give times= or rate="
    motion = qs.read_motion(path, rate=10)
    expected = [0.999999263, 0.000577706, -0.001033316, -0.000264229]
    np.testing.assert_allclose(motion.quaternions[1, 0], expected, atol=5e-9)
    np.testing.assert_allclose(motion.positions[1, 0], [-0.04690294, -0.02839928, 0.8586941])
    np.testing.assert_allclose(motion.times, [0, 0.1])
    times = put(tmp_path / "times.txt", "0.0e+00\n1.03736e-01\n")
    np.testing.assert_array_equal(qs.read_motion(path, times=times).stamps, [0, 0.103736])
    with pytest.raises(qs.MotionFileError, match=r"times has shape \(1,\) for 2 frames"):
        qs.read_motion(path, times=[0.0])


def test_matrices_in_named_columns(tmp_path: Path) -> None:
    names = ",".join(f"r{i}{j}" for i in range(3) for j in range(3))
    text = f"t,{names},x,y,z\n0,0,-1,0,1,0,0,0,0,1,7,8,9\n1,1,0,0,0,1,0,0,0,1,7,8,9\n"
    motion = qs.read_motion(put(tmp_path / "a.csv", text))
    half = np.sqrt(0.5)
    np.testing.assert_allclose(motion.quaternions[0, 0], [half, 0, 0, half], atol=1e-15)
    np.testing.assert_array_equal(motion.positions[0, 0], [7, 8, 9])
    off = text.replace("1,1,0,0,0,1,0,0,0,1,7", "1,1.01,0,0,0,1,0,0,0,1,7")
    assert "line 3: matrix is off orthogonality by 0.0201" in refusal(put(tmp_path / "b.csv", off))
    flip = text.replace("1,1,0,0,0,1,0,0,0,1,7", "1,1,0,0,0,1,0,0,0,-1,7")
    assert "line 3: matrix mirrors" in refusal(put(tmp_path / "c.csv", flip))


@pytest.mark.parametrize(
    ("names", "scale"),
    [
        ("euler_zyx_z [deg],euler_zyx_y [deg],euler_zyx_x [deg]", 1.0),
        ("euler_zyx_z_rad,euler_zyx_y_rad,euler_zyx_x_rad", np.radians(1.0)),
    ],
)
def test_angles_in_a_named_order_and_unit(tmp_path: Path, names: str, scale: float) -> None:
    text = f"t,{names}\n0,{10 * scale},{20 * scale},{30 * scale}\n"
    motion = qs.read_motion(put(tmp_path / "a.csv", text))
    expected = euler.from_angles(np.radians([[10, 20, 30]]), "ZYX")
    np.testing.assert_allclose(motion.quaternions[:, 0], expected, atol=1e-15)


@pytest.mark.parametrize(
    ("names", "what"),
    [
        ("roll,pitch,yaw", "not said in which order they turn"),
        ("euler_zyx_z,euler_zyx_y,euler_zyx_x", "name the unit"),
        ("euler_zyx_z_deg,euler_zyx_y_deg,other", "one column of each axis"),
        ("euler_zyx_z_deg,euler_zyx_y_rad,euler_zyx_x_deg", "more than one order or unit"),
        ("euler_zyz_z_deg,euler_zyz_y_deg,euler_zyz_z_deg", "repeats an axis"),
    ],
)
def test_angles_that_leave_something_open_are_refused(
    tmp_path: Path, names: str, what: str
) -> None:
    assert what in refusal(put(tmp_path / "a.csv", f"t,{names}\n0,1,2,3\n"))


@pytest.mark.parametrize("suffix", [".csv", ".npz"])
def test_tracks_are_kept_by_name(tmp_path: Path, suffix: str) -> None:
    motion = figure(9, 3)
    names = ["hip, left", 'say "x"', "c"]
    motion = qs.Motion(motion.stamps, motion.quaternions, motion.positions, names)
    qs.write_motion(tmp_path / f"a{suffix}", motion)
    again = qs.read_motion(tmp_path / f"a{suffix}")
    assert again.tracks == names
    for name in ("stamps", "quaternions", "positions"):
        np.testing.assert_array_equal(getattr(again, name), getattr(motion, name))


def test_npz_holds_all_of_a_skeleton(tmp_path: Path) -> None:
    motion = figure()
    qs.write_motion(tmp_path / "a.npz", motion)
    again = qs.read_motion(tmp_path / "a.npz")
    for a, b in zip(again.world(), motion.world(), strict=True):
        np.testing.assert_array_equal(a, b)
    assert again.skeleton.orders == motion.skeleton.orders
    assert again.ends().keys() == motion.ends().keys()


def test_a_skeleton_that_is_dropped_is_told(tmp_path: Path) -> None:
    with pytest.warns(MotionFileWarning, match=r"a\.csv: the skeleton is not carried"):
        qs.write_motion(tmp_path / "a.csv", figure())
    with (
        pytest.warns(MotionFileWarning, match="skeleton"),
        pytest.raises(qs.MotionFileError, match="holds one body, not 5 tracks"),
    ):
        qs.write_motion(tmp_path / "a.tum", figure())


def test_tracks_with_stamps_of_their_own_are_refused(tmp_path: Path) -> None:
    text = "t,joint,qw,qx,qy,qz\n0,a,1,0,0,0\n0,b,1,0,0,0\n1,a,1,0,0,0\n2,b,1,0,0,0\n"
    assert "'b' has other stamps than 'a'" in refusal(put(tmp_path / "a.csv", text))


ROWS = "t,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,2,0,0,0.8,0.6,0,0\n1,4,0,0,-0.8,0.6,0,0\n2,9,0,0,1,0,0,0\n"


@pytest.mark.parametrize(
    ("how", "place", "turn"),
    [
        ("first", 2.0, [0.8, 0.6, 0, 0]),
        ("last", 4.0, [0.8, -0.6, 0, 0]),
        ("mean", 3.0, [1, 0, 0, 0]),
    ],
)
def test_duplicates_become_one(tmp_path: Path, how: str, place: float, turn: list) -> None:
    """The mean is of one hemisphere: 73.7 degrees to either side of no turn."""
    path = put(tmp_path / "a.csv", ROWS)
    assert "t = 1.0 repeats the stamp before it" in refusal(path)
    motion = qs.read_motion(path, duplicates=how)
    np.testing.assert_array_equal(motion.times, [0, 1, 2])
    assert motion.positions[1, 0, 0] == place
    assert angles(motion.quaternions[1, 0], np.array(turn)) < 1e-6


def test_duplicates_in_npz(tmp_path: Path) -> None:
    q = np.array([[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0.8, 0, 0]])
    np.savez(tmp_path / "a.npz", times=[0, 1, 1], quaternions=q)
    motion = qs.read_motion(tmp_path / "a.npz", duplicates="last")
    np.testing.assert_array_equal(motion.quaternions[:, 0], q[[0, 2]])


@pytest.mark.parametrize("blank", ["", "nan", "NA"])
def test_missing_rows_are_skipped_where_asked(tmp_path: Path, blank: str) -> None:
    text = f"t,qw,qx,qy,qz\n0,1,0,0,0\n1,1,{blank},0,0\n2,0.8,0.6,0,0\n"
    path = put(tmp_path / "a.csv", text)
    assert "qx holds no number" in refusal(path)
    np.testing.assert_array_equal(qs.read_motion(path, missing="skip").times, [0, 2])
    wrong = put(tmp_path / "b.csv", text.replace("2,0.8", "2,9.8"))
    assert "norm 9.8" in refusal(wrong, missing="skip")


def test_quaternions_are_aligned_in_time(tmp_path: Path) -> None:
    path = put(tmp_path / "a.csv", "0,1,0,0,0\n1,-0.8,-0.6,0,0\n2,0.6,0.8,0,0\n")
    motion = qs.read_motion(path)
    np.testing.assert_array_equal(motion.quaternions[:, 0, 0], [1, 0.8, 0.6])


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"skip": -1}, "skip=-1: a whole number"),
        ({"duplicates": "both"}, "duplicates='both': known: first"),
        ({"missing": "skp"}, "missing='skp': did you mean 'skip'?"),
        ({"rate": 0}, "rate=0: a positive number"),
        ({"max_gap": np.nan}, "max_gap=nan: a positive number"),
        ({"units": "inch"}, "units='inch': known: cmu, spec"),
        ({"rate": 1, "times": [0]}, "rate and times are both given"),
    ],
)
def test_wrong_options_are_refused(tmp_path: Path, options: dict, what: str) -> None:
    with pytest.raises(ValueError, match=f"^{what[:20]}") as caught:
        qs.read_motion(put(tmp_path / "a.csv", ROWS), **options)
    assert what in str(caught.value)


@pytest.mark.parametrize(
    "options",
    [{"rate": 5}, {"times": [0, 1]}, {"skeleton": "x.asf"}, {"units": "cmu"}, {"animation": 0}],
)
def test_options_that_say_nothing_of_a_format_are_refused(tmp_path: Path, options: dict) -> None:
    assert "is of no use in a file of this format" in refusal(
        put(tmp_path / "a.csv", "0,1,0,0,0\n1,1,0,0,0\n"), **options
    )


def test_more_frames_than_there_are_cannot_be_skipped(tmp_path: Path) -> None:
    path = put(tmp_path / "a.csv", "0,1,0,0,0\n1,1,0,0,0\n")
    assert qs.read_motion(path, skip=1).start == 1
    assert refusal(path, skip=2) == ": skip=2 leaves none of its 2 frames"
