"""Figure 4 of the paper: the teapot under the quartic and under the B-spline."""

import pandas as pd
from matplotlib.figure import Figure

from quatspline.figures.motions import caption_of, four_panels, motion_table
from quatspline.runs.experiment import Run
from quatspline.trajectories.paper import RECONSTRUCTED, TEAPOT

TITLE = "Figure 4: the teapot"
PAPER = True
NOTE = RECONSTRUCTED
SCHEMES = ("quartic", "nielson", "kim")
KEYS = ["panel", "scheme", "t"]


def measure(run: Run) -> pd.DataFrame:
    return motion_table(TEAPOT, tuple(dict.fromkeys([*SCHEMES, *(run.schemes or [])])))


def draw(table: pd.DataFrame) -> Figure:
    return four_panels(TEAPOT, table)


def caption(table: pd.DataFrame) -> str:
    return caption_of(TEAPOT, table)
