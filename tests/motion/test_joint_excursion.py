"""`compare --keep` on several tracks: how far joints leave the arcs between their keyframes, and needs of that."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from clips import figure

import quatspline as qs
from quatspline.catalogue import called, scheme
from quatspline.cli import joint_ranking, main
from quatspline.findings.needs import Needs
from quatspline.instruments import kept
from quatspline.motion import Motion
from quatspline.timing.own_keyframes import too_dear


@pytest.fixture
def walk(tmp_path: Path) -> Path:
    qs.write_motion(tmp_path / "walk.bvh", figure(64))
    return tmp_path / "walk.bvh"


def run(*words: Any) -> int:
    return main([str(word) for word in words])


def test_the_excursion_of_a_joint_is_that_of_its_track_alone(walk: Path, tmp_path: Path) -> None:
    names = ["slerp", "squad", "min-torque"]
    words = ("compare", walk, "--keep", 8, "--schemes", *names, "--out", tmp_path / "out")
    assert run(*words) == 0
    joints = pd.read_csv(tmp_path / "out" / "joints.csv").set_index(["scheme", "joint"])
    worst = pd.read_csv(tmp_path / "out" / "kept.csv").set_index("scheme")
    keys = [*range(0, 64, 8), 63]
    motion = qs.read_motion(walk)
    for k in range(5):
        alone = qs.compare(motion.times[keys], motion.quaternions[keys, k], names, tolerance=1e-11)
        for name, own in alone.set_index("scheme")["excursion"].items():
            assert joints.loc[(name, f"joint {k}"), "excursion"] == pytest.approx(own, abs=1e-6)
    assert worst["excursion"].to_dict() == joints["excursion"].groupby("scheme").max().to_dict()
    assert worst.loc["slerp", "excursion"] == 0.0
    assert worst.loc["squad", "excursion"] > 0.1


def test_pieces_and_joints_without_a_curve_have_excursions_of_their_own(walk: Path) -> None:
    motion = qs.read_motion(walk)
    edges = motion.stamps.copy()
    edges[30:] += 10.0
    split = Motion(edges, motion.quaternions, motion.positions, motion.tracks, max_gap=5.0)
    whole = kept.row(split, "squad", 4, {})
    parts = [kept.row(piece, "squad", 4, {}) for piece in split.pieces()]
    assert len(parts) == 2
    assert whole["excursion"] == pytest.approx(max(p["excursion"] for p in parts), rel=1e-9)
    assert np.isnan(kept.row(split, "squad", 4, {}, arcs=False)["excursion"])


def test_joints_that_must_not_overshoot(
    walk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = "slerp,local-quintic,squad,quartic,biarc,catmull-rom,kim"
    words = ("compare", walk, "--keep", 8, "--schemes", names, "--out", tmp_path / "out")
    assert run(*words) == 0
    table = pd.read_csv(tmp_path / "out" / "kept.csv").set_index("scheme")["excursion"]
    assert table.idxmin() == "slerp"
    between = np.mean(np.sort(table)[1:3])
    second, third = table.sort_values().index[1:3]
    capsys.readouterr()
    assert run(*words, "--max-excursion", between) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith(f"Ruled out by --max-excursion {between:g}: {third}")
    assert "slerp" not in lines[0]
    told = re.match(rf".*?: {third}[^,]*, ([\d.]+) deg", lines[0])
    assert told is not None
    assert float(told[1]) == pytest.approx(table[third], rel=5e-3)
    shown = [line.split()[0] for line in lines[3:8]]
    assert sorted(shown[:2]) == sorted(["slerp", second])
    assert shown[2] == third
    assert lines[8] == "2 more on the page, all ruled out by your needs."
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert f"Ruled out by --max-excursion {between:g}" in page
    [played] = json.loads((tmp_path / "out" / "kept.replay.json").read_text())
    assert sorted(played["schemes"]) == sorted(["slerp", second])


def test_joints_none_of_which_keep_to_their_arcs(
    walk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("compare", walk, "--keep", 8, "--schemes", "squad,local-quintic")
    assert run(*words, "--out", tmp_path / "out", "--max-excursion", 0) == 0
    first, second, *_ = capsys.readouterr().out.splitlines()
    table = pd.read_csv(tmp_path / "out" / "kept.csv").set_index("scheme")["excursion"]
    nearest = called(str(table.idxmin()))
    every = "No scheme measured meets your needs (--max-excursion 0)."
    assert first.startswith(f"{every} The nearest is {nearest}: ")
    assert second.startswith(f"Ruled out by --max-excursion 0: {nearest}, ")


def test_joints_whose_curves_wait_for_few_keyframes(
    walk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = ["kim", "slerp", "squad", "local-quintic"]
    words = ("compare", walk, "--keep", 8, "--schemes", *names, "--out", tmp_path / "out")
    assert run(*words, "--local", "--causal", 0) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "Ruled out by --local: kim, shaped by all keyframes."
    assert lines[1].startswith("Ruled out by --causal 0: squad, waits for 1 keyframe; ")
    assert lines[4].startswith("slerp ")
    table = pd.read_csv(tmp_path / "out" / "kept.csv").set_index("scheme")
    for name in names:
        cls = scheme(name)
        wanted = ["all" if n is None else str(n) for n in (cls.support, cls.lookahead)]
        assert table.loc[name, ["support", "lookahead"]].astype(str).tolist() == wanted


@pytest.mark.parametrize("flag", ["--smooth 2", "--max-rate 10", "--max-accel 10"])
def test_needs_that_only_one_track_has_are_refused_with_a_way_out(
    flag: str, walk: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("compare", walk, "--keep", 8, "--out", tmp_path / "out", "--max-excursion", 1)
    assert run(*words, *flag.split()) == 2
    told = capsys.readouterr().err
    assert f"walk.bvh: {flag} applies to a single track, and there are 5: leave it out" in told


def test_a_library_that_would_take_too_long_is_dear() -> None:
    assert not too_dear("squad", 10**6, 65)
    assert not too_dear("scipy-slerp", 100, 65)
    assert too_dear("splines-squad", 10**5, 65)


def test_what_was_not_measured_meets_no_need_and_breaks_none() -> None:
    row = {"rms_median": 0.1, "rms_worst": 0.2, "largest": 0.3, "failure": None}
    row |= {"worst_joint": "a", "largest_joint": "b", "support": "4", "lookahead": "1"}
    off = {"kim": np.nan, "squad": 3.0, "slerp": 0.0}
    table = pd.DataFrame([{"scheme": name, "excursion": x} | row for name, x in off.items()])
    needs = Needs(max_excursion=1.0, table="kept")
    found = joint_ranking.answer(table, needs)
    text, more = (finding.text for finding in found)
    assert more == "Not held against your needs, because measuring would take too long: kim."
    assert text == "Ruled out by --max-excursion 1: squad, 3.00 deg."
    assert {cell.table for finding in found for cell in finding.cells} == {"kept"}
    lines = joint_ranking.spoken(found, table, needs)
    assert [line.split()[0] for line in lines[4:]] == ["slerp", "squad", "kim"]
    assert lines[-1].split()[4] == "-"
    assert joint_ranking.meeting(table, needs)["scheme"].tolist() == ["slerp"]
    order = [line.split()[0] for line in joint_ranking.spoken([], table, Needs())[1:]]
    assert order == list(off)
