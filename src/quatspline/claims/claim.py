"""Claims and verdicts: what is said of a scheme, held against probes from simple cases to hard ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal, NamedTuple

from quatspline.instruments.trials import Row, reason

Source = Literal["ours", "plug-in", "peer", "paper"]
Value = int | float | str | bool

HOLDS, DEPARTS, UNKNOWN = "holds", "departs", "not measurable"
UNDECIDED = "not decided at this size"
"""It holds as far as it was tried, in a part of the cases that decide at full size."""

SCHEME, PUBLICATION = "scheme", "publication"
"""Whose fault a departure is: a curve does not owe what a publication says of it."""


class Probe:
    """A call with scalar arguments, and itself as a line of Python."""

    def __init__(self, function: Callable[..., Value], *arguments: Any, **named: Any) -> None:
        self._function, self._arguments, self._named = function, arguments, named

    def __call__(self) -> Value:
        """The value measured."""
        return self._function(*self._arguments, **self._named)

    def __str__(self) -> str:
        name = self._function.__name__
        given = [repr(value) for value in self._arguments]
        given += [f"{key}={value!r}" for key, value in self._named.items()]
        call = f"{name}({', '.join(given)})"
        return f"from {self._function.__module__} import {name}; print({call})"


class Claim(NamedTuple):
    """Something said of a scheme, and how it is put to the test.

    Attributes
    ----------
    scheme, source : of whom it is said, and by whom: this package, a plug-in, the library, a publication
    text : what is said; ``claimed``: the value that is said, as text where it is no value
    probes : from the simplest case to the hardest; none where nothing can be measured
    kept : whether a measured value agrees
    badness : the larger, the worse a value that agrees; of several cases the worst is shown
    unknown : why there are no probes
    partial : whether probes are only a part of those that decide
    """

    scheme: str
    source: Source
    text: str
    claimed: Value
    probes: Sequence[Probe] = ()
    kept: Callable[[Any], bool] = bool
    badness: Callable[[Any], float] = lambda value: 0.0
    unknown: str = ""
    partial: bool = False


def judged(claim: Claim) -> Row:
    """The row of a claim: scheme, source, claim, claimed, measured, verdict, fault, case, failure.

    The case is the first, and so the simplest, at which the claim departs; otherwise the worst.  Cases
    that a scheme refuses or cannot solve say nothing about it: where all are of that kind the claim is
    not measurable and ``failure`` gives the reason.  The fault of a departure is the scheme's, or the
    publication's that says so.
    """
    base = {"scheme": claim.scheme, "source": claim.source, "claim": claim.text}
    base |= {"claimed": shown(claim.claimed)}
    measured: list[tuple[Probe, Value]] = []
    refusal = claim.unknown
    for probe in claim.probes:
        try:
            value = probe()
        except Exception as error:  # whatever a scheme raises is its answer
            refusal = reason(error)
            continue
        measured.append((probe, value))
        if not claim.kept(value):
            fault = PUBLICATION if claim.source == "paper" else SCHEME
            return base | _verdict(DEPARTS, probe, value, fault)
    if not measured:
        case = str(claim.probes[0]) if claim.probes else None
        nothing = {"measured": None, "verdict": UNKNOWN, "fault": None}
        return base | nothing | {"case": case, "failure": refusal}
    verdict = UNDECIDED if claim.partial else HOLDS
    return base | _verdict(verdict, *max(measured, key=lambda item: claim.badness(item[1])))


def _verdict(verdict: str, probe: Probe, value: Value, fault: str | None = None) -> Row:
    row: Row = {"measured": shown(value), "verdict": verdict, "fault": fault}
    return row | {"case": str(probe), "failure": None}


def shown(value: Value) -> str:
    """A value as a table has it: three digits of a float, yes or no."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.3g}" if isinstance(value, float) else str(value)


def below(limit: float, value: Any) -> bool:
    """Whether a measured value keeps to a limit; with `functools.partial` a claim's ``kept``."""
    return bool(value <= limit)


def above(limit: float, value: Any) -> bool:
    """Whether a measured value exceeds a limit; with `functools.partial` a claim's ``kept``."""
    return bool(value > limit)
