"""What every scheme costs: set-up and evaluation apart, against the size; latency; memory."""

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from quatspline import catalogue
from quatspline.curve import Curve
from quatspline.figures import named, style
from quatspline.runs.experiment import Run
from quatspline.timing.budget import Budget, Call, seconds
from quatspline.timing.cost import SPREAD, Task, costs, fitted_whole, operations, peak_bytes
from quatspline.trajectories.smooth import tumble

TITLE = "Cost of set-up and evaluation"
PAPER = False
SERIAL = True
KEYS = ["task", "size", "scheme"]
BUDGET, BUDGET_QUICK = 5.0, 0.1
KEYFRAMES = 100
BYTES = 32
"""Of a quaternion."""
NOTE = (
    "Public calls, including validation, on one thread, on a smooth motion at times 0, 1, 2, ... . set-up: the curve "
    f"through size keyframes and, beyond {SPREAD}, a sample every {SPREAD} segments, so that all of a long curve is "
    f"fitted. evaluation: orientations at size times in order, on {KEYFRAMES} keyframes. one sample: a call with a "
    "scalar time, on size keyframes. seconds_*: medians and interquartile ranges of interleaved rounds; a slow call "
    f"is timed once. A call that smaller ones predict to take more than {BUDGET:g} s ({BUDGET_QUICK:g} s at quick "
    "size) is over budget. times_fastest: the time relative to the fastest scheme for that task and size. exps, logs, "
    "slerps: counts per keyframe (set-up, all iterations) or per sample; none for libraries. times_memory: the peak "
    f"of resident memory relative to the bytes of the keyframes (set-up) or samples (evaluation), {BYTES} each, at "
    "full size only: for 100,000 keyframes, or for a tenth or a hundredth of that where more would take over a second."
)
FORMATS = {"seconds_median": ".3e", "seconds_iqr": ".1e", "times_fastest": ".1f"}
SETUP = (5, 100, 1000, 10_000, 100_000, 1_000_000)
EVALUATION = (1, 10, 100, 1000, 10_000, 100_000, 1_000_000, 10_000_000)
LATENCY = (5, 1000, 100_000)
SIZES = {"set-up": SETUP, "evaluation": EVALUATION, "one sample": LATENCY}
QUICK = {"set-up": (5, 100, 1000), "evaluation": (1, 100, 10_000), "one sample": (1000,)}
LEAST = {"set-up": 5, "evaluation": 1, "one sample": 5}
MEMORY = {
    "set-up": (1000, 10_000, 100_000),
    "evaluation": (1_000_000,),
    "one sample": (),
}
"""Sizes at which memory is measured: at the largest of a task that a scheme takes in time."""
BETWEEN = 2.5
"""A time within every curve's domain, not at a keyframe."""
MEMORY_SHARE = 0.2
"""Memory is measured for calls that take up to this share of the budget: it takes two more."""


def cells(run: Run) -> list[dict[str, Any]]:
    sizes = QUICK if run.quick else SIZES
    return [{"task": task, "size": size} for task, all_of in sizes.items() for size in all_of]


def measure_cell(run: Run, task: str, size: int) -> list[dict[str, Any]]:
    names = run.schemes or catalogue.schemes()
    tasks = {name: TASKS[task](catalogue.scheme(name)) for name in names}
    budget = Budget(BUDGET_QUICK if run.quick else BUDGET, seconds)
    effort: dict[str, Any] = {"rounds": 7, "duration": 1e-2}
    if run.quick:
        effort = {"rounds": 3, "duration": 2e-3}
    found = costs(tasks, size, least=LEAST[task], budget=budget, seed=run.seed, **effort)
    rows = []
    for name in names:
        cost = found[name]
        row = {"task": task, "size": size, "scheme": name, "version": catalogue.version(name)}
        row["run_size"] = run.size
        row |= {"failure": cost.failure, **_counts(task, name)}
        row |= {"seconds_median": cost.seconds, "seconds_iqr": cost.iqr}
        if not run.quick and size == weighed(task, size, cost.seconds / (MEMORY_SHARE * BUDGET)):
            row["times_memory"] = peak_bytes(tasks[name].prepare(size)) / (BYTES * size)
        rows.append(row)
    return rows


def weighed(task: str, size: int, share: float) -> int | None:
    """The size at which memory is measured, where a call of some size takes a share of what is allowed it.

    The largest of `MEMORY` that is expected to stay below it, were the time proportional to the size.
    """
    return max((each for each in MEMORY[task] if share * each < size), default=None)


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    fastest = table.groupby(["task", "size"])["seconds_median"].transform("min")
    return table.assign(times_fastest=table["seconds_median"] / fastest)


# -- tasks --------------------------------------------------------------------------------------


def _setup(cls: type[Curve]) -> Task:
    def prepare(count: int) -> Call:
        t = np.arange(float(count))
        return fitted_whole(partial(cls, t, tumble(t)), t)

    return Task(prepare, linear=cls.support is not None)


def _evaluation(cls: type[Curve]) -> Task:
    curve = cache(lambda: _curve(cls, KEYFRAMES))

    def prepare(samples: int) -> Call:
        evaluate, at = curve(), np.linspace(0.0, KEYFRAMES - 1.0, samples)
        return lambda: evaluate(at)

    return Task(prepare)


def _latency(cls: type[Curve]) -> Task:
    def prepare(count: int) -> Call:
        curve = _curve(cls, count)
        return lambda: curve(BETWEEN)

    return Task(prepare, linear=cls.support is not None)


TASKS: dict[str, Callable[[type[Curve]], Task]] = {
    "set-up": _setup,
    "evaluation": _evaluation,
    "one sample": _latency,
}


def _curve(cls: type[Curve], count: int) -> Curve:
    t = np.arange(float(count))
    return cls(t, tumble(t))


@cache
def _counts(task: str, name: str) -> dict[str, float]:
    try:
        curve = _curve(catalogue.scheme(name), KEYFRAMES)
    except Exception:  # its row gives the reason
        return {}
    return operations(curve, "keyframe" if task == "set-up" else "sample")


# -- figure -------------------------------------------------------------------------------------


def draw(table: pd.DataFrame) -> Figure:
    fig, panels = style.axes(style.PAGE, 3.6, 1, 2)
    measured = _drawn(table).sort_values("size")
    lit = named.coloured(measured["scheme"])
    ends = {}
    for ax, task, unit in zip(panels[0], SIZES, ("keyframe", "sample"), strict=False):
        groups = measured[measured["task"] == task].groupby("scheme")
        rows = (
            (str(name), each["size"], each["seconds_median"] / each["size"])
            for name, each in groups
        )
        ends[ax] = named.draw_curves(ax, rows, lit)
        ax.set(xscale="log", yscale="log", title=task)
        ax.set(xlabel=f"{unit}s", ylabel=f"seconds per {unit}")
        ax.xaxis.set_major_locator(LogLocator(numticks=len(EVALUATION) + 2))
        ax.xaxis.set_minor_locator(NullLocator())
    style.letters(panels[0])
    named.name_ends(fig, ends)
    return fig


def _drawn(table: pd.DataFrame) -> pd.DataFrame:
    return table[table["seconds_median"].notna() & table["task"].isin(list(SIZES)[:2])]


def caption(table: pd.DataFrame) -> str:
    winners = table[table["times_fastest"] == 1.0].sort_values("size").groupby("task").last()
    told = [
        f"{task} at {row['size']:,}: {row['scheme']} ({row['seconds_median']:.1e} s)"
        for task, row in winners.iterrows()
    ]
    return (
        "Seconds per keyframe of set-up, and per sample of evaluation, by size; less is better."
        f"{named.said(_drawn(table)['scheme'])} Curves end where "
        f"a call would be over budget. Fastest at the largest size: {'; '.join(told)}."
    )
