"""Counts of operations: by hand, and by running the kernels as Python with every call counted."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from quatspline.catalogue import load, scheme, shipped
from quatspline.curve import Curve
from quatspline.operations import Operations, Per
from quatspline.options import among
from quatspline.timing.operations import executed, iterations, per_keyframe, per_sample
from quatspline.trajectories.paper import CASES, SOLVE

COUNTING = Path(__file__).parents[1] / "counting.py"

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


FITS = [
    *(("quartic",), ("slerp",)),
    *(("nielson", "change"), ("nielson", "residual"), ("kim", "change")),
]
SOLVES = [(name, case, *stop) for name, *stop in FITS for case in CASES]


@pytest.fixture(scope="module")
def counted() -> dict[tuple[str, ...], dict[str, int]]:
    """What the kernels of fits call, in a process without a compiler."""
    command = [sys.executable, str(COUNTING), *(",".join(solve) for solve in SOLVES)]
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    blank = dict.fromkeys(("slerps", "exps", "logs"), 0)
    found = (blank | json.loads(line) for line in done.stdout.splitlines())
    return dict(zip(SOLVES, found, strict=True))


@pytest.mark.parametrize("solve", SOLVES, ids="-".join)
def test_counts_are_what_the_kernels_execute(
    solve: tuple[str, ...], counted: dict[tuple[str, ...], dict[str, int]]
) -> None:
    found = dict(counted[solve])
    curve = solved(*solve)
    assert iterations(curve) == found.pop("iterations")
    assert executed(curve, samples=0).total == found


def test_many_keyframes_take_the_same_each() -> None:
    curve = solved("nielson", "teapot")
    assert per_sample(curve) == {"slerps": 6, "exps": 0, "logs": 0}
    assert per_keyframe(curve) == {"slerps": 40 * 2 + 3 + 2, "exps": 0, "logs": 3}
    assert executed(curve, 0).total["slerps"] == 6 * per_keyframe(curve)["slerps"]


def test_every_unit_is_counted_as_often_as_there_are_some() -> None:
    """Of the closed teapot's 6 keyframes and of the open key's 5, in two solves and three samples."""
    each = Per(sample=1, keyframe=10, inner_keyframe=100, segment=1e3, knot=1e4, solve=1e5)
    for case, inner, segments in (("teapot", 6, 6), ("key", 3, 4)):
        curve = solved("nielson", case)
        keys, updates = curve.keyframes.count, iterations(curve)
        set_up = 10 * keys + 100 * inner + 1e3 * segments + 1e4 * (segments + 1) + 1e5
        curve.operations = Operations(exps=each, iteration=Operations(exps=Per(keyframe=1)))
        counts = executed(curve, samples=3, solves=2)
        assert counts.updates["exps"] == 3 + 2 * updates * keys
        assert counts.rest["exps"] == 2 * set_up
        assert per_keyframe(curve)["exps"] == 10 + 100 + 1e3 + 1e4 + updates


def test_counts_in_english_are_refused() -> None:
    with pytest.raises(
        TypeError, match=r"operations of .* is no Operations: {'exps per sample': 3}"
    ):

        class Told(Curve):
            operations = {"exps per sample": 3}  # type: ignore[assignment]


def test_an_iteration_has_no_iteration() -> None:
    once = Operations(exps=Per(keyframe=1))
    with pytest.raises(ValueError, match="an iteration has no iteration of its own"):
        Operations(iteration=Operations(iteration=once))


def test_the_table_prints_them_apart() -> None:
    columns = [
        f"{key}_{part}" for key in ("slerps", "exps", "logs") for part in ("updates", "rest")
    ]
    row = pd.Series(counts("key", 9, "per-frame", "nielson"))
    assert set(columns) <= set(row.index)
