"""Torque energy over the least possible, on committed sets of keyframes."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.instruments.fairness import fairness
from quatspline.registry import found, scheme, version
from quatspline.report import style
from quatspline.running import Run
from quatspline.trajectories.sets import COUNT, torque_sets

TITLE = "Fairness: torque energy over the minimum"
PAPER = False
KEYS = ["scheme"]
NOTE = (
    "Ratios of the integral of |alpha|^2 to that of min-torque (an upper bound of the true minimum) on committed "
    "seeded sets: 4 to 9 keyframes, steps of 20 to 110 degrees, spacings uniform in [0.5, 1.5], open. Where velocity "
    "jumps (C0) the energy is infinite. Iterative schemes are solved to 1e-9. peak and length are medians of "
    "ratios to min-torque."
)
FORMATS = {
    "least": ".6f",
    "median": ".4f",
    "q95": ".3f",
    "worst": ".3f",
    "jerk_median": ".3g",
    "length_median": ".4f",
    "peak_median": ".3f",
}
REFERENCE = "min-torque"
TOLERANCE = 1e-9


def measure(run: Run) -> pd.DataFrame:
    sets = torque_sets(6 if run.quick else COUNT)
    names = [REFERENCE, *(n for n in (run.schemes or found()) if n != REFERENCE)]
    ratios: dict[str, list[dict[str, float]]] = {name: [] for name in names}
    reasons: dict[str, str] = {}
    for times, keyframes, _ in run.progress(sets, label="fairness"):
        least: dict[str, float] = {}
        for name in names:  # the reference comes first
            try:
                cls = scheme(name)
                options: dict[str, Any] = {"tolerance": TOLERANCE} if cls.iterative else {}
                own = fairness(cls(times, keyframes, **options))
                least = least or own
                ratios[name].append({key: own[key] / least[key] for key in own})
            except Exception as error:  # what does not apply or fails is a row with its reason
                reasons.setdefault(name, f"{type(error).__name__}: {error}")
                if name == REFERENCE:
                    break
    return pd.DataFrame([_summary(name, ratios[name], len(sets), reasons) for name in names])


def _summary(
    name: str, ratios: list[dict[str, float]], sets: int, reasons: dict[str, str]
) -> dict[str, object]:
    table = pd.DataFrame(ratios)
    row: dict[str, object] = {
        "scheme": name,
        "sets": sets,
        "failed": sets - len(table),
        "velocity_jumps": (cls := found()[name].scheme) is not None and cls.continuity < 1,
        "version": version(name),
        "failure": reasons.get(name),
    }
    if len(table):
        torque = table["torque"] + (np.inf if row["velocity_jumps"] else 0.0)
        row |= {
            "least": torque.min(),
            "median": torque.median(),
            "q95": torque.quantile(0.95),
            "worst": torque.max(),
            "jerk_median": table["jerk"].median(),
            "length_median": table["length"].median(),
            "peak_median": table["peak"].median(),
        }
    return row


def draw(table: pd.DataFrame) -> Figure:
    rows = table[~table["velocity_jumps"] & table["median"].notna()].sort_values(
        "median", ascending=False
    )
    fig, panels = style.axes(style.PAGE, 0.19 * len(rows) + 0.9)
    ax = panels[0, 0]
    y = np.arange(len(rows))
    excess = {key: (rows[key] - 1.0).clip(lower=1e-6) for key in ("least", "median", "worst")}
    ax.hlines(y, excess["least"], excess["worst"], color="#bbbbbb", lw=2)
    for x, height, name in zip(excess["median"], y, rows["scheme"], strict=True):
        looks = style.scheme_style(name)
        ax.plot(x, height, color=looks["color"], marker=looks["marker"], ms=5)
    ax.set_yticks(y, rows["scheme"])
    ax.set(xscale="log", xlabel="torque energy over the minimum, minus 1")
    return fig


def caption(table: pd.DataFrame) -> str:
    return (
        f"Excess of the torque energy over the minimum on {int(table['sets'].max())} keyframe sets: median (marker), "
        "range (bar); below 1e-6 drawn there. Schemes whose velocity jumps are left out: theirs is infinite."
    )
