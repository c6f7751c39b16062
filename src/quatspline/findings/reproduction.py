"""Sentences on the paper: what reproduces, what is protocol, and how smooth its baseline is."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from quatspline.findings.lists import numbered
from quatspline.findings.quotes import Cell, Ledger, Part, Quote, Span, said

ROWS = (("key", 101), ("key", 201), ("teapot", 150), ("teapot", 300))


def _iterations(cell: Ledger) -> tuple[Part, ...]:
    key: dict[str, Any] = {"case": "key", "frames": 101, "scheme": "nielson"}
    pot: dict[str, Any] = {"case": "teapot", "frames": 150, "scheme": "nielson"}
    key["protocol"] = pot["protocol"] = "per-frame"
    return said(
        "Nielson's iteration takes {key:d} steps for the key and {pot:d} for the teapot; the paper prints "
        "{paper_key:.0f} and {paper_pot:.0f}. The paper prints no keyframes; they were reconstructed to give "
        "these numbers.",
        key=cell("table1", "iterations", **key),
        pot=cell("table1", "iterations", **pot),
        paper_key=cell("table1", "paper_iterations", **key),
        paper_pot=cell("table1", "paper_iterations", **pot),
    )


def time_ratios(cell: Ledger, scheme: str, protocol: str, column: str = "ratio_to_quartic") -> Span:
    """The least and the most of a column of Table 1 over its four rows, of one scheme by one protocol."""
    where = {"scheme": scheme, "protocol": protocol}
    found = (cell("table1", column, case=case, frames=frames, **where) for case, frames in ROWS)
    cells = tuple(found)
    return Quote(cells, "least"), Quote(cells, "most")


def _protocol(cell: Ledger) -> tuple[Part, ...]:
    where = {"scheme": "nielson", "protocol": "per-frame"}
    counts = [cell("table1", "frames", case=case, frames=frames, **where) for case, frames in ROWS]
    return said(
        "The paper finds its quartic {paper:.3g} times faster than the B-spline. Solving again for every frame, as the "
        "paper does, we measure {slow:.3g} (key at {v0} and {v1} frames, teapot at {v2} and {v3}). Solving once and "
        "then evaluating, we measure {fast:.3g}. The difference comes from the protocol; what remains comes from the "
        "scheme.",
        paper=time_ratios(cell, "nielson", "per-frame", "paper_ratio"),
        slow=time_ratios(cell, "nielson", "per-frame"),
        fast=time_ratios(cell, "nielson", "solve-once"),
        **numbered(counts),
    )


def _newton(cell: Ledger) -> tuple[Part, ...]:
    where = {"case": "teapot", "frames": 150, "scheme": "kim", "protocol": "per-frame"}
    return said(
        "The cumulative B-spline of Kim, Kim & Shin, solved by Newton's method ({steps:d} steps for the teapot), "
        "costs {slow:.3g} times as much as the quartic if solved for every frame, and {fast:.3g} times if solved once.",
        steps=cell("table1", "iterations", **where),
        slow=time_ratios(cell, "kim", "per-frame"),
        fast=time_ratios(cell, "kim", "solve-once"),
    )


def _jump(cell: Ledger) -> tuple[Part, ...]:
    def jump(scheme: str, case: str, column: str = "relative") -> Cell:
        return cell("continuity", column, scheme=scheme, case=case, quantity="alpha")

    even, uneven = "60 degrees, uniform", "60 degrees, uneven"
    return said(
        "The paper's baseline lacks the C2 continuity that the title of the paper is about: Nielson's curve is only "
        "C1. Its acceleration jumps at keyframes by {smooth:.1f} % of its size on random keyframes ({even}) and by "
        "{rough:.1f} % at uneven times ({uneven}). The jumps of the quartic ({quartic:.0e}) and of the cumulative "
        "B-spline ({kim:.0e}) are within rounding.",
        smooth=Quote((jump("nielson", even),), "percent"),
        rough=Quote((jump("nielson", uneven),), "percent"),
        even=jump("nielson", even, "case"),
        uneven=jump("nielson", uneven, "case"),
        quartic=jump("quartic", uneven),
        kim=jump("kim", uneven),
    )


def _cubic_fall(cell: Ledger) -> tuple[Part, ...]:
    where = {"scheme": "nielson", "quantity": "alpha"}
    cases = [f"smooth motion, {n} keyframes" for n in (41, 81)]
    jumps = tuple(cell("continuity", "jump", case=case, **where) for case in cases)
    return said(
        "On smooth motion the jump of Nielson's curve falls by a factor of {fall:.1f} when the keyframe spacing is "
        "halved (third order).",
        fall=Quote(jumps, "ratio"),
    )


SENTENCES: tuple[tuple[str, Callable[[Ledger], tuple[Part, ...]]], ...] = (
    ("reproduction", _iterations),
    ("protocol", _protocol),
    ("protocol", _newton),
    ("continuity", _jump),
    ("continuity", _cubic_fall),
)
"""Topics and sentences, in order."""
