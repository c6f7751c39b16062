"""The log-curves ln q(t) of several schemes in R^3, with their keyframes."""

from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator, MultipleLocator
from mpl_toolkits.mplot3d.axes3d import Axes3D
from numpy.typing import ArrayLike

from quatspline.figures.scenes import project, view_axes
from quatspline.quaternion import FloatArray

_GRID, _TEXT = "#dcdee3", "#374151"
_AROUND = 0.8
"""Inches of a panel, in all, for numbers and names of axes."""
_LETTER = 0.032
"""Width of a letter, about, over the extent of what is drawn."""
_BOTH = np.array([-1.0, 1.0])


def draw_log_curves(
    ax: Axes3D,
    curves: Sequence[tuple[ArrayLike, Any, str]],
    keyframes: ArrayLike,
    *,
    elev: float = 22.0,
    azim: float = -55.0,
    linewidth: float = 1.4,
) -> None:
    """Draw curves ln q(t) in R³ with their keyframes, lengths true in every direction.

    Parameters
    ----------
    ax : an empty 3-D axes.
    curves : points (m, 3) of ln q (half rotation vectors, radians), colour and label of each.
    keyframes : (n, 3) logarithms of the keyframes.
    elev : the camera's elevation, in degrees.
    azim : the camera's azimuth, in degrees.
    linewidth : of the curves, in points.
    """
    lines = [np.asarray(points, dtype=np.float64) for points, _, _ in curves]
    keys = np.asarray(keyframes, dtype=np.float64)
    _log_axes(ax, np.concatenate([*lines, keys]), elev, azim)
    floor = ax.get_zlim()[0]
    for (_, color, _), line in zip(curves, lines, strict=True):
        ax.plot(line[:, 0], line[:, 1], floor, color=color, alpha=0.18, lw=0.7, zorder=1)
        ax.plot(*line.T, color=color, lw=linewidth, zorder=3)
    for x, y, z in keys:
        ax.plot([x, x], [y, y], [floor, z], color=_GRID, lw=0.6, zorder=2)
    style = {"marker": "o", "ls": "none", "mfc": "white", "mec": "black", "mew": 0.9, "ms": 4.0}
    ax.plot(*keys.T, zorder=4, **style)
    for k, (_, color, label) in enumerate(curves):
        _name(ax, lines[k], [line for line in lines if line is not lines[k]], label, color)


def _name(
    ax: Axes3D, line: FloatArray, others: Sequence[FloatArray], label: str, color: Any
) -> None:
    """Write a curve's name beside it, over as few points of curves and as far from the others as that goes."""
    seen = view_axes(ax.elev, ax.azim)[:2].T
    flat, drawn = line @ seen, np.concatenate([line, *others]) @ seen
    gaps = [np.linalg.norm(flat - _nearest(flat, other @ seen), axis=1) for other in others]
    gap = np.min(gaps, axis=0) if gaps else np.zeros(len(line))
    unit = _LETTER * np.ptp(drawn, axis=0).max()
    half = unit * np.array([0.5 * len(label) + 1.0, 1.2])
    best = min(
        (_covered(flat[at] + [side * (half[0] + unit), 0.0], half, drawn), -gap[at], at, side)
        for at in range(0, len(line), 10)
        for side in (1, -1)
    )
    *_, at, side = best
    place = {"ha": "left" if side > 0 else "right", "va": "center", "zorder": 5}
    ax.text(*line[at], f"  {label}  ", color=color, **place)


def _covered(centre: FloatArray, half: FloatArray, points: FloatArray) -> int:
    """How many points (k, 2) lie in a box."""
    return int((np.abs(points - centre) < half).all(axis=1).sum())


def _nearest(line: FloatArray, other: FloatArray) -> FloatArray:
    """The point of another curve (k, 2) nearest to each point of a curve (m, 2), as the camera sees them."""
    from scipy.spatial import KDTree

    points: FloatArray = other[KDTree(other).query(line)[1]]
    return points


def _log_axes(ax: Axes3D, points: FloatArray, elev: float, azim: float) -> None:
    """Lay out white panes with a light grid around points (k, 3), one scale for all axes."""
    low, high = points.min(axis=0), points.max(axis=0)
    size = np.maximum(high - low, 0.25 * (high - low).max())
    middle, half = 0.5 * (low + high), 0.56 * size
    ax.computed_zorder = False
    ax.set_proj_type("ortho")
    ax.view_init(elev=elev, azim=azim)
    step = MaxNLocator(5, steps=[1, 2, 5, 10]).tick_values(low[0], low[0] + size.max())
    for index, axis in enumerate((ax.xaxis, ax.yaxis, ax.zaxis)):
        limits = middle[index] + half[index] * _BOTH
        getattr(ax, f"set_{'xyz'[index]}lim")(limits, view_margin=0)
        _style_axis(axis, f"$(\\ln q)_{'xyz'[index]}$", step[1] - step[0])
    ax.set_box_aspect(tuple(size))  # a copy: it scales what it is given
    ax.set_box_aspect(tuple(size), zoom=_zoom(ax))


def _zoom(ax: Axes3D) -> float:
    """How much larger the box may be drawn, numbers and names of its axes included."""
    ax.apply_aspect()
    corners = np.array(list(product(*(getattr(ax, f"get_{name}lim")() for name in "xyz"))))
    drawn = np.ptp(ax.transData.transform(project(ax, corners)), axis=0)
    panel = ax.get_position(original=True).transformed(ax.figure.transSubfigure)
    room = np.array([panel.width, panel.height]) - _AROUND * ax.figure.dpi
    return float((room / drawn).min())


def _style_axis(axis: Any, label: str, step: float) -> None:
    axis.set_major_locator(MultipleLocator(step))
    axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
    axis.line.set(color=_GRID, linewidth=0.8)
    axis._axinfo["grid"].update(color=_GRID, linewidth=0.5)
    axis._axinfo["tick"].update(inward_factor=0.0, outward_factor=0.12)
    axis.set_tick_params(labelsize=7, labelcolor=_TEXT, color=_GRID, pad=-1)
    axis.set_label_text(label, fontsize=8.5, color=_TEXT)
    axis.labelpad = 1
