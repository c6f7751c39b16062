"""The picture of each page that derives schemes: their blending functions, and keyframes on which they fail.

What a page shows is a row of `shown.SHOWN`; the rest is the same for all.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
from tools.shown import SHOWN, Shown

PREFIX = "derivation-"
"""Of the picture's name, before that of the page."""
SAMPLES = 120
"""Of a segment."""
BELOW = 0.04
"""Of an axis, under its zero: what is still there is not hidden by its frame."""
LEAD = 16.0
"""Points of the lines to names: enough to tell dashes."""
NAMED = {
    0: "angle from a keyframe (°)",
    1: "angular speed (° per unit of time)",
    2: "acceleration (° per unit$^2$)",
}


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
    for place, name in enumerate(table, first):
        k = 2 * place - 1 if place > 0 else -2 * place  # looks go by the place, on every page
        color, dash = style.PALETTE[k], DASHES[k]
        ax.plot(u, table[name], color=color, ls=dash)
        index = f"i{place:+d}" if place else "i"
        text = f"${symbol}_{{{index}}}$"
        ends.append(direct.End(1.0, table[name].iloc[-1], text, color, dash))
    of = "step" if shown.cumulative else "keyframe"
    ax.set(xlabel="$u$", ylabel=f"weight of a {of}", xlim=(0.0, 1.0))
    direct.label_ends(ax, ends)


def _failure(ax: Any, shown: Shown) -> None:
    times, q = shown.keyframes()
    curves = shown.curves
    if not isinstance(curves, Mapping):
        curves = {name: {} for name in curves}
    ends = [
        _line(ax, text, shown, looks, qs.build(text.split(",")[0], times, q, **given))
        for looks, (text, given) in zip(_looks(list(curves)), curves.items(), strict=True)
    ]
    for time in times:
        ax.axvline(time, color="#d9d9d9", lw=0.5, zorder=0)
    ax.set(
        xlabel="time (lines at keyframes)",
        ylabel=_quantity(shown),
        xlim=(times[shown.inner], times[-1 - shown.inner]),
    )
    ax.grid(visible=False)
    if shown.log:
        ax.set_yscale("log")
    elif shown.component is None:
        ax.set_ylim(-BELOW * ax.get_ylim()[1], None)
    direct.label_ends(ax, ends, lead=LEAD)


def _quantity(shown: Shown) -> str:
    name, unit = NAMED[shown.order].split(" (")
    which = "" if shown.component is None else f", ${'xyz'[shown.component]}$"
    return f"{name}{which} ({unit}"


def _looks(texts: Sequence[str]) -> list[dict[str, Any]]:
    """How curves look: as their schemes do, but for a dash that one before them has, since colours may not print."""
    found: list[dict[str, Any]] = []
    for k, text in enumerate(texts):
        name, *way = text.split(",")
        looks = style.scheme_style(name) | {"marker": ""}
        if way:  # the same scheme with other options
            looks |= {"color": style.PALETTE[k], "linestyle": DASHES[k]}
        taken = [other["linestyle"] for other in found]
        if looks["linestyle"] in taken:
            looks["linestyle"] = next(dash for dash in DASHES if dash not in taken)
        found.append(looks)
    return found


def _line(ax: Any, text: str, shown: Shown, looks: dict[str, Any], curve: Curve) -> direct.End:
    """Draw a quantity segment by segment, since it may leap at keyframes; where it ends."""
    end = 0.0
    times = curve.keyframes.times
    inside = times[shown.inner : len(times) - shown.inner]
    for a, b in pairwise(inside):
        t, values = _piece(curve, a, b, shown)
        ax.plot(t, values, **looks)
        end = values[-1]
    name, *way = text.split(",")
    told = ",".join([called(name), *way])
    return direct.End(inside[-1], end, told, looks["color"], looks["linestyle"])


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
