"""What the speed table is held against: a bound, the measured value, and whether it was met.

A target whose cells are missing or hold no number stays in the list, with the reason.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import pandas as pd

from quatspline.claims.claim import UNDECIDED
from quatspline.findings.quotes import Ledger, Reader
from quatspline.runs.experiment import QUICK
from quatspline.timing.speed import FOUR_FRAMES, JOINTS, SET_UP_OF_JOINTS

ROTATION_SPLINE = "scipy-rotation-spline"
SHORT = "falls short"
CLEAR = 2.0
"""The factor by which a bound has to be kept at quick size to count as met: rounds are short there."""

ACCURACY = (
    "Accuracy: the orientation of `quartic` agrees with evaluation in 50 digits to 1e-15 on 10,000 random samples; "
    "`tests/schemes/test_paper.py` asserts it."
)
"""The test is test_ten_thousand_random_samples_err_by_four_ulp_at_most."""

SOFTWARE = {"python": "Python", "numba": "numba"}
"""What times depend on besides the machine, by its key in the manifest."""


@dataclass(frozen=True)
class Target:
    """A sentence, its bound, and the value computed from cells of the speed table."""

    text: str
    bound: float
    value: Callable[[Ledger], float]
    at_least: bool = False
    unit: str = "x"


@dataclass(frozen=True)
class Verdict:
    """A target with what was measured, or the reason why nothing was (then ``value`` is None)."""

    target: Target
    value: float | None
    failure: str | None = None
    quick: bool = False

    @property
    def met(self) -> bool:
        """Whether a value was measured and keeps the bound, at quick size by a factor."""
        if self.value is None:
            return False
        bound, clear = self.target.bound, CLEAR if self.quick else 1.0
        if self.target.at_least:
            return self.value >= clear * bound
        return clear * self.value <= bound

    def __str__(self) -> str:
        if self.value is None:
            return f"not measured: {self.failure}"
        return "met" if self.met else UNDECIDED if self.quick else SHORT


def _number(column: str, cell: Ledger, task: str, scheme: str) -> float:
    try:
        value = float(cell("speed", column, task=task, scheme=scheme).value)
    except KeyError:  # the table has no such column
        raise
    except LookupError:
        raise LookupError(f"no row {task!r} of {scheme}; full size has one") from None
    if math.isfinite(value):
        return value
    why = cell("speed", "failure", task=task, scheme=scheme).value
    raise LookupError(f"{scheme}, {task}: {why}")


_each = partial(_number, "nanoseconds_per_item")
_seconds = partial(_number, "seconds_median")
_share = partial(_number, "timed_share")


def _faster(task: str, scheme: str, *peers: str) -> Callable[[Ledger], float]:
    """How many times faster than the fastest of the peers."""
    return lambda cell: min(_each(cell, task, p) for p in peers) / _each(cell, task, scheme)


def _orders(cell: Ledger) -> float:
    three = [_each(cell, task, "quartic") for task in ("evaluate", "velocity", "acceleration")]
    return sum(three) / three[0]


def _ahead(*peers: str, scheme: str) -> Target:
    text = f"`{scheme}` over the fastest of {', '.join(f'`{p}`' for p in peers)}, time per sample"
    return Target(text, 20.0, _faster("evaluate", scheme, *peers), at_least=True)


def _attaining(scheme: str, least: float) -> Target:
    text = f"`{scheme}`, a million sorted samples, as a share of what one core attains"
    return Target(text, least, partial(_share, task="evaluate", scheme=scheme), True, "%")


def _many(scheme: str) -> Target:
    def value(cell: Ledger) -> float:
        return _each(cell, FOUR_FRAMES, scheme) / JOINTS / _each(cell, "evaluate", scheme)

    return Target(
        f"`{scheme}`, 31 joints at four frames a segment, over one dense track", 1.25, value
    )


def _joints(scheme: str, most: float) -> Target:
    def value(cell: Ledger) -> float:
        return 1e3 * _seconds(cell, SET_UP_OF_JOINTS, scheme)

    return Target(f"set-up of `{scheme}` on 31 joints and 2500 keyframes", most, value, unit="ms")


TARGETS: tuple[Target, ...] = (
    *(
        _attaining(scheme, least)
        for scheme, least in (
            *(("quartic", 65), ("local-quintic", 50)),
            *(("monotone-quintic", 50), ("slerp", 35)),
        )
    ),
    Target(
        f"`quartic`, a million sorted samples, over `{ROTATION_SPLINE}`",
        50.0,
        _faster("evaluate", "quartic", ROTATION_SPLINE),
        at_least=True,
    ),
    Target("orders 0, 1 and 2 of `quartic` over order 0 alone", 3.5, _orders),
    Target(
        "`local-quintic` over `quartic`, time per sample",
        1.0,
        lambda cell: _each(cell, "evaluate", "local-quintic") / _each(cell, "evaluate", "quartic"),
    ),
    _ahead("scipy-slerp", "rowan-slerp", "pytransform3d-slerp", scheme="slerp"),
    _ahead("quaternionic-squad", "numpy-quaternion-squad", "splines-squad", scheme="squad"),
    _ahead("splines-catmull-rom", scheme="catmull-rom"),
    _ahead("splines-kochanek-bartels", scheme="kochanek-bartels"),
    _ahead("splines-barry-goldman", scheme="barry-goldman"),
    Target(
        "set-up of `quartic` on 1000 keyframes",
        100.0,
        lambda cell: 1e6 * _seconds(cell, "set-up", "quartic"),
        unit="us",
    ),
    Target(
        f"set-up of `kim` to 1e-9 over `{ROTATION_SPLINE}`",
        10.0,
        _faster("set-up", "kim", ROTATION_SPLINE),
        at_least=True,
    ),
    Target(
        "one sample of `quartic`",
        5.0,
        lambda cell: 1e6 * _seconds(cell, "one sample", "quartic"),
        unit="us",
    ),
    Target(
        f"one sample of `quartic`, over `{ROTATION_SPLINE}`",
        20.0,
        _faster("one sample", "quartic", ROTATION_SPLINE),
        at_least=True,
    ),
    *(_many(scheme) for scheme in ("squad", "local-quintic", "quartic")),
    *(_joints(scheme, most) for scheme, most in (("local-quintic", 7), ("kim", 15), ("squad", 15))),
    Target(
        "a first curve and sample in a new process, after `import numpy`",
        2.0,
        lambda cell: _seconds(cell, "start", "first sample"),
        unit="s",
    ),
    Target(
        "`import quatspline` after `import numpy`",
        0.1,
        lambda cell: _seconds(cell, "start", "import quatspline"),
        unit="s",
    ),
)


def verdicts(read: Reader) -> list[Verdict]:
    """All targets with what a folder of tables says of them."""
    return [_verdict(target, read) for target in TARGETS]


def _verdict(target: Target, read: Reader) -> Verdict:
    try:
        value = target.value(Ledger(read))
        return Verdict(target, value, quick=_quick(read("speed")))
    except FileNotFoundError:
        return Verdict(target, None, "there is no table of speed")
    except LookupError as error:  # a row, a column or a number that the table lacks
        return Verdict(target, None, " ".join(str(error.args[0]).split()))


def _quick(table: pd.DataFrame) -> bool:
    """Whether a table of speed was measured at quick size; tables by hand say nothing of that."""
    return "run_size" in table and bool(table["run_size"].eq(QUICK).any())


def markdown(read: Reader) -> str:
    """The verdicts as a Markdown table; one that falls short or was not measured says so."""
    lines = ["| | bound | measured | |", "| --- | ---: | ---: | --- |"]
    for verdict in verdicts(read):
        text, bound, value, said = cells(verdict)
        shown = f"**{said}**" if said == SHORT else said
        lines.append(f"| {text} | {bound} | {value} | {shown} |")
    return "\n".join(lines)


def cells(verdict: Verdict) -> tuple[str, str, str, str]:
    """The target, its bound, what was measured and whether that is met, as a table shows them."""
    target = verdict.target
    bound = f"{'≥' if target.at_least else '≤'} {target.bound:g} {target.unit}"
    value = "" if verdict.value is None else f"{verdict.value:.3g} {target.unit}"
    return target.text, bound, value, str(verdict)


def measured_on(run: Mapping[str, Any]) -> str:
    """Machine, software and day of a run, as far as its manifest tells, and whether sizes are those of the targets."""
    cpu, known = run.get("cpu"), run.get("versions", {})
    machine = f"{cpu['model']}, {cpu['cores']} cores" if cpu else "a machine that no manifest names"
    parts = [machine, *(f"{shown} {known[key]}" for key, shown in SOFTWARE.items() if key in known)]
    parts += [run["end"][:10]] if run.get("end") else []
    quick = run.get("sizes", {}).get("speed") == QUICK
    short = (
        " At quick size: fewer tasks and shorter rounds than the targets ask for. A bound counts as met there that is "
        f"kept by a factor of {CLEAR:g}; others are not decided."
    )
    return f"Measured on {', '.join(parts)}.{short if quick else ''}"
