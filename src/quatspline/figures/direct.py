"""Direct labels: names beside the ends of curves, in their order so that no leader crosses, and beside points."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
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


SIZE, LEAD = 7.5, 12.0
"""Points: of names at ends, and of the lines that lead to them."""


def hold_room(ax: Any, ends: Iterable[End], size: float = SIZE, lead: float = LEAD) -> list[Any]:
    """Texts right of the axes for a layout to reckon with, at least as wide as `label_ends` will reach."""
    place = {"xycoords": "axes fraction", "textcoords": "offset points", "fontsize": size}
    return [ax.annotate(end.text, (1.0, 0.5), (lead, 0.0), va="center", **place) for end in ends]


def label_ends(ax: Any, ends: Sequence[End], size: float = SIZE, lead: float = LEAD) -> None:
    """Write names right of the ends of curves, joined to them by thin lines; sizes in points.

    Limits and scales of the axes must be final, and the figure laid out: labels keep their places in points.
    """
    if not ends:
        return
    transform, scale = ax.transData, ax.figure.dpi / POINTS
    tips = np.array([transform.transform((end.x, end.y)) for end in ends])
    heights = np.round(tips[:, 1], 2)  # where ends differ by rounding alone the first is lowest
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
REACHES = (1.0, 1.6)
"""How far from it, where there is no room nearer."""
MARK = 0.8
"""Radius of what is drawn at a point, rings included, over the distance of a name."""
ALIGNED = {-1.0: "right", 0.0: "center", 1.0: "left"}


def label_points(
    ax: Any,
    points: Sequence[End],
    marks: Sequence[tuple[float, float]] = (),
    size: float = 7.0,
    away: float = 7.0,
) -> None:
    """Write names beside points, inside the axes, where they cover no other name and the fewest marks.

    Limits and scales of the axes must be final, and the figure laid out.  Sizes are in points.

    Parameters
    ----------
    points : what is named
    marks : of points without a name, which are not to be covered either; in data
    away : from a point to its name, at least; `MARK` of it is clear of names around every point
    """
    scale = ax.figure.dpi / POINTS
    at = [*((point.x, point.y) for point in points), *marks]
    dots = ax.transData.transform(np.reshape(at, (-1, 2)))
    sides = [(reach * x, reach * y) for reach in REACHES for x, y in SIDES]
    places = []
    for k, point in enumerate(points):
        others = np.delete(dots, k, axis=0)
        tried = []
        for side in sides:
            text = _beside(ax, point, side, size, away)
            cost = _outside(text, ax.bbox.padded(-2.0 * scale))
            tried.append(
                (text, cost + _near(text.get_window_extent(), others, MARK * away * scale))
            )
        places.append(tried)
    _chosen(places)


FORBIDDEN = 100
"""Marks that a name may rather cover than another name or the frame."""


def _chosen(places: Sequence[Sequence[tuple[Any, int]]]) -> None:
    """Keep of each name one text, the first of the cheapest; names with the fewest free places choose first."""
    taken: list[Any] = []
    for tried in sorted(places, key=lambda tried: sum(cost == 0 for _, cost in tried)):
        boxes = [text.get_window_extent() for text, _ in tried]
        costs = [
            cost + FORBIDDEN * sum(box.overlaps(other) for other in taken)
            for box, (_, cost) in zip(boxes, tried, strict=True)
        ]
        best = int(np.argmin(costs))
        taken.append(boxes[best])
        _keep([text for text, _ in tried], best)


def _keep(texts: Sequence[Any], best: int) -> None:
    for text in (*texts[:best], *texts[best + 1 :]):
        text.remove()


def _outside(text: Any, frame: Any) -> int:
    box = text.get_window_extent()
    inside = frame.x0 <= box.x0 and box.x1 <= frame.x1 and frame.y0 <= box.y0 and box.y1 <= frame.y1
    return 0 if inside else FORBIDDEN


def _near(box: Any, dots: FloatArray, radius: float) -> int:
    """How many dots (k, 2) lie in a box or nearer to it than a radius, in pixels."""
    low, high = np.array(box.min), np.array(box.max)
    return int((np.linalg.norm(dots - dots.clip(low, high), axis=1) < radius).sum())


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


STRIDE = 5
"""Of the points of a curve beside which its name is tried."""


def label_curves(ax: Any, size: float = 8.5, away: float = 3.0) -> None:
    """Write the labels of an axes' curves beside them, inside, over no curve and as far from the others as that goes.

    Limits and scales must be final, and the figure laid out; sizes are in points.
    """
    curves = ax.get_lines()
    paths = [ax.transData.transform(curve.get_xydata()) for curve in curves]
    for k, curve in enumerate(curves):
        rest = np.concatenate([*paths[:k], *paths[k + 1 :], np.empty((0, 2))])
        data, look = curve.get_xydata(), (curve.get_label(), curve.get_color())
        texts = [
            _beside(ax, End(x, y, *look), side, size, away)
            for x, y in data[2 * STRIDE : -2 * STRIDE : STRIDE]
            for side in SIDES
        ]
        _keep(texts, _clearest(texts, rest, np.concatenate(paths)))


def _clearest(texts: Sequence[Any], rest: FloatArray, dots: FloatArray) -> int:
    """The text in the frame over the fewest dots (k, 2) of curves, then the farthest from the rest of them."""

    def cost(at: int) -> tuple[int, float]:
        box, frame = texts[at].get_window_extent(), texts[at].axes.bbox
        gaps = np.linalg.norm(rest - np.mean([box.min, box.max], axis=0), axis=1)
        return _outside(texts[at], frame) + _near(box, dots, 1.0), -float(gaps.min(initial=np.inf))

    return min(range(len(texts)), key=cost)
