"""`sample`, `reduce`, `info` and `compare --keep` on recorded motion, of bodies and of skeletons."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from clips import angles, figure, put

import quatspline as qs
from quatspline import quaternion
from quatspline.cli import joints, main


@pytest.fixture
def walk(tmp_path: Path) -> Path:
    qs.write_motion(tmp_path / "walk.bvh", figure(64))
    return tmp_path / "walk.bvh"


def run(*words: Any) -> int:
    return main([str(word) for word in words])


def test_sample_of_a_skeleton(walk: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.bvh"
    assert run("sample", walk, "--scheme", "local-quintic", "--rate", 120, "-o", out) == 0
    motion, fine = qs.read_motion(walk), qs.read_motion(out)
    assert len(fine.times) == 127
    assert angles(fine.quaternions[::2], motion.quaternions) < 2e-6
    assert fine.tracks == motion.tracks


def test_sample_at_the_times_of_another_file(tmp_path: Path) -> None:
    """By the clock of both: one counts nanoseconds, the other seconds."""
    rows = [f"{10**9 * k},{np.cos(k / 4)},{np.sin(k / 4)},0,0" for k in range(100, 104)]
    path = put(tmp_path / "a.csv", "timestamp_ns,qw,qx,qy,qz\n" + "\n".join(rows) + "\n")
    other = put(tmp_path / "b.tum", "100.5 0 0 0 0 0 0 1\n102.25 0 0 0 0 0 0 1\n")
    out = tmp_path / "out.csv"
    assert run("sample", path, "--scheme", "slerp", "--at", other, "-o", out) == 0
    found = qs.read_motion(out)
    assert found.stamps.tolist() == [100_500_000_000, 102_250_000_000]
    half = np.array([25.125, 25.5625])
    expected = np.stack([np.cos(half), np.sin(half), 0 * half, 0 * half], axis=1)
    assert angles(found.quaternions[:, 0], expected) < 1e-6


def test_hold_takes_the_end_poses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = put(tmp_path / "a.csv", "0,1,0,0,0\n1,0.8,0.6,0,0\n")
    other = put(tmp_path / "b.csv", "-1,1,0,0,0\n0.5,1,0,0,0\n9,1,0,0,0\n")
    assert run("sample", path, "--scheme", "slerp", "--at", other) == 2
    assert "outside the domain" in capsys.readouterr().err
    assert run("sample", path, "--scheme", "slerp", "--at", other, "--hold") == 0
    rows = capsys.readouterr().out.splitlines()
    assert rows[1] == "-1.0,1.0,0.0,0.0,0.0"
    assert rows[3] == "9.0,0.8,0.6,0.0,0.0"


def test_positions_by_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = put(
        tmp_path / "a.csv",
        "t,qw,qx,qy,qz,x,y,z\n0,1,0,0,0,0,0,0\n1,1,0,0,0,1,0,0\n2,1,0,0,0,4,0,0\n",
    )
    places = {}
    for name in ("linear", "matched"):
        words = ("sample", path, "--scheme", "squad", "--count", 5, "--positions", name)
        assert run(*words) == 0
        places[name] = [
            float(row.split(",")[5]) for row in capsys.readouterr().out.splitlines()[1:]
        ]
    assert places["linear"] == [0, 0.5, 1, 2.5, 4]
    np.testing.assert_allclose(places["matched"], [0, 0.25, 1, 2.25, 4])


def test_reduce_tells_each_joint_and_writes(
    walk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outs = {name: tmp_path / f"out.{name}" for name in ("bvh", "glb", "csv", "npz")}
    for out in outs.values():
        assert run("reduce", walk, "--error", "0.5deg", "--scheme", "squad", "-o", out) == 0
    *joints, whole = capsys.readouterr().out.splitlines()[-6:]
    assert [line.split("  ")[0] for line in joints] == [f"joint {k}" for k in range(5)]
    source = qs.read_motion(walk)
    for name in ("bvh", "glb"):
        found = qs.read_motion(outs[name])
        assert angles(found.quaternions, source.quaternions) < 0.50001
    table = pd.read_csv(outs["csv"])
    kept = source.reduce("squad", error=np.radians(0.5)).frames
    assert {name: len(index) for name, index in kept.items()} == table[
        "track"
    ].value_counts().to_dict()
    with np.load(outs["npz"]) as arrays:
        np.testing.assert_array_equal(arrays["frame"], table["frame"])
        np.testing.assert_array_equal(arrays["quaternion"], table[["qw", "qx", "qy", "qz"]])
    assert f"{len(table)} of {64 * 5}" in whole


def test_reduce_of_a_body_writes_its_keyframes(tmp_path: Path) -> None:
    t = np.arange(50) / 50
    q = np.stack([np.cos(t * t), np.sin(t * t), 0 * t, 0 * t], axis=1)
    qs.write_motion(tmp_path / "a.csv", qs.Motion(t, q))
    assert run("reduce", tmp_path / "a.csv", "--error", "5e-3 rad", "-o", tmp_path / "k.tum") == 0
    found = qs.read_motion(tmp_path / "k.tum")
    assert 3 < len(found.times) < 25
    assert set(found.times) <= set(t)


@pytest.mark.parametrize("given", ["0.5", "deg", "-1deg", "nanrad", "1grad", ""])
def test_an_angle_without_its_unit_is_refused(
    walk: Path, given: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("reduce", walk, f"--error={given}") == 2
    assert "expected a positive angle with its unit" in capsys.readouterr().err


def test_reduce_into_a_format_of_one_set_of_frames_is_refused(
    walk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("reduce", walk, "--error", "1deg", "-o", tmp_path / "k.tum") == 2
    assert "keyframes by joint go into .csv or .npz" in capsys.readouterr().err


def test_info_is_one_screen(walk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("info", walk) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) < 24
    found = dict(line.split(maxsplit=1) for line in lines if not line.startswith("largest"))
    assert found["tracks"].startswith("5, a skeleton: joint 0, joint 1")
    assert found["frames"] == "64"
    assert found["rate"] == "60 Hz (even)"
    assert found["start"] == "0.0 s"
    assert found["gaps"] == "none"
    assert found["positions"] == "in the file's unit, 1 of 5 changing"


def test_info_tells_what_is_refused_and_goes_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [f"{t},1,0,0,0" for t in (0, 0.1, 0.1, 0.2, 0.3, "nan", 0.4, 3.4, 3.5)]
    path = put(tmp_path / "a.csv", "\n".join(rows) + "\n")
    assert run("info", path) == 0
    text = capsys.readouterr().out
    assert "refused as it stands" in text
    assert "line 3: t = 0.1 repeats the stamp before it" in text
    assert "1 over 5 median spacings, the longest 3 s after frame 4" in text
    assert run("info", put(tmp_path / "b.csv", "0,1,0,0,0\n1,9,0,0,0\n")) == 2


@pytest.mark.parametrize(("frames", "told"), [(2000, True), (40, True), (39, False)])
def test_the_noise_is_about_as_large_as_was_added(
    frames: int, told: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As `compare` tells it; nothing of few frames."""
    rng = np.random.default_rng(0)
    t = np.arange(frames) / 100
    v = np.stack([np.sin(t), np.cos(t), 0.1 * t], axis=1) / 2
    errors = quaternion.exp(1e-3 * rng.normal(size=v.shape))  # 2 mrad about each axis
    q = quaternion.mul(quaternion.exp(v), errors)
    qs.write_motion(tmp_path / "a.csv", qs.Motion(t, q))
    run("info", tmp_path / "a.csv")
    lines = [li for li in capsys.readouterr().out.splitlines() if li.startswith("noise")]
    assert len(lines) == told
    if told:
        assert "degrees about each axis at most ('body', from third differences)" in lines[0]
        size = float(lines[0].split()[1])
        assert np.radians(size) == pytest.approx(2e-3, rel=0.3 if frames == 40 else 0.05)
        [compared] = qs.compare(t, q, ["slerp"])["noise"]
        assert size == pytest.approx(compared, rel=5e-3)


def test_a_smooth_motion_has_no_noise(walk: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run("info", walk)
    [line] = [li for li in capsys.readouterr().out.splitlines() if li.startswith("noise")]
    assert line.split(maxsplit=1)[1] == "none told from the motion"


def test_compare_of_a_skeleton_at_the_frames_left_out(
    walk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("compare", walk, "--schemes", "slerp,local-quintic", "--out", tmp_path / "out")
    assert run(*words) == 2
    assert "need --keep K" in capsys.readouterr().err
    assert run(*words, "--keep", 8) == 0
    table = pd.read_csv(tmp_path / "out" / "kept.csv").set_index("scheme")
    motion = qs.read_motion(walk)
    q, _ = motion.curve("slerp", every=8)(motion.times)
    out = np.delete(np.arange(64), [*range(0, 64, 8), 63])
    off = np.radians([angles(q[out, k], motion.quaternions[out, k]) for k in range(5)])
    slerp = table.loc["slerp"]
    assert slerp["largest"] == pytest.approx(off.max(), rel=1e-9)
    assert slerp["largest_joint"] == f"joint {off.argmax()}"
    assert table.index[0] == "local-quintic"
    assert table.loc["local-quintic", "end_rms"] < slerp["end_rms"]
    by_joint = pd.read_csv(tmp_path / "out" / "joints.csv").set_index(["scheme", "joint"])
    assert len(by_joint) == 2 * 5
    largest = [by_joint.loc[("slerp", f"joint {k}"), "largest"] for k in range(5)]
    np.testing.assert_allclose(largest, off, rtol=1e-9)
    assert by_joint.loc["slerp", "rms"].max() == pytest.approx(slerp["rms_worst"], rel=1e-9)
    assert by_joint.loc["slerp", "rms"].median() == pytest.approx(slerp["rms_median"], rel=1e-9)
    assert run(*words, "--keep", 1) == 2
    assert "leaves out none of" in capsys.readouterr().err


def test_the_folder_of_a_skeleton_has_figures_and_a_page_that_plays(
    walk: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    words = ("compare", walk, "--keep", 8, "--out", out)
    assert run(*words, "--schemes", "local-quintic,scipy-slerp,slerp") == 0
    assert set(joints.FILES) | {"manifest.json"} == {path.name for path in out.iterdir()}
    [played] = json.loads((out / "kept.replay.json").read_text())
    assert list(played["schemes"]) == ["slerp", "local-quintic", "scipy-slerp"]
    assert played["title"] == "walk.bvh"
    assert played["joints"] == [f"joint {k}" for k in range(5)]
    page = (out / "report.html").read_text(encoding="utf-8")
    assert 'id="replay"' in page
    assert page.count('class="picture"') == 2
    assert played["truth"] in page
    assert main(["report", "--out", str(out)]) == 0
    assert played["truth"] in (out / "report.html").read_text(encoding="utf-8")


def test_a_body_is_played_where_frames_are_left_out(tmp_path: Path) -> None:
    t = np.arange(33) / 8
    v = np.stack([np.sin(t), np.cos(1.3 * t), 0.2 * t], axis=1) / 2
    qs.write_motion(tmp_path / "a.tum", qs.Motion(t, quaternion.exp(v), 10 * v))
    out = tmp_path / "out"
    words = ("compare", tmp_path / "a.tum", "--schemes", "slerp,squad", "--out", out)
    assert run(*words, "--keep", 4) == 0
    [played] = json.loads((out / "compare.replay.json").read_text())
    assert (list(played["schemes"]), played["joints"]) == (["slerp", "squad"], ["body"])
    assert 'id="replay"' in (out / "report.html").read_text(encoding="utf-8")
    assert run(*words) == 0
    assert not (out / "compare.replay.json").exists()
    assert 'id="replay"' not in (out / "report.html").read_text(encoding="utf-8")


def test_compare_of_a_body_adds_the_errors_at_the_frames_left_out(tmp_path: Path) -> None:
    t = np.arange(33) / 8
    v = np.stack([np.sin(t), np.cos(1.3 * t), 0.2 * t], axis=1) / 2
    q = quaternion.exp(v)
    qs.write_motion(tmp_path / "a.csv", qs.Motion(t, q))
    words = ("--keep", 4, "--schemes", "slerp,kim", "--out", tmp_path / "out")
    assert run("compare", tmp_path / "a.csv", *words) == 0
    table = pd.read_csv(tmp_path / "out" / "compare.csv").set_index("scheme")
    out = np.arange(33) % 4 > 0
    rebuilt = qs.build("slerp", t[~out], q[~out])(t[out])
    assert table.loc["slerp", "left_out_largest"] == pytest.approx(
        np.radians(angles(rebuilt, q[out])), rel=1e-9
    )
    assert table.loc["kim", "left_out_rms"] < table.loc["slerp", "left_out_rms"] / 4


@pytest.mark.parametrize(
    ("name", "flags", "told"),
    [
        ("a.kitti", (), "has no times of its own: give --frame-rate"),
        ("a.csv", ("--skip", 3), "--skip 3 leaves none of its 3 frames"),
        ("a.csv", ("--frame-rate", 10), "--frame-rate 10.0 is of no use in a file of this format"),
        ("a.amc", (), "no skeleton beside it (looked for a.asf): give --skeleton"),
    ],
)
def test_refusals_name_options_as_flags(
    name: str, flags: tuple[Any, ...], told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    texts = {
        "a.kitti": "1 0 0 0 0 1 0 0 0 0 1 0\n" * 2,
        "a.csv": "t,qw,qx,qy,qz\n0,1,0,0,0\n1,1,0,0,0\n2,1,0,0,0\n",
        "a.amc": ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 0 0 0 0 0\n",
    }
    path = put(tmp_path / name, texts[name])
    assert run("sample", path, "--scheme", "slerp", "--count", 3, *flags) == 2
    assert capsys.readouterr().err == f"quatspline: {path}: {told}\n"


def test_a_pose_that_was_added_is_told_on_stderr(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motion = figure(20)
    q = motion.quaternions.copy()
    q[0, 2] = [0, 1, 0, 0]
    path = tmp_path / "a.bvh"
    qs.write_motion(path, motion.moved(motion.stamps, q, motion.positions))
    assert run("info", path) == 0
    assert ": --skip 1 leaves out a pose" in capsys.readouterr().err
    assert run("info", path, "--skip", 1) == 0
    assert capsys.readouterr().err == ""
