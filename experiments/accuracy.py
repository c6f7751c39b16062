"""Accuracy against keyframe spacing on a smooth motion, and the orders that it falls with."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.instruments.accuracy import errors, knots, with_slopes
from quatspline.instruments.derivatives import analytic
from quatspline.quaternion import FloatArray
from quatspline.registry import found, scheme, version
from quatspline.report import style
from quatspline.running import Run
from quatspline.trajectories.smooth import SPAN, tumble

TITLE = "Accuracy on a smooth motion"
PAPER = False
KEYS = ["knots", "scheme", "keyframes"]
NOTE = (
    "Largest errors to the analytic truth; 'inner' is the window [3, 7] of [0, 10], away from the ends. slope: "
    "order of inner_angle from the level before; regression: over the last five levels."
)
FORMATS = {
    "spacing": ".3g",
    "inner_angle": ".2e",
    "angle": ".2e",
    "inner_omega": ".2e",
    "inner_alpha": ".2e",
    "slope": ".2f",
    "regression": ".2f",
}
QUICK, FULL = (21, 41, 81), (11, 21, 41, 81, 161, 321, 641)
KINDS = ("uniform", "jittered", "log-uniform")


def measure(run: Run) -> pd.DataFrame:
    rows = []
    levels = QUICK if run.quick else FULL
    cells = [(kind, count) for kind in KINDS[: 2 if run.quick else 3] for count in levels]
    for kind, count in run.progress(cells, label="accuracy"):
        times = knots(run.rng("accuracy", kind, count), kind, count)
        keyframes = tumble(times)
        for name in run.schemes or found():
            base = {"knots": kind, "scheme": name, "keyframes": count}
            rows.append(base | {"spacing": SPAN / (count - 1)} | _measured(name, times, keyframes))
    return with_slopes(pd.DataFrame(rows), ["knots", "scheme"])


def _measured(name: str, times: FloatArray, keyframes: FloatArray) -> dict[str, object]:
    try:
        cls = scheme(name)
        limit = cls.practical_keyframes
        if limit is not None and len(times) > limit:
            return {"failure": f"over budget beyond {limit} keyframes"}
        options: dict[str, Any] = {"tolerance": 1e-11} if cls.iterative else {}
        curve = cls(times, keyframes, **options)
        rates = "analytic" if analytic(curve) else "numeric"
        return {**errors(curve), "rates": rates, "version": version(name)}
    except Exception as error:  # what does not apply or fails is a row with its reason
        return {"failure": f"{type(error).__name__}: {error}"}


def draw(table: pd.DataFrame) -> Figure:
    fig, panels = style.axes(style.PAGE, 5.2, 1, 2, sharey=True)
    for ax, kind in zip(panels[0], ("uniform", "jittered"), strict=True):
        for name, rows in table[table["knots"] == kind].groupby("scheme"):
            looks = style.scheme_style(str(name))
            ax.plot(rows["spacing"], rows["inner_angle"], label=name, **looks)
        _guides(ax, table["spacing"])
        ax.set(xscale="log", yscale="log", title=f"{kind} times", xlabel="keyframe spacing (t)")
    panels[0, 0].set_ylabel("largest error on the inner window (rad)")
    style.letters(panels[0])
    style.legend_of(fig, panels[0, 0], 4)
    return fig


def _guides(ax: object, spacing: pd.Series) -> None:
    """Slopes 2, 3 and 4 in grey."""
    x = np.array([spacing.min(), spacing.max()])
    for order in (2, 3, 4):
        ax.plot(x, 0.02 * x**order, color="#bbbbbb", lw=0.7, ls=":")  # type: ignore[attr-defined]
        at = (x[0], 0.02 * x[0] ** order)
        ax.annotate(f"order {order}", at, fontsize=7, color="#888888", va="top")  # type: ignore[attr-defined]


def caption(table: pd.DataFrame) -> str:
    return (
        "Largest angle between each curve and the analytic motion that its keyframes come from, on the inner window "
        "[3, 7] of [0, 10], against the keyframe spacing; dotted lines have slopes 2, 3, 4."
    )
