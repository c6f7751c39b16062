"""Figure 3 of the paper: the key under the quartic and under the B-spline."""

import pandas as pd
from matplotlib.figure import Figure

from quatspline.report.motions import four_panels, motion_table
from quatspline.running import Run
from quatspline.trajectories.paper import KEY, RECONSTRUCTED

TITLE = "Figure 3: the key"
PAPER = True
NOTE = RECONSTRUCTED
SCHEMES = ("quartic", "nielson", "kim")
KEYS = ["panel", "scheme", "t"]


def measure(run: Run) -> pd.DataFrame:
    return motion_table(KEY, tuple(dict.fromkeys([*SCHEMES, *(run.schemes or [])])))


def draw(table: pd.DataFrame) -> Figure:
    return four_panels(KEY, table)


def caption(table: pd.DataFrame) -> str:
    frames = int(((table.panel == "frames") & (table.scheme == "quartic")).sum())
    return (
        f"{KEY.title}. (a) Keyframes; (b) {frames} frames by the quartic; (c) {frames} frames by the "
        "cubic B-spline of Nielson, frames at keyframes in full colour; (d) the log-curves ln q(t) in "
        f"R^3, quartic red, B-spline blue, keyframes marked. {RECONSTRUCTED}"
    )
