"""Every claim about every scheme beside what is measured, with the simplest case that decides."""

import operator
from collections.abc import Iterator
from functools import partial
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import PLUG_IN, found, plug_ins, version
from quatspline.claims import probes
from quatspline.claims.claim import (
    DEPARTS,
    HOLDS,
    PUBLICATION,
    UNDECIDED,
    UNKNOWN,
    Claim,
    Probe,
    Source,
    judged,
)
from quatspline.claims.published import published, works
from quatspline.curve import Curve
from quatspline.figures import matrix
from quatspline.instruments.trials import Row
from quatspline.runs.experiment import Run

TITLE = "Claims and verdicts"
PAPER = False
KEYS: list[str] = []
NOTE = (
    "source: ours or plug-in (attributes of the class, of this package or not), peer (what the library publishes) or "
    "paper (a publication, by default that of 2017). verdict: holds, departs, not measurable (with the reason in "
    "failure), or not decided at this size: it holds in the cases of quick size, and full size has more. fault: "
    "whether a departure is the scheme's fault or, if a publication claims too much, the publication's. case: a line "
    "of Python that prints the value measured. It is the first of the cases tried, from few keyframes to more, in "
    "which a claim departs; otherwise the one in which it holds least well. continuity holds if the measured k is at "
    "least the claimed one, order within 0.3. Keyframes must be met to 1e-6 rad; published rates must agree with the "
    "curve's to 1e-6 (omega) or 1e-3 (alpha) of their size. Cost is counted in exponentials and logarithms; half of "
    "the printed ratio is enough."
)
MET = 1e-6
"""Largest angle (rad) at a keyframe that counts as passing through it."""
ORDER = 0.3
"""A slope over two halvings is this far off the order at most: neighbours are told apart."""
RATE = {"omega": 1e-6, "alpha": 1e-3}
"""Shares of the largest rate: ten thousand and ten times what differences over 1e-6 leave."""
FINEST = 641
"""Keyframes of the finest spacing of an order: that of interpolatepy-log still falls, 4.5 at half as many."""
MANY = 12
"""Keyframes on which a curve that need not meet them does not."""
SMOOTHEST = 3
"""The highest k that a probe tells."""
RATES = ("no", "interior", "everywhere")
"""Places of a constant rate, from fewest to most."""
NOT_THE_SCHEMES = "departs, the publication's fault"
COLORS = {
    UNKNOWN: "#c8c8c8",
    HOLDS: "#8fd3bd",
    UNDECIDED: "#e4efe9",
    NOT_THE_SCHEMES: "#f0d68a",
    DEPARTS: "#d55e00",
}
"""By verdict, the gravest last; text is legible on all of them."""
OTHERS = "departing of other claims"
BREAKS = {", ": "\n", " is the": "\nis the", " of other": "\nof other"}
"""Where the heads of columns go on in a second line."""


def cells(run: Run) -> list[dict[str, Any]]:
    names = run.schemes if run.schemes is not None else [*found(), *works()]
    return [{"scheme": name} for name in names]


def measure_cell(run: Run, scheme: str) -> list[Row]:
    if scheme not in found():
        return [judged(claim) for claim in published(scheme)]
    cls = found()[scheme].scheme
    if cls is None:
        source: Source = "peer" if found()[scheme].shipped else PLUG_IN
        unusable = Claim(scheme, source, "usable", True, unknown=found()[scheme].problem or "")
        return [judged(unusable)]
    claims = [*_of_class(run, cls), *published(scheme)]
    return [judged(claim) | {"version": version(scheme)} for claim in claims]


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    columns = ["scheme", "source", "claim", "claimed", "measured", "verdict", "fault"]
    return table.reindex(columns=[*columns, "case", "version", "failure"])


# -- what a class claims ------------------------------------------------------------------------


def _of_class(run: Run, cls: type[Curve]) -> Iterator[Claim]:
    name = cls.name
    own: Source = PLUG_IN if name in plug_ins() else "ours"
    publishes: Source = own if cls.peer is None else "peer"
    ours, theirs = partial(Claim, name, own), partial(Claim, name, publishes)
    met = partial(_meets, cls.interpolates)
    yield theirs("interpolates", cls.interpolates, _misses(cls), met, float)
    smooth = partial(operator.le, min(cls.continuity, SMOOTHEST))
    in_part = run.quick and cls.peer is not None
    for where, tried in _regimes(run, cls, in_part).items():
        said = cls.continuity, tried, smooth, operator.neg
        yield theirs(f"continuity, {where}", *said, partial=in_part)
    yield ours("order", cls.order, [Probe(probes.order, name, FINEST)], partial(_near, cls.order))
    for reach, probe in {"support": probes.support, "lookahead": probes.lookahead}.items():
        claimed = getattr(cls, reach)
        shaped = "all" if claimed is None else claimed
        yield ours(reach, shaped, [Probe(probe, name)], partial(operator.eq, shaped))
    spins = [Probe(probes.constant_rate, name, *case) for case in _spins(cls)]
    steady = partial(_as_steady, cls.constant_rate)
    yield ours("constant rate", cls.constant_rate, spins, steady, _unsteadiness)
    yield from _of_input(cls, own)
    for quantity, share in RATE.items():
        off = [Probe(probes.rate_error, name, quantity, count) for count in (3, 4)]
        right = partial(operator.ge, share)
        yield theirs(f"published {quantity} is the curve's", "0 off", off, right, float)


def _meets(claimed: bool, miss: float) -> bool:
    return (miss <= MET) == claimed


def _near(claimed: int, slope: float) -> bool:
    return abs(slope - claimed) <= ORDER


def _unsteadiness(place: str) -> int:
    return -RATES.index(place)


def _as_steady(claimed: str, place: str) -> bool:
    return _unsteadiness(place) <= _unsteadiness(claimed)


def _of_input(cls: type[Curve], own: Source) -> Iterator[Claim]:
    ours = partial(Claim, cls.name, own)
    asked = {
        "takes uneven times": (cls.non_uniform, probes.takes_uneven_times),
        "closes": (cls.closable, probes.closes),
        "fewest keyframes": (cls.min_keyframes, probes.fewest_keyframes),
    }
    for text, (value, probe) in asked.items():
        yield ours(text, value, [Probe(probe, cls.name)], partial(operator.eq, value))
    if cls.peer is None:
        report = [Probe(probes.reports_a_solve, cls.name)]
        yield ours("iterative", cls.iterative, report, partial(operator.eq, cls.iterative))
    else:
        silent = "a library says nothing of its iterations"
        yield ours("iterative", cls.iterative, unknown=silent)


def _misses(cls: type[Curve]) -> list[Probe]:
    if not cls.interpolates:  # on few keyframes a curve may have the freedom to meet them all
        return [Probe(probes.miss, cls.name, MANY)]
    hard = [(3, 60), (4, 170), *([(6, 170, True)] if cls.non_uniform else [])]
    through = Probe(probes.miss_through_half_turn, cls.name)
    return [through, *(Probe(probes.miss, cls.name, *case) for case in hard)]


def _spins(cls: type[Curve]) -> list[tuple[Any, ...]]:
    return [(50,), (110,), *([(50, True)] if cls.non_uniform else [])]


def _regimes(run: Run, cls: type[Curve], in_part: bool) -> dict[str, list[Probe]]:
    """Probes of continuity by step angle and kind of times, fewest keyframes first.

    In part, those of the fewest that are cheap: libraries take most of the time.
    """
    angles, (counts, seeds) = (60, 120, 170), ((4,), 1) if in_part else ((3, 4, 6), 3)
    takes = (False, True) if cls.non_uniform else (False,)
    return {
        f"{degrees} degrees, {'uneven' if uneven else 'uniform'}": [
            Probe(probes.continuity, cls.name, count, degrees, uneven, run.seed + seed)
            for count in counts
            for seed in range(seeds)
        ]
        for degrees in angles
        for uneven in takes
    }


SHORT = {"everywhere": "all", "interior": "inside"}
"""In the figure."""
LEAST = 1e-9
"""Numbers below are written as 0: they are rounding."""
HEAD = 1.1
"""Inches of the columns' heads."""


# -- figure -------------------------------------------------------------------------------------


def draw(table: pd.DataFrame) -> Figure:
    verdicts, texts = _matrices(table)
    heads = [_two_lines(str(name).replace(" degrees", "°")) for name in verdicts]
    return matrix.draw(verdicts, texts, COLORS, heads=heads, head=HEAD, rotation=90.0, dark=DEPARTS)


def _two_lines(head: str) -> str:
    for here, broken in BREAKS.items():
        head = head.replace(here, broken, 1)
    return head


def _matrices(table: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Verdicts, and what is written on them: a row per scheme, those with fewest departures first."""
    sayings = {claim.text for name in table["scheme"].unique() for claim in published(name)}
    columns = [name for name in dict.fromkeys(table["claim"]) if name not in sayings]
    looks = table["verdict"].where(table["fault"].ne(PUBLICATION), NOT_THE_SCHEMES)
    table = table.assign(looks=looks)
    named = table[table["claim"].isin(columns)]
    verdicts = named.pivot(index="scheme", columns="claim", values="looks")[columns]
    texts = named.pivot(index="scheme", columns="claim", values="measured")[columns]
    texts = texts.map(_short, na_action="ignore")
    rest = table[~table["claim"].isin(columns)].groupby("scheme")["looks"]
    told = rest.agg(lambda found: f"{found.isin([DEPARTS, NOT_THE_SCHEMES]).sum()}/{len(found)}")
    verdicts[OTHERS] = rest.agg(lambda found: max(found, key=list(COLORS).index))
    texts[OTHERS] = told
    departs = (verdicts == DEPARTS).sum(axis=1).sort_values(kind="stable").index
    return verdicts.loc[departs], texts.loc[departs]


def _short(text: Any) -> str:
    """What was measured, in a cell's width: two digits, one of small numbers, and where a rate is kept."""
    told = str(text)
    if "e-" in told:
        value = float(told)
        return "0" if abs(value) < LEAST else f"{value:.0e}".replace("e-0", "e-")
    return f"{float(told):.2g}" if "." in told else SHORT.get(told, told)


def caption(table: pd.DataFrame) -> str:
    counts = table["verdict"].value_counts()
    parts = [f"{counts.get(verdict, 0)} {verdict}" for verdict in (UNKNOWN, HOLDS, DEPARTS)]
    parts += [f"{counts[UNDECIDED]} {UNDECIDED}"] if UNDECIDED in counts else []
    return (
        f"Claims by verdict with what was measured (0 is less than {LEAST:g}); white: nothing is claimed. "
        f"Of {len(table)} in all, {', '.join(parts)}. Continuity is claimed once and tried under several step angles "
        "and kinds of times; -1 is a leap. Rows are sorted by departures; other claims are those of publications and "
        "libraries about one scheme (departures/all). A constant rate is kept by all segments, or inside: away from "
        f"the ends.{matrix.said(matrix.alike(*_matrices(table)))}"
    )
