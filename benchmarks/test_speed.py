"""The tasks of the speed table under pytest-benchmark: ``make benchmark-speed``.

One group a task, with the floors in every group.  Times and brackets of pytest-benchmark are of calls,
and slow contenders do fewer items a call: the tables at the end compare per item.  Rows are timed one
after the other here; for ratios of schemes use the experiment ``speed``, which interleaves them.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from quatspline.catalogue import schemes, version
from quatspline.timing.budget import OverBudget
from quatspline.timing.speed import FLOORS, Task, contender_of, tasks

SEED = 0


@cache
def _tasks() -> dict[str, Task]:
    return {task.name: task for task in tasks(np.random.default_rng(SEED), quick=False)}


@pytest.mark.parametrize("name", [*FLOORS, *schemes()])
@pytest.mark.parametrize("task", list(_tasks()))
def test_speed(benchmark: Any, task: str, name: str) -> None:
    chosen = _tasks()[task]
    benchmark.group = f"{task}, {chosen.keyframes:,} keyframes"
    try:
        contender, items = contender_of(chosen, name)
    except (ValueError, OverBudget) as reason:  # what a scheme lacks
        pytest.skip(str(reason))
    benchmark.extra_info |= {"items": items, "unit": chosen.unit}
    if name not in FLOORS:
        benchmark.extra_info["version"] = version(name)
    contender(1)
    benchmark(contender, 1)
