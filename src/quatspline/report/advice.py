"""What a comparison says: a recommendation with its reasons, each number tied to its cell, and figures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from quatspline.instruments.derivatives import shape_rates
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.registry import scheme
from quatspline.report import style
from quatspline.report.findings import Finding
from quatspline.report.quotes import Ledger, Quote, said

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

MET = 1e-6
"""Largest angle at a keyframe, in rad, that counts as passing through it."""
FAIR = 1.05
"""Torque within this of the least is as good as the least: nobody sees five per cent."""
STOPS = 0.01
"""A least speed at keyframes below this share of the mean is a stop."""
CURVES = 4
"""Schemes drawn over time."""
SAMPLES = 2000
ADVICE = "recommendation"
PAPERS = "quartic"
"""What a reader of the paper asks about."""
FAMILIAR = (PAPERS, "squad", "nielson", "slerp")
"""Curves that readers know, drawn beside the recommended one."""


def recommendation(table: pd.DataFrame) -> list[Finding]:
    """The advice for a table of `quatspline.compare`, best reason first; empty if nothing works.

    Candidates pass through the keyframes (to MET), are C2 as measured (C1 if none is), do not stop
    at keyframes (unless all do), and have a torque within FAIR of the least among them.  Local
    schemes go before global ones, then the least torque decides.
    """
    pool = candidates(table)
    if pool.empty:
        return []
    ledger = Ledger(lambda name: table)
    best, fairest = _best(pool), str(pool.iloc[0]["scheme"])
    torques = pool.set_index("scheme")["torque"]
    found = [_first(ledger, best, pool)]
    if torques[best] > torques[fairest]:
        found.append(_fairest(ledger, fairest, best))
    quickest = str(pool.sort_values("seconds_per_sample").iloc[0]["scheme"])
    if quickest != best:
        found.append(_quickest(ledger, quickest, best))
    paper = table[(table["scheme"] == PAPERS) & table["failure"].isna()]
    if best != PAPERS and len(paper) and np.isfinite(paper["torque_over_least"]).all():
        found.append(_paper(ledger))
    return found


def candidates(table: pd.DataFrame) -> pd.DataFrame:
    """The rows among which the recommendation chooses, by torque, those of equal torque by time."""
    pool = table[table["failure"].isna() & (table["misses"] <= MET) & np.isfinite(table["torque"])]
    if pool.empty:
        return pool
    smoothest = pool[pool["continuity"] >= min(2, pool["continuity"].max())]
    moving = smoothest[~(smoothest["key_speed"] < STOPS)]
    return (moving if len(moving) else smoothest).sort_values(["torque", "seconds_per_sample"])


def _best(pool: pd.DataFrame) -> str:
    fair = pool[pool["torque"] <= FAIR * pool["torque"].min()]
    local = fair[fair["support"] != "all"]
    return str((local if len(local) else fair).iloc[0]["scheme"])


def _cell(ledger: Ledger, name: str, column: str) -> Quote:
    return Quote((ledger("compare", column, scheme=name),))


def _ratio(ledger: Ledger, column: str, above: str, below: str) -> Quote:
    cells = tuple(ledger("compare", column, scheme=name) for name in (above, below))
    return Quote(cells, "ratio")


def _first(ledger: Ledger, best: str, pool: pd.DataFrame) -> Finding:
    local = pool.set_index("scheme").loc[best, "support"] != "all"
    reach = (
        "a changed keyframe changes the curve nearby only" if local else "all keyframes shape it"
    )
    torque = _cell(ledger, best, "torque_over_least")
    share = "its torque is {torque:.3f} times the least of all schemes compared, and "
    parts = said(
        f"Take {best}: it passes through the keyframes (largest miss {{misses:.0e}} rad), is C{{k:.0f}} as measured "
        f"here, {share if np.isfinite(torque.value) else 'and '}{reach}.",
        misses=_cell(ledger, best, "misses"),
        k=_cell(ledger, best, "continuity"),
        torque=torque,
    )
    return Finding(ADVICE, parts)


def _fairest(ledger: Ledger, name: str, best: str) -> Finding:
    text = (
        f"The fairest candidate is {name}: the torque of {best} is {{ratio:.3f}} times its own; its set-up takes "
        "{cost:.2g} times as long."
    )
    ratio = _ratio(ledger, "torque", best, name)
    return Finding(
        ADVICE, said(text, ratio=ratio, cost=_ratio(ledger, "seconds_set_up", name, best))
    )


def _quickest(ledger: Ledger, name: str, best: str) -> Finding:
    text = f"The quickest candidate to evaluate is {name}: a sample of {best} takes {{cost:.2g}} times as long"
    cost = _ratio(ledger, "seconds_per_sample", best, name)
    torque = _ratio(ledger, "torque", name, best)
    if not torque.cells[1].value:  # at rest no curve needs any
        return Finding(ADVICE, said(text + ".", cost=cost))
    text += ", but the torque of the quickest is {torque:.3f} times that of the first choice."
    return Finding(ADVICE, said(text, cost=cost, torque=torque))


def _paper(ledger: Ledger) -> Finding:
    text = (
        "The paper's quartic has {torque:.3f} times the least torque here and a peak acceleration of {peak:.3f} times "
        "the least."
    )
    torque, peak = (_cell(ledger, PAPERS, f"{name}_over_least") for name in ("torque", "peak"))
    return Finding(ADVICE, said(text, torque=torque, peak=peak))


def lines(found: list[Finding]) -> Iterator[str]:
    """The advice as plain lines."""
    if not found:
        yield "No recommendation: no scheme compared passes through these keyframes with a continuous velocity."
    for finding in found:
        yield finding.text


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


def rates(keyframes: Keyframes, names: list[str]) -> Figure:
    """Norms of angular velocity and acceleration over time."""
    fig, panels = style.axes(style.PAGE, 3.6, 2, 1, sharex=True)
    for name in names:
        curve = scheme(name).from_keyframes(keyframes)
        t = _times(keyframes)
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
    if names:
        style.legend_of(fig, panels[0, 0], CURVES)
    return fig


def _times(keyframes: Keyframes) -> FloatArray:
    """Samples away from knots, where rates of some schemes jump."""
    each = max(2, SAMPLES // len(keyframes.spacings))
    u = (np.arange(each) + 0.5) / each
    inner = keyframes.times[:-1, None] + keyframes.spacings[:, None] * u
    return inner.reshape(-1)
