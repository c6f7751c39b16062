"""What the pictures of derivations show: schemes, and keyframes on which they fail."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.inputs.arrays import FloatArray
from quatspline.trajectories.walks import walk

Set = Callable[[], tuple[FloatArray, FloatArray]]


def walked(seed: int, count: int, degrees: float, spacings: Sequence[float] = (1.0,)) -> Set:
    """Random axes; the spacings are taken in turn."""

    def made() -> tuple[FloatArray, FloatArray]:
        times = np.cumsum([0.0, *np.resize(spacings, count - 1)])
        return times, walk(np.random.default_rng(seed), count, degrees)[:, 0]

    return made


def _turned(*degrees: float) -> Set:
    """About one axis, to given angles, at equal times."""

    def made() -> tuple[FloatArray, FloatArray]:
        half = 0.5 * np.radians(degrees)[:, None] * [0.0, 0.0, 1.0]
        return np.arange(len(degrees), dtype=float), quaternion.align(quaternion.exp(half))

    return made


def _held() -> tuple[FloatArray, FloatArray]:
    """Two moves, a hold of five times their length, and two moves more."""
    q = walk(np.random.default_rng(4), 5, 90.0)[:, 0]
    return np.array([0.0, 1.0, 2.0, 7.0, 8.0, 9.0]), q[[0, 1, 2, 2, 3, 4]]


@dataclass(frozen=True)
class Shown:
    """What the picture of a page shows.

    scheme : whose blending functions are drawn, ``cumulative`` ones where the page is written in them, of as many
        keyframes as are ``around`` the segment
    keyframes, order, curves : the right panel: the angle from a keyframe, ``origin``, |omega| or |alpha| over time,
        of schemes, or of schemes with options by what they are called there
    component : of the vector, drawn in place of its length
    inner : segments at either end that are left out, on a panel about what happens between others
    """

    scheme: str
    keyframes: Set
    order: int
    curves: Mapping[str, Mapping[str, Any]] | Sequence[str]
    cumulative: bool = False
    around: int = 4
    options: Mapping[str, Any] = field(default_factory=dict)
    log: bool = False
    origin: int = 0
    inner: int = 0
    component: int | None = None


SHOWN: dict[str, Shown] = {
    "slerp": Shown("slerp", walked(1, 5, 150.0, (1.0, 1.5)), 1, ("slerp", "nlerp"), around=2),
    "bezier-and-barry-goldman": Shown(
        "catmull-rom", walked(2, 6, 60.0), 2, ("catmull-rom", "barry-goldman")
    ),
    "squad": Shown(
        "squad",
        walked(3, 6, 60.0, (1.0, 3.0)),
        1,
        {"squad": {}, "squad, textbook points": {"inner": "textbook"}},
    ),
    "hermite": Shown("hermite", walked(2, 6, 60.0), 2, ("hermite", "kim"), cumulative=True),
    "biarc": Shown("biarc", walked(2, 6, 60.0), 1, ("biarc", "catmull-rom")),
    "circular-blend": Shown(
        "circular-blend", _turned(0, 40, 80, 75, 35, 0), 0, ("circular-blend", "catmull-rom")
    ),
    "quartic": Shown(
        "quartic",
        _turned(*(8.0 * k * k / 2.0 for k in range(8))),
        2,
        ("quartic", "quintic"),
        cumulative=True,
        inner=1,
    ),
    "quintic": Shown(
        "quintic",
        _turned(*(8.0 * k * k / 2.0 for k in range(8))),
        2,
        {
            "quintic, κ = 1": {"curvature": 1.0},
            "quintic, κ = 0": {"curvature": 0.0},
            "quintic, κ = 3": {"curvature": 3.0},
        },
        cumulative=True,
        inner=1,
    ),
    "local-quintic": Shown(
        "local-quintic", _held, 0, ("local-quintic", "monotone-quintic"), around=6, origin=2
    ),
    "monotone-quintic": Shown(
        "monotone-quintic", walked(2, 6, 60.0), 2, ("monotone-quintic", "local-quintic"), around=6
    ),
    "kim": Shown(
        "kim", _turned(0, 0, 0, 90, 90, 90), 0, ("kim", "slerp"), cumulative=True, around=6
    ),
    "nielson": Shown(
        "nielson",
        walked(4, 6, 120.0, (3.0, 1.0, 1.0)),  # of seeds 0 to 9 that of the largest jump
        2,
        ("nielson", "local-quintic"),
        around=6,
        component=2,
    ),
    "spherical-average": Shown(
        "spherical-average", _held, 0, ("spherical-average", "slerp"), around=6, origin=2
    ),
    "moving-frame": Shown(
        "moving-frame", walked(2, 6, 150.0), 1, ("moving-frame", "local-quintic"), around=6
    ),
    "log-cubic": Shown(
        "log-cubic", _turned(*(50.0 * k for k in range(9))), 1, ("log-cubic", "slerp"), around=6
    ),
    "cubics-in-r4": Shown(
        "normalised-cubic",
        walked(2, 6, 160.0),
        1,
        ("normalised-cubic", "gltf-cubic", "local-quintic"),
        around=6,
    ),
    "park-ravani": Shown("park-ravani", walked(2, 9, 40.0), 1, ("park-ravani", "kim"), log=True),
    "min-torque": Shown(
        "min-torque", _held, 0, ("min-torque", "monotone-quintic"), around=6, origin=2
    ),
    "smoothing-spline": Shown(
        "smoothing-spline",
        _turned(0, 0, 0, 0, 90, 90, 90, 90),
        0,
        {"kim": {}, "smoothing-spline": {"smoothing": 1.0}},
        around=6,
        options={"smoothing": 1.0},
    ),
    "least-squares": Shown(
        "least-squares",
        _turned(0, 0, 0, 0, 90, 90, 90, 90),
        0,
        ("kim", "least-squares"),
        cumulative=True,
        around=6,
    ),
}
"""By the name of the page's file."""
