"""The log-curves ln q(t) of several schemes in R^3, with their keyframes."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator, MultipleLocator
from mpl_toolkits.mplot3d.axes3d import Axes3D
from numpy.typing import ArrayLike

from quatspline.quaternion import FloatArray

_GRID, _TEXT = "#dcdee3", "#374151"
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
    for (_, color, label), line in zip(curves, lines, strict=True):
        ax.plot(line[:, 0], line[:, 1], floor, color=color, alpha=0.18, lw=0.7, zorder=1)
        ax.plot(*line.T, color=color, label=label, lw=linewidth, zorder=3)
    for x, y, z in keys:
        ax.plot([x, x], [y, y], [floor, z], color=_GRID, lw=0.6, zorder=2)
    style = {"marker": "o", "ls": "none", "mfc": "white", "mec": "black", "mew": 0.9, "ms": 4.0}
    ax.plot(*keys.T, label="keyframes", zorder=4, **style)
    # above the box, in rows of three: nothing of the grid runs through it
    ax.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=3,
        handlelength=1.4,
        columnspacing=1.0,
    )


def _log_axes(ax: Axes3D, points: FloatArray, elev: float, azim: float) -> None:
    """Lay out white panes with a light grid around points (k, 3), one scale for all axes."""
    low, high = points.min(axis=0), points.max(axis=0)
    size = np.maximum(high - low, 0.25 * (high - low).max())
    middle, half = 0.5 * (low + high), 0.56 * size
    ax.computed_zorder = False
    ax.set_proj_type("ortho")
    ax.view_init(elev=elev, azim=azim)
    ax.set_box_aspect(size, zoom=0.86)
    step = MaxNLocator(3, steps=[1, 2, 5, 10]).tick_values(low[0], low[0] + size.max())
    for index, axis in enumerate((ax.xaxis, ax.yaxis, ax.zaxis)):
        limits = middle[index] + half[index] * _BOTH
        getattr(ax, f"set_{'xyz'[index]}lim")(limits, view_margin=0)
        _style_axis(axis, f"$(\\ln q)_{'xyz'[index]}$", step[1] - step[0])


def _style_axis(axis: Any, label: str, step: float) -> None:
    axis.set_major_locator(MultipleLocator(step))
    axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
    axis.line.set(color=_GRID, linewidth=0.8)
    axis._axinfo["grid"].update(color=_GRID, linewidth=0.5)
    axis._axinfo["tick"].update(inward_factor=0.0, outward_factor=0.12)
    axis.set_tick_params(labelsize=7, labelcolor=_TEXT, color=_GRID, pad=-1)
    axis.set_label_text(label, fontsize=8.5, color=_TEXT)
    axis.labelpad = -2
