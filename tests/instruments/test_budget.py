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
from quatspline.discovery import shipped
from quatspline.runs.experiment import Run
from quatspline.system.loading import load
from quatspline.timing import own_keyframes
from quatspline.timing.budget import OVER, Budget, Call, Job, calls, rungs, seconds, too_many
from quatspline.timing.own_keyframes import left_out
from walks import walk

IN_HOUSE = [name for name in qs.schemes() if qs.scheme(name).peer is None]
PEERS = [name for name in qs.schemes() if qs.scheme(name).peer is not None]


def looping(power: int) -> Job:
    """A job that makes so many calls: its size to a power, and ten."""

    def job(size: int) -> Call:
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
    assert Budget(limit=9.0, meter=lambda call: 3.0).forecast(looping(1), 10**6) == 3.0
    assert Budget(limit=9.0, meter=lambda call: 0.0).forecast(looping(1), 10**6) == 0.0


def test_the_first_call_is_not_measured() -> None:
    """It compiles or loads what it needs: here the first call of a size makes a thousand calls more."""
    seen: set[int] = set()

    def job(size: int) -> Call:
        def call() -> object:
            extra = 0 if size in seen else 1000
            seen.add(size)
            return [abs(-1) for _ in range(size + extra)]

        return call

    budget = Budget(limit=1e6, meter=calls)
    assert budget.forecast(job, 1000, linear=True) == calls(job(1000)) - 1000


def test_seconds_are_of_computing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Who else shares the processor decides nothing."""
    now = [0.0]
    monkeypatch.setattr(time, "process_time", lambda: now[0])
    monkeypatch.setattr(time, "perf_counter", lambda: 1e3 * now[0])

    def job(size: int) -> Call:
        return lambda: now.append(now.pop() + 0.5 * size)

    budget = Budget(limit=1e9, meter=seconds)
    assert budget.forecast(job, 4, linear=True, sizes=(1, 2)) == pytest.approx(2.0)


def test_rungs_lead_up_to_a_size() -> None:
    assert rungs(1_000_000, 5) == [10, 100, 1000, 10_000, 100_000]
    assert rungs(100, 1) == [1, 10]
    assert rungs(5, 5) == [5]


def metered(cost: Callable[[int], float], limit: float = 1e9) -> tuple[Budget, Job, list[int]]:
    """A budget whose meter reads off what a call of a size costs; the job, and the sizes it was called at."""
    made: list[int] = []

    def meter(call: Call) -> float:
        call()
        return cost(made[-1])

    return Budget(limit, meter), lambda size: lambda: made.append(size), made


@pytest.mark.parametrize(("power", "linear"), [(0, True), (1, True), (1, False), (2, False)])
def test_the_last_two_rungs_are_extrapolated(power: int, linear: bool) -> None:
    budget, job, _ = metered(lambda size: 1e-6 * size**power)
    foretold = budget.forecast(job, 10_000, linear=linear, sizes=rungs(10_000, 1))
    assert foretold == pytest.approx(1e-6 * 10_000**power)


def test_a_cost_of_one_size_is_in_proportion_and_of_the_size_itself() -> None:
    budget, job, _ = metered(lambda size: 2.0 * size)
    assert budget.forecast(job, 100, sizes=[10]) == 200.0
    assert budget.forecast(job, 5, sizes=rungs(5, 5)) == 10.0


def test_a_forecast_never_falls_with_the_size() -> None:
    budget, job, _ = metered(lambda size: 1.0 / size)
    assert budget.forecast(job, 1000, linear=True, sizes=(1, 10)) == 1.0


def test_a_size_that_is_foretold_to_exceed_the_limit_is_not_tried() -> None:
    budget, job, made = metered(lambda size: 1e-6 * size**2, limit=5.0)
    foretold = budget.forecast(job, 1_000_000, sizes=rungs(1_000_000, 1))
    assert not budget.affords(foretold)
    assert max(made) == 1000  # costs 1, from which 10,000 would cost a hundred


def test_a_hiccup_is_no_cost_and_a_dear_call_is_made_once() -> None:
    waits = [0.3]
    budget, job, made = metered(lambda size: 1e-3 * size + (waits.pop() if waits else 0.0), 5.0)
    assert budget.forecast(job, 10_000, sizes=(100, 1000)) == pytest.approx(10.0)
    assert made == [100, 100, 100, 1000]


@pytest.mark.parametrize(("fixed", "most", "expected"), [(0.0, 50, 50), (0.0, 10**6, 1000)])
def test_the_largest_size_keeps_within_the_limit(fixed: float, most: int, expected: int) -> None:
    budget, job, _ = metered(lambda size: fixed + 1e-3 * size, limit=1.0)
    assert budget.largest(job, most, start=10) == expected


def test_a_fixed_cost_does_not_count_for_every_item() -> None:
    budget, job, _ = metered(lambda size: 0.1 + 1e-6 * size, limit=1.0)
    size = budget.largest(job, 10**7, start=100)
    assert 0.5 <= 0.1 + 1e-6 * size <= 1.0


def test_a_scheme_says_how_many_keyframes_are_practical() -> None:
    assert too_many(qs.scheme("min-torque"), 200) is None
    assert too_many(qs.scheme("min-torque"), 201) == "over budget beyond 200 keyframes"
    assert too_many(qs.scheme("slerp"), 10**9) is None


@pytest.mark.parametrize("limit", [0.0, 1e12])
def test_only_libraries_are_held_against_a_budget(limit: float) -> None:
    budget = Budget(limit, calls)
    assert budget.refusal(qs.scheme("slerp"), 1000, (1, 0, 0)) is None
    assert budget.refusal(qs.scheme("scipy-slerp"), 1000) == (None if limit else OVER)


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
    monkeypatch.setattr(time, "process_time", never)
    assert left_out(name, 50) is None
    left = [left_out(name, count) is not None for count in (50, 200, 1000, 5000, 20_000)]
    assert left == sorted(left)
    reason = left_out(name, 10**6)
    assert reason is not None
    assert reason.startswith(OVER)
    assert reason.endswith("; ask for it by name")


def test_work_is_counted_alike_every_time() -> None:
    for name in ("splines-squad", "scipy-slerp"):
        budget = Budget(limit=1e9, meter=calls)
        work = {budget.work(qs.scheme(name), 1000, (400, 20, 20)) for _ in range(3)}
        assert len(work) == 1
        assert min(work) > 0.0


def test_levels_of_accuracy_are_over_budget_by_what_is_practical_and_by_counts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    module = load(shipped("experiments") / "accuracy.py", "experiment")
    monkeypatch.setattr(module, "BUDGET", Budget(limit=5e5, meter=calls))
    monkeypatch.setattr(module, "QUICK", (11, 21, 201))
    monkeypatch.setattr(module, "FULL", (11, 21, 201))
    run = Run(quick=True, schemes=["slerp", "min-torque", "splines-squad"])
    found = {
        name: [row.get("failure") for row in module.measure_cell(run, "uniform", name)]
        for name in run.schemes
    }
    assert found["slerp"] == [None] * 3
    assert found["min-torque"] == [None, None, "over budget beyond 200 keyframes"]
    assert found["splines-squad"] == [None, None, OVER]


def test_what_is_left_out_is_a_row_unless_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ["slerp", "min-torque", "scipy-slerp"]
    monkeypatch.setattr(comparing, "schemes", lambda: names)
    monkeypatch.setattr(own_keyframes, "BUDGET", Budget(limit=10.0, meter=calls))
    keyframes = walk(201, 5.0, seed=1)
    failures = qs.compare(None, keyframes).set_index("scheme")["failure"]
    assert failures.isna().to_dict() == {"slerp": True, "min-torque": False, "scipy-slerp": False}
    assert failures["min-torque"] == "over budget beyond 200 keyframes; ask for it by name"
    assert failures["scipy-slerp"] == "over budget; ask for it by name"
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
