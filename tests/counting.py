"""Counts what fits execute, by running their kernels as Python: ``counting.py SCHEME,CASE[,STOP] ...``.

Prints for each a JSON object of operations, with the iterations of the solve; numba has to be disabled
(NUMBA_DISABLE_JIT).
"""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Callable
from typing import Any

import numpy as np

from quatspline.catalogue import scheme
from quatspline.segments import SegmentCurve
from quatspline.trajectories.paper import CASES

KINDS = {
    **dict.fromkeys(("log", "turn"), "logs"),
    **dict.fromkeys(("exp", "put_jet"), "exps"),
    "slerp": "slerps",
}
"""Functions that are one operation each, whatever they call."""

COUNTS: Counter[str] = Counter()
INSIDE: list[str] = []


class Counted(Exception):
    """The fit has been run."""


def counting(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
    def counted(*arguments: Any) -> Any:
        if not INSIDE:
            COUNTS[KINDS[name]] += 1
        INSIDE.append(name)
        try:
            return function(*arguments)
        finally:
            INSIDE.pop()

    return counted


def watch(modules: list[Any]) -> None:
    """Count calls of the functions, under whatever module they were imported into."""
    for module in modules:
        for name in KINDS:
            function = vars(module).get(name)
            if callable(function):
                setattr(module, name, counting(name, function))


def solve(self: SegmentCurve, kernel: Any, parameters: Any = ()) -> None:
    frames, report = self.keyframes, np.zeros((1, 4))
    segments = np.zeros((1, frames.spacings.size, self.family.constants))
    parameters = np.asarray(parameters, dtype=float)
    sign = float(frames.signs[0])
    given = frames.tracks[0], frames.spacings, frames.closed, sign, parameters
    kernel.python(*given, segments[0], report[0])
    raise Counted(int(report[0, 0]))


def counted(name: str, case: str, *stop: str) -> dict[str, int]:
    COUNTS.clear()
    options: dict[str, Any] = {"stop": stop[0]} if stop else {}
    try:
        scheme(name).from_keyframes(CASES[case].keyframes(), **options)
    except Counted as done:
        return dict(COUNTS) | {"iterations": done.args[0]}
    raise LookupError(f"{name} has no fit kernel")


def main(*asked: str) -> None:
    jobs = [job.split(",") for job in asked]
    schemes = {scheme(name).__module__ for name, *_ in jobs}
    kernels = [
        m
        for n, m in sys.modules.items()
        if n.startswith(("quatspline.families.", "quatspline.fitting."))
    ]
    watch([*kernels, sys.modules["quatspline.kernels.values"], *map(sys.modules.get, schemes)])
    SegmentCurve._solve = solve  # type: ignore[assignment]
    for job in jobs:
        print(json.dumps(counted(*job)))


if __name__ == "__main__":
    main(*sys.argv[1:])
