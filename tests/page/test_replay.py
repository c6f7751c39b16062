"""Recorded motion for the player: what is stored of it, and that the page has it from the folder alone."""

from __future__ import annotations

import base64
import dataclasses
import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import quatspline as qs
from pages import EVERY, REBUILT, Elements, loop
from quatspline import quaternion
from quatspline.cli import running
from quatspline.motion import Motion
from quatspline.motion.keeping import left_out, moving
from quatspline.motion.replay import BUDGET, PARTS, WIRES, replay, wires
from quatspline.page import write_page
from quatspline.runs.experiment import Run, files
from quatspline.runs.results import Results
from quatspline.system.loading import load
from quatspline.trajectories.credits import credit
from quatspline.trajectories.figure_walk import figure_walk

CLIP = 100_000
"""Bytes of the points of a clip of 31 joints and 500 frames."""


def places(data: dict[str, Any], text: str) -> np.ndarray:
    """Points (n, P, 3) as the browser has them."""
    whole = np.frombuffer(base64.b64decode(text), "<i2").astype(float)
    points = 1 + max(max(line) for line in data["lines"])
    return np.array(data["origin"]) + data["step"] * whole.reshape(-1, points, 3)


def angles(data: dict[str, Any], scheme: str) -> np.ndarray:
    """Degrees (n, J) as the browser has them."""
    stored = data["schemes"][scheme]
    whole = np.frombuffer(base64.b64decode(stored["angles"]), "<u2").astype(float)
    return stored["angle_step"] * whole.reshape(-1, len(data["joints"]))


def shown(data: dict[str, Any], motion: Motion) -> np.ndarray:
    """The indices of the frames that are stored."""
    first, last, count = data["frames"]
    assert count == len(motion.times)
    times = np.frombuffer(base64.b64decode(data["times"]), "<f4")
    frames = np.linspace(first, last, len(times)).round().astype(int)
    np.testing.assert_allclose(data["start"] + times, motion.times[frames], rtol=1e-6)
    return frames


@pytest.fixture(scope="module")
def walk() -> Motion:
    return figure_walk()


@pytest.fixture(scope="module")
def data(walk: Motion) -> dict[str, Any]:
    return replay(walk, REBUILT, EVERY, title="walk", source="made")


def test_the_truth_is_the_forward_kinematics(walk: Motion, data: dict[str, Any]) -> None:
    assert set(data) == set(PARTS)
    stored, frames = places(data, data["truth"]), shown(data, walk)
    joints, ends = walk.world()[1][frames], walk.ends()
    assert stored.shape[1] == len(walk.tracks) + len(walk.skeleton.ends)
    within = {"rtol": 0.0, "atol": 0.5001 * data["step"]}
    np.testing.assert_allclose(stored[:, : len(walk.tracks)], joints, **within)
    for joint, tip in zip(data["joints"], data["tips"], strict=True):
        if joint in ends:
            np.testing.assert_allclose(stored[:, tip], ends[joint][frames], **within)
    assert data["step"] < 2e-4  # m, of a walk of six


def test_a_scheme_is_its_curve_on_the_true_path(walk: Motion, data: dict[str, Any]) -> None:
    frames = shown(data, walk)
    for name in REBUILT:
        q, _ = walk.curve(name, EVERY)(walk.times[frames])
        part = walk.frames(frames)
        rebuilt = part.moved(part.stamps, q, part.positions)
        stored = places(data, data["schemes"][name]["places"])[:, : len(walk.tracks)]
        np.testing.assert_allclose(stored, rebuilt.world()[1], atol=0.5001 * data["step"])
        off = np.degrees(quaternion.distance(q, walk.quaternions[frames]))[:, moving(walk)]
        step = data["schemes"][name]["angle_step"]
        np.testing.assert_allclose(angles(data, name), off, atol=0.5001 * step)
        assert step <= off.max() / 60000


def test_keyframes_are_where_nothing_is_off(walk: Motion, data: dict[str, Any]) -> None:
    frames = shown(data, walk)
    keys = np.flatnonzero(~left_out(walk, EVERY)[frames])
    assert data["keyframes"] == keys.tolist()
    assert len(keys) > 30
    for name in REBUILT:
        assert angles(data, name)[keys].max() < 1e-4
        assert np.delete(angles(data, name), keys, axis=0).max() > 1.0


def test_data_stay_small(data: dict[str, Any]) -> None:
    def clip(frames: int, joints: int) -> Motion:
        return long_chain(frames, joints)

    for motion in (clip(500, 31), clip(3000, 31)):
        made = replay(motion, ["slerp"], 8, title="")
        assert len(base64.b64decode(made["truth"])) <= min(6 * BUDGET, CLIP)
    assert len(json.dumps(data)) < 80_000 * (1 + len(REBUILT))


def long_chain(frames: int, joints: int) -> Motion:
    """A chain of joints, each of which turns a little."""
    from quatspline.motion import Skeleton

    t = np.arange(frames) / 120.0
    half = 0.2 * np.sin(t[:, None, None] * (1 + np.arange(joints)[:, None] / joints) + np.arange(3))
    skeleton = Skeleton(np.arange(-1, joints - 1), np.full((joints, 3), 0.1), ("XYZ",) * joints)
    names = [f"joint {k}" for k in range(joints)]
    return Motion(t, quaternion.exp(half), np.full((frames, joints, 3), 0.1), names, skeleton)


def test_of_a_long_clip_the_middle_is_shown() -> None:
    motion = long_chain(3001, 31)
    made = replay(motion, ["slerp"], 8, title="")
    first, last, count = made["frames"]
    assert count == 3001
    assert first % 8 == 0
    assert abs(first - (count - 1 - last)) <= 8
    frames = shown(made, motion)
    np.testing.assert_allclose(
        places(made, made["truth"]), motion.world()[1][frames], atol=0.5001 * made["step"]
    )


def test_a_body_goes_its_own_way() -> None:
    motion = loop()
    made = replay(motion, ("slerp", "quartic"), EVERY, title="loop")
    assert (made["joints"], made["tips"], made["upright"]) == (["body"], [0], False)
    frames = shown(made, motion)
    truth = places(made, made["truth"])
    np.testing.assert_allclose(truth[:, 0], motion.positions[frames, 0], atol=made["step"])
    arms = np.linalg.norm(truth - truth[:, :1], axis=-1)
    size = 0.12 * np.ptp(motion.positions, axis=0).max()
    np.testing.assert_allclose(
        arms, np.tile(size * np.linalg.norm(WIRES, axis=1), (len(arms), 1)), atol=2 * made["step"]
    )
    for name in ("slerp", "quartic"):
        _, x = motion.curve(name, EVERY)(motion.times[frames])
        stored = places(made, made["schemes"][name]["places"])
        np.testing.assert_allclose(stored[:, 0], x[:, 0], atol=made["step"])


@pytest.mark.parametrize("suffix", [".bvh", ".glb"])
def test_what_was_resampled_and_written_is_played_as_it_was(
    walk: Motion, tmp_path: Path, suffix: str
) -> None:
    fine = walk.frames(slice(0, 120)).resample(240, "local-quintic")
    qs.write_motion(tmp_path / f"out{suffix}", fine)
    again = qs.read_motion(tmp_path / f"out{suffix}")
    found, expected = (replay(m, ["slerp"], EVERY, title="") for m in (again, fine))
    assert found["keyframes"] == expected["keyframes"]
    stored, own = (places(each, each["truth"]) for each in (found, expected))
    near = 1e-5 + found["step"] + expected["step"]
    for joint in expected["joints"]:
        tips = (each["tips"][each["joints"].index(joint)] for each in (found, expected))
        np.testing.assert_allclose(stored[:, next(tips)], own[:, next(tips)], atol=near)
    off = [angles(each, "slerp") for each in (found, expected)]
    order = [expected["joints"].index(joint) for joint in found["joints"]]
    np.testing.assert_allclose(off[0], off[1][:, order], atol=1e-3)


@pytest.mark.parametrize(
    ("rate", "every", "stride"),
    [(120, 16, 2), (120, 8, 1), (240, 16, 2), (240, 32, 4), (30, 32, 1)],
)
def test_what_is_stored_shows_motion_and_the_course_of_errors(
    rate: int, every: int, stride: int
) -> None:
    motion = loop(300)
    made = replay(
        motion.moved(np.arange(300) / rate, motion.quaternions, motion.positions),
        ["slerp"],
        every,
        title="",
    )
    assert made["keyframes"][1] == every // stride


def test_frames_alone_between_gaps_are_not_shown() -> None:
    motion = loop(200)
    stamps = motion.stamps + np.repeat([0.0, 5.0, 10.0], [100, 1, 99])
    parted = dataclasses.replace(motion, stamps=stamps, max_gap=1.0)
    made = replay(parted, ["slerp"], EVERY, title="")
    truth = places(made, made["truth"])[:, 0]
    rest = np.delete(motion.positions[:, 0], 100, axis=0)
    np.testing.assert_allclose(truth, rest, atol=made["step"])


def test_a_body_without_positions_turns_in_place() -> None:
    motion = dataclasses.replace(loop(), positions=None)
    made = replay(motion, ["slerp"], EVERY, title="")
    truth = places(made, made["truth"])
    assert np.abs(truth[:, 0]).max() <= made["step"]
    assert np.ptp(truth[:, made["tips"][0]], axis=0).max() > 1.0


def test_a_point_that_a_joint_moves_is_not_at_the_joint(walk: Motion) -> None:
    figure = wires(walk.frames(slice(0, 1)))
    for joint, tip in enumerate(figure.tips):
        assert np.linalg.norm(figure.points[0, tip] - figure.points[0, joint]) > 0.01
    assert len(figure.lines) == figure.points.shape[1] - 1


def test_what_does_not_apply_is_told(walk: Motion) -> None:
    part = walk.frames(slice(0, 64))
    made = replay(part, ("shoemake-bezier", "slerp"), 16, title="")
    assert list(made["schemes"]) == made["pair"] == ["slerp"]
    assert "uniform" in made["refused"]["shoemake-bezier"]
    with pytest.raises(ValueError, match="no scheme rebuilds it: shoemake-bezier: "):
        replay(part, ("shoemake-bezier",), 16, title="")


def test_the_page_is_drawn_from_the_folder_alone(page_folder: Path, tmp_path: Path) -> None:
    folder = tmp_path / "copy"
    shutil.copytree(page_folder, folder)
    page = Elements(write_page(folder, scenes=[]).read_text(encoding="utf-8"))
    assert page.data("replays") == json.loads((folder / "reconstruct.replay.json").read_text())
    assert "recorded" in {a["id"] for tag, a, _ in page.items if tag == "section"}
    (folder / "reconstruct.replay.json").unlink()
    bare = Elements(write_page(folder, scenes=[]).read_text(encoding="utf-8"))
    assert not any(a.get("id") == "replay" for _, a, _ in bare.items)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("[", "not a file in JSON"),
        ("{}", "a list is expected"),
        ("[1]", "motion 0: an object is expected, found 1"),
        ('[{"title": ""}]', "motion 0: 'source' is missing"),
    ],
)
def test_a_file_that_holds_no_motions_is_refused(tmp_path: Path, content: str, told: str) -> None:
    import pandas as pd

    results = Results(tmp_path)
    results.table("x", pd.DataFrame({"a": [1]}))
    results.text("x.replay.json", content)
    with pytest.raises(ValueError, match=r"x\.replay\.json: ") as caught:
        write_page(tmp_path, scenes=[])
    assert told in str(caught.value)
    assert not (tmp_path / "report.html").exists()


EXPERIMENT = """
import pandas as pd
from quatspline.motion.replay import replay
from quatspline.trajectories.figure_walk import figure_walk
TITLE, PAPER = "Small", False
def measure(run):
    return pd.DataFrame({"x": [1]})
def replays(run):
    return [replay(figure_walk(64), run.schemes or ["slerp"], 16, title="a walk")]
"""


def test_a_run_writes_motions_that_its_page_plays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out, file = tmp_path / "out", tmp_path / "experiments" / "small.py"
    file.parent.mkdir()
    file.write_text(EXPERIMENT)
    monkeypatch.setenv("QUATSPLINE_EXPERIMENTS", str(file.parent))
    assert running.run(["small"], schemes=["squad"], out=out) == []
    [played] = json.loads((out / "small.replay.json").read_text())
    assert (played["title"], played["pair"]) == ("a walk", ["squad"])
    manifest = json.loads((out / "manifest.json").read_text())
    assert "small.replay.json" in manifest["experiments"]["small"]["files"]
    page = Elements(write_page(out, scenes=[]).read_text(encoding="utf-8"))
    assert page.data("replays") == [played]
    monkeypatch.delattr(load(file, "experiment"), "replays")
    assert running.run(["small"], out=out) == []
    assert not (out / "small.replay.json").exists()


def test_the_experiment_plays_the_first_of_each_kind_with_its_owners_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("QUATSPLINE_MOTIONS", raising=False)
    module = load(files()["reconstruct"], "experiment")
    [own] = module.replays(Run(quick=True, schemes=["slerp"]))
    assert (own["title"], own["source"]) == ("figure-walk", credit("figure-walk"))
    assert "nobody recorded it" in own["source"]
    qs.write_motion(tmp_path / "12_01.bvh", figure_walk(64))
    qs.write_motion(tmp_path / "a.tum", loop(64))
    qs.write_motion(tmp_path / "b.bvh", figure_walk(64))
    monkeypatch.setenv("QUATSPLINE_MOTIONS", str(tmp_path))
    played = module.replays(Run(quick=True, schemes=["slerp"]))
    assert [each["title"] for each in played] == ["12_01.bvh", "a.tum"]
    assert "mocap.cs.cmu.edu" in played[0]["source"]
    assert played[1]["source"] == ""
