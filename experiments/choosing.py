"""One row per scheme, one column per question: derived from the other tables of the folder."""

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import called, found, version
from quatspline.claims.claim import DEPARTS, UNDECIDED
from quatspline.figures import direct, named, style
from quatspline.findings import decisions
from quatspline.findings.quotes import Reader
from quatspline.runs.experiment import FULL, QUICK, Run
from quatspline.trajectories.sets import COUNT

TITLE = "Which scheme"
PAPER = False
KEYS = ["torque", "scheme"]
NOTE = (
    "Derived from the tables claims, continuity, accuracy, locality, edge-cases, convergence, fairness and cost of "
    "this folder; missing names those that are not there. smooth_k: k of C^k at steps of 60 degrees; smooth_k_worst: "
    "the least over all steps and times measured, where -1 is a leap. order: of the error, at uniform times and up to "
    "321 keyframes. spacing_0.1deg: the largest spacing below which the error on a smooth motion stays under 0.1 "
    "degrees. torque: median and worst energy relative to the minimum, on the committed sets. operations: "
    "exponentials and logarithms per sample and per keyframe, including iterations, where a slerp counts as two; "
    "empty where a scheme counts other things. pareto: yes if no other scheme that passes through its keyframes is at "
    "least as good in torque, order (as a whole number) and both operations and better in one of them; times_pareto: "
    "the same with the two timings, which libraries also have. Timings are of 10,000 samples and 1000 keyframes, or "
    "of the largest smaller size measured. worst_failure: the worst case of each kind; a deviation where a scheme "
    "claims nothing is not a failure. run_size: quick if a table behind the row was measured at that size; close "
    "decisions are then left open, and smooth_k_worst of libraries is empty."
)
FORMATS = {
    "order": ".2f",
    "spacing_0.1deg": ".3g",
    "torque": ".4f",
    "torque_worst": ".3f",
    "operations_sample": ".0f",
    "operations_keyframe": ".0f",
    "nanoseconds_per_sample": ".3g",
    "microseconds_per_keyframe": ".3g",
    "times_fastest_sample": ".1f",
    "times_fastest_keyframe": ".1f",
}
COLUMNS = [
    *("scheme", "passes_keys", "smooth_k", "smooth_k_worst", "order", "spacing_0.1deg", "support"),
    *("uneven_times", "closes", "worst_failure", "edge_cases_exact", "torque", "torque_worst"),
    *("operations_sample", "operations_keyframe", "pareto", "version", "missing", "run_size"),
    *("nanoseconds_per_sample", "microseconds_per_keyframe"),
    *("times_fastest_sample", "times_fastest_keyframe", "times_pareto"),
]
WHOLE = ("smooth_k", "smooth_k_worst", "edge_cases_exact")
WORST = ("k_claims", "k_continuity")
FAILURES = ("leaps", "unsolved", "edges_NaN", "edges_error", "edges_wrong")
"""Columns on the way: worst continuities, and the worst failure of each cause, the gravest cause first."""
SMALL = ("undecided", "few_sets", "short_rounds")
ASIDE = ("leaps_claims", "leaps_continuity", *SMALL)
"""More of them: leaps by the table that tells of one; and whether the worst continuity is open, sets are few and
timings are short, as in tables of quick size."""
ASKED = {"interpolates": "passes_keys", "takes uneven times": "uneven_times", "closes": "closes"}
"""Claims whose measured answers are columns."""
EASY, SMOOTH = "60 degrees", "smooth"
COSTS = {
    "evaluation": (10_000, 1e9, "nanoseconds_per_{}", "sample"),
    "set-up": (1000, 1e6, "microseconds_per_{}", "keyframe"),
}
"""The largest size of a task, units a second, and columns."""
COUNTED = {"exps": 1.0, "logs": 1.0, "slerps": 2.0}  # a slerp is one of each
LEAST_EXCESS = 1e-4
"""Excess of torque below this is drawn there."""


def derive(run: Run, read: Reader) -> pd.DataFrame:
    parts, missing = [], []
    for name, gather in SOURCES.items():
        try:
            parts.append(gather(read(name)))
        except FileNotFoundError:
            missing.append(name)
    if not parts:
        raise ValueError(f"none of {', '.join(SOURCES)} is in the folder: run them first")
    table = pd.concat(parts, axis=1).rename_axis("scheme").reset_index()
    table = table[table["scheme"].isin(run.schemes if run.schemes is not None else list(found()))]
    table = table.reindex(columns=[*COLUMNS, *WORST, *FAILURES, *ASIDE]).infer_objects()
    worst = table[list(WORST)].min(axis=1)
    table["smooth_k_worst"] = worst.where(table["undecided"].ne(True))
    leaps = zip(table["leaps_claims"], table["leaps_continuity"], strict=True)
    table["leaps"] = pd.Series([next(_texts(pair), None) for pair in leaps], dtype=object)
    causes = zip(*(table[name] for name in FAILURES), strict=True)
    table["worst_failure"] = ["; ".join(_texts(row)) or None for row in causes]
    table["run_size"] = QUICK if table[list(SMALL)].eq(True).to_numpy().any() else FULL
    table["version"] = table["scheme"].map(version)
    table["missing"] = ", ".join(missing) or None
    through = table[table["passes_keys"].ne("no")]
    table["pareto"] = decisions.pareto(through, decisions.COUNTED)
    table["times_pareto"] = decisions.pareto(through, decisions.TIMED)
    return table[COLUMNS].astype(dict.fromkeys(WHOLE, "Int64"))


def _texts(values: Iterable[Any]) -> Iterator[str]:
    """Those that are there."""
    return (str(value) for value in values if not pd.isna(value))


def text(table: pd.DataFrame) -> str:
    return "## Decisions\n\n" + "\n".join(decisions.lines(table))


# -- what each table says -----------------------------------------------------------------------


def _claims(table: pd.DataFrame) -> pd.DataFrame:
    rows = table[table["claim"].isin(ASKED) & table["measured"].notna()]
    other = rows["claimed"].map({"yes": "no", "no": "yes"})
    answers = rows.assign(answer=rows["claimed"].where(rows["verdict"].ne(DEPARTS), other))
    answers = answers.pivot(index="scheme", columns="claim", values="answer").rename(columns=ASKED)
    orders = table[table["claim"].eq("order")].set_index("scheme")["measured"].astype(float)
    answers = answers.assign(order=orders)
    tried = table[table["claim"].str.startswith("continuity") & table["measured"].notna()]
    tried = tried.assign(
        k=tried["measured"].astype(int), case=tried["claim"].str.split(", ", n=1).str[1]
    )
    answers = answers.join(_smoothness(tried, "claims"), how="outer")
    open_ones = tried[tried["verdict"].eq(UNDECIDED)]["scheme"].unique()
    return answers.assign(undecided=answers.index.isin(open_ones))


def _continuity(table: pd.DataFrame) -> pd.DataFrame:
    known = table[table["measured_k"].notna() & ~table["case"].str.startswith(SMOOTH)]
    known = known.assign(k=known["measured_k"])
    easy = known[known["case"].str.startswith(EASY)].groupby("scheme")["k"].min()
    return _smoothness(known, "continuity").assign(smooth_k=easy)


def _smoothness(rows: pd.DataFrame, source: str) -> pd.DataFrame:
    """The worst k of a table that tells cases, and the first case in which a curve leaps."""
    leaps = rows[rows["k"] < 0].groupby("scheme")["case"].first()
    return pd.DataFrame(
        {f"k_{source}": rows.groupby("scheme")["k"].min(), f"leaps_{source}": "leaps: " + leaps}
    )


def _accuracy(table: pd.DataFrame) -> pd.DataFrame:
    return table[table["knots"] == "uniform"].groupby("scheme")[["spacing_0.1deg"]].first()


def _locality(table: pd.DataFrame) -> pd.DataFrame:
    first = table[table["support"].notna()].groupby("scheme").first()
    local = first["support"].astype(int).astype(str)
    return pd.DataFrame({"support": local.where(first["decay"].isna(), "all")})


FAULTS = ("NaN", "error", "wrong")
"""Results of edge cases that are faults; to be off where a scheme claims nothing is none."""


def _edge_cases(table: pd.DataFrame) -> pd.DataFrame:
    """How many are exact, and the worst of each kind of fault: what is off by most, one of the others."""
    exact = table[table["result"] == "exact"].groupby("scheme").size()
    bad = table[table["result"].isin(FAULTS) & ~_refused(table)]
    bad = bad.sort_values("relative", ascending=False, kind="stable")
    columns: dict[str, Any] = {"edge_cases_exact": exact}
    for result in FAULTS:
        worst = bad[bad["result"] == result].groupby("scheme").first()
        told = [_told(str(row["case"]), result, row["relative"]) for _, row in worst.iterrows()]
        columns[f"edges_{result}"] = pd.Series(told, index=worst.index, dtype=object)
    return pd.DataFrame(columns)


def _told(case: str, result: str, relative: float) -> str:
    if result == "wrong" and np.isfinite(relative):
        return f"off by {relative:.2g} of the step: {case}"
    return f"{result}: {case}"


def _refused(table: pd.DataFrame) -> pd.Series:
    """A scheme that says that it does not apply has not failed."""
    return table["failure"].astype(str).str.startswith("ValueError")


def _convergence(table: pd.DataFrame) -> pd.DataFrame:
    """The share solved where it is least, by the best of a scheme's methods."""
    where = ["scheme", "keyframes", "step_degrees", "unevenness"]
    best = table[table["share_converged"].notna()].groupby(where)["share_converged"].max()
    worst = best.reset_index().sort_values("share_converged", kind="stable").groupby("scheme")
    rows = worst.first()
    rows = rows[rows["share_converged"] < 1.0]
    told = [
        f"solves {100.0 * row['share_converged']:.3g} %: {row['keyframes']:.0f} keyframes, "
        f"{row['step_degrees']:.0f} degrees, unevenness {row['unevenness']:.3g}"
        for _, row in rows.iterrows()
    ]
    return pd.DataFrame({"unsolved": pd.Series(told, index=rows.index, dtype=object)})


def _fairness(table: pd.DataFrame) -> pd.DataFrame:
    rows = table[table["data"] == "committed"].set_index("scheme")
    energies = rows[["median", "worst"]].set_axis(["torque", "torque_worst"], axis=1)
    return energies.assign(few_sets=rows["sets"] < COUNT if "sets" in rows else False)


def _cost(table: pd.DataFrame) -> pd.DataFrame:
    parts = []
    for task, (size, unit, seconds, item) in COSTS.items():
        rows = table[(table["task"] == task) & (table["size"] <= size)]
        rows = rows[rows["seconds_median"].notna()].sort_values("size").groupby("scheme").last()
        each = rows["seconds_median"] / rows["size"] * unit
        counts = rows[list(COUNTED)].mul(pd.Series(COUNTED)).sum(axis=1, skipna=False)
        part = {seconds.format(item): each, f"times_fastest_{item}": each / each.min()}
        parts.append(pd.DataFrame({**part, f"operations_{item}": counts.where(counts > 0)}))
    short = "run_size" in table and bool(table["run_size"].eq(QUICK).any())
    return pd.concat(parts, axis=1).assign(short_rounds=short)


SOURCES: dict[str, Callable[[pd.DataFrame], pd.DataFrame]] = {
    "claims": _claims,
    "continuity": _continuity,
    "accuracy": _accuracy,
    "locality": _locality,
    "edge-cases": _edge_cases,
    "convergence": _convergence,
    "fairness": _fairness,
    "cost": _cost,
}


# -- figure -------------------------------------------------------------------------------------


def draw(table: pd.DataFrame) -> Figure:
    fig, panels = style.axes(style.PAGE, 4.2)
    ax = panels[0, 0]
    shown = _shown(table)
    shown = shown.assign(excess=(shown["torque"] - 1.0).clip(lower=LEAST_EXCESS))
    lit = named.coloured(shown["scheme"])
    points = [_drawn(ax, row, lit) for _, row in shown.iterrows()]
    ax.set(xscale="log", yscale="log", xlabel="nanoseconds per sample", xmargin=0.1)
    ax.set_ylabel("median excess of torque energy over the minimum")
    fig.draw_without_rendering()
    fig.set_layout_engine("none")
    marks = zip(shown["nanoseconds_per_sample"], shown["excess"], points, strict=True)
    unnamed = [(x, y) for x, y, point in marks if point is None]
    direct.label_points(ax, [point for point in points if point is not None], unnamed)
    return fig


def _shown(table: pd.DataFrame) -> pd.DataFrame:
    return table[np.isfinite(table["torque"]) & table["nanoseconds_per_sample"].notna()]


def _drawn(ax: Any, row: pd.Series, lit: Collection[str]) -> direct.End | None:
    """Draw a scheme's point; what is written beside it, if anything is."""
    name, x, y = row["scheme"], row["nanoseconds_per_sample"], row["excess"]
    looks = named.looks(name, lit) | {"linestyle": "", "ms": 5}
    if best := row["times_pareto"] == "yes":
        ax.plot(x, y, "o", ms=10, mfc="none", mec="#444444", mew=0.8)
    ax.plot(x, y, **looks)
    if not best and name not in lit:
        return None
    return direct.End(x, y, called(name), looks["color"] if name in lit else "#555555")


def caption(table: pd.DataFrame) -> str:
    return (
        "Torque energy over the minimum (median of the committed sets, minus 1; below 1e-4 drawn there) against the "
        f"time of a sample; both are better when less.{named.said(_shown(table)['scheme'])} "
        "Ringed: on the front of torque, order and the two "
        "timings. Schemes of infinite energy are left out."
    )
