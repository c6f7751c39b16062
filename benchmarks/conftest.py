"""Ends a run with what pytest-benchmark cannot say: every row per item, as times the floors of its group.

Slow contenders are timed on fewer items, so that ratios of raw seconds mislead.
"""

from __future__ import annotations

from typing import Any

import pandas as pd
import pytest

from quatspline.timing.floors import WRITING
from quatspline.timing.speed import SINCOS


@pytest.hookimpl(trylast=True)
def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    session = getattr(
        config, "_benchmarksession", None
    )  # pytest-benchmark has no public equivalent
    rows = [_row(b) for b in getattr(session, "benchmarks", []) if b and not b.has_error]
    if not rows:
        return
    terminalreporter.section("times the floor, per item")
    for (group, unit), table in pd.DataFrame(rows).groupby(["group", "unit"], sort=False):
        each = table.set_index("name")["nanoseconds"].rename(f"ns a {unit}").sort_values()
        terminalreporter.write_line(f"\n{group}\n{_beside_floors(each)}")


def _row(benchmark: Any) -> dict[str, Any]:
    info, name = benchmark.extra_info, benchmark.params["name"]
    each = 1e9 * benchmark.stats.median / info["items"]
    return {"group": benchmark.group, "unit": info["unit"], "name": name, "nanoseconds": each}


def _beside_floors(each: pd.Series) -> str:
    """Nanoseconds by name as a table; the column of a floor that was deselected is empty."""
    times = {f"times {floor}": each / each.get(floor, float("nan")) for floor in (WRITING, SINCOS)}
    table = pd.DataFrame({each.name: each, **times})
    return table.to_string(float_format="{:,.2f}".format, index_names=False, na_rep="")
