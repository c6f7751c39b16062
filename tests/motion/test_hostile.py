"""Files that are wrong in many ways: each is refused in one sentence that names the place and the reason."""

from __future__ import annotations

import copy
import json
import os
import struct
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from clips import AMC, ASF, BVH, figure, gltf, put, refusal

import quatspline as qs

BVHS: dict[str, tuple[str, str, str]] = {
    "no hierarchy": ("HIERARCHY\n", "", ", line 1: HIERARCHY is expected first"),
    "no motion": ("MOTION\n", "", "no line MOTION: the file ends within the hierarchy"),
    "an open brace": ("    }\n  }\n}", "    }\n  }", ", line 14: the hierarchy is not closed"),
    "a brace too many": ("}\nMOTION", "}}\nMOTION", ", line 15: } closes nothing"),
    "no brace": ("Arm\n  {", "Arm\n", ", line 8: { is expected after JOINT Arm"),
    "a brace from nowhere": ("OFFSET 1 2 3", "{ OFFSET 1 2 3", ", line 8: { opens nothing"),
    "a short offset": (
        "OFFSET 1 2 3",
        "OFFSET 1 2",
        ", line 8: OFFSET: 3 numbers expected, found 2",
    ),
    "an offset of words": ("OFFSET 1 2 3", "OFFSET 1 two 3", ", line 8: 'two' is not a number"),
    "an endless offset": ("OFFSET 1 2 3", "OFFSET 1 nan 3", ", line 8: nan is not a finite number"),
    "no offset": ("    OFFSET 1 2 3\n", "", "joint 'Arm' has no OFFSET"),
    "two offsets": ("OFFSET 1 2 3", "OFFSET 1 2 3\nOFFSET 1 2 3", "a second OFFSET of joint 'Arm'"),
    "channels miscounted": ("CHANNELS 3 X", "CHANNELS 4 X", ", line 9: CHANNELS 4 and 3 names"),
    "channels uncounted": ("CHANNELS 3 X", "CHANNELS X", ", line 9: CHANNELS Xrotation"),
    "a channel twice": (
        "Xrotation Yrotation Z",
        "Xrotation Xrotation Z",
        "'xrotation' comes twice",
    ),
    "a channel unknown": ("Xrotation Yrotation Z", "Wrotation Yrotation Z", "'wrotation'"),
    "one name twice": ("JOINT Arm", "JOINT Hips", "a second joint is called 'Hips'"),
    "no name": ("JOINT Arm", "JOINT", "JOINT without a name"),
    "a root in a joint": ("JOINT Arm", "ROOT Arm", "ROOT Arm stands inside a joint"),
    "a joint outside": ("ROOT Hips", "JOINT Hips", "JOINT Hips stands outside a root"),
    "an unknown word": ("    End Site", "    Begin Site", ", line 10: unknown word 'Begin'"),
    "no frames": ("Frames: 2", "Frames: 0", ", line 17: 0 frames cannot be read"),
    "frames of words": ("Frames: 2", "Frames: two", ", line 17: 'Frames:' and a whole number"),
    "too many frames": (
        "Frames: 2",
        "Frames: 3",
        ", line 20: 3 frames are announced, and 2 follow",
    ),
    "endless frames": ("Frames: 2", "Frames: 99999999999", "frames cannot be read"),
    "no frame time": (".0083333", "", ", line 18: 'Frame Time:' and a positive number"),
    "a frame time of 0": (".0083333", "0", ", line 18: 'Frame Time:' and a positive number"),
    "an endless rate": (".0083333", "1e-320", ", line 18: 'Frame Time:' and a positive number"),
    "a short frame": (" 50 60\n1", " 50\n1", ", line 19: 9 values expected, found 8"),
    "a long frame": (" 50 60\n1", " 50 60 70\n1", ", line 19: 9 values expected, found 10"),
    "a decimal comma": (" 50 60\n1", " 50 60,5\n1", ", line 19: '60,5' is not a number"),
    "an underscore": (" 50 60\n1", " 50 6_0\n1", ", line 19: '6_0' is not a number"),
    "infinity": (" 50 60\n1", " 50 1e999\n1", ", line 19: 1e999 is not a finite number"),
}


@pytest.mark.parametrize(("old", "new", "what"), BVHS.values(), ids=BVHS)
def test_bvh(tmp_path: Path, old: str, new: str, what: str) -> None:
    assert BVH.count(old) == 1
    assert what in refusal(put(tmp_path / "a.bvh", BVH.replace(old, new)))


@pytest.mark.parametrize("content", [b"", b"\n", b"\xff\xfe\x00", b"HIERARCHY\nMOTION\n"])
def test_no_bvh_at_all(tmp_path: Path, content: bytes) -> None:
    refusal(put(tmp_path / "a.bvh", content))


def test_a_hierarchy_of_any_depth_is_read(tmp_path: Path) -> None:
    depth = 3000
    joints = "".join(f"JOINT j{k}\n{{\nOFFSET 0 1 0\n" for k in range(depth))
    text = (
        f"HIERARCHY\nROOT r\n{{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n{joints}{'}' * (depth + 1)}\n"
    )
    path = put(tmp_path / "a.bvh", f"{text}MOTION\nFrames: 1\nFrame Time: 1\n90\n")
    assert qs.read_motion(path).world()[1][0, -1] == pytest.approx([0, 0, depth])


ASFS: dict[str, tuple[str, str, str]] = {
    "no hierarchy": (
        ":hierarchy\n  begin\n    root hip\n    hip lhumerus\n  end\n",
        "",
        "no section :hierarchy",
    ),
    "an unknown angle": ("angle deg", "angle grad", "line 7: angle grad: deg or rad is expected"),
    "a length of 0": ("length 0.45", "length 0", "line 6: length 0: not positive"),
    "a length of words": ("length 0.45", "length metre", "line 6: 'metre' is not a number"),
    "a direction too short": ("direction 1 0 0", "direction 1 0", "direction: 3 numbers expected"),
    "an axis without order": ("-90  XYZ", "-90", "axis without an order: as XYZ is expected"),
    "an axis of two": ("-90  XYZ", "-90  XYX", "axis XYX: as XYZ is expected"),
    "an unknown dof": ("dof rx ry rz", "dof rx rw", "rx rw: each of tx ty tz rx ry rz once"),
    "a dof twice": ("dof rx ry rz", "dof rx rx", "each of tx ty tz rx ry rz once"),
    "a dof that moves": ("dof rx ry rz", "dof tx rx", "only turns are read of bones"),
    "a bone without name": ("     name hip\n", "", "a bone without a name"),
    "a bone twice": ("name lhumerus", "name hip", "a second bone 'hip'"),
    "a loose bone": ("    hip lhumerus\n", "", "bone 'lhumerus' does not hang on the root"),
    "an unknown bone": ("hip lhumerus\n", "hip arm\n", "no bone is called 'arm'"),
    "a circle": ("root hip\n", "lhumerus hip\n", "does not hang on the root"),
    "two parents": ("root hip\n", "root hip lhumerus\n", "bone 'lhumerus' hangs on two others"),
}


@pytest.mark.parametrize(("old", "new", "what"), ASFS.values(), ids=ASFS)
def test_asf(tmp_path: Path, old: str, new: str, what: str) -> None:
    assert ASF.count(old) == 1
    put(tmp_path / "made.asf", ASF.replace(old, new))
    path = put(tmp_path / "made.amc", AMC)
    with pytest.raises(qs.MotionFileError) as caught:
        qs.read_motion(path)
    message = str(caught.value)
    assert what in message
    assert message.startswith(f"{tmp_path / 'made.asf'}, line ")


AMCS: dict[str, tuple[str, str, str]] = {
    "no frames": (AMC[AMC.index("1\n") :], "", "no frames in it"),
    "a bone missing": ("lhumerus 40 50 60\n", "", "frame 1 has no values of 'lhumerus'"),
    "the last bone missing": ("lhumerus 40 50 61\n", "", "frame 2 has no values of 'lhumerus'"),
    "a bone twice": ("60\n", "60\nlhumerus 1 2 3\n", ", line 7: lhumerus comes twice in frame 1"),
    "an unknown bone": ("60\n", "60\nhip 1 2 3\n", ", line 7: no bone that moves is called 'hip'"),
    "too few values": ("40 50 60", "40 50", "lhumerus: 3 values expected, found 2"),
    "too many values": ("40 50 60", "40 50 60 70", "lhumerus: 3 values expected, found 4"),
    "words": ("40 50 60", "40 fifty 60", "'fifty' is not a number"),
    "infinity": ("40 50 60", "40 inf 60", "inf is not a finite number"),
    "a frame left out": ("\n2\n", "\n3\n", "frame 3 follows frame 1"),
    "values before frames": ("1\nroot", "root", "root stands before the first frame"),
}


@pytest.mark.parametrize(("old", "new", "what"), AMCS.values(), ids=AMCS)
def test_amc(tmp_path: Path, old: str, new: str, what: str) -> None:
    put(tmp_path / "made.asf", ASF)
    told = refusal(put(tmp_path / "made.amc", AMC.replace(old, new, 1)))
    assert what in told


def test_a_skeleton_that_cannot_be_read(tmp_path: Path) -> None:
    path = put(tmp_path / "made.amc", AMC)
    with pytest.raises(qs.MotionFileError, match=r"gone\.asf: cannot be read: No such file"):
        qs.read_motion(path, skeleton=tmp_path / "gone.asf")
    with pytest.raises(qs.MotionFileError, match="not a text file in UTF-8"):
        qs.read_motion(path, skeleton=put(tmp_path / "b.asf", b"\xff\xfe\x00"))


TURNS = [(0, 0, 0, 1), (0, 0, 1, 0), (0, 0, 0, 1)]
GOOD = gltf(
    [{"node": 0, "path": "rotation", "times": [0, 1, 2], "values": TURNS}],
    [{"name": "a", "children": [1]}, {"name": "b"}],
)


def changed(*path: Any, to: Any) -> Callable[[dict[str, Any]], None]:
    """Sets one entry of a glTF, by its path."""

    def change(document: dict[str, Any]) -> None:
        for step in path[:-1]:
            document = document[step]
        document[path[-1]] = to

    return change


GLTFS: dict[str, tuple[Callable[[dict[str, Any]], None], str]] = {
    "version 1": (changed("asset", "version", to="1.0"), "asset.version is 1.0: glTF 2 is read"),
    "no asset": (changed("asset", to=None), "asset.version is None"),
    "an extension": (changed("extensionsRequired", to=["KHR_x"]), "requires extensions"),
    "no animation": (changed("animations", to=[]), "no animation in it"),
    "animations of text": (changed("animations", to="x"), "animations is no list of objects"),
    "no channel": (changed("animations", 0, "channels", to=[]), "moves no node's rotation"),
    "no target": (changed("animations", 0, "channels", 0, "target", to=3), "has no target"),
    "no such node": (
        changed("animations", 0, "channels", 0, "target", "node", to=7),
        "nodes[7] does not exist: there are 2",
    ),
    "no such sampler": (
        changed("animations", 0, "channels", 0, "sampler", to=-1),
        "samplers[-1] does not exist",
    ),
    "an unknown mode": (
        changed("animations", 0, "samplers", 0, "interpolation", to="BEZIER"),
        "interpolation 'BEZIER': LINEAR, STEP, CUBICSPLINE are read",
    ),
    "too few for cubic": (
        changed("animations", 0, "samplers", 0, "interpolation", to="CUBICSPLINE"),
        "3 times and 3 values of a rotation (CUBICSPLINE)",
    ),
    "no such accessor": (
        changed("animations", 0, "samplers", 0, "output", to="x"),
        "accessors['x'] does not exist",
    ),
    "the wrong type": (changed("accessors", 1, "type", to="VEC3"), "VEC4 expected, found VEC3"),
    "an unknown number": (changed("accessors", 1, "componentType", to=5130), "found VEC4 of 5130"),
    "whole numbers": (changed("accessors", 0, "componentType", to=5125), "are not normalised"),
    "a negative count": (changed("accessors", 0, "count", to=-1), "count = -1: a whole number"),
    "a huge count": (changed("accessors", 0, "count", to=10**12), "are not read"),
    "no data": (lambda document: document["accessors"][1].pop("bufferView"), "without data"),
    "beyond the view": (changed("accessors", 0, "count", to=4), "reaches beyond its buffer"),
    "beyond the buffer": (
        changed("bufferViews", 1, "byteOffset", to=40),
        "reaches beyond its buffer",
    ),
    "a stride of 1": (changed("bufferViews", 1, "byteStride", to=1), "reaches beyond its buffer"),
    "no buffer": (changed("buffers", to=[]), "buffers[0] does not exist"),
    "a short buffer": (changed("buffers", 0, "byteLength", to=999), "60 of 999 bytes"),
    "no base64": (
        changed("buffers", 0, "uri", to="data:application/octet-stream;base64,@@@"),
        "not base64",
    ),
    "the internet": (
        changed("buffers", 0, "uri", to="http://example.org/a.bin"),
        "only files in its folder are read",
    ),
    "another folder": (
        changed("buffers", 0, "uri", to="../../a.bin"),
        "only files in its folder are read",
    ),
    "hidden dots": (changed("buffers", 0, "uri", to="%2e%2e/a.bin"), "only files in its folder"),
    "a root": (changed("buffers", 0, "uri", to="/etc/hostname"), "only files in its folder"),
    "no such file": (changed("buffers", 0, "uri", to="a.bin"), "cannot be read: No such file"),
    "itself": (changed("nodes", 0, "children", to=[0]), "hangs on itself"),
    "two parents": (changed("nodes", 1, "children", to=[1]), "hangs on two others"),
    "a short rotation": (changed("nodes", 0, "rotation", to=[0, 0, 1]), "4 numbers are expected"),
    "a long rotation": (changed("nodes", 0, "rotation", to=[0, 0, 1, 1]), "no unit quaternion"),
    "a flat matrix": (changed("nodes", 0, "matrix", to=[0.0] * 16), "mirrors or flattens"),
    "children of text": (changed("nodes", 0, "children", to="1"), "are no list"),
}


@pytest.mark.parametrize(("change", "what"), GLTFS.values(), ids=GLTFS)
def test_gltf(tmp_path: Path, change: Callable[[dict[str, Any]], None], what: str) -> None:
    document = copy.deepcopy(GOOD)
    change(document)
    assert what in refusal(put(tmp_path / "a.gltf", document))


@pytest.mark.parametrize(
    ("values", "what"),
    [
        ({"times": [0, 1, 1]}, "time 2, 1, does not exceed the one before it"),
        ({"times": [0, np.nan, 2]}, "values that are not finite numbers"),
        (
            {"values": [(0, 0, 0, 1), (0, 0, 0, 0), (0, 0, 0, 1)]},
            "rotation 1 of an animation has norm 0",
        ),
        ({"values": TURNS[:2]}, "3 times and 2 values"),
        ({"times": [], "values": np.zeros((0, 4))}, "0 times and 0 values"),
    ],
)
def test_gltf_values(tmp_path: Path, values: dict, what: str) -> None:
    sampler = {"node": 0, "path": "rotation", "times": [0, 1, 2], "values": TURNS} | values
    assert what in refusal(put(tmp_path / "a.gltf", gltf([sampler], [{}])))


@pytest.mark.parametrize(
    "content",
    ["", "{", "[]", "[" * 100_000, '{"asset": NaN}', b"\xff\xfe\x00", b"glTF", b"glTF" + bytes(16)],
)
def test_no_gltf_at_all(tmp_path: Path, content: Any) -> None:
    refusal(put(tmp_path / "a.gltf", content))


def glb(*chunks: tuple[int, bytes], version: int = 2, more: int = 0) -> bytes:
    body = b"".join(struct.pack("<II", len(data), kind) + data for kind, data in chunks)
    return struct.pack("<4sII", b"glTF", version, 12 + len(body) + more) + body


WHOLE = json.dumps({**GOOD, "buffers": [{"byteLength": 60}]}).encode()
JSON, BINARY = 0x4E4F534A, 0x004E4942


@pytest.mark.parametrize(
    ("content", "what"),
    [
        (glb((JSON, WHOLE), version=1), "version 1 of GLB: 2 is read"),
        (glb((JSON, WHOLE), more=9), "bytes"),
        (glb((JSON, WHOLE))[:-4], "bytes"),
        (glb((BINARY, bytes(60))), "no chunk of JSON in it"),
        (glb((JSON, b"{}      ")), "asset.version is None"),
        (glb((JSON, WHOLE)), "buffers[0] has 0 of 60 bytes"),
        (glb((JSON, WHOLE), (BINARY, bytes(8))), "buffers[0] has 8 of 60 bytes"),
        (glb((JSON, WHOLE[:-20])), "not JSON"),
        (glb((JSON, WHOLE))[:12] + struct.pack("<II", 2**31, JSON) + WHOLE, "beyond the end"),
        (glb((JSON, WHOLE), (BINARY, bytes(60))), "does not exceed the one before it"),
    ],
)
def test_glb(tmp_path: Path, content: bytes, what: str) -> None:
    assert what in refusal(put(tmp_path / "a.glb", content))


EUROC = "{},1,2,3,0.8,0.6,0,0\n"
ROWS: dict[str, tuple[str, str, str]] = {
    "euroc: a word": ("a.euroc.csv", "1,1,2,3,0.8,east,0,0\n", "qx = 'east' is not a number"),
    "euroc: no unit": ("a.euroc.csv", "1,1,2,3,0.8,0.7,0,0\n", "quaternion has norm 1.06"),
    "euroc: too few": ("a.euroc.csv", "1,1,2,3,0.8,0.6,0\n", "expected 8 fields, found 7"),
    "euroc: a fraction": ("a.euroc.csv", EUROC.format("1.5"), "is no whole nanosecond"),
    "euroc: backwards": ("a.euroc.csv", EUROC.format(2) + EUROC.format(1), "goes back behind"),
    "euroc: twice": ("a.euroc.csv", EUROC.format(2) * 2, "repeats the stamp"),
    "euroc: 65 bits": ("a.euroc.csv", EUROC.format(2**64), "does not fit into 64 bits"),
    "euroc: a gap": ("a.euroc.csv", "1,1,,3,0.8,0.6,0,0\n", "ty holds no number"),
    "euroc: infinity": ("a.euroc.csv", "1,1,inf,3,0.8,0.6,0,0\n", "ty = inf is not a finite"),
    "euroc: empty": ("a.euroc.csv", "", "no keyframes in it"),
    "euroc: w last": (
        "a.euroc.csv",
        "#t,x,y,z,qx,qy,qz\n1,1,2,3,0,0,1\n",
        "no column of the quaternion's w",
    ),
    "kitti: eleven": ("a.kitti", "1 0 0 0 0 1 0 0 0 0 1\n", "expected 12 fields, found 11"),
    "kitti: a word": ("a.kitti", "1 0 0 0 0 1 0 0 0 0 1 east\n", "tz = 'east' is not a number"),
    "kitti: a gap": ("a.kitti", "1 0 0 0 0 1 0 0 0 0 1 nan\n", "tz holds no number"),
    "kitti: infinity": ("a.kitti", "1 0 0 inf 0 1 0 0 0 0 1 0\n", "tx = inf is not a finite"),
    "kitti: huge": ("a.kitti", "1e300 0 0 0 0 1 0 0 0 0 1 0\n", "matrix is off orthogonality"),
    "kitti: zeros": ("a.kitti", "0 0 0 0 0 0 0 0 0 0 0 0\n", "matrix is off orthogonality by 1"),
    "kitti: sheared": ("a.kitti", "1 .1 0 0 0 1 0 0 0 0 1 0\n", "matrix is off orthogonality"),
    "kitti: mirrored": ("a.kitti", "1 0 0 0 0 1 0 0 0 0 -1 0\n", "matrix mirrors"),
    "kitti: ragged": ("a.kitti", "1 0 0 0 0 1 0 0 0 0 1 0\n1 2\n", "line 2: expected 12 fields"),
    "kitti: empty": ("a.kitti", "\n", "no keyframes in it"),
    "csv: digits of another script": ("a.csv", "\u0661,1,0,0,0\n", "'\u0661' is not a number"),
    "csv: an endless line": (
        "a.csv",
        "0" * (2**20 + 1),
        ", line 1: longer than 1,048,576 characters",
    ),
    "csv: a colour": ("a.csv", "0,\x1b[31m1,0,0,0\n", r"qw = '\x1b[31m1' is not a number"),
    "csv: a long word": ("a.csv", "0," + "x" * 5000 + ",0,0,0\n", "is not a number (1 row)"),
}


@pytest.mark.parametrize(("name", "text", "what"), ROWS.values(), ids=ROWS)
def test_rows(tmp_path: Path, name: str, text: str, what: str) -> None:
    options = {"rate": 10} if name.endswith(".kitti") else {}
    assert what in refusal(put(tmp_path / name, text), **options)


@pytest.mark.parametrize("suffix", [".csv", ".tum", ".npz", ".bvh", ".amc", ".asf", ".glb"])
def test_what_may_never_end_is_not_opened(tmp_path: Path, suffix: str) -> None:
    pipe, device = tmp_path / f"pipe{suffix}", tmp_path / f"zero{suffix}"
    os.mkfifo(pipe)
    device.symlink_to("/dev/zero")
    motions = put(tmp_path / "a.amc", AMC)
    for path, what in ((pipe, "a pipe, not a file"), (device, "a device, not a file")):
        if suffix == ".asf":
            assert refusal(motions, skeleton=path).endswith(what)
        else:
            assert refusal(path) == f": {what}"
    with pytest.raises(qs.MotionFileError, match="a pipe, not a file"):
        qs.read_motion(put(tmp_path / "a.bvh", BVH), times=pipe)


@pytest.mark.parametrize(
    ("arrays", "what"),
    [
        ({"tracks": np.array(["a"])}, "1 tracks"),
        ({"tracks": np.array(["a", "a"])}, "tracks: two are called 'a'"),
        ({"tracks": np.arange(2)}, "tracks (int64): text expected"),
        ({"parents": np.array([1, 0])}, "parents[0] leads to no root"),
        ({"parents": np.array([-1, 7])}, "parents[1] leads to no root"),
        ({"parents": np.array([-1])}, "parents has shape (1,): expected (2,)"),
        ({"offsets": np.zeros((2, 2))}, "offsets has shape (2, 2): expected (2, 3)"),
        ({"orders": np.array(["XYZ"])}, "orders has shape (1,): expected (2,)"),
        ({"orders": np.array(["XYZ", "XXQ"])}, "orders[1] = 'XXQ'"),
        ({"end_joints": np.array([5])}, "do not belong to the tracks"),
        ({"ends": np.zeros((2, 3))}, "do not belong to the tracks"),
        ({"per_second": np.array(7)}, "per_second = 7"),
        ({"offsets": np.full((2, 3), np.nan)}, "offsets: not finite numbers"),
        ({"positions": np.zeros((3, 1, 3))}, "expected positions (3, 2, 3)"),
        ({"quaternions": np.full((3, 2, 4), 0.6)}, "row 0: quaternion has norm 1.2"),
    ],
)
def test_npz_of_skeletons(tmp_path: Path, arrays: dict, what: str) -> None:
    whole = figure(3, 2)
    qs.write_motion(tmp_path / "a.npz", whole)
    kept = dict(np.load(tmp_path / "a.npz"))
    np.savez(tmp_path / "a.npz", **(kept | arrays))
    assert what in refusal(tmp_path / "a.npz")


SEEDS = {
    "a.bvh": BVH.encode(),
    "made.amc": AMC.encode(),
    "a.gltf": json.dumps(GOOD).encode(),
    "a.glb": glb((JSON, WHOLE), (BINARY, np.arange(15, dtype="<f4").tobytes())),
}
TOKENS = [
    b"{",
    b"}",
    b"\n",
    b" ",
    b"-1",
    b"1e999",
    b"nan",
    b"JOINT",
    b'"',
    b"[",
    b"]",
    b":",
    b"\0",
    b"\xc3",
]


def read_or_told(path: Path) -> str:
    """The refusal of a file, or "" where what is read holds together."""
    try:
        motion = qs.read_motion(path)
    except qs.MotionFileError as error:
        return str(error)
    assert np.isfinite(motion.quaternions).all()
    motion.world()
    return ""


@pytest.mark.parametrize("name", SEEDS)
def test_any_bytes_are_read_or_refused_in_a_sentence(tmp_path: Path, name: str) -> None:
    rng = np.random.default_rng(0)
    put(tmp_path / "made.asf", ASF)
    for _ in range(150):
        content = bytearray(SEEDS[name])
        for _ in range(rng.integers(1, 4)):
            at = int(rng.integers(len(content)))
            content[at : at + int(rng.integers(0, 4))] = TOKENS[rng.integers(len(TOKENS))]
        path = put(tmp_path / name, bytes(content))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            told = read_or_told(path)
        assert "\n" not in told
        assert not told or told.startswith(str(path))
