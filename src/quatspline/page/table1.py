"""Table 1 as the paper prints it, twelve rows, with ours beside under both protocols."""

from __future__ import annotations

from typing import Any

import pandas as pd

from quatspline.trajectories.paper import CASES

ROW = ["case", "frames", "scheme"]
PROTOCOLS = ("per-frame", "solve-once")
DIGITS = ".3g"
PRINTED = {"nielson": "B-spline (nielson)", "quartic": "quartic"}
"""Schemes of the paper's table in its order, and how they are called there."""
NOTHING = "—"
"""Where nothing iterates."""
UNITS = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}


def side_by_side(table: pd.DataFrame, told: pd.DataFrame | None = None) -> list[dict[str, Any]]:
    """One row a case, frame count and scheme of the paper's: its cells, then those of each protocol.

    Cells are pairs of text, in the order of the template's headings: what was measured, empty where
    nothing was, and what the reference table has where that is another.
    """
    groups, others = _groups(table), {} if told is None else _groups(told)
    keys = [
        (case.name, row.frames, scheme)
        for case in CASES.values()
        for row in case.rows
        for scheme in PRINTED
    ]
    return [_printed(key, groups[key], others.get(key)) for key in keys if key in groups]


def _groups(table: pd.DataFrame) -> dict[Any, pd.DataFrame]:
    return dict(list(table.groupby(ROW, sort=False)))


def _printed(
    key: tuple[str, int, str], group: pd.DataFrame, told: pd.DataFrame | None
) -> dict[str, Any]:
    case, frames, scheme = key
    cells = _cells(group)
    others = cells if told is None else _cells(told)
    beside = ["" if other == cell else other for cell, other in zip(cells, others, strict=True)]
    pairs = list(zip(cells, beside, strict=True))
    return {"key": [case, str(frames), PRINTED[scheme]], "cells": pairs}


def _cells(group: pd.DataFrame) -> list[str]:
    """Iterations, seconds and ratios of one row: the paper's before ours."""
    paper = group.iloc[0]
    anew, once = (group[group["protocol"] == protocol] for protocol in PROTOCOLS)
    steps = [_steps(paper["paper_iterations"]), _steps(paper["iterations"])]
    measured = [None if g.empty else g.iloc[0]["seconds_median"] for g in (anew, once)]
    seconds = [duration(value) for value in (paper["paper_seconds"], *measured)]
    ratios = [_shown(paper["paper_ratio"]), *(_first(g, "ratio_to_quartic") for g in (anew, once))]
    return steps + seconds + ratios


def _steps(count: Any) -> str:
    """A number of iterations; of a scheme that solves nothing, none."""
    return NOTHING if count == 0 else _shown(count, ".0f")


def _first(group: pd.DataFrame, column: str, spec: str = DIGITS) -> str:
    return "" if group.empty else _shown(group.iloc[0][column], spec)


def _shown(value: Any, spec: str = DIGITS) -> str:
    return "" if pd.isna(value) else format(value, spec)


def duration(seconds: float | None) -> str:
    """A time in the unit that leaves at least one digit before the point; nothing where there is none."""
    if seconds is None or pd.isna(seconds):
        return ""
    unit = next((u for u in UNITS if seconds >= UNITS[u]), "ns")
    return f"{seconds / UNITS[unit]:.3g} {unit}"
