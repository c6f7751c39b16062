"""Measured continuity of every scheme: jumps at keyframes, the control order, the speed there."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.instruments.continuity import jumps, measured_continuity, speeds
from quatspline.instruments.derivatives import analytic
from quatspline.quaternion import FloatArray
from quatspline.registry import found, scheme, version
from quatspline.report import style
from quatspline.running import Run
from quatspline.trajectories.smooth import SPAN, tumble
from quatspline.trajectories.walks import walk

TITLE = "Continuity at keyframes"
PAPER = False
KEYS = ["case", "scheme", "order"]
NOTE = (
    "Jump: the largest difference of one-sided limits over inner keyframes. An order counts as continuous "
    "when its jump is below 1e-5 of its size or falls with the step; the first that stays is the control. "
    "Iterative schemes are solved to 1e-11. Smooth motion is for in-house schemes. measured_k is k of C^k "
    "(3: no jump up to the third derivative)."
)
FORMATS = {
    "jump": ".2e",
    "coarse_jump": ".2e",
    "size": ".3g",
    "relative": ".1e",
    "least_key_speed": ".3f",
    "peak_speed": ".2f",
}
COUNT = 7
TOLERANCE = 1e-11
SMOOTH = (11, 21, 41, 81)


def measure(run: Run) -> pd.DataFrame:
    tables = []
    names = run.schemes or list(found())
    for case, (times, keyframes) in run.progress(_cases(run).items(), label="continuity"):
        for name in names:
            cls = found()[name].scheme
            if not case.startswith("smooth") or (cls is not None and cls.peer is None):
                tables.append(_measured(case, name, times, keyframes))
    return pd.concat(tables, ignore_index=True)


def _cases(run: Run) -> dict[str, tuple[FloatArray, FloatArray]]:
    cases = {}
    even = np.arange(float(COUNT))
    for degrees in (60, 170) if run.quick else (60, 120, 170):
        rng = run.rng("continuity", degrees)
        keyframes = walk(rng, COUNT, float(degrees))[:, 0]
        uneven = np.concatenate([[0.0], np.cumsum(np.exp(rng.uniform(-1.0, 1.0, COUNT - 1)))])
        cases[f"{degrees} degrees, uniform"] = (even, keyframes)
        cases[f"{degrees} degrees, uneven"] = (uneven, keyframes)
    for count in SMOOTH:
        t = np.linspace(0.0, SPAN, count)
        cases[f"smooth motion, {count} keyframes"] = (t, tumble(t))
    return cases


def _measured(case: str, name: str, times: FloatArray, keyframes: FloatArray) -> pd.DataFrame:
    try:
        cls = scheme(name)
        options: dict[str, Any] = {"tolerance": TOLERANCE} if cls.iterative else {}
        curve = cls(times, keyframes, **options)
        table = jumps(curve)
        more = {
            "measured_k": measured_continuity(table),
            "claimed_k": curve.continuity,
            "rates": "analytic" if analytic(curve) else "numeric",
            "version": version(name),
            **speeds(curve),
        }
    except Exception as error:  # a scheme that does not apply or fails is a row with its reason
        table = pd.DataFrame([{"order": 0, "failure": f"{type(error).__name__}: {error}"}])
        more = {}
    return table.assign(case=case, scheme=name, **more)


def draw(table: pd.DataFrame) -> Figure:
    names = sorted(table["scheme"].unique(), reverse=True)
    fig, panels = style.axes(style.PAGE, 0.19 * len(names) + 1.3, 1, 3, sharey=True)
    shown = ("60 degrees, uniform", "60 degrees, uneven", "170 degrees, uneven")
    looks = {"omega": ("o", style.BLUE), "alpha": ("s", style.RED)}
    for ax, case in zip(panels[0], shown, strict=True):
        for quantity, (marker, color) in looks.items():
            rows = table[(table["case"] == case) & (table["quantity"] == quantity)]
            y = [names.index(name) for name in rows["scheme"]]
            x = rows["relative"].clip(lower=1e-14)
            ax.plot(x, y, marker, color=color, ms=4, mfc="none", label=f"jump of {quantity}")
        ax.axvline(1e-5, color="#888888", lw=0.7, ls=":")
        ax.set(xscale="log", xlim=(3e-15, 30), title=case, xlabel="share of its size")
        ax.set_yticks(range(len(names)), names)
    style.letters(panels[0])
    style.legend_of(fig, panels[0, 0], 2)
    return fig


def caption(table: pd.DataFrame) -> str:
    return (
        "Largest jump of angular velocity and acceleration at inner keyframes, as a share of the quantity's "
        "size on the curve; left of the dotted line counts as continuous. Values below 1e-14 are drawn there."
    )
