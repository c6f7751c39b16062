"""Keyframe files: three formats, every malformed line, atomic writing."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from quatspline.trajectories import files
from quatspline.trajectories.files import KeyframeFileError, Motion, read, write

TIMES = np.array([0.0, 0.1, 1.0 / 3.0, 1305031102.175800085])
QUATERNIONS = np.array([[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0, -0.8, 0], [0.5, 0.5, 0.5, -0.5]])
POSITIONS = np.array([[0, 0, 0], [1, 2, 3], [0.1, 0.2, 0.3], [-1e-17, 5, 1e300]])


def put(folder: Path, name: str, content: str) -> Path:
    path = folder / name
    path.write_text(content, encoding="utf-8")
    return path


def refusal(path: Path) -> str:
    with pytest.raises(KeyframeFileError) as caught:
        read(path)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(str(path))
    return message.removeprefix(str(path))


# -- what is read -------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".csv", ".tum", ".txt", ".npz", ".CSV", ".Npz"])
@pytest.mark.parametrize("positions", [None, POSITIONS])
def test_what_is_written_is_read_back_exactly(
    tmp_path: Path, suffix: str, positions: np.ndarray | None
) -> None:
    path = tmp_path / f"motion{suffix}"
    write(path, Motion(TIMES, QUATERNIONS, positions))
    motion = read(path)
    np.testing.assert_array_equal(motion.times, TIMES)
    np.testing.assert_array_equal(motion.quaternions, QUATERNIONS)
    if suffix.lower() in (".tum", ".txt"):
        expected = np.zeros((4, 3)) if positions is None else positions
        np.testing.assert_array_equal(motion.positions, expected)
    else:
        assert motion.positions is None
    assert os.listdir(tmp_path) == [path.name]


def test_csv_without_a_header_is_in_the_documented_order(tmp_path: Path) -> None:
    motion = read(put(tmp_path, "k.csv", "0,0.8,0.6,0,0\n1,0.6,0,0.8,0\n"))
    np.testing.assert_array_equal(motion.times, [0, 1])
    np.testing.assert_array_equal(motion.quaternions, [[0.8, 0.6, 0, 0], [0.6, 0, 0.8, 0]])


def test_csv_header_names_columns_in_any_order_among_others(tmp_path: Path) -> None:
    text = (
        "\ufeff# a comment\n\n"
        '"qz", x, QX ,y,label,qy,z,T,qw\n'
        "0,9,0.6,9,start,0,9,-1.5,0.8\n"
        "  # another\n"
        "0,9,0,9,,0.8,9,2e0,0.6\n"
    )
    motion = read(put(tmp_path, "k.csv", text))
    np.testing.assert_array_equal(motion.times, [-1.5, 2])
    np.testing.assert_array_equal(motion.quaternions, [[0.8, 0.6, 0, 0], [0.6, 0, 0.8, 0]])
    assert motion.positions is None


def test_tum_is_scalar_last_with_positions(tmp_path: Path) -> None:
    text = "# timestamp tx ty tz qx qy qz qw\n0 1 2 3 0.6 0 0 0.8\r\n\n 1\t4 5  6 0 0 0 -1 \n"
    motion = read(put(tmp_path, "k.txt", text))
    np.testing.assert_array_equal(motion.quaternions, [[0.8, 0.6, 0, 0], [-1, 0, 0, 0]])
    np.testing.assert_array_equal(motion.positions, [[1, 2, 3], [4, 5, 6]])


def test_a_norm_within_the_tolerance_is_read_as_given(tmp_path: Path) -> None:
    motion = read(put(tmp_path, "k.csv", "0,1.0005,0,0,0\n1,1,0,0,0\n"))
    assert motion.quaternions[0, 0] == 1.0005


# -- what is refused ----------------------------------------------------------------------------

LINES = {
    "few fields": ("2,1,0,0", "expected 5 fields, found 4"),
    "many fields": ("2,1,0,0,0,0", "expected 5 fields, found 6"),
    "text": ("2,1,0,none,0", "qy = 'none' is not a number"),
    "empty field": ("2,1,0,,0", "qy = '' is not a number"),
    "underscore": ("2,1,0,0_0,0", "qy = '0_0' is not a number"),
    "nan": ("2,1,0,nan,0", "qy = nan is not a finite number"),
    "nan time": ("NaN,1,0,0,0", "t = NaN is not a finite number"),
    "infinity": ("1e999,1,0,0,0", "t = 1e999 is not a finite number"),
    "norm": ("2,1,0,0.1,0", "quaternion has norm 1.00499"),
    "zero": ("2,0,0,0,0", "quaternion has norm 0"),
    "equal time": ("1,1,0,0,0", "t = 1.0 does not exceed 1.0"),
    "earlier time": ("0.5,1,0,0,0", "t = 0.5 does not exceed 1.0"),
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
    if "fields" in what or "''" in what:  # blanks separate: an empty field is no field
        what = f"expected 8 fields, found {len(fields.split())}"
    assert message.startswith(f", line 4: {what}")


def test_tum_refuses_a_position_that_is_no_number(tmp_path: Path) -> None:
    assert (
        refusal(put(tmp_path, "k.tum", "0 1 x 3 0 0 0 1")) == ", line 1: ty = 'x' is not a number"
    )


@pytest.mark.parametrize("row", [0, 1, 2])
@pytest.mark.parametrize(
    ("time", "quaternion", "what"),
    [
        (np.nan, [1, 0, 0, 0], "t = nan is not a finite number"),
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
    assert message == f", row 2: t = {float(times[2])} does not exceed 1.0 before it"


@pytest.mark.parametrize("last", [3.0, 2.0, np.nan, np.inf])
def test_npz_of_a_closed_motion_has_one_time_more(tmp_path: Path, last: float) -> None:
    q = np.tile([1.0, 0, 0, 0], (3, 1))
    path = tmp_path / "k.npz"
    np.savez(path, times=[0.0, 1.0, 2.0, last], quaternions=q)
    if last == 3.0:
        motion = read(path)
        assert (motion.times.shape, motion.quaternions.shape) == ((4,), (3, 4))
        assert motion.returning() is motion
    else:
        assert refusal(path).startswith(", row 3: t = ")


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


@pytest.mark.parametrize(
    ("header", "what"),
    [
        ("t,qw,qx,qy", "no column 'qz' in the header: did you mean 'qy'?"),
        ("time,qw,qx,qy,qz", "no column 't' in the header: known: "),
        ("t,w,x,y,z", "no column 'qw' in the header: did you mean 'w'?"),
        ("a,b,c,d,e", "no column 't' in the header"),
        ("t,qw,qx,qy,qz,qw", "two columns 'qw' in the header"),
    ],
)
def test_csv_refuses_a_header_without_the_columns(tmp_path: Path, header: str, what: str) -> None:
    message = refusal(put(tmp_path, "k.csv", f"# first\n{header}\n0,1,0,0,0\n"))
    assert message.startswith(f", line 2: {what}")


def test_a_header_comes_first_only(tmp_path: Path) -> None:
    message = refusal(put(tmp_path, "k.csv", "0,1,0,0,0\nt,qw,qx,qy,qz\n"))
    assert message == ", line 2: t = 't' is not a number"


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


# -- writing ------------------------------------------------------------------------------------


def test_a_failed_write_leaves_the_old_file(tmp_path: Path) -> None:
    path = put(tmp_path, "k.csv", "precious")

    def fail_halfway() -> None:
        with files.replacing(path) as aside:
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
    with files.replacing(Path(os.devnull)) as aside:
        assert aside == Path(os.devnull)
    assert Path(os.devnull).is_char_device()


def test_a_file_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(KeyframeFileError, match=r"no/k\.csv: cannot be written: No such file"):
        write(tmp_path / "no" / "k.csv", Motion(TIMES, QUATERNIONS))
    with pytest.raises(KeyframeFileError, match="unknown suffix"):
        write(tmp_path / "k.json", Motion(TIMES, QUATERNIONS))


def test_blocks_of_rows_join(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(files, "BLOCK", 3)
    write(tmp_path / "k.csv", Motion(TIMES, QUATERNIONS))
    np.testing.assert_array_equal(read(tmp_path / "k.csv").times, TIMES)


# -- motions ------------------------------------------------------------------------------------


def test_positions_follow_linearly() -> None:
    motion = Motion(np.array([1e9, 1e9 + 2]), QUATERNIONS[:2], np.array([[0.0, 1, 2], [4, 1, 0]]))
    sampled = motion.sampled(np.array([1e9, 1e9 + 0.5, 1e9 + 2]), QUATERNIONS[:3])
    np.testing.assert_allclose(sampled.positions, [[0, 1, 2], [1, 1, 1.5], [4, 1, 0]], atol=1e-15)
    assert Motion(TIMES, QUATERNIONS).sampled(TIMES, QUATERNIONS).positions is None


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_repeated_first_orientation_is_the_return(sign: float) -> None:
    times, q = (
        np.array([0.0, 1, 5]),
        np.array([QUATERNIONS[0], QUATERNIONS[1], sign * QUATERNIONS[0]]),
    )
    closed = Motion(times, q, POSITIONS[:3]).returning()
    np.testing.assert_array_equal(closed.times, times)
    np.testing.assert_array_equal(closed.quaternions, q[:2])
    np.testing.assert_array_equal(closed.positions, POSITIONS[:3])


def test_uniform_times_return_after_one_more_step() -> None:
    closed = Motion(np.array([1.0, 1.5, 2.0]), QUATERNIONS[:3], POSITIONS[:3]).returning()
    np.testing.assert_allclose(closed.times, [1, 1.5, 2, 2.5])
    np.testing.assert_array_equal(closed.quaternions, QUATERNIONS[:3])
    np.testing.assert_array_equal(closed.positions[-1], POSITIONS[0])


def test_uneven_times_without_a_return_are_refused() -> None:
    with pytest.raises(ValueError, match="the last row must repeat the first orientation"):
        Motion(TIMES, QUATERNIONS).returning()
