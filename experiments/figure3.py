"""Figure 3 of the paper: the key under the quartic and under the B-spline."""

import pandas as pd
from matplotlib.figure import Figure

from quatspline.figures.motions import caption_of, four_panels, motion_table
from quatspline.runs.experiment import Run
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
    return caption_of(KEY, table)
