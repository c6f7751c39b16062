"""Phrases of a recommendation: what its sentences name beside columns of the table."""

from __future__ import annotations

from dataclasses import replace
from math import isclose

import numpy as np

from quatspline.catalogue import called
from quatspline.comparing import MET
from quatspline.findings.candidates import alike, measured
from quatspline.findings.questions import ROUNDED, Table, Words
from quatspline.findings.quotes import Part, Quote
from quatspline.instruments.trials import Row, records

EQUAL = 0.005
"""Torques that differ by a smaller share are the same to three digits, and said to be."""


def _misses(table: Table) -> tuple[Part, ...]:
    return (table.quote("misses", ".0e" if table.best["misses"] else ".0f"),)


def _degrees(table: Table) -> tuple[Part, ...]:
    return (Quote((table.cell("misses"),), "rounded degrees", ".3g"), " degrees")


def _has_torque(table: Table) -> tuple[Part, ...]:
    """How much, where there is another to say it beside."""
    at_rest = table.taken["torque"] == 0.0 and alike(table.frame, table.taken).sum() > 1
    known = np.isfinite(table.taken["torque_over_least"]) and measured(table.frame, {}).sum() > 1
    return ("has ", *_over_least("torque", "torque", table), ", ") if known and not at_rest else ()


def _over_least(energy: str, thing: str, table: Table, *, whole: bool = True) -> tuple[Part, ...]:
    """How much of an energy a scheme needs, as an object of "has"; of which curves' least, if it is the whole."""
    column = f"{energy}_over_least"
    over, of = table.best[column], f" of all schemes {_all(table)}" if whole else ""
    if np.isinf(over):
        return (f"some {thing} where another scheme needs none",)
    if over - 1.0 > EQUAL:
        return table.quote(column, ROUNDED), f" times the least {thing}{of}"
    return (f"the least {thing}{'' if over == 1.0 else ', to three digits,'}{of}",)


def _over_both(table: Table) -> tuple[Part, ...]:
    """Torque and peak acceleration, whose curves are named once."""
    alone = bool(np.isinf(table.best["peak_over_least"]))
    torque = _over_least("torque", "torque", table, whole=alone)
    return *torque, " and ", *_over_least("peak", "peak acceleration", table)


def _all(table: Table) -> str:
    """Whose least it is: of curves that pass near keyframes only, none."""
    misses = table.frame.loc[table.frame["failure"].isna(), "misses"]
    return "measured" if (misses <= MET).all() else "that pass through the keyframes"


def _reach(row: Row) -> str:
    nearby = "is local: edits stay nearby"
    whole = "is global: every keyframe shapes the whole curve"
    return whole if row["support"] == "all" else nearby


def _price(table: Table) -> tuple[str, ...]:
    """What speaks against a scheme that is better than the recommended one, if its reach does."""
    own = _reach(table.best)
    return () if own == _reach(table.taken) else (f", but {called(table.best['scheme'])} {own}",)


def _more(table: Table) -> tuple[Part, ...]:
    """By how much the torque of the recommended one is more."""
    if table.best["torque"] == 0.0:
        return ("it needs no torque",)
    ratio = table.quote("taken.torque/torque", ROUNDED)
    return f"{called(table.taken['scheme'])} has ", ratio, " times its torque"


def _at_torque(table: Table) -> tuple[Part, ...]:
    """What a quicker scheme costs.  No seconds: they differ from run to run, and stand in the table."""
    other, own, usual = called(table.taken["scheme"]), table.best["torque"], table.taken["torque"]
    if isclose(own, usual, rel_tol=EQUAL):
        return ", at the same torque", *_price(table)
    if usual == 0.0:
        return (f", but needs torque where {other} needs none",)
    times = table.quote("torque/taken.torque", ROUNDED), f" times that of {other}"
    if own < usual:
        return ", and its torque is also lower, ", *times, *_price(table)
    return ", but its torque is ", *times


def _count(table: Table) -> tuple[Part, ...]:
    return (Quote(tuple(table.cell("torque", row) for row in records(table.rows)), "count"),)


def _why_alike(table: Table) -> tuple[Part, ...]:
    if table.taken["torque"]:
        return ("their curves coincide on these keyframes",)
    turns = "turn about one axis at a constant rate"
    return (f"the keyframes {turns if table.taken['length'] > MET else 'do not move'}",)


def _called(table: Table) -> tuple[Part, ...]:
    """The schemes of all rows in a sentence, ours marked."""
    names = [called(row["scheme"]) for row in records(table.rows)]
    return (" and ".join(filter(None, [", ".join(names[:-1]), names[-1]])),)


def _schemes(table: Table) -> tuple[Part, ...]:
    quotes = [Quote((table.cell("scheme", row),)) for row in records(table.rows)]
    return tuple(part for quote in quotes for part in (", ", quote))[1:]


PHRASES: dict[str, Words] = {
    "best": lambda table: (called(table.best["scheme"]),),
    "taken": lambda table: (called(table.taken["scheme"]),),
    "misses by": _misses,
    "near": _degrees,
    "has torque": _has_torque,
    "reach": lambda table: (_reach(table.best),),
    "count": _count,
    "count of all": lambda table: _count(replace(table, rows=table.frame).asked((measured,))),
    "why": _why_alike,
    "more": _more,
    "price": _price,
    "at torque": _at_torque,
    "over both": _over_both,
    "schemes": _schemes,
    "called": _called,
    "reason": lambda table: (Quote((table.cell("failure"), table.cell("scheme")), "reason"),),
}
