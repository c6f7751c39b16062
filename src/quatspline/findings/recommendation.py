"""What a comparison on somebody's keyframes recommends, and why: the questions asked of it, and their wording."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import isclose

import numpy as np
import pandas as pd

from quatspline.findings import candidates
from quatspline.findings.candidates import (
    CANDIDATES,
    MET,
    ROUNDABOUT,
    STOPS,
    alike,
    itself,
    measured,
    rank,
)
from quatspline.findings.findings import Finding, lines
from quatspline.findings.questions import ROUNDED, Question, Table, Words, answered, by_name
from quatspline.findings.quotes import Part, Quote, without_name
from quatspline.instruments.trials import Row, records

EQUAL = 0.005
"""Torques that differ by a smaller share are the same to three digits, and said to be."""
ADVICE = "recommendation"
PAPERS = "quartic"
"""What a reader of the paper asks about."""
FAMILIAR = (PAPERS, "squad", "nielson", "slerp")
"""Curves that readers know, drawn beside the recommended one."""


def recommendation(frame: pd.DataFrame) -> list[Finding]:
    """The advice for a table of `quatspline.compare`, best reason first, then what was not measured and why.

    It takes, of the candidates (see `candidates`) within FAIR of the least torque, a local scheme before global ones,
    then the one of least torque.
    """
    table = Table("compare", frame, frame, PHRASES)
    best = records(table.asked(TAKE.filters, rank).rows)[:1]
    questions = (TAKE, *BESIDE) if best else NONE
    table = replace(table, taken=best[0] if best else {})
    return [Finding(ADVICE, parts) for parts in answered((*questions, *OTHERS), table)]


def markdown(found: list[Finding]) -> str:
    """The advice as Markdown."""
    return "# Recommendation\n\n" + "\n".join(lines(found)) + "\n"


def shown(frame: pd.DataFrame) -> list[str]:
    """The schemes that were measured: the recommended one, the fairest candidate, what people know, the others."""
    table = Table("compare", frame, frame, PHRASES)
    every = table.asked((measured,)).rows["scheme"].tolist()
    taken, fair = (table.asked(f, rank).rows["scheme"][:1] for f in (TAKE.filters, CANDIDATES))
    return list(dict.fromkeys([*taken, *fair, *(n for n in FAMILIAR if n in every), *every]))


# -- phrases ------------------------------------------------------------------------------------


def _misses(table: Table) -> tuple[Part, ...]:
    return (table.quote("misses", ".0e" if table.best["misses"] else ".0f"),)


def _has_torque(table: Table) -> tuple[Part, ...]:
    """How much, where there is another to say it beside."""
    at_rest = table.taken["torque"] == 0.0 and alike(table.frame, table.taken).sum() > 1
    known = np.isfinite(table.taken["torque_over_least"]) and measured(table.frame, {}).sum() > 1
    return ("has ", *_over_least("torque", "torque", table), ", ") if known and not at_rest else ()


def _over_least(energy: str, thing: str, table: Table) -> tuple[Part, ...]:
    """How much of an energy a scheme needs, as an object of "has"."""
    column, least = f"{energy}_over_least", f"the least {thing} of all measured"
    over = table.best[column]
    if np.isinf(over):
        return (f"a {thing} where another needs none",)
    if over - 1.0 > EQUAL:
        return table.quote(column, ROUNDED), f" times {least}"
    return (least if over == 1.0 else f"{least} to three digits",)


def _reach(row: Row) -> str:
    nearby = "a changed keyframe changes the curve nearby only"
    return "all keyframes shape it" if row["support"] == "all" else nearby


def _price(table: Table) -> tuple[str, ...]:
    """What speaks against a scheme that is better than the recommended one, if its reach does."""
    own = _reach(table.best)
    return () if own == _reach(table.taken) else (f", but {own}",)


def _more(table: Table) -> tuple[Part, ...]:
    """By how much the torque of the recommended one is more."""
    if table.best["torque"] == 0.0:
        return ("it needs no torque",)
    ratio = table.quote("taken.torque/torque", ROUNDED)
    return f"the torque of {table.taken['scheme']} is ", ratio, " times its own"


def _at_torque(table: Table) -> tuple[Part, ...]:
    """What a quicker scheme costs.  No seconds: they differ from run to run, and stand in the table."""
    other, own, usual = table.taken["scheme"], table.best["torque"], table.taken["torque"]
    if isclose(own, usual, rel_tol=EQUAL):
        return ", at the same torque", *_price(table)
    if usual == 0.0:
        return (f", but it needs a torque where {other} needs none",)
    times = table.quote("torque/taken.torque", ROUNDED), f" times that of {other}"
    if own < usual:
        return ", and its torque is lower, too, ", *times, *_price(table)
    return ", but its torque is ", *times


def _count(table: Table) -> tuple[Part, ...]:
    return (Quote(tuple(table.cell("torque", row) for row in records(table.rows)), "count"),)


def _why_alike(table: Table) -> tuple[Part, ...]:
    if table.taken["torque"]:
        return ("their curves coincide on these keyframes",)
    turns = "turn about one axis at a constant rate"
    return (f"the keyframes {turns if table.taken['length'] > MET else 'do not move'}",)


def _schemes(table: Table) -> tuple[Part, ...]:
    quotes = [Quote((table.cell("scheme", row),)) for row in records(table.rows)]
    return tuple(part for quote in quotes for part in (", ", quote))[1:]


PHRASES: dict[str, Words] = {
    "best": lambda table: (table.best["scheme"],),
    "taken": lambda table: (table.taken["scheme"],),
    "misses by": _misses,
    "has torque": _has_torque,
    "reach": lambda table: (_reach(table.best),),
    "count": _count,
    "count of all": lambda table: _count(replace(table, rows=table.frame).asked((measured,))),
    "why": _why_alike,
    "more": _more,
    "price": _price,
    "at torque": _at_torque,
    "torque over least": partial(_over_least, "torque", "torque"),
    "peak over least": partial(_over_least, "peak", "peak acceleration"),
    "schemes": _schemes,
    "reason": lambda table: (Quote((table.cell("failure"), table.cell("scheme")), "reason"),),
}


# -- questions ----------------------------------------------------------------------------------

TAKE = Question(
    "Take {best}: it passes through the keyframes (largest miss {misses by} rad), is C{continuity:.0f} as "
    "measured here, {has torque}and {reach}.",
    (
        *CANDIDATES,
        lambda rows, _: rows["torque"] <= candidates.FAIR * rows["torque"].min(),
        lambda rows, _: (rows["support"] != "all") | bool((rows["support"] == "all").all()),
    ),
    rank,
)

BESIDE = (
    Question(
        "{count} of the {count of all} schemes measured are alike here (in torque, length and peak acceleration, "
        "to six digits): {why}. Any of them will do.",
        (alike, lambda rows, _: len(rows) > 1),
    ),
    Question(
        "It turns {length:rounded} rad where the keyframes need {keyframes_length:rounded}.",
        (
            itself,
            lambda rows, _: rows["length"] > (ROUNDABOUT * rows["keyframes_length"]).clip(MET),
        ),
    ),
    Question(
        "It comes to a stop at a keyframe.", (itself, lambda rows, _: rows["key_speed"] < STOPS)
    ),
    Question(
        "Passed over for wandering: {best} turns {length:rounded} rad; {more}.",
        (
            candidates.usable,
            candidates.wandering,
            lambda rows, taken: rows["torque"] < taken["torque"],
        ),
        rank,
    ),
    Question(
        "The fairest candidate is {best}: {more}{price}.",
        (
            *(*CANDIDATES, candidates.fairest),
            lambda rows, taken: ~candidates.quicker(rows, taken),
            lambda rows, taken: rows["torque"].map(
                lambda own: not isclose(own, taken["torque"], rel_tol=EQUAL)
            ),
        ),
    ),
    Question(
        "Tens of times quicker to evaluate than {taken} is {best}{at torque}.",
        (*CANDIDATES, candidates.quicker),
        rank,
    ),
    Question(
        "The paper's quartic has {torque over least} and {peak over least}.",
        (
            lambda rows, taken: ~alike(rows, taken) & (rows["scheme"] == PAPERS),
            lambda rows, _: np.isfinite(rows["torque_over_least"]),
        ),
    ),
)
"""Asked where a scheme is taken, and held against it."""

NONE = (
    Question(
        "No recommendation: nothing was measured.",
        (lambda rows, _: rows["failure"].notna().all(),),
    ),
    Question(
        "No recommendation: no scheme measured passes through these keyframes with a continuous velocity.",
        (measured,),
    ),
)
"""Asked where none is."""

OTHERS = (
    Question("Of {best}: {note}.", (lambda rows, _: rows["note"].notna(),), by_name, by_name),
    Question(
        "Not measured: {schemes} ({reason}).",
        (lambda rows, _: rows["failure"].notna(),),
        by_name,
        lambda row: without_name(str(row["failure"]), str(row["scheme"])),
    ),
)
"""Asked in the end."""
