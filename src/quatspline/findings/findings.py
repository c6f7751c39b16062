"""Findings: sentences made of table cells; every number in one is tied to the cells that it follows from."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from quatspline.findings import decisions, naive, recorded, reproduction
from quatspline.findings.lists import joined, listed, numbered
from quatspline.findings.quotes import Cell, Ledger, Part, Quote, Reader, Span, said
from quatspline.instruments.summary import ALL


@dataclass(frozen=True)
class Finding:
    """A sentence: text, and a quote for each number of a table; those of keyframes and needs are text."""

    topic: str
    parts: tuple[Part, ...]

    @property
    def text(self) -> str:
        """The sentence as plain text."""
        return "".join(map(str, self.parts))

    @property
    def quotes(self) -> tuple[Quote, ...]:
        """Its numbers."""
        return tuple(part for part in self.parts if isinstance(part, Quote))

    @property
    def cells(self) -> tuple[Cell, ...]:
        """The cells that its numbers come from."""
        return tuple(cell for quote in self.quotes for cell in quote.cells)


def findings(read: Reader) -> list[Finding]:
    """All findings that the tables at hand support, in the order of the page."""
    found = []
    for topic, sentence in FINDINGS:
        try:
            found.append(Finding(topic, sentence(Ledger(read))))
        except (FileNotFoundError, LookupError):  # an experiment not run, or run for fewer cases
            continue
    return found + _decisions(read)


def _decisions(read: Reader) -> list[Finding]:
    try:
        table = read(decisions.TABLE)
        return [Finding(decisions.TABLE, parts) for parts in decisions.decisions(table)]
    except (FileNotFoundError, LookupError):
        return []


def reader(folder: Path) -> Reader:
    """Tables of a folder, each read once."""
    from quatspline.runs.results import Results

    tables: dict[str, pd.DataFrame] = {}

    def read(name: str) -> pd.DataFrame:
        if name not in tables:
            tables[name] = Results(folder).read_table(name)
        return tables[name]

    return read


def _orders(cell: Ledger) -> tuple[Part, ...]:
    names = ("slerp", "quartic", "quintic", "kim", "nielson", "local-quintic")
    sizes = cell.values("accuracy", "keyframes", scheme="quartic", knots="uniform")
    coarse, fine = sizes[-2], sizes[-1]
    where = {"knots": "uniform", "keyframes": fine}
    slopes = [cell("accuracy", "slope", scheme=name, **where) for name in names]
    return said(
        "Orders of convergence on a smooth motion, away from the ends, from {before} to {after} uniform keyframes: "
        f"{listed(names, '.2f')}. The paper's quartic converges no faster than slerp. With the second derivative of "
        "the parabola through three keyframes (quintic), the same construction gains one order.",
        before=cell("accuracy", "keyframes", scheme="quartic", knots="uniform", keyframes=coarse),
        after=cell("accuracy", "keyframes", scheme="quartic", **where),
        **numbered(slopes),
    )


def _torque(cell: Ledger) -> tuple[Part, ...]:
    names = ("nielson", "kim", "local-quintic", "scipy-rotation-spline", "squad", "quartic")
    where = {"data": "committed"}
    medians = [cell("fairness", "median", scheme=name, **where) for name in names]
    return said(
        "Torque energy relative to the least possible, in the median of {sets:d} committed keyframe sets: "
        f"{listed(names, '.4f')}. local-quintic is local and solves nothing.",
        sets=cell("fairness", "sets", scheme="local-quintic", **where),
        **numbered(medians),
    )


def _variants(cell: Ledger) -> tuple[Part, ...]:
    arc: dict[str, Any] = {"scheme": "nlerp", "sphere_degrees": 90}
    return said(
        "Substitutes for slerp: on an arc of {angle:.0f} degrees on the sphere of quaternions, a step of {step:.0f} "
        "degrees, nlerp is off by up to {lag:.3f} degrees there ({formula:.4f} rad as a rotation by its closed form, "
        "{measured:.4f} measured). On the same arc, Eberly's polynomial is off by {few:.1e} rad with {few_n:.0f} "
        "terms, {some:.1e} with {some_n:.0f} and {many:.1e} with {many_n:.0f}; Li's recurrence drifts by "
        "{short:.1e} rad in {short_n:.0f} steps and {long:.1e} in {long_n:.0f}.",
        lag=cell("slerp-variants", "sphere_error_degrees", **arc),
        angle=cell("slerp-variants", "sphere_degrees", **arc),
        step=cell("slerp-variants", "step_degrees", **arc),
        formula=cell("slerp-variants", "closed_form", **arc),
        measured=cell("slerp-variants", "error", **arc),
        **_settings(cell, "fast-slerp", "terms", few=4, some=8, many=16),
        **_settings(cell, "incremental-slerp", "steps", short=64, long=4096),
    )


def _settings(cell: Ledger, scheme: str, option: str, **values: int) -> dict[str, Cell]:
    """Errors by the names given, and the settings that they belong to as ``<name>_n``."""
    quoted = {}
    for name, value in values.items():
        row: dict[str, Any] = {"scheme": scheme, "sphere_degrees": 90, option: value}
        quoted[name] = cell("slerp-variants", "error", **row)
        quoted[f"{name}_n"] = cell("slerp-variants", option, **row)
    return quoted


NAMED = ("slerp", "local-quintic", "kim", "smoothing-spline")


def _smoothing(cell: Ledger) -> tuple[Part, ...]:
    where = {"clip": "tumble", "every": 3, "noise_degrees": 1.0}
    angles = [cell("denoise", "rms_degrees", scheme=name, **where) for name in NAMED]
    return said(
        "What smoothing gains: with white noise of {sigma:.0f} degree about each axis on {keyframes:.0f} keyframes of "
        f"a known motion, the rms errors in degrees are {listed(NAMED, '.2f')}. Those of the angular velocity, in "
        "degrees per second, are {through:.3g} through the keyframes (local-quintic) and {near:.3g} near them "
        "(smoothing-spline). The noise estimated from the keyframes is {told:.2f} degrees.",
        sigma=cell("denoise", "noise_degrees", scheme="slerp", **where),
        keyframes=cell("denoise", "keyframes", scheme="slerp", **where),
        through=cell("denoise", "omega", scheme="local-quintic", **where),
        near=cell("denoise", "omega", scheme="smoothing-spline", **where),
        told=cell("denoise", "told_degrees", scheme="smoothing-spline", **where),
        **numbered(angles),
    )


def _unsmoothed(cell: Ledger) -> tuple[Part, ...]:
    every = cell.values("denoise", "every", clip=ALL)[-1]
    names = NAMED[1:]

    def ratios(degrees: float) -> list[Cell]:
        where = {"clip": ALL, "every": every, "noise_degrees": degrees}
        return [cell("denoise", "over_slerp", scheme=name, **where) for name in names]

    noisy = ", ".join(f"{name} {{n{i}:.2f}}" for i, name in enumerate(names))
    return said(
        "Where smoothing gains nothing: on clips as recorded, with one frame in {every:d} kept, the rms angles at the "
        f"frames left out, relative to slerp's, are {listed(names, '.2f')}, because the roughness of recordings is "
        f"not white noise. With {{sigma:.0f}} degree of white noise added they are {noisy}.",
        every=cell("denoise", "every", clip=ALL, every=every, noise_degrees=0.0, scheme="slerp"),
        sigma=cell(
            "denoise", "noise_degrees", clip=ALL, every=every, noise_degrees=1.0, scheme="slerp"
        ),
        **{f"n{i}": value for i, value in enumerate(ratios(1.0))},
        **numbered(ratios(0.0)),
    )


EXCURSIVE = ("squad", "kim", "quartic", "local-quintic", "monotone-quintic")


def _wander(cell: Ledger) -> tuple[Part, ...]:
    where = {"data": "hold 10 : 1"}
    worst = [cell("excursion", "wander_worst", scheme=name, **where) for name in EXCURSIVE]
    return said(
        "Where two keyframes are equal and a body should hold still between moves (sets '{data}'), curves wander from "
        f"the keyframe by at most this many degrees: {listed(EXCURSIVE, '.0f')}.",
        data=cell("excursion", "data", scheme=EXCURSIVE[0], **where),
        **numbered(worst),
    )


def _overshoot(cell: Ledger) -> tuple[Part, ...]:
    def worst(data: str) -> Span:
        found = tuple(cell("excursion", "over_worst", scheme=name, data=data) for name in others)
        return Quote(found, "least"), Quote(found, "most")

    own, others = EXCURSIVE[-1], EXCURSIVE[:-1]
    generic, axis = (
        cell("excursion", "over_worst", scheme=own, data=x) for x in ("generic", "one axis")
    )
    found = said(
        f"The worst overshoot of a step, as a share of the step, is {{generic:.2g}} for {joined(others)} on generic "
        f"keyframes and {{axis:.2g}} on keyframes about one axis; for {own} it is "
        f"{{own_generic:.1g}} and {{own_axis:.1g}}.",
        generic=worst("generic"),
        axis=worst("one axis"),
        own_generic=generic,
        own_axis=axis,
    )
    return (*found, *_price(cell, own))


def _price(cell: Ledger, scheme: str) -> tuple[Part, ...]:
    """What a scheme's torque is, where it was measured."""
    try:
        torque = cell("fairness", "median", scheme=scheme, data="committed")
    except (FileNotFoundError, LookupError):
        return ()
    return said(" Its median torque energy is {x:.3f} times the least possible.", x=torque)


FINDINGS: tuple[tuple[str, Callable[[Ledger], tuple[Part, ...]]], ...] = (
    *reproduction.SENTENCES,
    ("accuracy", _orders),
    ("fairness", _torque),
    *naive.SENTENCES,
    ("slerp-variants", _variants),
    ("denoise", _smoothing),
    ("denoise", _unsmoothed),
    ("excursion", _wander),
    ("excursion", _overshoot),
    *recorded.SENTENCES,
)


def lines(found: Iterable[Finding]) -> Iterator[str]:
    """Findings as a Markdown list."""
    return (f"- {finding.text}" for finding in found)
