"""Keyframe files: three formats, every malformed line, atomic writing."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from keyfiles import put, refusal

from quatspline.motion.closing import opened, returning
from quatspline.motion.files import Motion, MotionFileError, read, write, writing
from quatspline.motion.resampling import sampled
from quatspline.system.atomic import replacing

TIMES = np.array([0.0, 0.1, 1.0 / 3.0, 1305031102.175800085])
QUATERNIONS = np.array([[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0, -0.8, 0], [0.5, 0.5, 0.5, -0.5]])
POSITIONS = np.array([[0, 0, 0], [1, 2, 3], [0.1, 0.2, 0.3], [-1e-17, 5, 1e300]])


# -- what is read -------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".csv", ".tum", ".txt", ".npz", ".CSV", ".Npz"])
@pytest.mark.parametrize("positions", [None, POSITIONS])
def test_what_is_written_is_read_back_exactly(
    tmp_path: Path, suffix: str, positions: np.ndarray | None
) -> None:
    path = tmp_path / f"motion{suffix}"
    write(path, Motion(TIMES, QUATERNIONS, positions))
    motion = read(path)
    np.testing.assert_array_equal(motion.stamps, TIMES)
    np.testing.assert_array_equal(motion.quaternions[:, 0], QUATERNIONS)
    if positions is None and suffix.lower() not in (".tum", ".txt"):
        assert motion.positions is None
    else:
        expected = np.zeros((4, 3)) if positions is None else positions
        np.testing.assert_array_equal(motion.positions[:, 0], expected)
    assert os.listdir(tmp_path) == [path.name]


def test_csv_without_a_header_is_in_the_documented_order(tmp_path: Path) -> None:
    motion = read(put(tmp_path, "k.csv", "0,0.8,0.6,0,0\n1,0.6,0,0.8,0\n"))
    np.testing.assert_array_equal(motion.stamps, [0, 1])
    np.testing.assert_array_equal(motion.quaternions[:, 0], [[0.8, 0.6, 0, 0], [0.6, 0, 0.8, 0]])


def test_csv_header_names_columns_in_any_order_among_others(tmp_path: Path) -> None:
    text = (
        "\ufeff# a comment\n\n"
        '"qz", x, QX ,y,label,qy,z,T,qw\n'
        "0,9,0.6,8,start,0,7,-1.5,0.8\n"
        "  # another\n"
        "0,6,0,5,,0.8,4,2e0,0.6\n"
    )
    motion = read(put(tmp_path, "k.csv", text))
    np.testing.assert_array_equal(motion.stamps, [-1.5, 2])
    np.testing.assert_array_equal(motion.quaternions[:, 0], [[0.8, 0.6, 0, 0], [0.6, 0, 0.8, 0]])
    np.testing.assert_array_equal(motion.positions[:, 0], [[9, 8, 7], [6, 5, 4]])
    assert motion.unread == ("label",)


def test_tum_is_scalar_last_with_positions(tmp_path: Path) -> None:
    text = "# timestamp tx ty tz qx qy qz qw\n0 1 2 3 0.6 0 0 0.8\r\n\n 1\t4 5  6 0 0 0 -1 \n"
    motion = read(put(tmp_path, "k.txt", text))
    np.testing.assert_array_equal(motion.quaternions[:, 0], [[0.8, 0.6, 0, 0], [-1, 0, 0, 0]])
    np.testing.assert_array_equal(motion.positions[:, 0], [[1, 2, 3], [4, 5, 6]])


def test_a_norm_within_the_tolerance_is_read_as_given(tmp_path: Path) -> None:
    motion = read(put(tmp_path, "k.csv", "0,1.0005,0,0,0\n1,1,0,0,0\n"))
    assert motion.quaternions[0, 0, 0] == 1.0005


# -- what is refused ----------------------------------------------------------------------------

LINES = {
    "few fields": ("2,1,0,0", "expected 5 fields, found 4"),
    "many fields": ("2,1,0,0,0,0", "expected 5 fields, found 6"),
    "text": ("2,1,0,east,0", "qy = 'east' is not a number"),
    "empty field": ("2,1,0,,0", "qy holds no number (blank or nan)"),
    "underscore": ("2,1,0,0_0,0", "qy = '0_0' is not a number"),
    "nan": ("2,1,0,nan,0", "qy holds no number (blank or nan)"),
    "nan time": ("NaN,1,0,0,0", "t holds no number (blank or nan)"),
    "infinity": ("1e999,1,0,0,0", "t = inf is not a finite number"),
    "norm": ("2,1,0,0.1,0", "quaternion has norm 1.00499"),
    "zero": ("2,0,0,0,0", "quaternion has norm 0"),
    "equal time": ("1,1,0,0,0", "t = 1.0 repeats the stamp before it (1 row)"),
    "earlier time": ("0.5,1,0,0,0", "t = 0.5 goes back behind 1.0 before it (1 row)"),
}


@pytest.mark.parametrize("header", ["", "t,qw,qx,qy,qz\n"])
@pytest.mark.parametrize(("line", "what"), LINES.values(), ids=LINES)
def test_csv_names_the_malformed_line(tmp_path: Path, line: str, what: str, header: str) -> None:
    text = f"# keyframes\n{header}0,1,0,0,0\n\n1,0.8,0.6,0,0\n{line}\n3,1,0,0,0\n"
    message = refusal(put(tmp_path, "k.csv", text))
    assert message.startswith(f", line {6 if header else 5}: {what}")


@pytest.mark.parametrize(("line", "what"), LINES.values(), ids=LINES)
def test_tum_names_the_malformed_line(tmp_path: Path, line: str, what: str) -> None:
    t, *q = line.split(",")
    fields = " ".join([t, "0 0 0", *q[1:], q[0]])
    good = "0 7 7 7 0 0 0 1\n# comment\n1 7 7 7 0.6 0 0 0.8\n"
    message = refusal(put(tmp_path, "k.tum", f"{good}{fields}\n"))
    if "fields" in what or ",," in line:  # blanks separate: an empty field is no field
        what = f"expected 8 fields, found {len(fields.split())}"
    assert message.startswith(f", line 4: {what}")


def test_tum_refuses_a_position_that_is_no_number(tmp_path: Path) -> None:
    message = refusal(put(tmp_path, "k.tum", "0 1 x 3 0 0 0 1"))
    assert message == ", line 1: ty = 'x' is not a number (1 row)"


@pytest.mark.parametrize("row", [0, 1, 2])
@pytest.mark.parametrize(
    ("time", "quaternion", "what"),
    [
        (np.nan, [1, 0, 0, 0], "t holds no number (blank or nan)"),
        (5.0, [np.inf, 0, 0, 0], "qw = inf is not a finite number"),
        (5.0, [0.5, 0, 0, 0], "quaternion has norm 0.5"),
    ],
)
def test_npz_names_the_row(
    tmp_path: Path, row: int, time: float, quaternion: list[float], what: str
) -> None:
    times, q = np.arange(3.0), np.tile([1.0, 0, 0, 0], (3, 1))
    times[row], q[row] = time, quaternion
    np.savez(tmp_path / "k.npz", times=times, quaternions=q)
    assert refusal(tmp_path / "k.npz").startswith(f", row {row}: {what}")


@pytest.mark.parametrize("times", [[0.0, 1, 1], [0.0, 1, -1]])
def test_npz_names_the_row_whose_time_does_not_increase(tmp_path: Path, times: list[float]) -> None:
    np.savez(tmp_path / "k.npz", times=times, quaternions=np.tile([1.0, 0, 0, 0], (3, 1)))
    message = refusal(tmp_path / "k.npz")
    what = "repeats the stamp" if times[2] == 1 else "goes back behind 1.0"
    assert message == f", row 2: t = {float(times[2])} {what} before it (1 row)"


@pytest.mark.parametrize("last", [3.0, 2.0, np.nan, np.inf])
def test_npz_of_a_closed_motion_has_one_time_more(tmp_path: Path, last: float) -> None:
    q = np.tile([1.0, 0, 0, 0], (3, 1))
    path = tmp_path / "k.npz"
    np.savez(path, times=[0.0, 1.0, 2.0, last], quaternions=q)
    if last == 3.0:
        motion = read(path)
        assert (motion.stamps.shape, motion.quaternions.shape) == ((4,), (3, 1, 4))
        assert returning(motion) is motion
        with pytest.raises(ValueError, match=r"^4 times for 3 quaternions: .*; --closed takes the"):
            opened(motion)
    else:
        assert refusal(path).startswith(", row 3: t ")


@pytest.mark.parametrize(
    ("arrays", "what"),
    [
        ({"times": [0.0]}, "no array 'quaternions': known: times"),
        (
            {"time": [0.0], "quaternions": [[1.0, 0, 0, 0]]},
            "no array 'times': did you mean 'time'?",
        ),
        ({"times": [0.0, 1.0], "quaternions": np.ones((2, 3))}, "expected (n,) and (n, 4)"),
        ({"times": [0.0], "quaternions": np.ones((2, 4)) / 2}, "expected (n,) and (n, 4)"),
        ({"times": [[0.0]], "quaternions": np.ones((1, 4)) / 2}, "expected (n,) and (n, 4)"),
        ({"times": ["a"], "quaternions": np.ones((1, 4)) / 2}, "not numbers"),
        ({"times": [0.0], "quaternions": np.ones((1, 4)) * 1j}, "not numbers"),
        ({"times": np.array([None]), "quaternions": np.ones((1, 4))}, "not an NPZ file of plain"),
        ({"times": [], "quaternions": np.ones((0, 4))}, "no keyframes in it"),
    ],
)
def test_npz_refuses_other_arrays(tmp_path: Path, arrays: dict, what: str) -> None:
    np.savez(tmp_path / "k.npz", **arrays)
    assert what in refusal(tmp_path / "k.npz")


@pytest.mark.parametrize("content", [b"", b"t,qw\n", b"PK\x03\x04 broken", b"\x93NUMPY"])
def test_npz_refuses_other_files(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "k.npz").write_bytes(content)
    assert refusal(tmp_path / "k.npz") == ": not an NPZ file of plain arrays"


def test_npz_refuses_a_bare_array(tmp_path: Path) -> None:
    with (tmp_path / "k.npz").open("wb") as stream:
        np.save(stream, np.ones(3))
    assert refusal(tmp_path / "k.npz") == ": not an NPZ file of plain arrays"


def test_a_header_comes_first_only(tmp_path: Path) -> None:
    message = refusal(put(tmp_path, "k.csv", "0,1,0,0,0\nt,qw,qx,qy,qz\n"))
    assert message == ", line 2: t = 't' is not a number (1 row)"


@pytest.mark.parametrize("name", ["k.csv", "k.tum"])
@pytest.mark.parametrize("content", ["", "\n\n", "# only a comment\n"])
def test_empty_files_are_refused(tmp_path: Path, name: str, content: str) -> None:
    assert refusal(put(tmp_path, name, content)) == ": no keyframes in it"


def test_a_csv_of_a_header_alone_is_empty(tmp_path: Path) -> None:
    assert refusal(put(tmp_path, "k.csv", "t,qw,qx,qy,qz\n")) == ": no keyframes in it"


def test_missing_file_folder_binary_and_suffix_are_refused(tmp_path: Path) -> None:
    assert refusal(tmp_path / "k.csv") == ": cannot be read: No such file or directory"
    (tmp_path / "folder.csv").mkdir()
    assert refusal(tmp_path / "folder.csv") == ": cannot be read: Is a directory"
    (tmp_path / "k.tum").write_bytes(b"\xff\xfe\x00")
    assert refusal(tmp_path / "k.tum") == ": not a text file in UTF-8"
    assert "unknown suffix '.cvs': did you mean '.csv'?" in refusal(tmp_path / "k.cvs")
    assert "unknown suffix ''" in refusal(tmp_path / "k")


@pytest.mark.parametrize("name", ["k.csv", "k.txt"])
def test_faults_are_counted_by_kind(tmp_path: Path, name: str) -> None:
    rows = ["0", "1", "1", "1", "nan", "3", "2", "4", "4", "5", "1e999"]
    good, tail = ("1,0,0,0", "2,0,0,0") if name == "k.csv" else ("0 0 0 0 0 0 1", "0 0 0 0 0 0 2")
    separator = "," if name == "k.csv" else " "
    text = "".join(f"{t}{separator}{good}\n" for t in rows) + f"6{separator}{tail}\n"
    assert refusal(put(tmp_path, name, f"# made up\n\n{text}")) == (
        ", line 5: t = 1.0 repeats the stamp before it (the first of 3 rows); "
        "line 7: t holds no number (blank or nan) (1 row); "
        "line 9: t = 2.0 goes back behind 3.0 before it (1 row); "
        "line 13: t = inf is not a finite number (1 row); "
        "line 14: quaternion has norm 2, not 1 (within 0.001) (1 row)"
    )


@pytest.mark.parametrize("blank", [",,,,", "1.5,,,,", "1.5,nan,0,0,0", "1.5,1,0,NA,0", ", , ,,"])
def test_blank_rows_are_counted(tmp_path: Path, blank: str) -> None:
    text = f"0,1,0,0,0\n{blank}\n2,1,0,0,0\n{blank}\n{blank}\n3,1,0,0,0\n"
    message = refusal(put(tmp_path, "k.csv", text))
    assert message.startswith(", line 2: ")
    assert message.endswith(" holds no number (blank or nan) (the first of 3 rows)")
    assert "; " not in message  # gaps hide no fault and make none


def test_npz_faults_are_counted(tmp_path: Path) -> None:
    q = np.tile([1.0, 0, 0, 0], (6, 1))
    q[4:, 2] = np.nan
    np.savez(tmp_path / "k.npz", times=[0, 1, 1, 1, 2, 3], quaternions=q)
    assert refusal(tmp_path / "k.npz") == (
        ", row 2: t = 1.0 repeats the stamp before it (the first of 2 rows); "
        "row 4: qy holds no number (blank or nan) (the first of 2 rows)"
    )


# -- stamps -------------------------------------------------------------------------------------

EPOCH = 1_650_000_000_000_000_001
STAMPS = [EPOCH, EPOCH + 100, EPOCH + 300]


@pytest.mark.parametrize("suffix", [".csv", ".tum", ".npz"])
def test_integer_stamps_stay_integers(tmp_path: Path, suffix: str) -> None:
    given = Motion(np.array(STAMPS), QUATERNIONS[:3], POSITIONS[:3])
    write(tmp_path / f"k{suffix}", given)
    motion = read(tmp_path / f"k{suffix}")
    assert motion.stamps.dtype == np.int64
    assert motion.stamps.tolist() == STAMPS


@pytest.mark.parametrize("spelled", ["{}", "+{}", "{}.0", "{}.000", "{}e0", '"{}"'])
def test_stamps_are_exact_however_they_are_spelled(tmp_path: Path, spelled: str) -> None:
    text = "".join(f"{spelled.format(t)},1,0,0,0\n" for t in STAMPS)
    times = read(put(tmp_path, "k.csv", text)).stamps
    assert (times.dtype, times.tolist()) == (np.int64, STAMPS)


def test_other_times_are_floats(tmp_path: Path) -> None:
    for times in (["0", "1"], ["9007199254740992", "1e300"], ["0.5", "1650000000000000000"]):
        text = "".join(f"{t},1,0,0,0\n" for t in times)
        motion = read(put(tmp_path, "k.csv", text))
        np.testing.assert_array_equal(motion.stamps, list(map(float, times)))
        assert motion.stamps.dtype == float


@pytest.mark.parametrize("kind", [np.int32, np.int64, np.uint64, np.float32, np.float16])
def test_npz_takes_numbers_of_any_kind(tmp_path: Path, kind: type) -> None:
    q = np.array([[1, 0, 0, 0], [0, 1, 0, 0]])
    np.savez(tmp_path / "k.npz", times=np.array([3, 5], kind), quaternions=q.astype(kind))
    motion = read(tmp_path / "k.npz")
    assert (motion.stamps.dtype, motion.quaternions.dtype) == (float, float)
    np.testing.assert_array_equal(motion.stamps, [3, 5])
    np.testing.assert_array_equal(motion.quaternions[:, 0], q)


def test_stamps_beyond_64_bits_are_refused(tmp_path: Path) -> None:
    text = f"{2**63 - 1},1,0,0,0\n{2**63},1,0,0,0\n"
    message = refusal(put(tmp_path, "k.csv", text))
    assert message == f", line 2: t = {2**63} does not fit into 64 bits"
    times = np.array([1, 2**63], np.uint64)
    np.savez(tmp_path / "k.npz", times=times, quaternions=QUATERNIONS[:2])
    assert f"times[1] = {2**63}: beyond the range of int64" in refusal(tmp_path / "k.npz")


def test_stamps_that_float64_does_not_tell_apart_are_not_called_equal(tmp_path: Path) -> None:
    text = "1650000000.00000001,1,0,0,0\n1650000000.00000002,1,0,0,0\n"
    message = refusal(put(tmp_path, "k.csv", text))
    assert "float64 cannot tell them apart" in message
    assert "repeats" not in message
    text = "1650000000.5,1,0,0,0\n1650000000.50,1,0,0,0\n"
    assert "repeats the stamp before it" in refusal(put(tmp_path, "k.csv", text))


# -- writing ------------------------------------------------------------------------------------


def test_a_failed_write_leaves_the_old_file(tmp_path: Path) -> None:
    path = put(tmp_path, "k.csv", "precious")

    def fail_halfway() -> None:
        with replacing(path) as aside:
            aside.write_text("half")
            assert path.read_text() == "precious"
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail_halfway()
    assert path.read_text() == "precious"
    assert os.listdir(tmp_path) == ["k.csv"]


def test_writing_goes_through_links_and_keeps_devices(tmp_path: Path) -> None:
    target = put(tmp_path, "real.csv", "old")
    (tmp_path / "link.csv").symlink_to(target)
    write(tmp_path / "link.csv", Motion(TIMES, QUATERNIONS))
    assert (tmp_path / "link.csv").is_symlink()
    assert target.read_text().startswith("t,qw")
    with replacing(Path(os.devnull)) as aside:
        assert aside == Path(os.devnull)
    assert Path(os.devnull).is_char_device()


def test_a_file_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(MotionFileError, match=r"no/k\.csv: cannot be written: No such file"):
        write(tmp_path / "no" / "k.csv", Motion(TIMES, QUATERNIONS))
    with pytest.raises(MotionFileError, match="unknown suffix"):
        write(tmp_path / "k.json", Motion(TIMES, QUATERNIONS))


def test_blocks_of_rows_join(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(writing, "BLOCK", 3)
    write(tmp_path / "k.csv", Motion(TIMES, QUATERNIONS))
    np.testing.assert_array_equal(read(tmp_path / "k.csv").stamps, TIMES)


# -- motions ------------------------------------------------------------------------------------


def along(motion: Motion, stamps: np.ndarray, positions: str = "linear") -> np.ndarray:
    """Positions (m, 3) at stamps of a slerp curve through a body's motion."""
    x = sampled(motion.curve("slerp", positions=positions), stamps).positions
    assert x is not None
    return x[:, 0]


def test_positions_follow_linearly() -> None:
    motion = Motion(np.array([1e9, 1e9 + 2]), QUATERNIONS[:2], np.array([[0.0, 1, 2], [4, 1, 0]]))
    x = along(motion, np.array([1e9, 1e9 + 0.5, 1e9 + 2]))
    np.testing.assert_allclose(x, [[0, 1, 2], [1, 1, 1.5], [4, 1, 0]], atol=1e-15)
    bare = Motion(TIMES, QUATERNIONS)
    assert sampled(bare.curve("slerp"), TIMES).positions is None


@pytest.mark.parametrize("spacing", [1.0, 1e-3])
def test_positions_follow_linearly_however_far_apart(spacing: float) -> None:
    far = np.array([[1e308, -1.7e308, 1e308], [-1e308, 1.7e308, 1e308], [1e308, 0.1, 0.3]])
    motion = Motion(np.arange(3) * spacing, QUATERNIONS[:3], far)
    x = along(motion, np.arange(9) * (spacing / 4))
    np.testing.assert_allclose(x[:5, 0], [1e308, 5e307, 0, -5e307, -1e308], atol=1e293)
    np.testing.assert_allclose(x[:5, 1], [-1.7e308, -8.5e307, 0, 8.5e307, 1.7e308], atol=1e293)
    np.testing.assert_array_equal(x[:5, 2], 1e308)
    np.testing.assert_array_equal(x[::4], far)


@pytest.mark.parametrize("positions", ["catmull-rom", "cubic", "local-quintic", "quartic"])
def test_smooth_positions_of_any_size_are_finite(positions: str) -> None:
    far = np.array([[1e307, 0, -1e307], [-1e307, 1, 1e307], [1e307, 2, 1e307], [1e307, 4, 0]])
    x = along(Motion(np.arange(4) * 1e-3, QUATERNIONS, far), np.arange(7) * 5e-4, positions)
    np.testing.assert_allclose(x[::2], far, rtol=1e-12, atol=1e295)
    assert np.isfinite(x).all()


def test_positions_follow_integer_stamps_exactly() -> None:
    motion = Motion(
        np.array(STAMPS), QUATERNIONS[:3], np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]])
    )
    x = along(motion, np.array([EPOCH, EPOCH + 150, EPOCH + 201]))
    np.testing.assert_array_equal(x[:, 0], [0, 1.5, 2.01])


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_repeated_first_orientation_is_the_return(sign: float) -> None:
    times, q = (
        np.array([0.0, 1, 5]),
        np.array([QUATERNIONS[0], QUATERNIONS[1], sign * QUATERNIONS[0]]),
    )
    closed = returning(Motion(times, q, POSITIONS[:3]))
    np.testing.assert_array_equal(closed.stamps, times)
    np.testing.assert_array_equal(closed.quaternions[:, 0], q[:2])
    np.testing.assert_array_equal(closed.positions[:, 0], POSITIONS[:3])


def test_uniform_times_return_after_one_more_step() -> None:
    closed = returning(Motion(np.array([1.0, 1.5, 2.0]), QUATERNIONS[:3], POSITIONS[:3]))
    np.testing.assert_allclose(closed.stamps, [1, 1.5, 2, 2.5])
    np.testing.assert_array_equal(closed.quaternions[:, 0], QUATERNIONS[:3])
    np.testing.assert_array_equal(closed.positions[-1, 0], POSITIONS[0])


def test_a_last_row_near_the_first_is_told_apart(tmp_path: Path) -> None:
    half = 0.5e-4
    nearly = [np.cos(half), np.sin(half), 0, 0]
    q = np.array([QUATERNIONS[0], QUATERNIONS[1], QUATERNIONS[2], nearly])
    closed = returning(Motion(np.arange(4.0), q))
    assert closed.note == (
        "closed: the last row is 0.0057 degrees from the first orientation; it is kept as a "
        "keyframe, and the curve returns one step later (to return at that row, make it equal to the first)"
    )
    assert (len(closed.stamps), len(closed.quaternions)) == (5, 4)
    with pytest.raises(ValueError, match=r"its return; the last row is 0\.0057 degrees from"):
        returning(Motion(np.array([0.0, 1, 2, 5]), q))


def test_small_steps_are_not_taken_for_a_return() -> None:
    angles = np.radians([0.0, 0.5, 1.0, 0.5]) / 2
    q = np.stack([np.cos(angles), np.sin(angles), 0 * angles, 0 * angles], axis=1)
    assert returning(Motion(np.arange(4.0), q)).note == ""
    assert returning(Motion(np.arange(3.0), QUATERNIONS[:3])).note == ""


def test_a_rounded_return_is_the_return() -> None:
    q = np.array([[0.71, 0, 0, 0.7099], [0.8, 0.6, 0, 0], [0.71, 0, 0, 0.7099]]) / 1.004
    q[2] *= 1.0005
    assert len(returning(Motion(np.array([0.0, 1, 5]), q)).quaternions) == 2


def test_integer_stamps_return_after_one_more_step() -> None:
    closed = returning(Motion(np.array([EPOCH, EPOCH + 10, EPOCH + 20]), QUATERNIONS[:3]))
    assert closed.stamps.dtype == np.int64
    assert closed.stamps[-1] == EPOCH + 30
    with pytest.raises(ValueError, match="beyond 64-bit integers"):
        returning(Motion(np.array([2**63 - 2, 2**63 - 1]), QUATERNIONS[:2]))


def test_uneven_times_without_a_return_are_refused() -> None:
    with pytest.raises(ValueError, match="the last row must repeat the first orientation"):
        returning(Motion(TIMES, QUATERNIONS))


# -- whatever else comes ------------------------------------------------------------------------

SEEDS = [
    "t,qw,qx,qy,qz\n0,1,0,0,0\n1,0.8,0.6,0,0\n",
    "# timestamp tx ty tz qx qy qz qw\n0 1 2 3 0 0 0 1\n1 1 2 3 0.6 0 0 0.8\n",
    "#timestamp [ns],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []\n1650000000000000000,1,0,0,0\n",
    '"t";"qw";"qx";"qy";"qz"\n0;1;0;0;0\n1;0,8;0,6;0;0\n',
]
TOKENS = [*"\n\r\t,; #\"'[]()|%:_.-tw\0\x1c\x85é٣", "nan", "1e999", "1_0", "qw", "0x1", "9" * 5000]
TOKENS += ["1e18", "1e-99999999999999999999", "\ufeff"]


def check_or_told(path: Path) -> str:
    """The refusal of a file, or "" where what is read holds together."""
    try:
        times = read(path).stamps
    except MotionFileError as error:
        return str(error)
    assert np.all(times[1:] > times[:-1])
    return ""


@pytest.mark.parametrize("seed", range(4))
def test_any_text_is_read_or_refused_in_a_sentence(tmp_path: Path, seed: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(100):
        text = list(rng.choice(SEEDS))
        for _ in range(rng.integers(1, 6)):
            at = rng.integers(len(text) + 1)
            text[at : at + rng.integers(0, 3)] = [] if rng.random() < 0.3 else rng.choice(TOKENS)
        path = put(tmp_path, str(rng.choice(["k.csv", "k.txt"])), "".join(text))
        told = check_or_told(path)
        assert "\n" not in told
        assert not told or told.startswith(str(path))


@pytest.mark.parametrize("compress", [np.savez, np.savez_compressed])
def test_any_bytes_are_read_or_refused_in_a_sentence(tmp_path: Path, compress: Any) -> None:
    rng, path = np.random.default_rng(0), tmp_path / "k.npz"
    compress(path, times=[0.0, 1.0], quaternions=[[1.0, 0, 0, 0], [0.8, 0.6, 0, 0]])
    whole = np.frombuffer(path.read_bytes(), np.uint8)
    for _ in range(200):
        damaged = whole.copy()
        damaged[rng.integers(len(whole), size=rng.integers(1, 4))] = rng.integers(256)
        path.write_bytes(damaged.tobytes())
        assert "\n" not in check_or_told(path)
