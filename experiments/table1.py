"""Table 1 of the paper: iterations and seconds, under its own protocol and under solving once."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from quatspline.catalogue import scheme
from quatspline.curve import Curve
from quatspline.instruments.trials import reason
from quatspline.options import among
from quatspline.runs.experiment import Run
from quatspline.timing.interleaved import Contender, interleaved
from quatspline.timing.operations import OPERATIONS, executed, iterations
from quatspline.timing.protocols import PROTOCOLS, Protocol, frames
from quatspline.trajectories.paper import CASES, RECONSTRUCTED, SOLVE, PaperCase, PaperRow

TITLE = "Table 1: iterations and seconds"
PAPER = True
SCHEMES = ("quartic", "nielson", "kim")
KEYS = ["case", "frames", "protocol", "scheme"]
NOTE = (
    f"{RECONSTRUCTED} The paper's seconds are its own (Matlab 7.11, Core i5-3210M), measured per frame; they are shown "
    "beside both protocols so that the ratios can be compared. Rows of 9 and 12 frames include rendering. slerps, "
    "exps and logs count everything executed for the frames: *_updates in updates of the iteration and in samples of "
    "the frames, *_rest in set-up and in the final residual. The fit and the evaluation of prepared keyframes are "
    "timed; 'public call' rows add validation."
)
FORMATS = {
    "seconds_median": ".3g",
    "seconds_iqr": ".1g",
    "ratio_to_quartic": ".3g",
    "paper_seconds": "g",
    "tolerance": "g",
}
APART = [f"{operation}_{part}" for operation in OPERATIONS for part in ("updates", "rest")]
"""Columns of the counts in two parts, after all others."""
ROUNDS, RENDERED_ROUNDS = 15, 2


def measure(run: Run) -> pd.DataFrame:
    schemes = tuple(dict.fromkeys([*SCHEMES, *(run.schemes or [])]))
    groups = [
        (case, row, protocol)
        for case in CASES.values()
        for row in case.rows
        for protocol in PROTOCOLS
    ]
    tables = []
    for case, row, protocol in run.progress(groups, label="table1"):
        tables.append(group(run, case, row, protocol, schemes))
    for case in CASES.values():
        tables.append(_public(run, case, case.rows[1], schemes))
    return pd.concat(tables, ignore_index=True)


def _options(name: str) -> dict[str, Any]:
    """The paper's tolerance and stop rule, as far as the scheme has them."""
    return among(scheme(name), SOLVE)


def group(
    run: Run, case: PaperCase, row: PaperRow, protocol: Protocol, schemes: tuple[str, ...]
) -> pd.DataFrame:
    """One case and protocol: all schemes timed against one another."""
    t = case.frames(row.frames)
    generators, failures = {}, []
    for name in schemes:
        try:
            generators[name] = frames(scheme(name), case.keyframes(), t, protocol, **_options(name))
        except Exception as error:  # what does not apply or fails is a row with its reason
            base = {"case": case.name, "frames": row.frames, "protocol": protocol, "scheme": name}
            failures.append(base | {"failure": reason(error)})
    if row.rendered:
        generators = {name: _rendering(case, t, g) for name, g in generators.items()}
    timed = _timed(run, case.name, case, row, protocol, generators)
    return pd.concat([timed, pd.DataFrame(failures)]) if failures else timed


def _rendering(case: PaperCase, t: Any, generate: Callable[[int], Any]) -> Callable[[int], Any]:
    from quatspline.figures.motions import render

    def contender(repeats: int) -> None:
        for _ in range(repeats):
            render(case, t, generate(1))

    return contender


def _public(run: Run, case: PaperCase, row: PaperRow, schemes: tuple[str, ...]) -> pd.DataFrame:
    """The public call, validation included: build and evaluate all frames."""
    times, quaternions, t = case.times, case.quaternions, case.frames(row.frames)

    def calling(cls: type[Curve], options: dict[str, Any]) -> Contender:
        def contender(repeats: int) -> None:
            for _ in range(repeats):
                cls(times, quaternions, closed=case.closed, **options)(t)

        return contender

    contenders = {
        name: calling(scheme(name), _options(name))
        for name in schemes
        if scheme(name).closable or not case.closed
    }
    return _timed(run, f"{case.name}, public call", case, row, "solve-once", contenders)


def _timed(
    run: Run,
    label: str,
    case: PaperCase,
    row: PaperRow,
    protocol: Protocol,
    contenders: Mapping[str, Contender],
) -> pd.DataFrame:
    rounds = RENDERED_ROUNDS if row.rendered else ROUNDS
    timings = interleaved(contenders, 1 if run.quick else rounds, run.seed)
    quartic = timings["quartic"].median
    rows = []
    for name, timing in timings.items():
        base = {"case": label, "frames": row.frames, "scheme": name, "protocol": protocol}
        counts = counted(case, row.frames, protocol, name)
        apart = {key: counts.pop(key) for key in APART}
        measured = {
            "seconds_median": timing.median,
            "seconds_iqr": timing.iqr,
            "repeats": timing.rounds * timing.loops,
            "ratio_to_quartic": timing.median / quartic,
        }
        rows.append(base | counts | measured | _papers(row, name) | apart)
    return pd.DataFrame(rows)


def counted(case: PaperCase, count: int, protocol: Protocol, name: str) -> dict[str, Any]:
    """Iterations of one solve, and the operations of all frames: no machine changes them."""
    curve = scheme(name).from_keyframes(case.keyframes(), **_options(name))
    counts = executed(curve, count, count if protocol == "per-frame" else 1)
    parts = {"": counts.total, "_updates": counts.updates, "_rest": counts.rest}
    return {
        "iterations": iterations(curve),
        "tolerance": curve.solve_report.tolerance if curve.solve_report else np.nan,
        **{f"{key}{part}": _whole(n) for part, found in parts.items() for key, n in found.items()},
    }


def _whole(count: float) -> float:
    """An integer, or NaN: not every set-up is counted."""
    return count if math.isnan(count) else int(count)


def _papers(row: PaperRow, name: str) -> dict[str, Any]:
    """The paper's own numbers: its B-spline stands beside both constructions of one."""
    spline = (row.iterations, row.seconds, row.ratio)
    published = {"quartic": (0, row.quartic_seconds, 1.0), "nielson": spline, "kim": spline}
    names = ("paper_iterations", "paper_seconds", "paper_ratio")
    return dict(zip(names, published.get(name, (None, None, None)), strict=True))
