"""What the speed table is held against: a bound, the measured value, and whether it was met."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from quatspline.report.quotes import Ledger, Reader

ROTATION_SPLINE = "scipy-rotation-spline"


@dataclass(frozen=True)
class Target:
    """A sentence, its bound, and the value computed from cells of the speed table."""

    text: str
    bound: float
    at_least: bool
    unit: str
    value: Callable[[Ledger], float]


@dataclass(frozen=True)
class Verdict:
    """A target with what was measured."""

    target: Target
    value: float

    @property
    def met(self) -> bool:
        """Whether the measured value keeps the bound."""
        bound = self.target.bound
        return self.value >= bound if self.target.at_least else self.value <= bound


def _each(cell: Ledger, task: str, scheme: str) -> float:
    return float(cell("speed", "nanoseconds_per_item", task=task, scheme=scheme).value)


def _seconds(cell: Ledger, task: str, scheme: str) -> float:
    return float(cell("speed", "seconds_median", task=task, scheme=scheme).value)


def _faster(task: str, scheme: str, *peers: str) -> Callable[[Ledger], float]:
    """How many times faster than the fastest of the peers."""
    return lambda cell: min(_each(cell, task, p) for p in peers) / _each(cell, task, scheme)


def _orders(cell: Ledger) -> float:
    three = [_each(cell, task, "quartic") for task in ("evaluate", "velocity", "acceleration")]
    return sum(three) / three[0]


def _ahead(*peers: str, scheme: str) -> Target:
    text = f"`{scheme}` over the fastest of {', '.join(f'`{p}`' for p in peers)}, a sample"
    return Target(text, 20.0, True, "x", _faster("evaluate", scheme, *peers))


TARGETS: tuple[Target, ...] = (
    Target(
        "`quartic`, a million sorted samples, over `out.fill` on the same output",
        6.0,
        False,
        "x",
        lambda cell: float(cell("speed", "times_fill", task="evaluate", scheme="quartic").value),
    ),
    Target(
        f"the same over `{ROTATION_SPLINE}`",
        50.0,
        True,
        "x",
        _faster("evaluate", "quartic", ROTATION_SPLINE),
    ),
    Target("orders 0, 1 and 2 of `quartic` over order 0 alone", 3.5, False, "x", _orders),
    Target(
        "`local-quintic` over `quartic`, time a sample",
        1.0,
        False,
        "x",
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
        False,
        "us",
        lambda cell: 1e6 * _seconds(cell, "set-up", "quartic"),
    ),
    Target(
        f"set-up of `kim` to 1e-9 over `{ROTATION_SPLINE}`",
        10.0,
        True,
        "x",
        _faster("set-up", "kim", ROTATION_SPLINE),
    ),
    Target(
        "one sample of `quartic`",
        5.0,
        False,
        "us",
        lambda cell: 1e6 * _seconds(cell, "one sample", "quartic"),
    ),
    Target(
        f"the same over `{ROTATION_SPLINE}`",
        20.0,
        True,
        "x",
        _faster("one sample", "quartic", ROTATION_SPLINE),
    ),
    Target(
        "`import quatspline` after `import numpy`",
        0.1,
        False,
        "s",
        lambda cell: _seconds(cell, "start", "import quatspline"),
    ),
)


def verdicts(read: Reader) -> list[Verdict]:
    """All targets with what a folder of tables says; none where speed was not measured in full."""
    found = []
    for target in TARGETS:
        with suppress(FileNotFoundError, LookupError):
            found.append(Verdict(target, target.value(Ledger(read))))
    return found


def markdown(read: Reader) -> str:
    """The verdicts as a Markdown table; one that falls short says so."""
    lines = ["| | bound | measured | |", "| --- | ---: | ---: | --- |"]
    for verdict in verdicts(read):
        target = verdict.target
        sense = "≥" if target.at_least else "≤"
        word = "met" if verdict.met else "**falls short**"
        bound = f"{sense} {target.bound:g} {target.unit}"
        lines.append(f"| {target.text} | {bound} | {verdict.value:.3g} {target.unit} | {word} |")
    return "\n".join(lines)
