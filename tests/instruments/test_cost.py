"""Costs within a budget, by a clock of our own; memory; counts; the experiment's table."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest

from quatspline.catalogue import scheme
from quatspline.curve import Curve
from quatspline.discovery import shipped
from quatspline.runs.experiment import Run
from quatspline.segments import CHUNK, LAZY
from quatspline.system.loading import load
from quatspline.timing import cost, speed
from quatspline.timing.budget import Budget, Call, calls, seconds
from quatspline.trajectories.walks import walk

AMPLE = 600.0
"""A budget in seconds that no hiccup of a busy machine exceeds."""


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The time, by the clock and of the process, which only toy calls advance."""
    now = [0.0]
    monkeypatch.setattr(time, "perf_counter", lambda: now[0])
    monkeypatch.setattr(time, "process_time", lambda: now[0])
    return now


def toy(clock: list[float], seconds: Callable[[int], float], made: list[int]) -> cost.Task:
    def prepare(size: int) -> Call:
        def call() -> None:
            made.append(size)
            clock[0] += seconds(size)

        return call

    return cost.Task(prepare, linear=False)


def test_a_call_over_budget_is_never_made(clock):
    made: list[int] = []
    found = cost.costs(
        {"square": toy(clock, lambda size: 1e-6 * size**2, made)},
        100_000,
        budget=Budget(5.0, seconds),
        rounds=3,
        duration=0.01,
    )
    assert found["square"].failure == "over budget"
    assert np.isnan(found["square"].seconds)
    assert max(made) == 1000  # a second, from which 10,000 would take a hundred


def test_fast_calls_are_timed_in_rounds_and_slow_ones_once(clock):
    made: list[int] = []
    tasks = {
        "fast": toy(clock, lambda size: 1e-6 * size, []),
        "slow": toy(clock, lambda size: 1e-3 * size, made),
    }
    found = cost.costs(tasks, 1000, budget=Budget(5.0, seconds), rounds=4, duration=0.01)
    assert found["fast"].seconds == pytest.approx(1e-3)
    assert found["fast"].iqr == pytest.approx(0.0, abs=1e-12)
    assert found["fast"].rounds == 4
    assert found["slow"].seconds == pytest.approx(1.0)
    assert np.isnan(found["slow"].iqr)
    assert made.count(1000) == 1


def test_a_failure_is_told_and_the_others_are_timed(clock):
    def broken(size: int) -> Call:
        raise ValueError("no such size")

    tasks = {"broken": cost.Task(broken), "fast": toy(clock, lambda size: 1e-6, [])}
    found = cost.costs(tasks, 10, budget=Budget(1.0, seconds), rounds=1, duration=1e-4)
    assert found["broken"].failure == "ValueError: no such size"
    assert found["fast"].failure is None


def test_peak_memory_counts_what_compiled_code_allocates():
    size = 32_000_000
    one = cost.peak_bytes(lambda: np.ones(size // 8))
    two = cost.peak_bytes(lambda: np.ones(size // 8) + np.ones(size // 8))  # three at once
    if np.isnan(one):
        pytest.skip("the system does not tell")
    assert one == pytest.approx(size, rel=0.05)
    assert 2 * size * 0.95 <= two <= 3 * size * 1.05


def test_few_samples_of_a_long_curve_take_a_share_of_its_memory():
    """In chunks of 256 segments, one in 16 of which holds a sample; many samples take it all."""
    t = np.arange(400_000.0)
    q = np.tile([1.0, 0.0, 0.0, 0.0], (t.size, 1))
    whole = scheme("quartic").family.constants * 8 * t.size
    curves = [scheme("quartic")(t, q) for _ in range(4)]  # each call has a curve of its own
    few, all_of = (
        cost.peak_bytes(lambda at=at: curves.pop()(at)) for at in (t[:: 16 * CHUNK], t[::CHUNK])
    )
    if np.isnan(few):
        pytest.skip("the system does not tell")
    assert few < 0.15 * whole
    assert all_of > 0.85 * whole


def test_operations_hold_all_iterations():
    q = np.array([[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0, 0.8, 0], [0, 0, 0.6, 0.8]])
    curve = scheme("nielson")(None, q)
    steps = curve.solve_report.iterations
    # 2 slerps an update and 3 a residual, before the first, after each and at the end; 2 and 3 logs a segment
    by_hand = {"exps": 0, "logs": 3, "slerps": (2 + 3) * steps + 3 + 3 + 2}
    assert cost.operations(curve, "keyframe") == by_hand
    assert cost.operations(curve, "sample") == {"exps": 0, "logs": 0, "slerps": 6}
    peer = cost.operations(scheme("scipy-slerp")(None, q), "sample")
    assert all(np.isnan(count) for count in peer.values())


@pytest.mark.parametrize(
    ("seconds_each", "weighed"),
    [(1e-7, 100_000), (0.9e-5, 100_000), (1.1e-5, 10_000), (4.6e-4, 1000), (1.1e-3, None)],
)
def test_memory_is_measured_at_the_largest_size_that_takes_a_second(seconds_each, weighed):
    module = load(shipped("experiments") / "cost.py", "experiment")
    allowed = module.MEMORY_SHARE * module.BUDGET
    sizes = [
        size
        for size in module.SETUP
        if module.weighed("set-up", size, seconds_each * size / allowed) == size
    ]
    assert sizes == ([weighed] if weighed else [])
    assert module.weighed("set-up", 1000, np.nan) is None  # over budget
    assert module.weighed("one sample", 1000, seconds_each) is None


@pytest.mark.parametrize("task", ["set-up", "evaluation", "one sample"])
def test_the_table_marks_the_fastest(task, monkeypatch):
    module = load(shipped("experiments") / "cost.py", "experiment")
    monkeypatch.setattr(module, "BUDGET_QUICK", AMPLE)
    run = Run(quick=True, schemes=["slerp", "quartic", "scipy-slerp"])
    rows = module.measure_cell(run, task, 100)
    table = module.gather(run, pd.DataFrame(rows))
    assert table["scheme"].tolist() == run.schemes
    assert table["failure"].isna().all()
    assert (table["seconds_median"] > 0.0).all()
    assert table["times_fastest"].min() == 1.0
    assert "Fastest at the largest size" in module.caption(table)


def test_a_scheme_that_fails_is_a_row_of_the_table(monkeypatch):
    module = load(shipped("experiments") / "cost.py", "experiment")
    monkeypatch.setattr(module, "BUDGET_QUICK", AMPLE)
    run = Run(quick=True, schemes=["slerp", "quartic"])

    def failing(*arguments, **options):
        raise ValueError("not today")

    monkeypatch.setattr(scheme("quartic"), "_fit", failing)
    rows = {row["scheme"]: row for row in module.measure_cell(run, "evaluation", 10)}
    assert rows["quartic"]["failure"] == "ValueError: not today"
    assert rows["slerp"]["failure"] is None


@pytest.mark.parametrize("count", [LAZY + 2, 20_000])
def test_set_up_fits_all_of_a_long_curve(monkeypatch, count):
    """A long curve waits for calls; what is timed must not."""
    module = load(shipped("experiments") / "cost.py", "experiment")
    made: list[Curve] = []
    cls = scheme("slerp")
    fit = cls._fit
    monkeypatch.setattr(
        cls, "_fit", lambda self, *given, **more: (made.append(self), fit(self, *given, **more))[1]
    )
    module.TASKS["set-up"](cls).prepare(count)()
    assert len(made) == 1
    assert made[0].segments.shape[1] > LAZY
    assert made[0]._waiting is None


def test_what_a_scheme_raises_stands_on_one_line():
    def task(size: int) -> Call:
        raise ValueError("not\ntoday")

    found = cost.costs(
        {"a": cost.Task(task)}, 10, budget=Budget(1.0, seconds), rounds=1, duration=0.01
    )
    assert found["a"].failure == "ValueError: not today"


def test_speed_leaves_out_libraries_by_counts_alone(monkeypatch):
    """The same rows in every run: the clock is not asked, and no seconds stand in the reason."""

    def never() -> float:
        raise AssertionError("a clock was read")

    scheme("scipy-slerp")(None, walk(np.random.default_rng(0), 5, 20.0)[:, 0])  # imported
    monkeypatch.setattr(speed, "BUDGET", Budget(limit=10.0, meter=calls))
    monkeypatch.setattr(time, "perf_counter", never)
    monkeypatch.setattr(time, "process_time", never)
    keyframes = walk(np.random.default_rng(0), 100, 20.0)[:, 0]
    row = next(speed.measured(speed.set_up("set-up", keyframes), ["scipy-slerp"], 1))
    assert row == speed.Timed("scipy-slerp", failure="over budget")


@pytest.mark.parametrize(
    ("name", "most"), [("interpolatepy-squad-c2", 20_000), ("splines-catmull-rom", 1000)]
)
def test_speed_measures_libraries_up_to_some_number_of_keyframes(name, most):
    """Of the tasks' 1000, 20,000 and a million."""
    reasons = [speed.BUDGET.refusal(scheme(name), count) for count in (1000, 20_000)]
    assert reasons == [None, None if most == 20_000 else "over budget"]
    assert speed.BUDGET.refusal(scheme(name), 10**6, (1, 0, 0)) == "over budget"
