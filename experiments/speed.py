"""Speed on fixed tasks: every scheme beside what one core can do."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import found, version
from quatspline.figures import rows as scheme_rows
from quatspline.figures import style
from quatspline.figures.heat import SMALL, TIGHT
from quatspline.figures.named import said
from quatspline.runs.experiment import FULL, QUICK, Run
from quatspline.timing.floors import MULTIPLY_ADD, WRITING, attainable
from quatspline.timing.interleaved import LEAST
from quatspline.timing.speed import FLOORS, SINCOS, Task, measured, starts, tasks

TITLE = "Speed"
PAPER = False
SERIAL = True
KEYS = ["task", "scheme"]
NOTE = (
    "Medians of interleaved, calibrated rounds on one thread unless the task says otherwise, without compilation and "
    "warm-up; keyframes are a walk of 40-degree steps. instructions: packed arithmetic instructions per item, counted "
    "by running the kernels, each for as many samples as a vector holds. nanoseconds_attainable: the larger of two "
    "times, that of these instructions at the rate of the row multiply-add and that of the row writing; timed_share: "
    "this as a percentage of the measured time. times_sincos: relative to one numpy sine and cosine per item in the "
    "same run. Slow peers do only the first items. Iterative schemes solve to 1e-9. 'start' rows are seconds in new "
    "processes."
)
FORMATS = {
    "seconds_median": ".3g",
    "seconds_iqr": ".1g",
    "nanoseconds_per_item": ".4g",
    "instructions": "g",
    "nanoseconds_attainable": ".3g",
    "timed_share": ".3g",
    "times_sincos": ".3g",
}
ROUNDS: dict[str, int] = {QUICK: 3, FULL: 9}
START = "start"
MANY = 1_000_000
"""Keyframes from which one round is enough: calls last seconds."""


def cells(run: Run) -> list[dict[str, str]]:
    return [{"task": task.name} for task in tasks(run.rng("speed"), run.quick)] + [{"task": START}]


def measure_cell(run: Run, task: str) -> list[dict[str, object]]:
    rounds = ROUNDS[run.size]
    if task == START:
        return _starts(rounds, run)
    chosen = next(t for t in tasks(run.rng("speed"), run.quick) if t.name == task)
    names = run.schemes or [name for name, item in found().items() if item.scheme is not None]
    return rows_of(chosen, run, names, rounds if chosen.keyframes < MANY else 1)


def rows_of(task: Task, run: Run, names: list[str], rounds: int) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    floors: dict[str, float] = {}
    least = LEAST / 10 if run.quick else LEAST
    for row in measured(task, names, rounds, run.seed, least):
        base: dict[str, object] = {"task": task.name, "scheme": row.name}
        base["unit"] = MULTIPLY_ADD if row.name == MULTIPLY_ADD else task.unit
        base |= {"keyframes": task.keyframes, "failure": row.failure, "run_size": run.size}
        if row.timing is None:
            rows.append(base)
            continue
        each = row.timing.median / row.items
        if row.name in FLOORS:
            floors[row.name] = each
        rows.append(
            base
            | {
                "version": None if row.name in FLOORS else version(row.name),
                "timed_items": row.items,
                "seconds_median": row.timing.median,
                "seconds_iqr": row.timing.iqr,
                "nanoseconds_per_item": 1e9 * each,
                "times_sincos": each / floors[SINCOS] if SINCOS in floors else None,
                **_attained(task, row.name, each, floors),
            }
        )
    return rows


def _attained(task: Task, name: str, each: float, floors: dict[str, float]) -> dict[str, object]:
    """What an item takes at least, of schemes whose arithmetic is counted."""
    instructions = None if name in FLOORS else task.arithmetic(name)
    if instructions is None:
        return {}
    least = attainable(instructions, floors[MULTIPLY_ADD], floors[WRITING])
    return {
        "instructions": instructions,
        "nanoseconds_attainable": 1e9 * least,
        "timed_share": 100.0 * least / each,
    }


def _starts(rounds: int, run: Run) -> list[dict[str, object]]:
    rows: list[dict[str, object]] = []
    for name, seconds in starts(min(rounds, 5), run.quick):
        low, middle, high = np.percentile(seconds, [25, 50, 75])
        base: dict[str, object] = {
            "task": START,
            "scheme": name,
            "unit": "process",
            "timed_items": 1,
            "run_size": run.size,
        }
        rows.append(base | {"seconds_median": float(middle), "seconds_iqr": float(high - low)})
    return rows


PANELS = ("evaluate", "one sample", "set-up")
LINES = {WRITING: ("-", "writing"), SINCOS: (":", "sin, cos")}
"""Floors in the figure."""


def draw(table: pd.DataFrame) -> Figure:
    """Nanoseconds per item, the quickest on top, the floors as lines."""
    measured, names = table[table["seconds_median"].notna()], _names(table)
    fig, panels = style.axes(style.PAGE, TIGHT * len(names) + 1.0, 1, len(PANELS), sharey=True)
    for ax, task in zip(panels[0], PANELS, strict=True):
        rows = measured[measured["task"] == task].set_index("scheme")
        scheme_rows.mark(ax, rows["nanoseconds_per_item"], names)
        unit = rows["unit"].drop(MULTIPLY_ADD, errors="ignore").iloc[0]
        ax.set(xscale="log", title=task, xlabel=f"ns per {unit}")
        _floors(ax, rows["nanoseconds_per_item"])
    scheme_rows.label(panels[0, 0], names, {})
    style.letters(panels[0])
    return fig


def _names(table: pd.DataFrame) -> list[str]:
    measured = table[table["seconds_median"].notna() & table["task"].eq(PANELS[0])]
    order = measured.sort_values("nanoseconds_per_item")["scheme"]
    return [name for name in order if name not in FLOORS]


def _floors(ax: Any, nanoseconds: pd.Series) -> None:
    """Lines with what they are, written along them where no scheme is as quick: at the bottom."""
    for floor, (dash, text) in LINES.items():
        if floor in nanoseconds:
            ax.axvline(nanoseconds[floor], color="#777777", ls=dash, lw=0.8, zorder=1)
            at = {"xytext": (2, 3), "textcoords": "offset points", "rotation": 90, "va": "bottom"}
            where = (nanoseconds[floor], 0.0)
            place = {"xycoords": ax.get_xaxis_transform(), "fontsize": SMALL, "color": "#555555"}
            ax.annotate(text, where, **at, **place)


def caption(table: pd.DataFrame) -> str:
    return (
        "Cost per sample of evaluating sorted samples of a curve through a thousand keyframes, of one sample per call, "
        "and per keyframe of its set-up, medians, sorted by the first. Grey lines are floors: writing the result "
        f"(solid), one sine and cosine per sample (dotted).{said(_names(table))}"
    )
