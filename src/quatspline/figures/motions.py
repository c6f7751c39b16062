"""The paper's animations: rendering frames one by one, and the four panels of Figures 3 and 4."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from quatspline.catalogue import scheme
from quatspline.figures import style
from quatspline.figures.log_axes import draw_log_curves
from quatspline.figures.meshes import Mesh, key_mesh, teapot_mesh
from quatspline.figures.scenes import BRASS, draw_frames
from quatspline.options import among
from quatspline.quaternion import FloatArray, distance
from quatspline.trajectories.paper import RECONSTRUCTED, SOLVE, PaperCase

LOG_SAMPLES = 601
ORIENTATION = ["qw", "qx", "qy", "qz"]
POSITION = ["x", "y", "z"]
LOGARITHM = ["lx", "ly", "lz"]


@cache
def body(case: str, *, small: bool = False) -> Mesh:
    """The mesh that a case moves, coarser for small pictures."""
    if case == "key":
        return key_mesh(14 if small else 28)
    return teapot_mesh(7 if small else 16)


VIEWS: dict[str, dict[str, Any]] = {
    "key": {"elev": 18.0, "azim": -80.0, "ground": -0.75, "scale": 0.95},
    "teapot": {"elev": 34.0, "azim": -70.0, "ground": -1.0, "scale": 1.1},
}
STRETCH = {"key": 1.9, "teapot": 1.45}
"""Of the paths in pictures, so that frames stand clear of one another; turns are as they are."""
PALE = 0.35
"""Of a scheme's own colour in frames between keyframes, the rest is white."""


def render(case: PaperCase, t: FloatArray, quaternions: FloatArray) -> int:
    """Draw every frame (m,) as a picture of its own, 320 x 240; returns the bytes drawn."""
    drawn = 0
    for place, q in zip(case.positions(t), quaternions, strict=True):
        fig = Figure(figsize=(3.2, 2.4), dpi=100)
        canvas = FigureCanvasAgg(fig)
        ax: Any = fig.add_axes((0, 0, 1, 1), projection="3d")
        draw_frames(ax, body(case.name, small=True), place[None], q[None], **VIEWS[case.name])
        canvas.draw()
        drawn += memoryview(canvas.buffer_rgba()).nbytes
    return drawn


def motion_table(case: PaperCase, schemes: tuple[str, ...]) -> pd.DataFrame:
    """What Figure 3 or 4 shows: keyframes, the paper's frames, and dense log-curves.

    Columns: panel (keyframes, frames, log), scheme, t, orientation qw qx qy qz, position x y z,
    logarithm lx ly lz (half rotation vectors in rad).
    """
    rows = []
    for name in schemes:
        cls = scheme(name)
        curve = cls.from_keyframes(case.keyframes(), **among(cls, SOLVE))
        dense = np.linspace(*curve.domain, LOG_SAMPLES)
        grids = {"frames": case.frames(case.rows[0].frames), "log": dense}
        if name == schemes[0]:
            grids["keyframes"] = case.times[: len(case.euler)]
        for panel, t in grids.items():
            data = np.hstack([t[:, None], curve(t), case.positions(t), curve.log(t)])
            table = pd.DataFrame(data, columns=["t", *ORIENTATION, *POSITION, *LOGARITHM])
            table.insert(0, "panel", panel)
            table.insert(1, "scheme", "-" if panel == "keyframes" else name)
            rows.append(table)
    return pd.concat(rows, ignore_index=True)


def four_panels(case: PaperCase, table: pd.DataFrame) -> Figure:
    """(a) keyframes, (b) and (c) frames of the two schemes, (d) both log-curves."""
    fig = Figure(figsize=(style.PAGE, 6.4 if case.name == "key" else 5.6))
    key_frames = table[table.panel == "keyframes"]
    panels = [("keyframes", key_frames, "white")]
    for name in ("quartic", "nielson"):
        picked = table[(table.panel == "frames") & (table.scheme == name)]
        apart = f", up to {_apart(table):.0f}° from (b)" if name == "nielson" else ""
        label = f"frames by {TITLES[name]}{apart}"
        panels.append((label, picked, style.scheme_style(name)["color"]))
    boxes = _boxes(case.name)
    for letter, (label, rows, color), box in zip("abc", panels, boxes, strict=False):
        _scene(fig, case, rows, key_frames, box, color)
        _label(fig, box, f"({letter}) {label}")
    _logs(fig, table, key_frames, boxes[3])
    _label(fig, boxes[3], r"(d) $\ln\,q(t)$, half rotation vectors in rad; circles are keyframes")
    return fig


def caption_of(case: PaperCase, table: pd.DataFrame) -> str:
    """What `four_panels` shows, as text to be printed beside it."""
    frames = int(((table.panel == "frames") & (table.scheme == "quartic")).sum())
    further = [name for name in table.scheme[table.panel == "log"].unique() if name not in PAPER]
    others = f", and {', '.join(further)}" if further else ""
    return (
        f"{case.title}. (a) Keyframes; (b) {frames} frames by the quartic; (c) {frames} frames by the "
        "cubic B-spline of Nielson. Frames at keyframes are of brass, those between reddish and bluish; the path is "
        "drawn longer than it is. (d) The log-curves ln q(t) in R^3, half rotation vectors in rad, quartic red, "
        f"B-spline blue{others}, keyframes marked, with their projections on the floor. {RECONSTRUCTED}"
    )


def _apart(table: pd.DataFrame) -> float:
    """The largest angle (degrees) between the frames of the two schemes, which the eye hardly finds."""
    frames = table[table.panel == "frames"]
    q, p = (frames.loc[frames.scheme == name, ORIENTATION].to_numpy() for name in PAPER[:2])
    return float(np.degrees(distance(q, p)).max())


PAPER = ("quartic", "nielson", "kim")
TITLES = {"quartic": "the quartic", "nielson": "the B-spline (Nielson)"}
Box = tuple[float, float, float, float]


def _boxes(name: str) -> list[Box]:
    """Left, bottom, width, height of the panels in shares of the figure."""
    if name == "key":
        return [*((0.0, 0.82 - 0.175 * k, 1.0, 0.145) for k in range(3)), (0.2, 0.0, 0.6, 0.44)]
    return [(x, y, 0.48, 0.45) for y in (0.5, 0.0) for x in (0.01, 0.51)]


def _scene(
    fig: Figure, case: PaperCase, rows: pd.DataFrame, keys: pd.DataFrame, box: Box, color: str
) -> None:
    ax: Any = fig.add_axes(box, projection="3d")
    stretch = STRETCH[case.name]
    pale = tuple(1.0 - PALE * (1.0 - np.array(to_rgb(color))))
    at_key = np.isclose(rows["t"].to_numpy()[:, None], keys["t"].to_numpy()).any(axis=1)
    lo, hi = case.times[0], case.times[-1]
    margin = 0.0 if case.closed else 0.5
    path = stretch * case.positions(np.linspace(lo - margin, hi + margin, 181))
    draw_frames(
        ax,
        body(case.name),
        stretch * rows[POSITION].to_numpy(),
        rows[ORIENTATION].to_numpy(),
        color=[BRASS if k else pale for k in at_key],
        path=path,
        **VIEWS[case.name],
    )


def _logs(fig: Figure, table: pd.DataFrame, keys: pd.DataFrame, box: Box) -> None:
    ax: Any = fig.add_axes(box, projection="3d")
    curves = []
    logs = table[table.panel == "log"]
    further = [name for name in logs["scheme"].unique() if name not in PAPER]
    for name in [*further, "nielson", "quartic"]:
        picked = logs[logs["scheme"] == name]
        label = TITLES.get(name, name).removeprefix("the ")
        curves.append((picked[LOGARITHM].to_numpy(), style.scheme_style(name)["color"], label))
    draw_log_curves(ax, curves, keys[LOGARITHM].to_numpy())


def _label(fig: Figure, box: Box, text: str) -> None:
    left, bottom, _, height = box
    fig.text(left + 0.012, bottom + height + 0.005, text, fontsize=9, va="bottom")
