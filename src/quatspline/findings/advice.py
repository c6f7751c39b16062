"""What a comparison says: a recommendation with its reasons, each number tied to its cell."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from quatspline.figures.comparison import CURVES
from quatspline.findings.choice import (
    MET,
    ROUNDABOUT,
    STOPS,
    alike,
    best_of,
    candidates,
    lengths,
    ranked,
    usable,
)
from quatspline.findings.findings import Finding
from quatspline.findings.quotes import Ledger, Part, Quote, multiple, said

if TYPE_CHECKING:
    import pandas as pd

EQUAL = 0.005
"""Torques that differ by a smaller share are the same to three digits, and said to be."""
QUICKER = 50.0
"""Times quicker that a candidate must be for a word about it: on a busy machine a timing was seen to be off
ten-fold, and what is said must not differ from run to run."""
ADVICE = "recommendation"
PAPERS = "quartic"
"""What a reader of the paper asks about."""
FAMILIAR = (PAPERS, "squad", "nielson", "slerp")
"""Curves that readers know, drawn beside the recommended one."""


def recommendation(table: pd.DataFrame) -> list[Finding]:
    """The advice for a table of `quatspline.compare`, best reason first, then what was not measured and why.

    Candidates pass through the keyframes (to MET), are C2 as measured (C1 if none is), do not stop
    at keyframes (unless all do), and turn at most ROUNDABOUT times as far as the shortest of them.
    Where that one still turns ASTRAY times as far as a curve that stops or is C1, those are
    candidates, too.  Of a torque within FAIR of the least among them, local schemes go before global
    ones, then the least torque decides.
    """
    ledger = Ledger(lambda name: table)
    pool = candidates(table)
    found = _reasons(ledger, table, pool) if len(pool) else [_nothing(table)]
    return [*found, *_noted(ledger, table), *_not_measured(ledger, table)]


def _reasons(ledger: Ledger, table: pd.DataFrame, pool: pd.DataFrame) -> list[Finding]:
    best = best_of(pool)
    same = alike(table, best)
    found = [_first(ledger, table, best, same)]
    if len(same) > 1:
        found.append(_same(ledger, table, best, same))
    found += _way(ledger, table, pool, best)
    fairest, quicker = str(pool.iloc[0]["scheme"]), _quicker(pool, best)
    if fairest != quicker and not _equal(ledger, fairest, best):
        found.append(_fairest(ledger, fairest, best))
    if quicker is not None:
        found.append(_quickest(ledger, quicker, best))
    paper = table[(table["scheme"] == PAPERS) & table["failure"].isna()]
    if PAPERS not in same and len(paper) and np.isfinite(paper["torque_over_least"]).all():
        found.append(_paper(ledger))
    return found


def _quicker(pool: pd.DataFrame, best: str) -> str | None:
    """The fairest of the candidates that are evaluated QUICKER times as fast as a scheme."""
    seconds = pool.set_index("scheme")["seconds_per_sample"]
    quick = seconds.index[seconds * QUICKER <= seconds[best]]
    return str(quick[0]) if len(quick) else None


def _equal(ledger: Ledger, name: str, other: str) -> bool:
    """Whether two schemes need the same torque, to three digits."""
    mine, others = (ledger("compare", "torque", scheme=who).value for who in (name, other))
    return bool(abs(mine - others) <= EQUAL * max(mine, others))


def _reach(ledger: Ledger, name: str) -> str:
    local = ledger("compare", "support", scheme=name).value != "all"
    return "a changed keyframe changes the curve nearby only" if local else "all keyframes shape it"


def _over_least(ledger: Ledger, name: str, column: str, thing: str) -> tuple[Part, ...]:
    """How much of an energy a scheme needs, as an object of "has"."""
    cell = ledger("compare", f"{column}_over_least", scheme=name)
    if cell.value == 1.0:
        return (f"the least {thing} of all measured",)
    if cell.value - 1.0 <= EQUAL:
        return (f"the least {thing} of all measured to three digits",)
    if np.isinf(cell.value):
        return (f"a {thing} where another needs none",)
    return multiple(cell), f" times the least {thing} of all measured"


def _first(ledger: Ledger, table: pd.DataFrame, best: str, same: list[str]) -> Finding:
    misses = ledger("compare", "misses", scheme=best)
    digits = ".0e" if misses.value else ".0f"
    parts = said(
        f"Take {best}: it passes through the keyframes (largest miss {{misses:{digits}}} rad), is C{{k:.0f}} as "
        "measured here, ",
        misses=misses,
        k=ledger("compare", "continuity", scheme=best),
    )
    torque, over_least = (
        ledger("compare", column, scheme=best).value for column in ("torque", "torque_over_least")
    )
    shared = torque == 0.0 and len(same) > 1
    if np.isfinite(over_least) and not shared and table["failure"].isna().sum() > 1:
        parts += ("has ", *_over_least(ledger, best, "torque", "torque"), ", ")
    return Finding(ADVICE, (*parts, f"and {_reach(ledger, best)}."))


def _same(ledger: Ledger, table: pd.DataFrame, best: str, same: list[str]) -> Finding:
    """That others are the same curve here, and for which simple reason."""
    torque, length = (
        ledger("compare", column, scheme=best).value for column in ("torque", "length")
    )
    reason = "their curves coincide on these keyframes"
    if torque == 0.0:
        turn = "turn about one axis at a constant rate" if length > MET else "do not move"
        reason = f"the keyframes {turn}"
    names = table.loc[table["failure"].isna(), "scheme"]
    alike, measured = (
        Quote(tuple(ledger("compare", "torque", scheme=name) for name in group), "count")
        for group in (same, names)
    )
    text = f" schemes measured are alike here (in torque, length and peak acceleration, to six digits): {reason}. "
    return Finding(ADVICE, (alike, " of the ", measured, text, "Any of them will do."))


def _way(ledger: Ledger, table: pd.DataFrame, pool: pd.DataFrame, best: str) -> Iterator[Finding]:
    """What is to be said of the way that the recommended curve takes, and of fairer ones that wander."""
    length, path, pace, torque = (
        ledger("compare", column, scheme=best)
        for column in ("length", "keyframes_length", "key_speed", "torque")
    )
    if length.value > max(MET, ROUNDABOUT * path.value):
        turns = ("It turns ", multiple(length), " rad where the keyframes need ", multiple(path))
        yield Finding(ADVICE, (*turns, "."))
    if pace.value < STOPS:
        yield Finding(ADVICE, ("It comes to a stop at a keyframe.",))
    rows = usable(table)
    wander = lengths(rows) > ROUNDABOUT * lengths(pool).min()
    fairer = ranked(rows[wander & (rows["torque"] < torque.value)])
    if len(fairer):
        name = str(fairer["scheme"].iloc[0])
        own, way = (ledger("compare", column, scheme=name) for column in ("torque", "length"))
        head = (f"Passed over for wandering: {name} turns ", multiple(way), " rad; ")
        more = (f"the torque of {best} is ", multiple(torque, own), " times its own.")
        yield Finding(ADVICE, (*head, *(more if own.value else ("it needs no torque.",))))


def _noted(ledger: Ledger, table: pd.DataFrame) -> Iterator[Finding]:
    """What stands beside the rows of schemes that were measured in another way than by default."""
    for name in sorted(table.loc[table["note"].notna(), "scheme"]):
        yield Finding(
            ADVICE, (f"Of {name}: ", Quote((ledger("compare", "note", scheme=name),)), ".")
        )


def _fairest(ledger: Ledger, name: str, best: str) -> Finding:
    ratio = multiple(*(ledger("compare", "torque", scheme=who) for who in (best, name)))
    head, tail = f"The fairest candidate is {name}: the torque of {best} is ", " times its own"
    return Finding(ADVICE, (head, ratio, tail, *_price(ledger, name, best), "."))


def _price(ledger: Ledger, name: str, best: str) -> tuple[str, ...]:
    """What speaks against a scheme that is better than the recommended one, if its reach does."""
    reach = _reach(ledger, name)
    return () if reach == _reach(ledger, best) else (f", but {reach}",)


def _quickest(ledger: Ledger, name: str, best: str) -> Finding:
    """No number: seconds differ from run to run, and stand in the table."""
    cells = [ledger("compare", "torque", scheme=who) for who in (name, best)]
    mine, others = (cell.value for cell in cells)
    parts: tuple[Part, ...]
    if _equal(ledger, name, best):
        parts = (", at the same torque", *_price(ledger, name, best))
    elif mine < others:
        parts = (", and its torque is lower, too, ", multiple(*cells), f" times that of {best}")
        parts += _price(ledger, name, best)
    elif others:
        parts = (", but its torque is ", multiple(*cells), f" times that of {best}")
    else:  # at rest, or at a constant rate
        parts = (f", but it needs a torque where {best} needs none",)
    return Finding(
        ADVICE, (f"Tens of times quicker to evaluate than {best} is {name}", *parts, ".")
    )


def _paper(ledger: Ledger) -> Finding:
    torque = _over_least(ledger, PAPERS, "torque", "torque")
    peak = _over_least(ledger, PAPERS, "peak", "peak acceleration")
    return Finding(ADVICE, ("The paper's quartic has ", *torque, " and ", *peak, "."))


def _nothing(table: pd.DataFrame) -> Finding:
    if table["failure"].notna().all():
        return Finding(ADVICE, ("No recommendation: nothing was measured.",))
    text = "No recommendation: no scheme measured passes through these keyframes with a continuous velocity."
    return Finding(ADVICE, (text,))


def _not_measured(ledger: Ledger, table: pd.DataFrame) -> Iterator[Finding]:
    """One sentence a reason, with the names of all schemes that have it."""
    groups: dict[str, list[str]] = {}
    for name in sorted(table.loc[table["failure"].notna(), "scheme"]):
        groups.setdefault(str(_reason(ledger, name)), []).append(name)
    for names in groups.values():
        listed = [Quote((ledger("compare", "scheme", scheme=name),)) for name in names]
        commas = [part for quote in listed for part in (", ", quote)][1:]
        yield Finding(ADVICE, ("Not measured: ", *commas, " (", _reason(ledger, names[0]), ")."))


def _reason(ledger: Ledger, name: str) -> Quote:
    cells = tuple(ledger("compare", column, scheme=name) for column in ("failure", "scheme"))
    return Quote(cells, "reason")


def lines(found: list[Finding]) -> Iterator[str]:
    """The advice as plain lines."""
    return (finding.text for finding in found)


def markdown(found: list[Finding]) -> str:
    """The advice as Markdown."""
    return "# Recommendation\n\n" + "\n".join(f"- {line}" for line in lines(found)) + "\n"


def shown(table: pd.DataFrame) -> list[str]:
    """The schemes to draw: the recommended one, then what people know, as far as they work."""
    pool = candidates(table)
    names = [best_of(pool)] if len(pool) else []
    names += [str(pool.iloc[0]["scheme"])] if len(pool) else []
    usable = set(table.loc[table["failure"].isna(), "scheme"])
    names += [name for name in FAMILIAR if name in usable]
    names += [str(name) for name in table.loc[table["failure"].isna(), "scheme"]]
    return list(dict.fromkeys(names))[:CURVES]
