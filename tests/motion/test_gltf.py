"""glTF and GLB: the three interpolations, nodes, and the way back."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest
from clips import angles, figure, gltf, put, refusal

import quatspline as qs
from quatspline import quaternion
from quatspline.motion import MotionFileWarning

HALF = np.sqrt(0.5)
KEYS = [(0, 0, 0, 1), (0, 0, HALF, HALF), (-HALF, 0, 0, -HALF)]
TURN = {"node": 0, "path": "rotation", "times": [0, 0.5, 2], "values": KEYS}
NODES = [{"name": "body"}]


def test_linear_is_slerp_the_short_way(tmp_path: Path) -> None:
    motion = qs.read_motion(put(tmp_path / "a.gltf", gltf([TURN], NODES)))
    assert (motion.tracks, motion.interpolation) == (["body"], "LINEAR")
    q, _ = motion.curve("slerp")([0.25, 1.0])
    expected = [
        [0.92387953, 0, 0, 0.38268343],
        [0.80409216, 0.27925828, 0, 0.52483389],
    ]
    np.testing.assert_allclose(q[:, 0], expected, atol=1e-7)


def test_nodes_with_times_of_their_own_are_brought_together(tmp_path: Path) -> None:
    place = {"node": 1, "path": "translation", "times": [0, 1], "values": [(0, 0, 0), (2, 0, 0)]}
    hold = {
        "node": 2,
        "path": "rotation",
        "mode": "STEP",
        "times": [0.25, 1],
        "values": [KEYS[0], KEYS[1]],
    }
    nodes = [*NODES, {"name": "cart"}, {"name": "flag"}]
    path = put(tmp_path / "a.gltf", gltf([TURN, place, hold], nodes))
    with pytest.warns(MotionFileWarning, match="brought to 5 by its own interpolation"):
        motion = qs.read_motion(path)
    np.testing.assert_array_equal(motion.times, [0, 0.25, 0.5, 1, 2])
    turned = [0.92387953, 0, 0, 0.38268343]
    np.testing.assert_allclose(motion.quaternions[1, 0], turned, atol=1e-7)
    np.testing.assert_allclose(motion.positions[:, 1, 0], [0, 0.5, 1, 2, 2], atol=1e-7)
    np.testing.assert_allclose(motion.quaternions[:, 2, 0], [1, 1, 1, HALF, HALF], atol=1e-7)
    assert motion.interpolation is None


def test_cubic_splines_keep_their_tangents(tmp_path: Path) -> None:
    zero = (0, 0, 0, 0)
    rows = [zero, KEYS[0], (0, 0, 1, 0), (0, 0, 0.5, 0), KEYS[1], (0.2, 0, 0.3, 0)]
    cubic = {**TURN, "mode": "CUBICSPLINE", "times": [0, 0.5], "values": rows}
    short = {"node": 1, "path": "translation", "times": [0, 0.25, 0.5], "values": np.zeros((3, 3))}
    motion = qs.read_motion(put(tmp_path / "a.gltf", gltf([cubic], NODES)))
    assert motion.interpolation == "CUBICSPLINE"
    np.testing.assert_allclose(
        motion.out_tangents[:, 0], [[0, 0, 0, 1], [0, 0.2, 0, 0.3]], atol=1e-7
    )
    np.testing.assert_allclose(motion.in_tangents[:, 0], [[0, 0, 0, 0], [0, 0, 0, 0.5]], atol=1e-7)
    qs.write_motion(tmp_path / "a.npz", motion)
    kept = qs.read_motion(tmp_path / "a.npz")
    assert kept.interpolation == "CUBICSPLINE"
    np.testing.assert_array_equal(kept.out_tangents, motion.out_tangents)
    with pytest.warns(MotionFileWarning, match="tangents of its splines are not carried"):
        qs.write_motion(tmp_path / "a.glb", motion)
    path = put(tmp_path / "b.gltf", gltf([cubic, short], [*NODES, {}]))
    with pytest.warns(MotionFileWarning, match="brought to 3"):
        both = qs.read_motion(path)
    # Hermite: half of either value, an eighth of the step times the tangents' difference.
    value = np.array([0.5 + HALF / 2, 0, 0, HALF / 2 + (1 - 0.5) * 0.5 / 8])
    np.testing.assert_allclose(both.quaternions[1, 0], value / np.linalg.norm(value), atol=1e-7)
    assert both.tracks == ["body", "node 1"]


def test_normalised_integers_are_fractions(tmp_path: Path) -> None:
    document = gltf([TURN], NODES)
    data = np.array([[0, 0, 0, 32767], [0, 0, 23170, 23170], [-23170, 0, 0, -32768]], "<i2")
    document["buffers"].append({"byteLength": data.nbytes, "uri": "more%20data.bin"})
    put(tmp_path / "more data.bin", data.tobytes())
    document["bufferViews"][1] = {"buffer": 1, "byteLength": data.nbytes}
    document["accessors"][1] |= {"componentType": 5122, "normalized": True}
    told = refusal(put(tmp_path / "a.gltf", document))
    assert "rotation 2 of an animation has norm 1.22" in told
    data[2] = [-23170, 0, 0, -23170]
    put(tmp_path / "more data.bin", data.tobytes())
    motion = qs.read_motion(tmp_path / "a.gltf")
    assert angles(motion.quaternions[:, 0], np.roll(np.array(KEYS, float), 1, axis=1)) < 0.01


def test_strides_and_sparse_accessors(tmp_path: Path) -> None:
    document = gltf([TURN], NODES)
    rows = np.zeros((3, 6), "<f4")
    rows[:, 1:5] = KEYS
    more = struct.pack("<B3x4f", 1, 0, 1, 0, 0)
    put(tmp_path / "rows.bin", rows.tobytes() + more)
    document["buffers"].append({"byteLength": rows.nbytes + len(more), "uri": "rows.bin"})
    document["bufferViews"][1] = {
        "buffer": 1, "byteOffset": 4, "byteLength": rows.nbytes - 4, "byteStride": 24,
    }  # fmt: skip
    document["bufferViews"].append({"buffer": 1, "byteOffset": rows.nbytes, "byteLength": 20})
    document["accessors"][1]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": 2, "componentType": 5121},
        "values": {"bufferView": 2, "byteOffset": 4},
    }
    motion = qs.read_motion(put(tmp_path / "a.gltf", document))
    np.testing.assert_allclose(motion.quaternions[:, 0, 0], [1, 0, -HALF], atol=1e-7)


def test_what_is_fixed_between_moving_nodes_stays(tmp_path: Path) -> None:
    """Static nodes turn, move and scale what hangs on them; a matrix does, too."""
    quarter = [0, 0, HALF, HALF]
    matrix = np.array([[0, -2, 0, 1], [2, 0, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1.0]]).T
    nodes = [
        {"name": "a", "children": [1], "translation": [1, 0, 0]},
        {"name": "fixed", "children": [2], "rotation": quarter, "translation": [0, 3, 0]},
        {"name": "b", "translation": [1, 0, 0]},
        {"name": "top", "children": [0], "matrix": matrix.reshape(-1).tolist()},
    ]
    still = [(0, 0, 0, 1), (0, 0, 0, 1)]
    moves = [{"node": i, "path": "rotation", "times": [0, 1], "values": still} for i in (2, 0)]
    motion = qs.read_motion(put(tmp_path / "a.gltf", gltf(moves, nodes)))
    assert motion.tracks == ["a", "b"]
    turns, places = motion.world()
    # Twice as large and a quarter turned: a is 2 up, what is fixed 6 to the left, b 2 more, half turned.
    np.testing.assert_allclose(places[0], [[1, 2, 0], [-7, 2, 0]], atol=1e-7)
    np.testing.assert_allclose(turns[0, 1], [0, 0, 0, 1], atol=1e-7)
    qs.write_motion(tmp_path / "b.glb", motion)
    again = qs.read_motion(tmp_path / "b.glb")
    np.testing.assert_allclose(again.world()[1], places, atol=1e-6)
    with pytest.raises(qs.MotionFileError, match="fixed between joints"):
        qs.write_motion(tmp_path / "b.bvh", motion)


def test_one_of_several_animations(tmp_path: Path) -> None:
    document = gltf([TURN], NODES)
    document["animations"] += [{**document["animations"][0], "name": "run"}]
    path = put(tmp_path / "a.gltf", document)
    assert refusal(path) == ": 2 animations, 'move', 'run': name one with animation="
    assert refusal(path, animation="ran") == ": no animation 'ran': did you mean 'run'?"
    assert len(qs.read_motion(path, animation="run").times) == 3
    assert len(qs.read_motion(path, animation=0).times) == 3


def test_other_channels_and_names_that_come_twice_are_told(tmp_path: Path) -> None:
    document = gltf([TURN, {**TURN, "node": 1}], [*NODES, {"name": "body"}])
    channel = {"sampler": 0, "target": {"node": 0, "path": "scale"}}
    document["animations"][0]["channels"].append(channel)
    path = put(tmp_path / "a.gltf", document)
    with pytest.warns(MotionFileWarning) as told:
        motion = qs.read_motion(path)
    assert [str(item.message).removeprefix(str(path)) for item in told] == [
        ": not carried: channels of scale",
        ": names of nodes come twice: body (node 1)",
    ]
    assert motion.tracks == ["body", "body (node 1)"]


def test_a_glb_is_read_back(tmp_path: Path) -> None:
    motion = figure()
    qs.write_motion(tmp_path / "a.glb", motion)
    again = qs.read_motion(tmp_path / "a.glb")
    assert angles(motion.quaternions, again.quaternions) < 1e-5
    np.testing.assert_allclose(motion.positions, again.positions, atol=1e-6)
    np.testing.assert_allclose(motion.times, again.times, atol=1e-6)
    assert again.tracks == motion.tracks
    ends, others = motion.ends(), again.ends()
    assert ends.keys() == others.keys()
    for name, path in ends.items():
        np.testing.assert_allclose(others[name], path, atol=1e-5)


def test_a_glb_is_laid_out_as_the_standard_says(tmp_path: Path) -> None:
    qs.write_motion(tmp_path / "a.glb", figure(7, 3))
    raw = (tmp_path / "a.glb").read_bytes()
    magic, version, length, size, kind = struct.unpack_from("<4sIIII", raw)
    assert (magic, version, length, kind) == (b"glTF", 2, len(raw), 0x4E4F534A)
    assert size % 4 == 0 == len(raw) % 4
    document = json.loads(raw[20 : 20 + size])
    binary = raw[28 + size :]
    assert len(binary) == document["buffers"][0]["byteLength"]
    for view in document["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
        assert view["byteOffset"] + view["byteLength"] <= len(binary)
    times = document["accessors"][document["animations"][0]["samplers"][0]["input"]]
    assert times["type"] == "SCALAR"
    assert (times["min"], times["max"]) == ([0.0], [float(np.float32(0.1))])
    hung = [child for node in document["nodes"] for child in node.get("children", [])]
    assert sorted([*hung, *document["scenes"][0]["nodes"]]) == list(range(len(document["nodes"])))
    for sampler in document["animations"][0]["samplers"]:
        rows = document["accessors"][sampler["output"]]
        view = document["bufferViews"][rows["bufferView"]]
        width = {"VEC4": 4, "VEC3": 3}[rows["type"]]
        values = np.frombuffer(binary, "<f4", rows["count"] * width, view["byteOffset"])
        if width == 4:
            norms = np.linalg.norm(values.reshape(-1, 4), axis=1)
            np.testing.assert_allclose(norms, 1, atol=1e-6)


def test_a_body_is_one_node(tmp_path: Path) -> None:
    q = quaternion.exp(np.linspace(0, 1, 5)[:, None] * [0.0, 0, 1])
    motion = qs.Motion(100 + np.arange(5.0), q, np.arange(15.0).reshape(5, 3))
    qs.write_motion(tmp_path / "a.glb", motion)
    again = qs.read_motion(tmp_path / "a.glb")
    assert angles(again.quaternions, motion.quaternions) < 1e-5
    np.testing.assert_array_equal(again.positions, motion.positions)
    np.testing.assert_array_equal(again.times, motion.times)
