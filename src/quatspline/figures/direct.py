"""Direct labels: names beside the ends of curves, in their order so that no leader crosses, and beside points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quatspline.figures.looks import Dash
from quatspline.inputs.arrays import FloatArray

GREY = "#b5b5b5"
"""Of curves that stand behind those with a name."""

POINTS = 72.0
"""Of an inch."""
LEADER = 0.7
"""Points of the line from a curve to its name."""


@dataclass(frozen=True)
class End:
    """Where a curve ends, in data, what is written there, and the curve's dash, which the line to it has, too."""

    x: float
    y: float
    text: str
    color: str
    dash: Dash = "-"


def spread(wanted: ArrayLike, gap: float) -> FloatArray:
    """Places nearest to those wanted, in least squares and in their order, that lie `gap` apart.

    Places less i times the gap must not decrease: that is an isotonic regression.

    Parameters
    ----------
    wanted : (n,), in any order
    gap : the least distance of two places
    """
    from scipy.optimize import isotonic_regression

    asked = np.asarray(wanted, dtype=float)
    order = np.argsort(asked, kind="stable")
    steps = gap * np.arange(len(order))
    places = np.empty(len(order))
    places[order] = isotonic_regression(asked[order] - steps).x + steps
    return places


def label_ends(ax: Any, ends: Sequence[End], size: float = 7.5, lead: float = 12.0) -> None:
    """Write names right of the ends of curves, joined to them by thin lines; sizes in points.

    Limits and scales of the axes must be final, and the figure laid out: labels keep their places in points.
    """
    transform, scale = ax.transData, ax.figure.dpi / POINTS
    tips = np.array([transform.transform((end.x, end.y)) for end in ends])
    heights = np.round(
        tips[:, 1], 2
    )  # of ends that are one but for rounding the first named is lowest
    places = spread(heights, 1.15 * size * scale)
    right = tips[:, 0].max() + lead * scale
    for end, tip, place in zip(ends, tips, places, strict=True):
        offset = ((right - tip[0]) / scale, (place - tip[1]) / scale)
        leader = {"arrowstyle": "-", "lw": LEADER, "ls": end.dash, "color": end.color}
        leader |= {"shrinkA": 1, "shrinkB": 1}
        ax.annotate(
            end.text,
            (end.x, end.y),
            offset,
            textcoords="offset points",
            color=end.color,
            fontsize=size,
            va="center",
            arrowprops=leader | {"relpos": (0.0, 0.5)},
            annotation_clip=False,
        )


SIDES = (
    *((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)),
    *((0.8, 0.9), (-0.8, 0.9), (0.8, -0.9), (-0.8, -0.9)),
)
"""Where a label may stand beside its point, the best first."""
ALIGNED = {-1.0: "right", 0.0: "center", 1.0: "left"}


def label_points(ax: Any, points: Sequence[End], size: float = 7.0, away: float = 7.0) -> None:
    """Write names beside points where they cover no other name and the fewest points; sizes in points.

    Limits and scales of the axes must be final, and the figure laid out.
    """
    scale = ax.figure.dpi / POINTS
    dots = [ax.transData.transform((point.x, point.y)) for point in points]
    taken: list[Any] = []
    for point in points:
        texts = [_beside(ax, point, side, size, away) for side in SIDES]
        boxes = [text.get_window_extent() for text in texts]
        covers = [
            100 * sum(box.overlaps(other) for other in taken)
            + 100 * (box.x0 < ax.bbox.x0 or box.x1 > ax.bbox.x1)
            + sum(bool(box.padded(scale).contains(*dot)) for dot in dots)
            for box in boxes
        ]
        best = int(np.argmin(covers))
        taken.append(boxes[best])
        for text in (*texts[:best], *texts[best + 1 :]):
            text.remove()


def _beside(ax: Any, point: End, side: tuple[float, float], size: float, away: float) -> Any:
    return ax.annotate(
        point.text,
        (point.x, point.y),
        (away * side[0], away * side[1]),
        textcoords="offset points",
        color=point.color,
        fontsize=size,
        ha=ALIGNED[float(np.sign(side[0]))],
        va="center" if side[1] == 0.0 else "bottom" if side[1] > 0.0 else "top",
        annotation_clip=False,
    )
