"""The questions of a user who has to choose a scheme, as conditions on a table with one row per scheme.

They are asked in three places, from here: `docs/choosing.md` has a heading for each, `decisions` takes its
conditions from them, and the page's chooser filters by them in the browser, which gets them as JSON.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import eq, ge, le, ne
from typing import Any

import pandas as pd

from quatspline.instruments.trials import Row

RELATIONS: dict[str, Callable[[Any, Any], Any]] = {"=": eq, "!=": ne, ">=": ge, "<=": le}


@dataclass(frozen=True)
class Condition:
    """Rows whose column is known and stands in a relation to a value.

    Attributes
    ----------
    column, relation, value : as in ``order >= 3``; the relations are those of `RELATIONS`
    """

    column: str
    relation: str
    value: Any

    def __call__(self, rows: pd.DataFrame, _: Row) -> pd.Series:
        """Which rows meet it: a filter of `questions`."""
        cells = rows.reindex(columns=[self.column])[self.column]
        met: pd.Series = cells.notna() & RELATIONS[self.relation](cells, self.value)
        return met


@dataclass(frozen=True)
class Answer:
    """An answer that narrows the choice: its key in an address, its text, and what rows have to meet."""

    key: str
    text: str
    conditions: tuple[Condition, ...]


@dataclass(frozen=True)
class Choice:
    """A question: its key in an address, the heading in `docs/choosing.md`, and the answers that narrow."""

    key: str
    text: str
    answers: tuple[Answer, ...]


YES, NO = "yes", "no"
HOLDS_STILL = 1.0
"""Degrees that a curve may wander during a hold ten times as long as the moves beside it."""

MEETS = Condition("passes_keys", "=", YES)
SMOOTH = {k: Condition("smooth_k", ">=", k) for k in (1, 2)}
LOCAL = Condition("support", "!=", "all")
CLOSES = Condition("closes", "=", YES)
KEEPS = Condition("keeps_smooth", "=", YES)
SOLVES_NOTHING = Condition("iterates", "=", NO)
FAULTLESS = Condition("faults", "=", NO)
STILL = Condition("wander", "<=", HOLDS_STILL)
NO_OVERSHOOT = Condition("overshot", "<=", 0.0)

CHOICES: tuple[Choice, ...] = (
    Choice(
        "rates",
        "Does anything differentiate the orientation?",
        (
            Answer("velocity", "the velocity", (SMOOTH[1],)),
            Answer("acceleration", "the acceleration too", (SMOOTH[2],)),
        ),
    ),
    Choice(
        "live",
        "Do keyframes arrive while the curve runs, or are they edited by hand?",
        (Answer(YES, YES, (LOCAL,)),),
    ),
    Choice("closed", "Must it run closed?", (Answer(YES, YES, (CLOSES,)),)),
    Choice("safe", "Must it never fail?", (Answer(YES, YES, (MEETS, SOLVES_NOTHING, FAULTLESS)),)),
    Choice("large", "Are steps larger than 90 degrees?", (Answer(YES, YES, (MEETS, KEEPS)),)),
    Choice(
        "holds",
        "Must it hold still between keyframes, or never overshoot?",
        (
            Answer(YES, "hold still", (STILL,)),
            Answer("overshoot", "hold still, and overshoot no step", (STILL, NO_OVERSHOOT)),
        ),
    ),
)
