"""Torque and jerk energy, arc length and peak acceleration over those of the least torque."""

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.catalogue import version
from quatspline.curve import Curve
from quatspline.figures import rows as scheme_rows
from quatspline.figures import style
from quatspline.figures.heat import ROW, log_heat
from quatspline.figures.named import said
from quatspline.instruments.continuity import jumps, measured_continuity
from quatspline.instruments.curvature import Bending, curvature_energy
from quatspline.instruments.fairness import fairness
from quatspline.instruments.least_curvature import least_curvature
from quatspline.instruments.node_rates import NodeRates
from quatspline.instruments.trials import Row, attempted, builder
from quatspline.quaternion import FloatArray
from quatspline.runs.experiment import Run
from quatspline.trajectories.sets import COUNT, step_sets, torque_sets

TITLE = "Fairness: torque energy over the minimum"
PAPER = False
KEYS = ["data", "scheme"]
NOTE = (
    "Ratios to min-torque on the same keyframes (its energy is an upper bound on the true minimum); lower is fairer. "
    "least to worst: the integral of |alpha|^2; jerk: that of |alpha'|^2; length: that of |omega|; peak: the largest "
    "|alpha|. Seeded open sets of 4 to 9 keyframes with spacings uniform in [0.5, 1.5]: each set of 'committed' has "
    "one step angle between 20 and 110 degrees; the others have the step angle named. Quadrature is refined inside "
    "segments until two levels agree to 1e-7; |alpha| is also read on both sides of every keyframe. Every set is "
    "searched for velocity jumps, at keyframes and inside segments. Where the velocity jumps or the curve leaps, the "
    "energy of the set is infinite; jumping counts these sets, and worst_finite is the worst of the others. Iterative "
    "schemes are solved to 1e-9. curvature_median: the median over curvature_sets sets of the path's curvature "
    "energy, the integral of kappa^2 by arc length on S^3, relative to the least of all paths through the keyframes "
    "that are no longer than min-torque's, found by refining chains of arcs until two levels agree to 1e-4. It is "
    "infinite on curvature_infinite of the sets; curvature_reason is the first reason."
)
FORMATS = {
    "least": ".6f",
    "median": ".4f",
    "q95": ".3f",
    "worst": ".3f",
    "worst_finite": ".3f",
    "jerk_median": ".3g",
    "length_median": ".4f",
    "peak_median": ".3f",
    "curvature_median": ".4g",
}
REFERENCE = "min-torque"
TOLERANCE = 1e-9
COMMITTED = "committed"
LIMITS = (1e-5, 10.0)
PASSES_BY = "passes near its keyframes, for which no energy is the least"


def cells(run: Run) -> list[dict[str, Any]]:
    names = dict.fromkeys([REFERENCE, *run.names])
    angles = (10, 90, 170) if run.quick else range(10, 171, 20)
    data = [COMMITTED, *(f"{degrees} degrees" for degrees in angles)]
    return [{"scheme": name, "data": where} for where in data for name in names]


def _sets(run: Run, data: str) -> list[tuple[FloatArray, FloatArray]]:
    if data == COMMITTED:
        return [(t, q) for t, q, _ in torque_sets(6 if run.quick else COUNT)]
    return step_sets(int(data.split()[0]), 1 if run.quick else 10)


def measure_cell(run: Run, scheme: str, data: str) -> list[Row]:
    rows = []
    for index, (times, keyframes) in enumerate(_sets(run, data)):
        measured = partial(measures, scheme, times, keyframes)
        rows += attempted(measured, scheme=scheme, data=data, set=index)
    return rows


def measures(name: str, times: FloatArray, keyframes: FloatArray) -> list[Row]:
    curve = builder(name, TOLERANCE)(times, keyframes)
    if not curve.interpolates:
        return [{"failure": PASSES_BY, "version": version(name)}]
    jump = measured_continuity(jumps(curve, (0, 1))) < 1
    rates = NodeRates(curve)
    fair = fairness(curve, rates)
    bent = Bending(np.inf, "the velocity jumps") if jump else curvature_energy(curve, rates)
    row: Row = {**fair, "curvature": bent.energy, "curvature_reason": bent.reason}
    if name == REFERENCE:
        row |= _least_curvature(curve, fair["length"])
    return [row | {"velocity_jumps": jump, "version": version(name)}]


def _least_curvature(curve: Curve, turned: float) -> Row:
    """The least curvature energy of paths as long as the curve's on S^3, which is half of what it turns."""
    least = least_curvature(curve, 0.5 * turned)
    return {"least_curvature": least.energy if least.settled else None}


def gather(run: Run, table: pd.DataFrame) -> pd.DataFrame:
    """Ratios to the reference's own sets, and their distribution."""
    keys, values = ["data", "set"], ["torque", "jerk", "length", "peak"]
    columns = ["velocity_jumps", "version", "failure", "curvature", "curvature_reason", *values]
    references = table[table["scheme"] == REFERENCE]
    least = references.reindex(columns=[*keys, *values, "least_curvature"])
    table = table.reindex(columns=["scheme", *keys, *columns])
    joined = table.merge(least, on=keys, suffixes=("", "_least"), how="left")
    for value in values:
        joined[value] = joined[value] / joined[f"{value}_least"]
    joined["curvature"] = joined["curvature"].astype(float) / joined["least_curvature"].astype(
        float
    )
    infinite = joined["velocity_jumps"].eq(True) & joined["torque"].notna()
    joined["torque"] = joined["torque"].where(~infinite, np.inf)
    groups = joined.groupby(["scheme", "data"], sort=False)
    return pd.DataFrame([_summary(rows) for _, rows in groups])


def _summary(rows: pd.DataFrame) -> Row:
    known = rows[rows["torque"].notna()]
    reasons = rows["failure"].dropna()
    lost = f"no {REFERENCE} to compare with" if len(known) < len(rows) else None
    jumping = int(rows["velocity_jumps"].eq(True).sum())
    summary: Row = {
        "scheme": rows["scheme"].iloc[0],
        "data": rows["data"].iloc[0],
        "sets": len(rows),
        "failed": len(rows) - len(known),
        "velocity_jumps": jumping > 0,
        "jumping": jumping,
        "version": rows["version"].dropna().iloc[0] if rows["version"].notna().any() else None,
        "failure": reasons.iloc[0] if len(reasons) else lost,
    }
    if len(known):
        levels = {"least": 0.0, "median": 0.5, "q95": 0.95, "worst": 1.0}
        summary |= {name: _quantile(known["torque"], level) for name, level in levels.items()}
        summary |= {
            "worst_finite": known["torque"].where(np.isfinite(known["torque"])).max(),
            "jerk_median": known["jerk"].median(),
            "length_median": known["length"].median(),
            "peak_median": known["peak"].median(),
        }
    return summary | _bending(rows)


def _bending(rows: pd.DataFrame) -> Row:
    """What is said of curvature: a stop bends a curve that is fair otherwise without bound."""
    bent = rows["curvature"].dropna()
    infinite = rows.loc[np.isinf(rows["curvature"]), "curvature_reason"].dropna()
    return {
        "curvature_median": _quantile(bent, 0.5) if len(bent) else None,
        "curvature_sets": len(bent),
        "curvature_infinite": int(np.isinf(bent).sum()),
        "curvature_reason": infinite.iloc[0] if len(infinite) else None,
    }


def _quantile(values: pd.Series, level: float) -> float:
    """By linear interpolation; infinite from where a neighbour that counts is."""
    ordered = np.sort(values.to_numpy(dtype=float))
    place = level * (len(ordered) - 1)
    below, above = ordered[int(np.floor(place))], ordered[int(np.ceil(place))]
    share = place - np.floor(place)
    return float(above if np.isinf(above) else below + share * (above - below))


LEAST = 1e-6
"""Excesses below are drawn there."""
EXCESS = "torque energy over the least, minus 1"


def draw(table: pd.DataFrame) -> Figure:
    finite, sharing = table[np.isfinite(table["median"])], _sharing(table)
    own = finite[finite["scheme"].isin(list(sharing))]
    committed = own[own["data"] == COMMITTED].set_index("scheme")["median"].sort_values()
    names = [*committed.index, *sorted(set(own["scheme"]) - set(committed.index))]
    fig, panels = style.axes(
        style.PAGE, ROW * len(names) + 1.2, 1, 2, gridspec_kw={"width_ratios": (1, 1.35)}
    )
    _excess(panels[0, 0], finite[finite["data"] == COMMITTED], names)
    scheme_rows.label(panels[0, 0], names, sharing)
    shown = _by_angle(finite).reindex(names)
    log_heat(panels[0, 1], shown, f"median {EXCESS}", LIMITS, names_shown=False)
    panels[0, 1].set(title="by step angle", xlabel="step angle (degrees)")
    style.letters(panels[0])
    return fig


def _by_angle(finite: pd.DataFrame) -> pd.DataFrame:
    steps = finite[finite["data"] != COMMITTED]
    steps = steps.assign(angle=steps["data"].str.split().str[0].astype(int))
    excess = steps.pivot(index="scheme", columns="angle", values="median") - 1.0
    return excess.clip(lower=LIMITS[0])


def _sharing(table: pd.DataFrame) -> dict[str, list[str]]:
    finite = table[np.isfinite(table["median"])]
    committed = finite[finite["data"] == COMMITTED].set_index("scheme")
    excess = (committed[["least", "median", "worst"]] - 1.0).clip(lower=LEAST)
    drawn = excess.join(_by_angle(finite).clip(*LIMITS), how="outer").transform(np.log10)
    return scheme_rows.shared(drawn)


def _excess(ax: Any, rows: pd.DataFrame, names: list[str]) -> None:
    """Median and range of the excess on the committed sets, in the order of the names."""
    rows = rows.set_index("scheme").reindex(names)
    excess = {key: (rows[key] - 1.0).clip(lower=LEAST) for key in ("least", "median", "worst")}
    ax.hlines(np.arange(len(names)), excess["least"], excess["worst"], color="#bbbbbb", lw=2)
    scheme_rows.mark(ax, excess["median"], names)
    ax.set(xscale="log", xlabel=EXCESS, title="committed sets")


def caption(table: pd.DataFrame) -> str:
    sets, sharing = int(table.loc[table["data"] == COMMITTED, "sets"].max()), _sharing(table)
    return (
        f"(a) Excess of the torque energy over the least on {sets} committed keyframe sets: median (mark) and range "
        f"(bar). Values below {LEAST:g} are drawn there; lower is fairer. (b) Its median on sets of one step angle; "
        "grey: the scheme does not apply, or its energy is infinite. Schemes whose velocity jumps everywhere are left "
        f"out.{said(sharing)} {scheme_rows.said(sharing)}"
    )
