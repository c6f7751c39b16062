"""What one core can do: the loops do what they say, and the rows stand in the table."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from quatspline.discovery import shipped
from quatspline.runs.experiment import Run
from quatspline.system.loading import load
from quatspline.timing import floors, speed
from quatspline.timing.interleaved import Timing
from quatspline.timing.speed import Timed
from quatspline.trajectories.walks import walk

KEYFRAMES = walk(np.random.default_rng(0), 40, 40.0)[:, 0]


def task(**how: object) -> speed.Task:
    return speed.evaluation("evaluate", KEYFRAMES, np.linspace(0.0, 39.0, 4000), 0.1, **how)


def test_chains_take_the_steps_that_are_counted() -> None:
    """By x = 1 and y = 1 a chain grows by one per step, whatever its start: the mean of starts is v + 3.5."""
    values = np.arange(5.0)
    floors.multiply_add(values, 1.0, 1.0)
    assert (values == np.arange(5.0) + 3.5 + floors.STEPS).all()


def test_writing_fills_all() -> None:
    out = np.zeros(7)
    floors.write(out, 2.0)
    assert (out == 2.0).all()


def test_attainable_is_the_larger() -> None:
    assert floors.attainable(100.0, 0.03, 1.0) == pytest.approx(3.0)
    assert floors.attainable(10.0, 0.03, 1.0) == 1.0


def test_arithmetic_of_a_task_is_counted() -> None:
    one = task().arithmetic
    assert (one("slerp"), one("quartic"), one("local-quintic")) == (27, 106, 56)
    assert one("scipy-slerp") is None
    assert task(threads=2).arithmetic("slerp") is None
    assert task(order=1).arithmetic("quartic") == 144
    three = np.stack([KEYFRAMES] * 3, axis=1)
    assert speed.evaluation("three", three, np.arange(39.0), 0.1).arithmetic("slerp") == 3 * 27


def test_shares_are_of_the_floors_of_the_same_run(monkeypatch: pytest.MonkeyPatch) -> None:
    experiment = load(shipped("experiments") / "speed.py", "experiment")
    seconds = {floors.MULTIPLY_ADD: 4e-11, floors.WRITING: 2e-9, speed.SINCOS: 1e-8}
    seconds |= {"quartic": 8e-9, "slerp": 5e-9, "scipy-slerp": 1e-7}

    def measured(*given: object) -> list[Timed]:
        return [Timed(name, 10, Timing(10 * s, 0.0, 1, 1)) for name, s in seconds.items()]

    monkeypatch.setattr(experiment, "measured", measured)
    rows = experiment.rows_of(task(), Run(quick=True), [], 1)
    table = pd.DataFrame(rows).set_index("scheme")
    assert table.loc["quartic", "instructions"] == 106
    assert table.loc["quartic", "nanoseconds_attainable"] == pytest.approx(106 * 0.04)
    assert table.loc["quartic", "timed_share"] == pytest.approx(100 * 106 * 0.04 / 8)
    # a slerp computes for 1.1 ns and writes for 2
    assert table.loc["slerp", "timed_share"] == pytest.approx(100 * 2 / 5)
    assert table.loc[["scipy-slerp", *speed.FLOORS], "timed_share"].isna().all()
    assert table.loc[floors.MULTIPLY_ADD, "unit"] == floors.MULTIPLY_ADD


def test_floors_are_rows_of_plausible_size() -> None:
    """Each is there and takes time, a multiply-add less than a sine and a cosine by far."""
    few = task()
    found = {row.name: row for row in speed.measured(few, ["slerp"], rounds=1, least=1e-4)}
    assert set(found) == {*speed.FLOORS, "slerp"}
    each = {name: found[name].timing.median / found[name].items for name in speed.FLOORS}
    assert 0.0 < each[floors.MULTIPLY_ADD] < each[speed.SINCOS]
    assert each[floors.WRITING] > 0.0
    assert found[floors.MULTIPLY_ADD].items == floors.MULTIPLY_ADDS
