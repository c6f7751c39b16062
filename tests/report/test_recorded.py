"""Findings on recorded motion: their numbers are those of the tables, and they say what was not recorded."""

from __future__ import annotations

import re

import pandas as pd
import pytest

from quatspline.findings.quotes import Ledger
from quatspline.findings.recorded import CIRCULAR, SCHEMES, SENTENCES, TOPIC
from quatspline.instruments.summary import ALL
from quatspline.trajectories.clips import CONTROLS, OWN

NAMES = ("slerp", *SCHEMES, *CIRCULAR)


def rebuilt(clips: list[str]) -> pd.DataFrame:
    """A table of the experiment reconstruct, each ratio a number of its own."""
    rows = [
        {"clip": clip, "filter": kind, "every": every, "scheme": name}
        for clip in (ALL, *clips, *CONTROLS)
        for kind in (("none",) if clip in CONTROLS else ("none", "6 Hz"))
        for every in (4, 16)
        for name in NAMES
    ]
    table = pd.DataFrame(rows)
    numbers = pd.Series(range(len(table)), dtype=float)
    angles = (170.0 - numbers / 10).where(table["clip"] != ALL)
    return table.assign(over_slerp=numbers / 100, compared_joints=40, largest_degrees=angles)


def reduced() -> pd.DataFrame:
    rows = [
        {"clip": ALL, "filter": kind, "error_degrees": 0.5, "scheme": name, "compared_joints": 41}
        for kind in ("none", "10 Hz")
        for name in NAMES
    ]
    table = pd.DataFrame(rows)
    return table.assign(over_slerp=pd.Series(range(len(table)), dtype=float) / 10)


def ledger(clips: list[str], **changed: pd.DataFrame) -> Ledger:
    tables = {"reconstruct": rebuilt(clips), "reduce": reduced()} | changed
    return Ledger(tables.__getitem__)


def text(sentence, cell: Ledger) -> str:
    return "".join(map(str, sentence(cell)))


@pytest.mark.parametrize("sentence", [sentence for _, sentence in SENTENCES])
def test_no_digit_is_written_by_hand(sentence) -> None:
    written = [part for part in sentence(ledger(["a.bvh", "b.amc"])) if isinstance(part, str)]
    assert not re.search(r"\d", "".join(written))


def test_what_nobody_recorded_is_told() -> None:
    worth = SENTENCES[0][1]
    assert "40 recorded joints are off" in text(worth, ledger(["a.bvh"]))
    made = text(worth, ledger([OWN]))
    assert "the 40 joints of the walk that this project generates" in made
    assert "recorded joints" not in made


def test_the_largest_angle_is_that_of_all_clips_but_controls() -> None:
    table = rebuilt(["a.bvh", "b.amc"])
    circles = SENTENCES[2][1]
    picked = table["clip"].isin(["a.bvh", "b.amc"]) & (table["filter"] == "none")
    rows = table[picked & (table["every"] == 16)].groupby("scheme")["largest_degrees"].max()
    told = text(circles, ledger(["a.bvh", "b.amc"]))
    for name in (*CIRCULAR, "slerp"):
        assert f"{rows[name]:.1f}" in told


@pytest.mark.parametrize("sentence", [sentence for _, sentence in SENTENCES])
def test_a_scheme_that_was_not_compared_leaves_the_sentence_out(sentence) -> None:
    lost = {
        name: table.assign(over_slerp=float("nan"), largest_degrees=float("nan"))
        for name, table in (("reconstruct", rebuilt(["a.bvh"])), ("reduce", reduced()))
    }
    with pytest.raises(LookupError):
        sentence(ledger(["a.bvh"], **lost))


def test_they_stand_under_one_topic() -> None:
    assert {topic for topic, _ in SENTENCES} == {TOPIC}
