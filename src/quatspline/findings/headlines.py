"""Headlines: the findings that a newcomer should know, in plain words; every number is a quote of a table."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from quatspline.findings import naive
from quatspline.findings.findings import Finding
from quatspline.findings.quotes import Cell, Ledger, Part, Quote, Reader, said
from quatspline.findings.recorded import ALLOWED, EVERY, RAW, whose
from quatspline.findings.reproduction import time_ratios
from quatspline.instruments.summary import ALL

SMOOTH = ("kim", "local-quintic", "squad", "quartic")


def headlines(read: Reader) -> list[Finding]:
    """All headlines that the tables at hand support."""
    found = []
    for topic, sentence in HEADLINES:
        try:
            found.append(Finding(topic, sentence(Ledger(read))))
        except (FileNotFoundError, LookupError):  # an experiment not run, or run for fewer cases
            continue
    return found


def _speed(cell: Ledger) -> tuple[Part, ...]:
    return said(
        "**Most of the paper's speed-up comes from its protocol.** Solved again for every frame, the B-spline costs "
        "{slow:.3g} times the quartic (printed: {paper:.3g}); solved once, {fast:.3g}.",
        slow=time_ratios(cell, "nielson", "per-frame"),
        paper=time_ratios(cell, "nielson", "per-frame", "paper_ratio"),
        fast=time_ratios(cell, "nielson", "solve-once"),
    )


def _fair(cell: Ledger) -> tuple[Part, ...]:
    told = said(
        "**A smooth, local curve need not waste torque.** `local-quintic` (ours) is C², solves nothing and has "
        "{ours:.3f} times the least torque; the paper's `quartic` has {paper:.2f}.",
        ours=cell("fairness", "median", scheme="local-quintic", data="committed"),
        paper=cell("fairness", "median", scheme="quartic", data="committed"),
    )
    try:
        return *told, " ", *naive.sentence(cell)
    except (FileNotFoundError, LookupError):  # of two schemes more
        return told


def _recorded(cell: Ledger) -> tuple[Part, ...]:
    where: dict[str, Any] = {"clip": ALL, "filter": RAW}
    errors = [
        cell("reconstruct", "over_slerp", scheme=name, every=EVERY, **where) for name in SMOOTH
    ]
    counts = [
        cell("reduce", "over_slerp", scheme=name, error_degrees=ALLOWED, **where) for name in SMOOTH
    ]
    return said(
        f"**Recorded motion is not smooth.** With every {{every:d}}th frame of {whose(cell)} kept, smooth schemes have "
        "{error:.2f} times slerp's error; to stay within {allowed:g}° they need {count:.2f} times as many keyframes.",
        joints=cell("reconstruct", "compared_joints", scheme="slerp", every=EVERY, **where),
        every=cell("reconstruct", "every", scheme="slerp", every=EVERY, **where),
        allowed=cell("reduce", "error_degrees", scheme="slerp", error_degrees=ALLOWED, **where),
        error=_span(errors),
        count=_span(counts),
    )


def _holds(cell: Ledger) -> tuple[Part, ...]:
    worst = [cell("excursion", "wander_worst", scheme=name, data="hold 10 : 1") for name in SMOOTH]
    own = cell("excursion", "wander_worst", scheme="monotone-quintic", data="hold 10 : 1")
    return said(
        "**Smooth curves leave a pose that should be held.** Between moves of 90°, common schemes turn away by "
        "{worst:.0f}° at worst, `monotone-quintic` (ours) by {own:.0f}° and `slerp` by {slerp:.0f}°.",
        worst=_span(worst),
        own=own,
        slerp=cell("excursion", "wander_worst", scheme="slerp", data="hold 10 : 1"),
    )


def _noise(cell: Ledger) -> tuple[Part, ...]:
    where: dict[str, Any] = {"clip": "tumble", "every": 3, "noise_degrees": 1.0}
    return said(
        "**Smooth noisy keyframes.** With {sigma:.0f}° of noise, angular velocity is off by {through:.3g}°/s through "
        "them (`local-quintic`) and by {near:.3g}°/s near them (`smoothing-spline`, ours).",
        sigma=cell("denoise", "noise_degrees", scheme="slerp", **where),
        through=cell("denoise", "omega", scheme="local-quintic", **where),
        near=cell("denoise", "omega", scheme="smoothing-spline", **where),
    )


def _span(cells: list[Cell]) -> tuple[Quote, Quote]:
    return Quote(tuple(cells), "least"), Quote(tuple(cells), "most")


HEADLINES: tuple[tuple[str, Callable[[Ledger], tuple[Part, ...]]], ...] = (
    ("protocol", _speed),
    ("fairness", _fair),
    ("reconstruct", _recorded),
    ("excursion", _holds),
    ("denoise", _noise),
)
