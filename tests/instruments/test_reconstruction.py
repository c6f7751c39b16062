"""Recorded motion rebuilt and reduced: values known by hand, joints left out, clips, ratios over clips."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.instruments import reconstruction as rec
from quatspline.instruments.reduction import reduction
from quatspline.instruments.summary import ALL, LISTS, compared
from quatspline.motion import Skeleton
from quatspline.runs.experiment import sources
from quatspline.trajectories import clips
from quatspline.trajectories.figure_walk import RATE, figure_walk

ARM = Skeleton(
    np.array([-1, 0]),
    np.array([[0.0, 0, 0], [0, 1, 0]]),
    ("ZYX", "ZYX"),
    {1: np.array([0, 2.0, 0])},
)


def spun(degrees: np.ndarray, rate: float = 100.0, tracks: int = 1) -> qs.Motion:
    """Turns about z by angles (n,), of a root at rest and an arm of 2 m, or of tracks alone."""
    half = np.radians(degrees)[:, None, None] / 2 * [0.0, 0, 1]
    q = np.repeat(quaternion.exp(half), tracks, axis=1)
    t = np.arange(len(degrees)) / rate
    if tracks == 1:
        q = np.concatenate([np.broadcast_to([1.0, 0, 0, 0], q.shape), q], axis=1)
        x = np.tile(ARM.offsets, (len(t), 1, 1))
        return qs.Motion(t, q, x, ["root", "arm"], ARM, "m")
    return qs.Motion(t, q, tracks=[f"track {k}" for k in range(tracks)])


def row(motion: qs.Motion, name: str, every: int, rates: bool = False) -> dict:
    true = rec.truth(motion)
    return rec.reconstruction(true, rec.rebuild(true, name, every, rates=rates), every)


def test_slerp_cuts_the_corner_of_a_parabola() -> None:
    """Of i^2 / 100 degrees, frame 2 k + 1 is 0.01 degrees below the chord: at every frame left out."""
    found = row(spun(np.arange(101.0) ** 2 / 100), "slerp", 2, rates=True)
    assert found["joints"] == 1
    assert found["frames"] == 50 - 4
    for column in ("rms_degrees", "worst_degrees", "largest_degrees"):
        assert found[column] == pytest.approx(0.01, rel=1e-9)
    assert found["worst_joint"] == "arm"
    assert found["end_cm"] == pytest.approx(200 * np.radians(0.01), rel=1e-6)
    assert found["end_largest_cm"] == pytest.approx(found["end_cm"])
    # A chord has the rate of the middle, and no acceleration where the truth has 200 degrees a second squared.
    assert found["omega"] < 1e-9
    assert found["alpha"] == pytest.approx(1.0)


@pytest.mark.parametrize("name", ["local-quintic", "squad", "euler-cubic"])
def test_smooth_schemes_rebuild_a_parabola(name: str) -> None:
    found = row(spun(np.arange(101.0) ** 2 / 100), name, 4)
    assert found["largest_degrees"] < 0.03 * 0.04  # slerp's


def test_euler_channels_are_slerp_about_one_axis() -> None:
    motion = spun(np.arange(101.0) ** 2 / 100)
    linear, slerp = (row(motion, name, 4)["rms_degrees"] for name in ("euler-linear", "slerp"))
    assert linear == pytest.approx(slerp, rel=1e-9)


def test_what_does_not_move_pops_or_is_a_finger_is_left_out() -> None:
    motion = spun(np.linspace(0, 90, 101), tracks=4)
    q = motion.quaternions.copy()
    q[:, 0] = q[0, 0]
    q[50:, 1] = quaternion.mul(q[50:, 1], [0.8, 0.6, 0, 0])
    motion = qs.Motion(motion.times, q, tracks=["still", "pop", "lthumb", "elbow"])
    true = rec.truth(motion)
    assert true.tracks.tracks == ["elbow"]
    assert true.pops == ["pop"]
    assert row(motion, "slerp", 5)["pops"] == "pop"
    with pytest.raises(ValueError, match="no joint moves"):
        rec.truth(qs.Motion(motion.times, q[:, :1]))


def test_the_filter_keeps_what_is_slow_and_takes_what_is_fast() -> None:
    """At the cutoff a Butterworth filter passes half of what goes through it twice."""
    t = np.arange(601) / 100
    swings = {hz: 10 * np.sin(2 * np.pi * hz * t) for hz in (0.5, 6.0, 30.0)}
    sizes = {}
    for hz, swing in swings.items():
        calm = rec.filtered(spun(swing), 6.0).quaternions[200:400, 1]
        steps = np.degrees(quaternion.distance(calm[1:], calm[:-1]))
        sizes[hz] = float(steps.max() / np.abs(np.diff(swing)).max())
    assert sizes[0.5] == pytest.approx(1.0, abs=1e-3)
    assert sizes[6.0] == pytest.approx(0.5, abs=0.01)
    assert sizes[30.0] < 0.01


def test_too_few_keyframes_are_refused() -> None:
    with pytest.raises(ValueError, match="none of their segments is away from the ends"):
        row(spun(np.linspace(0, 50, 33)), "slerp", 8)


def test_a_joint_that_fails_is_counted_and_the_others_go_on() -> None:
    motion = spun(np.arange(101.0) ** 2 / 100, tracks=3)
    true = rec.truth(motion)
    rebuilt = rec.rebuild(true, "slerp", 2)
    broken = rebuilt.quaternions.copy()
    broken[:, 1] = np.nan
    found = rec.reconstruction(true, rebuilt._replace(quaternions=broken), 2)
    assert found["failed_joints"] == 1
    assert found[LISTS] == [pytest.approx(0.01), None, pytest.approx(0.01)]
    assert found["rms_degrees"] == pytest.approx(0.01)


def test_a_zigzag_needs_its_corners() -> None:
    corners = np.abs((np.arange(41) + 10) % 20 - 10.0)
    found = reduction(spun(corners, tracks=2), "slerp", np.radians(0.1))
    assert found[LISTS] == [5, 5]
    assert found["keyframes"] == 10
    assert found["share"] == pytest.approx(10 / 82)
    assert found["per_second"] == pytest.approx(5 / 0.4)


# -- clips --------------------------------------------------------------------------------------


def test_the_figure_walks_and_its_hinges_reverse() -> None:
    motion = figure_walk()
    assert motion.quaternions.shape == (600, 18, 4)
    np.testing.assert_array_equal(motion.quaternions, figure_walk().quaternions)
    assert np.abs(motion.quaternions - figure_walk(seed=2).quaternions).max() > 0.01
    assert motion.positions is not None
    ahead = np.ptp(motion.positions[:, 0, 2])
    assert ahead == pytest.approx(1.25 * 599 / RATE, rel=1e-6)
    for side in ("left", "right"):
        hinge = motion.quaternions[:, motion.tracks.index(f"{side} shin")]
        np.testing.assert_array_equal(hinge[:, 2:], 0.0)  # about x alone
        turns = np.degrees(2 * np.arctan2(hinge[:, 1], hinge[:, 0]))
        assert np.ptp(turns) > 40
        slow = np.diff(turns[::12])
        assert np.count_nonzero(np.diff(np.sign(slow))) > 8
    ends = motion.ends()
    assert set(ends) == {"head"} | {f"{s} {e}" for s in ("left", "right") for e in ("toes", "hand")}
    assert ends["head"][:, 1].min() > 1.4 > 0.4 > ends["left toes"][:, 1].max()


def test_noise_is_what_keeps_schemes_close_on_the_figure() -> None:
    ratios = []
    for noise in (1.5, 0.0):
        motion = figure_walk(noise=noise)
        smooth, chords = (row(motion, name, 4)["rms_degrees"] for name in ("kim", "slerp"))
        ratios.append(smooth / chords)
    assert ratios[0] > 0.7
    assert ratios[1] < 0.02


def test_the_figure_survives_a_file(tmp_path: Path) -> None:
    motion = figure_walk(60)
    qs.write_motion(tmp_path / "walk.bvh", motion)
    again = qs.read_motion(tmp_path / "walk.bvh")
    assert again.tracks == motion.tracks
    apart = quaternion.distance(again.quaternions, motion.quaternions)
    assert np.degrees(apart.max()) < 1e-5


def test_white_noise_is_worse_the_smoother_the_scheme() -> None:
    """A frame's own noise, and the sum of squared weights of its keyframes': slerp's is 1/2 midway."""
    noise = clips.clip("white noise")
    slerp, kim = (row(noise, name, 2) for name in ("slerp", "kim"))
    rms = float(np.sqrt(np.mean(np.square(slerp[LISTS]))))
    assert rms == pytest.approx(clips.DEGREES * np.sqrt(3 * 1.5), rel=0.02)
    assert 1.02 < kim["rms_degrees"] / slerp["rms_degrees"] < 1.2


def test_clips_are_the_files_of_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(clips.FOLDER, raising=False)
    assert clips.names() == [clips.OWN]
    monkeypatch.setenv(clips.FOLDER, str(tmp_path))
    with pytest.raises(ValueError, match="no folder with motion files"):
        clips.names()
    motion = figure_walk(60)
    q = motion.quaternions.copy()
    q[0] = quaternion.mul(q[0], quaternion.exp([0.0, 0.7, 0]))
    qs.write_motion(tmp_path / "posed.bvh", motion.moved(motion.stamps, q, motion.positions))
    qs.write_motion(tmp_path / "walk.npz", motion)
    (tmp_path / "README.md").write_text("not a clip")
    assert clips.names() == ["posed.bvh", "walk.npz"]
    before = sources()  # what was measured on a clip does not stand for another of its name
    (tmp_path / "README.md").write_text("changed")
    assert sources() != before
    assert len(clips.clip("posed.bvh").times) == 59  # without the pose before the motion
    assert len(clips.clip("walk.npz").times) == 60
    with pytest.raises(ValueError, match=r"did you mean 'walk\.npz'"):
        clips.clip("wall.npz")


# -- ratios -------------------------------------------------------------------------------------


def test_ratios_are_of_joints_on_which_all_ran() -> None:
    """2 and 8 on nine joints; the tenth, on which squad failed, counts for nobody; rare failed on too many."""
    lists = {
        ("a", "slerp"): [1.0] * 10,
        ("a", "kim"): [8.0] * 3 + [2.0] * 6 + [100.0],
        ("a", "squad"): [4.0] * 9 + [None],
        ("a", "rare"): [1.0] * 8 + [None] * 2,
        ("b", "slerp"): [2.0],
        ("b", "kim"): [1.0],
        ("control", "slerp"): [1.0],
        ("control", "kim"): [50.0],
    }
    rows = [{"clip": clip, "scheme": s, "x": 1.0, LISTS: v} for (clip, s), v in lists.items()]
    rows.append({"clip": "a", "scheme": "broken", "failure": "ValueError: no"})
    table = compared(pd.DataFrame(rows), ["clip", "scheme"], "slerp", {"control"})
    assert LISTS not in table
    table = table.set_index(["clip", "scheme"])
    assert table.loc[("a", "kim"), "over_slerp"] == pytest.approx(2.0 ** (15 / 9))
    assert table.loc[("a", "kim"), "most_over_slerp"] == pytest.approx(8.0)
    assert table.loc[("a", "squad"), "over_slerp"] == pytest.approx(4.0)
    assert table.loc[("a", "kim"), "compared_joints"] == 9
    assert np.isnan(table.loc[("a", "rare"), "over_slerp"])
    assert table.loc[("control", "kim"), "over_slerp"] == pytest.approx(50.0)
    assert table.loc[(ALL, "kim"), "over_slerp"] == pytest.approx(2.0 ** (14 / 10))
    assert table.loc[(ALL, "kim"), "compared_joints"] == 10
    assert table.loc[(ALL, "squad"), "failure"] == "on 1 of 2 clips only"
    assert np.isnan(table.loc[(ALL, "squad"), "over_slerp"])
    assert table.loc[("a", "broken"), "failure"] == "ValueError: no"
