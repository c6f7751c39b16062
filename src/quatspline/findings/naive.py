"""What everyone's first idea costs: cubics through the numbers of quaternions, against scipy's spline of rotations."""

from __future__ import annotations

import math
from typing import Any

from quatspline.findings.quotes import Cell, Ledger, Part, Quote, said

NAIVE, CAREFUL = "normalised-cubic", "scipy-rotation-spline"


def torque(cell: Ledger) -> tuple[Part, ...]:
    """What it costs in torque."""
    return said(
        f"What naive costs: {NAIVE} has {{naive:.4f}} times the least torque energy in the median of {{sets:d}} "
        f"committed keyframe sets, scipy's RotationSpline {{careful:.4f}} times.",
        sets=cell("fairness", "sets", scheme=NAIVE, data="committed"),
        naive=_torque(cell, NAIVE),
        careful=_torque(cell, CAREFUL),
    )


def time(cell: Ledger) -> tuple[Part, ...]:
    """What it saves in time."""
    times = {
        f"{task[0]}{i}": _time(cell, name, task)
        for task in ("evaluate", "set-up")
        for i, name in enumerate((NAIVE, CAREFUL))
    }
    return said(
        f"What naive saves: a sample costs {{e0:.3g}} ns by {NAIVE}, compiled here, and {{e1:.3g}} ns by scipy's "
        "RotationSpline; set-up {s0:.3g} and {s1:.3g} ns per keyframe, of {keyframes:d}.",
        keyframes=cell("speed", "keyframes", scheme=NAIVE, task="set-up"),
        **times,
    )


def headline(cell: Ledger) -> tuple[Part, ...]:
    """Both, in plain words."""
    ratios: dict[str, Any] = {
        name: Quote((_time(cell, CAREFUL, task), _time(cell, NAIVE, task)), "ratio")
        for name, task in (("sample", "evaluate"), ("setup", "set-up"))
    }
    return said(
        f"**What naive costs.** Cubics through the quaternions' numbers, normalised (`{NAIVE}`), have {{naive:.3f}} "
        f"times the least torque, scipy's `RotationSpline` {{careful:.3f}} times, which takes {{sample:.0f}} times as "
        "long per sample and {setup:.0f} times per keyframe set up.",
        naive=_torque(cell, NAIVE),
        careful=_torque(cell, CAREFUL),
        **ratios,
    )


def _torque(cell: Ledger, name: str) -> Cell:
    return _measured(cell("fairness", "median", scheme=name, data="committed"), name)


def _time(cell: Ledger, name: str, task: str) -> Cell:
    return _measured(cell("speed", "nanoseconds_per_item", scheme=name, task=task), name)


def _measured(number: Cell, name: str) -> Cell:
    """A cell with a number; a scheme that is absent or was refused leaves the sentence out."""
    if not math.isfinite(number.value):
        raise LookupError(f"{name} has no number there")
    return number


SENTENCES = (("fairness", torque), ("speed", time))
