"""Counts of operations in tables: the published protocols by hand, beside what running the kernels counts."""

from __future__ import annotations

from typing import Any

import pandas as pd
import pytest

from quatspline.catalogue import scheme
from quatspline.curve import Curve
from quatspline.discovery import shipped
from quatspline.options import among
from quatspline.system.loading import load
from quatspline.timing.operations import executed, per_keyframe, per_sample
from quatspline.trajectories.paper import CASES, SOLVE

table1 = load(shipped("experiments") / "table1.py", "experiment")


def solved(name: str, case: str, stop: str | None = None) -> Curve:
    wanted = SOLVE | ({"stop": stop} if stop else {})
    given = among(scheme(name), wanted)
    return scheme(name).from_keyframes(CASES[case].keyframes(), **given)


def counts(case: str, frames: int, protocol: str, name: str) -> dict[str, Any]:
    return table1.counted(CASES[case], frames, protocol, name)


def test_nielson_on_the_open_key_solves_for_three_of_five_keyframes() -> None:
    """Per frame 16 updates of 3 controls by 2 slerps, and a sample of 6; then a residual of 3 slerps at each of 3
    and 2 slerps for each of 4 segments."""
    found = counts("key", 9, "per-frame", "nielson")
    assert found["iterations"] == 16
    assert found["slerps_updates"] == 9 * (16 * 3 * 2 + 6) == 918
    assert found["slerps_rest"] == 9 * (3 * 3 + 4 * 2) == 153
    assert found["slerps"] == 1071
    once = counts("key", 9, "solve-once", "nielson")
    assert once["slerps"] == 16 * 3 * 2 + 9 * 6 + 3 * 3 + 4 * 2


def test_nielson_on_the_closed_teapot_solves_for_all_six() -> None:
    found = counts("teapot", 12, "per-frame", "nielson")
    assert found["iterations"] == 40
    assert found["slerps_updates"] == 12 * (40 * 6 * 2 + 6) == 5832
    assert found["slerps_rest"] == 12 * (6 * 3 + 6 * 2) == 360
    assert found["slerps"] == 6192


def test_the_quartic_takes_a_logarithm_a_segment() -> None:
    found = counts("key", 9, "per-frame", "quartic")
    assert (found["logs"], found["logs_updates"], found["logs_rest"]) == (36, 0, 36)
    assert (found["exps"], found["exps_updates"], found["exps_rest"]) == (27, 27, 0)
    assert counts("teapot", 12, "per-frame", "quartic")["logs"] == 12 * 6


def test_what_is_printed_apart_adds_up() -> None:
    for name in table1.SCHEMES:
        for case in CASES:
            found = counts(case, 12, "per-frame", name)
            for operation in ("slerps", "exps", "logs"):
                parts = (found[f"{operation}_updates"], found[f"{operation}_rest"])
                assert found[operation] == sum(parts)


def test_many_keyframes_take_the_same_each() -> None:
    curve = solved("nielson", "teapot")
    assert per_sample(curve) == {"slerps": 6, "exps": 0, "logs": 0}
    assert per_keyframe(curve) == {"slerps": 40 * 2 + 3 + 2, "exps": 0, "logs": 3}
    assert executed(curve, 0).total["slerps"] == 6 * per_keyframe(curve)["slerps"]


def test_counts_in_english_are_refused() -> None:
    with pytest.raises(
        TypeError, match=r"operations of .*: expected an Operations, found {'exps per sample': 3}"
    ):

        class Told(Curve):
            operations = {"exps per sample": 3}  # type: ignore[assignment]


def test_the_table_prints_them_apart() -> None:
    columns = [
        f"{key}_{part}" for key in ("slerps", "exps", "logs") for part in ("updates", "rest")
    ]
    row = pd.Series(counts("key", 9, "per-frame", "nielson"))
    assert set(columns) <= set(row.index)
