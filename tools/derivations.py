"""The picture of each page that derives schemes: their blending functions, and keyframes on which they fail.

What a page shows is a row of `SHOWN`; the rest is the same for all.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import quatspline as qs
from quatspline import quaternion
from quatspline.catalogue import called
from quatspline.curve import Curve
from quatspline.figures import direct, style
from quatspline.figures.looks import DASHES
from quatspline.inputs.arrays import FloatArray
from quatspline.instruments.blending import blending
from quatspline.trajectories.walks import walk

PREFIX = "derivation-"
"""Of the picture's name, before that of the page."""
SAMPLES = 120
"""Of a segment."""
NAMED = {
    0: "angle from a keyframe (°)",
    1: "angular speed (° per unit of time)",
    2: "acceleration (° per unit$^2$)",
}
Set = Callable[[], tuple[FloatArray, FloatArray]]


def _walk(seed: int, count: int, degrees: float, spacings: Sequence[float] = (1.0,)) -> Set:
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
    "slerp": Shown("slerp", _walk(1, 5, 150.0, (1.0, 1.5)), 1, ("slerp", "nlerp"), around=2),
    "bezier-and-barry-goldman": Shown(
        "catmull-rom", _walk(2, 6, 60.0), 2, ("catmull-rom", "barry-goldman")
    ),
    "squad": Shown(
        "squad",
        _walk(3, 6, 60.0, (1.0, 3.0)),
        1,
        {"squad": {}, "squad, textbook points": {"inner": "textbook"}},
    ),
    "hermite": Shown("hermite", _walk(2, 6, 60.0), 2, ("hermite", "kim"), cumulative=True),
    "biarc": Shown("biarc", _walk(2, 6, 60.0), 1, ("biarc", "catmull-rom")),
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
        "monotone-quintic", _walk(2, 6, 60.0), 2, ("monotone-quintic", "local-quintic"), around=6
    ),
    "kim": Shown(
        "kim", _turned(0, 0, 0, 90, 90, 90), 0, ("kim", "slerp"), cumulative=True, around=6
    ),
    "nielson": Shown(
        "nielson",
        _walk(2, 6, 120.0, (3.0, 1.0, 1.0)),
        2,
        ("nielson", "local-quintic"),
        around=6,
        component=0,
    ),
    "spherical-average": Shown(
        "spherical-average", _held, 0, ("spherical-average", "slerp"), around=6, origin=2
    ),
    "moving-frame": Shown(
        "moving-frame", _walk(2, 6, 150.0), 1, ("moving-frame", "local-quintic"), around=6
    ),
    "log-cubic": Shown(
        "log-cubic", _turned(*(50.0 * k for k in range(9))), 1, ("log-cubic", "slerp"), around=6
    ),
    "cubics-in-r4": Shown(
        "normalised-cubic",
        _walk(2, 6, 160.0),
        1,
        ("normalised-cubic", "gltf-cubic", "local-quintic"),
        around=6,
    ),
    "park-ravani": Shown("park-ravani", _walk(2, 9, 40.0), 1, ("park-ravani", "kim"), log=True),
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


def drawn(shown: Shown) -> Figure:
    """The picture of a page: blending functions left, what goes wrong right."""
    fig = Figure(figsize=(style.PAGE, 2.3))
    left, right = fig.subplots(1, 2)
    fig.subplots_adjust(left=0.07, right=0.81, top=0.9, bottom=0.19, wspace=0.42)
    _blends(left, shown)
    _failure(right, shown)
    style.letters((left, right))
    return fig


def draw(folder: Path) -> None:
    """Draw the pictures of all pages into a folder."""
    with style.applied():
        for page, shown in SHOWN.items():
            picture = folder / f"{PREFIX}{page}.png"
            drawn(shown).savefig(picture, dpi=160, metadata={"Software": None})


def _blends(ax: Any, shown: Shown) -> None:
    u = np.linspace(0.0, 1.0, 201)
    scheme = qs.scheme(shown.scheme)
    table = blending(
        scheme, u, cumulative=shown.cumulative, around=shown.around, **shown.options
    ).drop(columns="u")
    # Keyframes q, of which the segment's start is q_i; cumulative functions are of steps, L_i from q_i to the next.
    symbol = "L" if shown.cumulative else "q"
    first = 1 - shown.around // 2 - shown.cumulative
    ends = []
    for k, name in enumerate(table):
        color, place = style.PALETTE[k], first + k
        ax.plot(u, table[name], color=color, ls=DASHES[k % len(DASHES)])
        index = f"i{place:+d}" if place else "i"
        ends.append(direct.End(1.0, table[name].iloc[-1], f"${symbol}_{{{index}}}$", color))
    of = "step" if shown.cumulative else "keyframe"
    ax.set(xlabel="$u$", ylabel=f"weight of a {of}", xlim=(0.0, 1.0))
    direct.label_ends(ax, ends)


def _failure(ax: Any, shown: Shown) -> None:
    times, q = shown.keyframes()
    curves = shown.curves
    if not isinstance(curves, Mapping):
        curves = {called(name): {"name": name} for name in curves}
    ends = [
        _line(ax, text, shown, k, times, q, dict(given))
        for k, (text, given) in enumerate(curves.items())
    ]
    for time in times:
        ax.axvline(time, color="#d9d9d9", lw=0.5, zorder=0)
    ax.set(
        xlabel="time", ylabel=NAMED[shown.order], xlim=(times[shown.inner], times[-1 - shown.inner])
    )
    ax.grid(visible=False)
    if shown.log:
        ax.set_yscale("log")
    elif shown.component is None:
        ax.set_ylim(0.0, None)
    direct.label_ends(ax, ends)


def _line(
    ax: Any,
    text: str,
    shown: Shown,
    k: int,
    times: FloatArray,
    q: FloatArray,
    given: dict[str, Any],
) -> direct.End:
    """Draw a quantity segment by segment, since it may leap at keyframes; where it ends."""
    name = given.pop("name", text.split(",")[0])
    looks = style.scheme_style(name) | {"marker": ""}
    if "," in text:  # the same scheme with other options
        looks |= {"color": style.PALETTE[k], "linestyle": DASHES[k]}
    curve = qs.build(name, times, q, **given)
    end = 0.0
    inside = times[shown.inner : len(times) - shown.inner]
    for a, b in pairwise(inside):
        t, values = _piece(curve, a, b, shown)
        ax.plot(t, values, **looks)
        end = values[-1]
    return direct.End(inside[-1], end, text, looks["color"])


def _piece(curve: Curve, a: float, b: float, shown: Shown) -> tuple[FloatArray, FloatArray]:
    """A segment's samples, ends not included where the quantity may leap."""
    inset = 1e-6 * (b - a)
    t = np.linspace(a + inset, b - inset, SAMPLES)
    if shown.order == 0:
        origin = curve.keyframes.quaternions[shown.origin]
        return t, np.degrees(quaternion.distance(curve(t), origin))
    rates = np.degrees(curve(t, shown.order))
    return t, np.linalg.norm(rates, axis=-1) if shown.component is None else rates[
        :, shown.component
    ]
