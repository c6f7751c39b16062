"""What the obvious first idea costs: cubics through the numbers of quaternions, against scipy's spline of rotations."""

from __future__ import annotations

import math

from quatspline.findings.quotes import Cell, Ledger, Part, Quote, said

NAIVE, CAREFUL = "normalised-cubic", "scipy-rotation-spline"
LARGE = "170 degrees"
"""The largest steps that torque is measured on."""


def torque(cell: Ledger) -> tuple[Part, ...]:
    """What it costs in torque."""
    return said(
        f"What a naive scheme costs in torque: relative to the least, in the median of {{sets:d}} committed keyframe "
        f"sets, {NAIVE} has {{naive:.4f}} and scipy's RotationSpline {{careful:.4f}}; at steps of {{where}}, "
        "{naive_large:.3g} and {careful_large:.3g}.",
        sets=cell("fairness", "sets", scheme=NAIVE, data="committed"),
        naive=_torque(cell, NAIVE),
        careful=_torque(cell, CAREFUL),
        where=cell("fairness", "data", scheme=NAIVE, data=LARGE),
        naive_large=_torque(cell, NAIVE, LARGE),
        careful_large=_torque(cell, CAREFUL, LARGE),
    )


def time(cell: Ledger) -> tuple[Part, ...]:
    """What it costs in time."""
    times = {
        f"{task[0]}{i}": Quote((_time(cell, name, task),), "rounded")
        for task in ("evaluate", "set-up")
        for i, name in enumerate((NAIVE, CAREFUL))
    }
    return said(
        f"What a naive scheme costs in time: a sample takes {{e0:g}} ns with {NAIVE}, compiled here, and {{e1:g}} ns "
        "with scipy's RotationSpline; set-up takes {s0:g} and {s1:g} ns per keyframe, with {keyframes:.0f} keyframes.",
        keyframes=cell("speed", "keyframes", scheme=NAIVE, task="set-up"),
        **times,
    )


def sentence(cell: Ledger) -> tuple[Part, ...]:
    """Both, in plain words, beside a sentence on the least torque."""
    return said(
        f"Naive `{NAIVE}` has {{naive:.3f}} ({{large:.3g}} at steps of {{where}}); scipy's `RotationSpline` has "
        "{careful:.3f} ({careful_large:.3g}) at {sample:.0f} times the time per sample.",
        naive=_torque(cell, NAIVE),
        where=cell("fairness", "data", scheme=NAIVE, data=LARGE),
        large=_torque(cell, NAIVE, LARGE),
        careful=_torque(cell, CAREFUL),
        careful_large=_torque(cell, CAREFUL, LARGE),
        sample=Quote((_time(cell, CAREFUL, "evaluate"), _time(cell, NAIVE, "evaluate")), "ratio"),
    )


def _torque(cell: Ledger, name: str, data: str = "committed") -> Cell:
    return _measured(cell("fairness", "median", scheme=name, data=data), name)


def _time(cell: Ledger, name: str, task: str) -> Cell:
    return _measured(cell("speed", "nanoseconds_per_item", scheme=name, task=task), name)


def _measured(number: Cell, name: str) -> Cell:
    """A cell with a number; a scheme that is absent or was refused leaves the sentence out."""
    if isinstance(number.value, float) and not math.isfinite(number.value):
        raise LookupError(f"{name} has no number there")
    return number


SENTENCES = (("fairness", torque), ("speed", time))
