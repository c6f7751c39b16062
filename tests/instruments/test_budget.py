"""Forecasts of cost, and what a comparison leaves out on many keyframes."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

import quatspline as qs
from quatspline import comparing
from quatspline.timing import practical
from quatspline.timing.budget import Budget, calls, seconds
from quatspline.timing.practical import left_out
from walks import walk

IN_HOUSE = [name for name in qs.schemes() if qs.scheme(name).peer is None]
PEERS = [name for name in qs.schemes() if qs.scheme(name).peer is not None]


def looping(power: int) -> Callable[[int], Callable[[], object]]:
    """A job that makes so many calls: its size to a power, and ten."""

    def job(size: int) -> Callable[[], object]:
        return lambda: [abs(-1) for _ in range(size**power + 10)]

    return job


def test_calls_are_the_same_number_every_time() -> None:
    def call() -> None:
        for _ in range(7):
            sum(range(3))

    before = sys.getprofile()
    assert {calls(call) for _ in range(5)} == {9.0}  # call, seven sums, and what stops counting
    assert sys.getprofile() is before


def test_the_counter_is_taken_away_where_a_call_raises() -> None:
    def call() -> None:
        raise KeyError

    before = sys.getprofile()
    with pytest.raises(KeyError):
        calls(call)
    assert sys.getprofile() is before


def test_a_line_foretells_what_grows_with_the_size() -> None:
    budget = Budget(limit=1e4, meter=calls)
    foretold = budget.forecast(looping(1), 5000, linear=True)
    assert foretold == calls(looping(1)(5000))


def test_a_power_foretells_what_grows_faster() -> None:
    budget = Budget(limit=1e4, meter=calls)
    foretold = budget.forecast(looping(2), 1000)
    assert foretold == pytest.approx(calls(looping(2)(1000)), rel=0.02)
    assert not budget.affords(foretold)
    assert budget.affords(1e4)


def test_a_cost_that_no_size_changes_stays() -> None:
    assert Budget(limit=1.0, meter=lambda call: 3.0).forecast(looping(1), 10**6) == 3.0
    assert Budget(limit=1.0, meter=lambda call: 0.0).forecast(looping(1), 10**6) == 0.0


def test_the_first_call_is_not_measured() -> None:
    """It compiles or loads what it needs: here the first call of a size makes a thousand calls more."""
    seen: set[int] = set()

    def job(size: int) -> Callable[[], object]:
        def call() -> object:
            extra = 0 if size in seen else 1000
            seen.add(size)
            return [abs(-1) for _ in range(size + extra)]

        return call

    budget = Budget(limit=1e4, meter=calls)
    assert budget.forecast(job, 1000, linear=True) == calls(job(1000)) - 1000


def test_the_clock_is_a_meter() -> None:
    budget = Budget(limit=1e9, meter=seconds, sizes=(1, 2))
    assert budget.affords(budget.forecast(lambda size: lambda: None, 3))


@pytest.mark.parametrize("name", IN_HOUSE)
def test_schemes_of_this_package_are_measured_on_long_recordings(name: str) -> None:
    limit = qs.scheme(name).practical_keyframes
    assert (left_out(name, 20_000) is None) == (limit is None or limit >= 20_000)


@pytest.mark.parametrize("name", PEERS)
def test_libraries_are_left_out_from_some_number_of_keyframes_on(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never() -> float:
        raise AssertionError("a clock was read")

    left_out(name, 50)  # the first use of a library waits for other processes, by the clock
    monkeypatch.setattr(time, "perf_counter", never)
    assert left_out(name, 50) is None
    left = [left_out(name, count) is not None for count in (50, 200, 1000, 5000, 20_000)]
    assert left == sorted(left)
    assert left_out(name, 10**6) == "over budget on so many keyframes; ask for it by name"


def test_work_is_counted_alike_every_time() -> None:
    for name in ("splines-squad", "scipy-slerp"):
        work = {practical._work(qs.scheme(name), 1000) for _ in range(3)}
        assert len(work) == 1
        assert min(work) > 0.0


def test_what_is_left_out_is_a_row_unless_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ["slerp", "min-torque", "scipy-slerp"]
    monkeypatch.setattr(comparing, "schemes", lambda: names)
    monkeypatch.setattr(practical, "BUDGET", Budget(limit=10.0, meter=calls))
    keyframes = walk(201, 5.0, seed=1)
    failures = qs.compare(None, keyframes).set_index("scheme")["failure"]
    assert failures.isna().to_dict() == {"slerp": True, "min-torque": False, "scipy-slerp": False}
    assert failures["min-torque"] == "over budget beyond 200 keyframes; ask for it by name"
    assert failures["scipy-slerp"].startswith("over budget on so many keyframes")
    assert qs.compare(None, keyframes, ["scipy-slerp"])["failure"].isna().all()


def test_failure_is_public() -> None:
    """A column of every table: NaN where a scheme was measured, else why it was not."""
    keyframes = np.tile([1.0, 0, 0, 0], (4, 1))
    for names, worked in ((["slerp"], [True]), (["shoemake-bezier"], [False])):
        table = qs.compare([0, 1, 3, 4], keyframes, names)
        assert pd.isna(table.failure).tolist() == worked
        assert pd.isna(table["misses"]).tolist() != worked
    assert table.failure[0].startswith("ValueError: times[1] to times[2]")
    table = qs.compare([0, 1, 3, 4], keyframes, ["shoemake-bezier", "slerp", "slerp"])
    assert table["scheme"].tolist() == ["slerp", "shoemake-bezier"]
    assert table.failure.isna().tolist() == [True, False]
