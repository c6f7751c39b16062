"""What a comparison on a user's keyframes recommends, and why: the questions it answers, and their wording."""

from __future__ import annotations

from dataclasses import replace
from math import isclose

import numpy as np
import pandas as pd

from quatspline.catalogue import PAPERS, called, plug_ins
from quatspline.comparing import MET
from quatspline.findings import candidates
from quatspline.findings.candidates import (
    CANDIDATES,
    ROUNDABOUT,
    STILL,
    alike,
    itself,
    measured,
    rank,
)
from quatspline.findings.findings import Finding, lines
from quatspline.findings.needs import Needs, breaches, had, unmet
from quatspline.findings.phrases import EQUAL, PHRASES
from quatspline.findings.questions import Filter, Question, Table, answered, by_name
from quatspline.findings.quotes import Part, without_name
from quatspline.instruments.trials import records

ADVICE = "recommendation"
NOTHING = Needs()
FAMILIAR = (PAPERS, "squad", "nielson", "slerp")
"""Curves that readers know, drawn beside the recommended one."""


def recommendation(frame: pd.DataFrame, needs: Needs = NOTHING) -> list[Finding]:
    """The advice for a table of `quatspline.compare`, best reason first, then what was not measured and why.

    It takes, of the candidates (see `candidates`) that meet the needs and are within FAIR of the least torque, a
    local scheme before global ones, then the one of least torque; of noisy keyframes first one that smooths them.
    """
    table = Table("compare", frame, frame, PHRASES)
    best = records(table.asked(take(needs), rank).rows)[:1]
    smoother = records(table.asked(smoothing(needs), rank).rows)[:1]
    table = replace(table, taken=best[0] if best else {})
    questions = (
        (*_taken(needs, bool(smoother)), *_beside(needs)) if best else _none(needs, bool(smoother))
    )
    head = (Question(NEAR, smoothing(needs), rank),) if smoother else ()
    said = list(answered((*head, *questions), table))
    if needs.limits:
        lost = table.asked((measured,)).rows
        said += map(tuple, breaches(needs, lost, called))
    return [Finding(ADVICE, parts) for parts in [*said, *answered(OTHERS, table)]]


def take(needs: Needs) -> tuple[Filter, ...]:
    """Which schemes may be taken, of which the first by `rank` is."""
    return (
        *candidates.candidates(needs),
        lambda rows, _: rows["torque"] <= candidates.FAIR * rows["torque"].min(),
        lambda rows, _: (rows["support"] != "all") | bool((rows["support"] == "all").all()),
    )


def smoothing(needs: Needs) -> tuple[Filter, ...]:
    """Which schemes may be taken in place of one that passes through noise."""
    return candidates.near, needs.met


def _taken(needs: Needs, noisy: bool) -> tuple[Question, ...]:
    """What is said of the scheme that is taken."""
    asked = Question(
        lambda table: ("It meets your needs: ", *had(needs.limits, table.best), "."),
        (itself,),
    )
    return Question(THROUGH if noisy else TAKE, take(needs), rank), *(
        (asked,) if needs.limits else ()
    )


def _none(needs: Needs, smoothed: bool) -> tuple[Question, ...]:
    """What is said where no scheme that passes through the keyframes is taken."""
    if smoothed:
        return ()
    nearest = Question(
        lambda table: _nearest(needs, table),
        (candidates.through, lambda *_: bool(needs.limits)),
        needs.distance,
    )
    return (*NONE[:1], nearest) if needs.limits else NONE


def _nearest(needs: Needs, table: Table) -> tuple[Part, ...]:
    """That no scheme meets all needs, and the one that comes nearest."""
    if needs.broken(table.best):
        return tuple(unmet(needs, table.best, called))
    every = ", ".join(limit.flag for limit in needs.limits)
    return (
        f"No recommendation: no scheme that meets your needs ({every}) has a continuous velocity.",
    )


def markdown(found: list[Finding]) -> str:
    """The advice as Markdown."""
    return "# Recommendation\n\n" + "\n".join(lines(found)) + "\n"


def shown(frame: pd.DataFrame, needs: Needs = NOTHING) -> list[str]:
    """The schemes that were measured: those recommended, the fairest candidate, plug-ins, what people know, others."""
    table = Table("compare", frame, frame, PHRASES)
    every = table.asked((measured,)).rows["scheme"].tolist()
    wanted = (smoothing(needs), take(needs), CANDIDATES)
    first = [name for which in wanted for name in table.asked(which, rank).rows["scheme"][:1]]
    known = (name for name in (*sorted(plug_ins()), *FAMILIAR) if name in every)
    return list(dict.fromkeys([*first, *known, *every]))


FEW = 4
"""Schemes that are named where they are alike; of more, only their number is told."""
ALIKE = "give the same result here (torque, length and peak acceleration, to six digits)"

# -- questions ----------------------------------------------------------------------------------

TAKE = (
    "Take {best}: it passes through the keyframes (largest miss {misses by} rad), is C{continuity:.0f} as "
    "measured here, {has torque}and {reach}."
)
THROUGH = (
    "If the curve must pass through the keyframes, noise and all, take {best}: it is C{continuity:.0f} as measured "
    "here, {has torque}and {reach}."
)
NEAR = (
    "Take {best}: the keyframes have about {noise:rounded} degrees of noise about each axis, and a curve through "
    "them repeats it. The smoothed curve is C{continuity:.0f} as measured here, passes within {near} of each keyframe, "
    "and {reach}."
)


def _beside(needs: Needs) -> tuple[Question, ...]:
    """What is asked where a scheme is taken, and held against it."""
    pool = candidates.candidates(needs)
    return (
        Question(
            f"{{called}} {ALIKE}: {{why}}. Any of them will do.",
            (alike, lambda rows, _: 1 < len(rows) <= FEW),
            rank,
        ),
        Question(
            f"{{count}} of the {{count of all}} schemes measured {ALIKE}: {{why}}. Any of them will do.",
            (alike, lambda rows, _: len(rows) > FEW),
        ),
        Question(
            "It turns {length:rounded} rad, although the keyframes need only {keyframes_length:rounded} rad.",
            (
                itself,
                lambda rows, _: rows["length"] > (ROUNDABOUT * rows["keyframes_length"]).clip(MET),
            ),
        ),
        Question(
            "It stands still where the keyframes do.",
            (itself, lambda rows, _: rows["hold_rotation"] <= STILL),
        ),
        Question(
            "While the keyframes stand still, it turns up to {hold_rotation:rounded} degrees away; no candidate "
            "stands still.",
            (itself, lambda rows, _: rows["hold_rotation"] > STILL),
        ),
        Question(
            "It comes to a stop at a keyframe.", (itself, lambda rows, _: candidates.stops(rows))
        ),
        Question(
            "Passed over because it turns too far: {best} turns {length:rounded} rad; {more}.",
            (
                candidates.usable,
                needs.met,
                candidates.wandering,
                lambda rows, taken: rows["torque"] < taken["torque"],
            ),
            rank,
        ),
        Question(
            "The candidate with the least torque is {best}: {more}{price}.",
            (
                *(*pool, candidates.fairest),
                lambda rows, taken: ~candidates.quicker(rows, taken),
                lambda rows, taken: rows["torque"].map(
                    lambda own: not isclose(own, taken["torque"], rel_tol=EQUAL)
                ),
            ),
        ),
        Question(
            "{best} evaluates tens of times faster than {taken}{at torque}.",
            (*pool, candidates.quicker),
            rank,
        ),
        Question(
            "The paper's quartic has {over both}.",
            (
                lambda rows, taken: ~alike(rows, taken) & (rows["scheme"] == PAPERS),
                lambda rows, _: np.isfinite(rows["torque_over_least"]),
            ),
        ),
    )


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
    Question("Note on {best}: {note}.", (lambda rows, _: rows["note"].notna(),), by_name, by_name),
    Question(
        "Not measured: {schemes} ({reason}).",
        (lambda rows, _: rows["failure"].notna(),),
        by_name,
        lambda row: without_name(str(row["failure"]), str(row["scheme"])),
    ),
)
"""Asked in the end."""
