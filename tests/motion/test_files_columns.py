"""Columns of keyframe files: names in the spellings of many tools, separators, what contradicts itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from keyfiles import put, refusal

from quatspline.motion.files import Motion, read

ROWS = np.array([[0.0, 1, 2, 3, 0.8, 0.6, 0, 0], [1.0, 4, 5, 6, 0.36, 0.48, 0.64, 0.48]])
"""Times, positions, w, x, y, z: no two columns alike, so that none can be swapped unseen."""

PARTS = dict(zip("txyzWXYZ", ROWS.T, strict=True))


def table(order: str, separator: str = ",", comma: bool = False) -> str:
    """Rows with columns in the order of letters: t, x, y, z, and W, X, Y, Z of the quaternion."""
    rows = zip(*(PARTS[letter].tolist() for letter in order), strict=True)
    lines = [separator.join(f"{value:g}" for value in row) for row in rows]
    text = "\n".join(lines) + "\n"
    return text.replace(".", ",") if comma else text


def taken(folder: Path, text: str, name: str = "k.csv") -> Motion:
    return read(put(folder, name, text))


def check(motion: Motion, positions: bool) -> None:
    np.testing.assert_array_equal(motion.stamps, ROWS[:, 0])
    np.testing.assert_array_equal(motion.quaternions[:, 0], ROWS[:, 4:])
    if positions:
        np.testing.assert_array_equal(motion.positions[:, 0], ROWS[:, 1:4])
    else:
        assert motion.positions is None


def refused(folder: Path, text: str, name: str = "k.csv") -> str:
    return refusal(put(folder, name, text))


# -- spellings ----------------------------------------------------------------------------------

SPELLINGS = [
    ("t,qx,qy,qz,qw", "tXYZW"),
    ("time,x,y,z,w", "tXYZW"),
    ("t,x,y,z,qw,qx,qy,qz", "txyzWXYZ"),
    ("w,x,y,z,Time [s],px,py,pz", "WXYZtxyz"),
    ("timestamp_ns,orientation.x,orientation.y,orientation.z,orientation.w", "tXYZW"),
    ("Timestamp,Q_W,Q_X,Q_Y,Q_Z", "tWXYZ"),
    ("time (s),quatW,quatX,quatY,quatZ", "tWXYZ"),
    ("TIME_STAMP,quat_w,quat_x,quat_y,quat_z,pos_x,pos_y,pos_z", "tWXYZxyz"),
    (
        "t,rotation.w,rotation.x,rotation.y,rotation.z,translation.x,translation.y,translation.z",
        "tWXYZxyz",
    ),
    ("t,p_x [m],p_y [m],p_z [m],q[w],q[x],q[y],q[z]", "txyzWXYZ"),
    (
        "timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],"
        "q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z []",
        "txyzWXYZ",
    ),
    ("t,tx_m,ty_m,tz_m,pelvis_qx,pelvis_qy,pelvis_qz,pelvis_qw", "txyzXYZW"),
    ("head_z,head_y,head_x,head_w,t", "ZYXWt"),
    (
        "%time,field.pose.position.x,field.pose.position.y,field.pose.position.z,"
        "field.pose.orientation.x,field.pose.orientation.y,field.pose.orientation.z,"
        "field.pose.orientation.w",
        "txyzXYZW",
    ),
    (
        "header.stamp,pose.pose.position.x,pose.pose.position.y,pose.pose.position.z,"
        "pose.pose.orientation.w,pose.pose.orientation.x,pose.pose.orientation.y,"
        "pose.pose.orientation.z",
        "txyzWXYZ",
    ),
]


@pytest.mark.parametrize("mark", ["", "#", "# ", "## columns: "])
@pytest.mark.parametrize("name", ["k.csv", "k.txt"])
@pytest.mark.parametrize(("header", "order"), SPELLINGS)
def test_columns_are_found_by_name(
    tmp_path: Path, header: str, order: str, name: str, mark: str
) -> None:
    check(taken(tmp_path, f"{mark}{header}\n{table(order)}", name), "x" in order)


@pytest.mark.parametrize("separator", [",", ";", "\t", " ", ", ", "; ", "  ", " \t ", "|"])
@pytest.mark.parametrize("name", ["k.csv", "k.tum"])
def test_fields_are_separated_by_what_separates_them(
    tmp_path: Path, separator: str, name: str
) -> None:
    order = "tWXYZ" if name == "k.csv" else "txyzXYZW"
    check(taken(tmp_path, table(order, separator), name), name == "k.tum")
    header = separator.join(["time", "q_z", "q_y", "q_x", "q_w"])
    check(taken(tmp_path, f"{header}\n{table('tZYXW', separator)}", name), False)
    check(taken(tmp_path, f"# {header}\n{table('tZYXW', separator)}", name), False)


@pytest.mark.parametrize("separator", [";", "\t", " ", "; ", "|"])
@pytest.mark.parametrize("header", ["", "time{0}qw{0}qx{0}qy{0}qz\n"])
def test_decimal_commas(tmp_path: Path, separator: str, header: str) -> None:
    text = header.format(separator) + table("tWXYZ", separator, comma=True)
    check(taken(tmp_path, text), False)


def test_quoted_fields(tmp_path: Path) -> None:
    text = (
        '"t","label","qw","qx","qy","qz"\n'
        '"0","a, ""b""","0.8","0.6","0","0"\n'
        '1,"two\nlines",0.36,"0.48",0.64,0.48\n'
    )
    check(taken(tmp_path, text), False)
    check(taken(tmp_path, '"0,0" "0,8" "0,6" 0 0\n"1" "0,36" "0,48" "0,64" "0,48"\n'), False)
    check(taken(tmp_path, '"0,0","0,8","0,6",0,0\n"1","0,36","0,48","0,64","0,48"\n'), False)


def test_names_with_blanks_between_tabs(tmp_path: Path) -> None:
    check(taken(tmp_path, f"time stamp\tq w\tq x\tq y\tq z\n{table('tWXYZ', chr(9))}"), False)


# -- headers and comments -----------------------------------------------------------------------


def test_a_header_may_be_separated_otherwise_than_rows(tmp_path: Path) -> None:
    check(taken(tmp_path, f"# timestamp tx ty tz qw qx qy qz\n{table('txyzWXYZ')}", "k.txt"), True)
    check(taken(tmp_path, f"#t,qz,qy,qx,qw\n{table('tZYXW', ' ')}"), False)


@pytest.mark.parametrize(
    "comment",
    [
        "",
        "#",
        "#,,",
        "recorded on a Tuesday, x forward, y left, z up",
        "file: 'rgbd_dataset_freiburg1_xyz.bag'",
        "time in seconds, quaternion scalar first",
        "t and w",
        "a b c d e",
        "1,2,3,4,5",
        "quaternions: w x y z",
        "w, x, y, z",
        "recorded by qw, on qx day, with qy and qz",
        "all times are in seconds",
        "time is measured in seconds",
        "distance between x and w",
        "quaternion norm 1, w >= 0",
        "axes x y z, weight w",
        "I, John, kept this real",
        "last w was dropped",
        "http://example.com/x/y/z",
        "timestamp, orientation (w x y z)",
        "unit quaternions (w, x, y, z), t in s",
        "quat: w first, then x, y and z",
        "stored as wxyz",
        "scalar-first",
    ],
)
@pytest.mark.parametrize("mark", ["# ", "%", "// ", "\ufeff\ufeff# ", '"#'])
def test_prose_stays_a_comment(tmp_path: Path, comment: str, mark: str) -> None:
    check(taken(tmp_path, f"{mark}{comment}\n{table('tWXYZ')}"), False)


@pytest.mark.parametrize(
    "comment",
    [
        "time stamps and poses of the left camera",
        "recorded by qw, on qx day, with qy and qz",
        "timestamp, position, orientation (x y z w)",
        "poses as x y z and quaternions x y z w",
        "t xyz xyzw",
        "scalar last",
    ],
)
def test_prose_stays_a_comment_beside_scalar_last(tmp_path: Path, comment: str) -> None:
    check(taken(tmp_path, f"# {comment}\n{table('txyzXYZW', ' ')}", "k.txt"), True)


@pytest.mark.parametrize(
    "comment",
    [
        "# t,qx,qy,qz,qw # from recorder",
        "# from recorder # t,qx,qy,qz,qw",
        "# t,qx,qy,qz,qw // from recorder",
        "# t,qx,qy,qz,qw (from recorder)",
        "# t,qx,qy,qz,qw from recorder",
        "# t,qx,qy,qz,qw, recorded by me",
        "# format: timestamp, orientation (qx qy qz qw)",
        "# timestamp, orientation (x y z w)",
        "# timestamp; orientation [x, y, z, w]",
        "# (t, qx, qy, qz, qw)",
        "# ['t', 'qx', 'qy', 'qz', 'qw']",
        "# Time  Qx  Qy  Qz  Qs",
        "# t,qi,qj,qk,qr",
        "# time,quat_i,quat_j,quat_k,quat_real",
        "# t,i,j,k,scalar",
        "# t, q[i], q[j], q[k], q[real]",
        "# t, qxyz, qw",
        "# t, quat xyzw",
        "# t,qx,qy,qz,qw,",
        "# t,qx,qy,qz,qw,,,",
        "# |t|qx|qy|qz|qw|",
        "# columns are t, qx, qy, qz and qw",
        "% t,qx,qy,qz,qw",
        "% made up\n%% t qx qy qz qw",
        "// t,qx,qy,qz,qw",
        '"# t","qx","qy","qz","qw"',
        '"# t,qx,qy,qz,qw",,,,',
        "\ufeff\ufeff# t,qx,qy,qz,qw",
        "# order: x y z w\n# t,qx,qy,qz,qw",
        "t,qi,qj,qk,qr",
        "i;j;k;real;t",
    ],
)
def test_names_are_honoured_however_a_comment_lists_them(tmp_path: Path, comment: str) -> None:
    order = "XYZWt" if comment.startswith("i") else "tXYZW"
    check(taken(tmp_path, f"{comment}\n{table(order)}"), False)


@pytest.mark.parametrize(
    "comment",
    [
        "timestamp, position (x y z), orientation (w x y z)",
        "(timestamp) (x y z) (qw qx qy qz)",
        "time, p (x, y, z), q (w, x, y, z)",
        "t, position xyz, quaternion wxyz",
        "t x y z qw qi qj qk",
        "t x y z w i j k",
        "Time, X, Y, Z, Qr, Qi, Qj, Qk",
        "TUM format: timestamp tx ty tz qw qx qy qz, in metres",
    ],
)
def test_names_of_poses_are_honoured_however_listed(tmp_path: Path, comment: str) -> None:
    check(taken(tmp_path, f"# {comment}\n{table('txyzWXYZ', ' ')}", "k.txt"), True)


OTHER_ORDERS = [
    "order: qi qj qk qr",
    "x y z w",
    "quaternions: x, y, z, w",
    "quaternion [x, y, z, w]",
    "the quaternion is xyzw",
    "stored as x/y/z/w",
    "qx, qy, qz and then qw",
    "qx..qw",
    "i,j,k,real",
    "t, pose, orientation (x y z w)",
    "x — y — z — w",
]


@pytest.mark.parametrize("comment", OTHER_ORDERS)
@pytest.mark.parametrize("header", ["", "t,qw,qx,qy,qz\n", "# t,qr,qi,qj,qk\n"])
@pytest.mark.parametrize("behind", [False, True])
def test_an_order_that_contradicts_the_columns_is_refused(
    tmp_path: Path, comment: str, header: str, behind: bool
) -> None:
    lines = f"{header}# {comment}\n" if behind else f"# {comment}\n{header}"
    message = refused(tmp_path, lines + table("tWXYZ"))
    assert message.startswith(f", line {1 + (behind and bool(header))}: the comment has the quater")
    assert message.endswith(", w, but the columns are read as w, x, y, z")


@pytest.mark.parametrize(
    ("comment", "name"),
    [
        ("scalar last", "k.csv"),
        ("the real part comes last", "k.csv"),
        ("quaternions, w-last", "k.csv"),
        ("the vector part is first", "k.csv"),
        ("scalar first", "k.txt"),
        ("qw is first", "k.txt"),
    ],
)
def test_a_place_of_the_scalar_that_contradicts_the_format_is_refused(
    tmp_path: Path, comment: str, name: str
) -> None:
    rows = table("tWXYZ" if name == "k.csv" else "txyzXYZW")
    place = "last" if name == "k.csv" else "first"
    what = f": the comment says that the scalar is {place}, but"
    assert what in refused(tmp_path, f"# {comment}\n{rows}", name)


@pytest.mark.parametrize("item", ["{}", "column {n}: {}", "{n}. {}", "{}: quaternion {}", "{} [-]"])
def test_columns_listed_one_below_another_are_held_against_the_rows(
    tmp_path: Path, item: str
) -> None:
    def listed(*names: str) -> str:
        return "".join(f"# {item.format(name, name, n=i)}\n" for i, name in enumerate(names, 1))

    check(taken(tmp_path, listed("t", "qw", "qx", "qy", "qz") + table("tWXYZ")), False)
    message = refused(tmp_path, listed("t", "qx", "qy", "qz", "qw") + table("tWXYZ"))
    assert message.startswith(", line 5: the comment has the quaternion in the order x, y, z, w")
    check(taken(tmp_path, "# x is up\n# y is left\n#\n# z\n# w\n" + table("tWXYZ")), False)


def test_names_overrule_a_place_of_the_scalar(tmp_path: Path) -> None:
    check(taken(tmp_path, f"# was scalar last\nt,qw,qx,qy,qz\n{table('tWXYZ')}"), False)
    check(taken(tmp_path, f"# t,qx,qy,qz,qw\n# was scalar first\n{table('tXYZW')}"), False)


@pytest.mark.parametrize(
    ("comment", "what"),
    [
        ("timestamp,q0,q1,q2,q3", "'q0', 'q1', 'q2', 'q3': numbers do not say which"),
        ("timestamp q1 q2 q3 q4", "'q1', 'q2', 'q3', 'q4': numbers do not say which"),
        ("t, quaternion (q0 q1 q2 q3)", "'q0', 'q1', 'q2', 'q3': numbers do not say which"),
        ("t,a,b,c,d", "no quaternion, such as 'qw'"),
        ("time;vx;vy;vz;s", "no quaternion, such as 'qw'"),
    ],
)
def test_a_comment_as_wide_as_rows_that_names_no_columns_is_refused(
    tmp_path: Path, comment: str, what: str
) -> None:
    assert refused(tmp_path, f"# {comment}\n{table('tWXYZ')}").startswith(f", line 1: {what}")
    check(taken(tmp_path, f"# {comment}\nt,qw,qx,qy,qz\n{table('tWXYZ')}"), False)


def test_columns_that_only_look_like_parts_of_a_quaternion_are_left(tmp_path: Path) -> None:
    header = "i,t,tx,ty,tz,qw,qx,qy,qz,rot_r,rot_p,real,s\n"
    text = "".join(f"5,{line},1,2,3,4\n" for line in table("txyzWXYZ").splitlines())
    motion = taken(tmp_path, header + text)
    check(motion, True)
    assert motion.unread == ("i", "rot_r", "rot_p", "real", "s")


@pytest.mark.parametrize("label", ['"#1"', "%1", "//host/1"])
def test_rows_that_begin_with_a_label_are_no_comments(tmp_path: Path, label: str) -> None:
    rows = "".join(f"{label},{line}\n" for line in table("tWXYZ").splitlines())
    check(taken(tmp_path, f"label,t,qw,qx,qy,qz\n{rows}"), False)


def test_comments_among_the_data_are_no_header(tmp_path: Path) -> None:
    first, second = table("tWXYZ").splitlines()
    check(taken(tmp_path, f"{first}\n# t,qx,qy,qz,qw\n{second}\n"), False)


def test_a_comment_and_a_header_that_agree(tmp_path: Path) -> None:
    names = "t,qx,qy,qz,qw"
    check(taken(tmp_path, f"# made up\n# {names}\n{names}\n{table('tXYZW')}"), False)


def test_names_among_prose_are_honoured(tmp_path: Path) -> None:
    check(taken(tmp_path, f"# columns are t qx qy qz qw\n{table('tXYZW', ' ')}"), False)


def test_positions_and_other_columns_are_told_apart(tmp_path: Path) -> None:
    header = "t,tx,ty,tz,w,x,y,z,v_x [m/s],v_y [m/s],label"
    text = "".join(f"{line},7,8,a\n" for line in table("txyzWXYZ").splitlines())
    motion = taken(tmp_path, f"{header}\n{text}")
    check(motion, True)
    assert motion.unread == ("v_x [m/s]", "v_y [m/s]", "label")


CONTRADICTIONS = {
    "w twice": ("t,qw,qx,qy,qz,qw", "'qw', 'qw': two columns of one name"),
    "two spellings": ("t,qw,q_w,qx,qy,qz", "'qw', 'q_w': two columns of one name"),
    "two quaternions": ("t,w,x,y,z,qw,qx,qy,qz", "'w', 'qw': more than one column may be the"),
    "two bodies": ("t,a_qw,a_qx,a_qy,a_qz,b_qw,b_qx,b_qy,b_qz", "'a_qw', 'b_qw': more than one"),
    "half of another": ("t,x,y,z,w,qx,qy,qz", "'x', 'qx': more than one column may be"),
    "lone w": ("t,qw,qx,qy,qz,quat_w", "'qw', 'quat_w': more than one column may be"),
    "no z": (
        "t,qw,qx,qy",
        "no column of the quaternion's z in the header, beside 'qw', 'qx', 'qy'",
    ),
    "mixed": ("t,w,qx,qy,qz", "no column of the quaternion's w in the header, beside 'qx', 'qy'"),
    "no quaternion": ("t,a,b,c,d", "no quaternion, such as 'qw', 'qx', 'qy', 'qz', in the header"),
    "numbered": ("t,q0,q1,q2,q3", "'q0', 'q1', 'q2', 'q3': numbers do not say which of them is w"),
    "indexed": (
        "t,q[0],q[1],q[2],q[3]",
        "'q[0]', 'q[1]', 'q[2]', 'q[3]': numbers do not say which of them is w",
    ),
    "no time": ("frame,qw,qx,qy,qz", "no column of times, such as 't', in the header: 'frame'"),
    "two times": ("time,timestamp_ns,qw,qx,qy,qz", "'time', 'timestamp_ns': more than one column"),
    "split time": ("secs,nsecs,qw,qx,qy,qz", "'secs', 'nsecs': more than one column of times"),
    "two positions": ("t,x,y,z,tx,ty,tz,qw,qx,qy,qz", "'x', 'tx': more than one column may be the"),
    "no tz": ("t,tx,ty,qw,qx,qy,qz", "no column of the position's z in the header, beside 'tx'"),
    "nothing known": ("a,b,c,d,e", "no column of times"),
}


@pytest.mark.parametrize(("header", "what"), CONTRADICTIONS.values(), ids=CONTRADICTIONS)
def test_a_header_that_contradicts_itself_is_refused(
    tmp_path: Path, header: str, what: str
) -> None:
    row = ",".join(["0", *["1"] * header.count(",")])
    message = refused(tmp_path, f"# first\n{header}\n{row}\n")
    assert message.startswith(f", line 2: {what}")


@pytest.mark.parametrize(
    ("lines", "number", "what"),
    [
        ("# t,qx,qy,qz,qw\nt,qw,qx,qy,qz", 1, "the comment and another header name the columns"),
        ("# t,qx,qy,qz,qw\n# t,qw,qx,qy,qz", 2, "the comment and another header name the columns"),
        ("# t,qx,qy,qz", 1, "the comment names 4 columns, but the rows have 5 fields"),
        ("# t,qx,qy,qz,qw,label", 1, "the comment names 6 columns, but the rows have 5 fields"),
        ("# t,qx,qy,qz,px", 1, "no column of the quaternion's w in the header"),
        ("t,qw,qx,qy,qz,label", 2, "expected 6 fields, found 5 (separated by commas)"),
    ],
)
def test_headers_that_contradict_the_rows_are_refused(
    tmp_path: Path, lines: str, number: int, what: str
) -> None:
    message = refused(tmp_path, f"{lines}\n{table('tWXYZ')}")
    assert message.startswith(f", line {number}: {what}")


@pytest.mark.parametrize(
    ("first", "what"),
    [
        ("0x,0.8,0.6,0,0", "t = '0x' is not a number"),
        ("x,0.8,0.6,0,0", "t = 'x' is not a number"),
        ("t,0.8,0.6,0,0", "t = 't' is not a number"),
        ("0,0.8,O.6,0,0", "qx = 'O.6' is not a number"),
        ("0,w,x,0,0", "qw = 'w' is not a number"),
        ("nan,nan,nan,nan,nan", "t holds no number"),
        (",,,,", "t holds no number"),
        ("0,0.8,0.6,0", "expected 5 fields, found 4 (separated by commas)"),
        ("0 0.8 0.6 0", "expected 5 fields, found 4 (separated by blanks)"),
        ("0;0.8;0.6;0;0;0", "expected 5 fields, found 6 (separated by semicolons)"),
        ("0,0,0,8,0,6,0,0,0,0", "expected 5 fields, found 10 (separated by commas)"),
        ("0/1/0/0/0", "no column of times, such as 't', in the header: '0/1/0/0/0'"),
    ],
)
def test_a_damaged_first_line_is_no_header(tmp_path: Path, first: str, what: str) -> None:
    message = refused(tmp_path, f"{first}\n{table('tWXYZ')}")
    assert message.startswith(f", line 1: {what}")


@pytest.mark.parametrize(
    ("row", "what"),
    [
        ("2 1 0 0 0", "expected 5 fields, found 1 (separated by commas)"),
        ('2,"1,0,0,0', "quotes do not match"),
        ("2,1,0,0,1_0", "qz = '1_0' is not a number"),
    ],
)
def test_a_row_unlike_the_others_is_refused(tmp_path: Path, row: str, what: str) -> None:
    assert refused(tmp_path, f"{table('tWXYZ')}{row}\n3,1,0,0,0\n").startswith(f", line 3: {what}")


def test_decimal_commas_and_points_do_not_mix(tmp_path: Path) -> None:
    message = refused(tmp_path, "0;0,8;0,6;0;0\n1;0.8;0.6;0;0\n")
    assert message == ", line 2: decimal commas and decimal points in one file"
