"""What a comparison says: a recommendation with its reasons, each number tied to its cell, and figures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from quatspline.curve import Curve
from quatspline.instruments.derivatives import shape_rates
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.registry import found as schemes_found
from quatspline.report import style
from quatspline.report.findings import Finding
from quatspline.report.quotes import Ledger, Part, Quote, multiple, said

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

MET = 1e-6
"""Largest angle at a keyframe, in rad, that counts as passing through it."""
FAIR = 1.05
"""Torque within this of the least is as good as the least: nobody sees five per cent."""
STOPS = 0.01
"""A least speed at keyframes below this share of the mean is a stop."""
EQUAL = 0.005
"""Torques that differ by a smaller share are the same to three digits, and said to be."""
QUICKER = 50.0
"""Times quicker that a candidate must be for a word about it: on a busy machine a timing was seen to be off
ten-fold, and what is said must not differ from run to run."""
CURVES = 4
"""Schemes drawn over time."""
SAMPLES = 2000
ADVICE = "recommendation"
PAPERS = "quartic"
"""What a reader of the paper asks about."""
FAMILIAR = (PAPERS, "squad", "nielson", "slerp")
"""Curves that readers know, drawn beside the recommended one."""


def recommendation(table: pd.DataFrame) -> list[Finding]:
    """The advice for a table of `quatspline.compare`, best reason first, then what was not measured and why.

    Candidates pass through the keyframes (to MET), are C2 as measured (C1 if none is), do not stop
    at keyframes (unless all do), and have a torque within FAIR of the least among them.  Local
    schemes go before global ones, then the least torque decides.
    """
    ledger = Ledger(lambda name: table)
    pool = candidates(table)
    found = _reasons(ledger, table, pool) if len(pool) else [_nothing(table)]
    return [*found, *_not_measured(ledger, table)]


def _reasons(ledger: Ledger, table: pd.DataFrame, pool: pd.DataFrame) -> list[Finding]:
    best = _best(pool)
    found = [_first(ledger, best)]
    fairest, quicker = str(pool.iloc[0]["scheme"]), _quicker(pool, best)
    if fairest != quicker and not _equal(ledger, fairest, best):
        found.append(_fairest(ledger, fairest, best))
    if quicker is not None:
        found.append(_quickest(ledger, quicker, best))
    paper = table[(table["scheme"] == PAPERS) & table["failure"].isna()]
    if best != PAPERS and len(paper) and np.isfinite(paper["torque_over_least"]).all():
        found.append(_paper(ledger))
    return found


def candidates(table: pd.DataFrame) -> pd.DataFrame:
    """The rows among which the recommendation chooses, best first: by torque, and those of equal torque by
    what they claim, jerk and support.  No clock decides."""
    pool = table[table["failure"].isna() & (table["misses"] <= MET) & np.isfinite(table["torque"])]
    if pool.empty:
        return pool
    smoothest = pool[pool["continuity"] >= min(2, pool["continuity"].max())]
    moving = smoothest[~(smoothest["key_speed"] < STOPS)]
    ranked = moving if len(moving) else smoothest
    return ranked.iloc[sorted(range(len(ranked)), key=lambda i: _rank(ranked.iloc[i]))]


def _rank(row: pd.Series) -> tuple[Any, ...]:
    """The less, the better."""
    item = schemes_found().get(str(row["scheme"]))
    claims = (item.scheme.continuity, item.scheme.order) if item and item.scheme else (0, 0)
    torque, jerk = (float(f"{row[name]:.6g}") for name in ("torque", "jerk"))  # not by rounding
    reach = np.inf if row["support"] == "all" else int(row["support"])
    return torque, *(-claim for claim in claims), jerk, reach, str(row["scheme"])


def _best(pool: pd.DataFrame) -> str:
    fair = pool[pool["torque"] <= FAIR * pool["torque"].min()]
    local = fair[fair["support"] != "all"]
    return str((local if len(local) else fair).iloc[0]["scheme"])


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


def _first(ledger: Ledger, best: str) -> Finding:
    misses = ledger("compare", "misses", scheme=best)
    digits = ".0e" if misses.value else ".0f"
    parts = said(
        f"Take {best}: it passes through the keyframes (largest miss {{misses:{digits}}} rad), is C{{k:.0f}} as "
        "measured here, ",
        misses=misses,
        k=ledger("compare", "continuity", scheme=best),
    )
    if np.isfinite(ledger("compare", "torque_over_least", scheme=best).value):
        parts += ("has ", *_over_least(ledger, best, "torque", "torque"), ", ")
    return Finding(ADVICE, (*parts, f"and {_reach(ledger, best)}."))


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
    names = [_best(pool)] if len(pool) else []
    names += [str(pool.iloc[0]["scheme"])] if len(pool) else []
    usable = set(table.loc[table["failure"].isna(), "scheme"])
    names += [name for name in FAMILIAR if name in usable]
    names += [str(name) for name in table.loc[table["failure"].isna(), "scheme"]]
    return list(dict.fromkeys(names))[:CURVES]


def bars(table: pd.DataFrame) -> Figure:
    """Torque over the least, a scheme a row, C2 filled, others hollow."""
    rows = table[table["failure"].isna() & np.isfinite(table["torque_over_least"])]
    rows = rows.sort_values("torque_over_least", ascending=False)
    fig, panels = style.axes(style.COLUMN, 0.6 + 0.17 * max(len(rows), 3))
    ax = panels[0, 0]
    for height, (_, row) in enumerate(rows.iterrows()):
        looks = style.scheme_style(str(row["scheme"])) | {"linestyle": ""}
        face = {} if row["continuity"] >= 2 else {"markerfacecolor": "white"}
        ax.plot(row["torque_over_least"], height, **(looks | face))
    ax.set(xscale="log", xlabel="torque over the least", yticks=range(len(rows)))
    ax.set_yticklabels(rows["scheme"])
    return fig


def rates(curves: Mapping[str, Curve], keyframes: Keyframes) -> Figure:
    """Norms of angular velocity and acceleration over time of the curves that were measured, by name."""
    fig, panels = style.axes(style.PAGE, 3.6, 2, 1, sharex=True)
    t = _times(keyframes)
    for name, curve in curves.items():
        looks = style.scheme_style(name) | {"marker": ""}
        for ax, rate in zip(panels[:, 0], shape_rates(curve, t), strict=True):
            ax.plot(t - t[0], np.linalg.norm(rate, axis=-1), label=name, **looks)
    for ax, label in zip(
        panels[:, 0], (r"$|\omega|$ (rad/t)", r"$|\alpha|$ (rad/t$^2$)"), strict=True
    ):
        ax.set_ylabel(label)
        if keyframes.count <= 60:
            for knot in keyframes.knots:
                ax.axvline(knot, color="#dddddd", lw=0.5, zorder=0)
    panels[1, 0].set_xlabel("t since the first keyframe")
    if curves:
        style.legend_of(fig, panels[0, 0], CURVES)
    return fig


def _times(keyframes: Keyframes) -> FloatArray:
    """Samples away from knots, where rates of some schemes jump."""
    each = max(2, SAMPLES // len(keyframes.spacings))
    u = (np.arange(each) + 0.5) / each
    inner = keyframes.times[:-1, None] + keyframes.spacings[:, None] * u
    return inner.reshape(-1)
