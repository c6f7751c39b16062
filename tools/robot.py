"""The picture of the README: angular speed through the waypoints of a robot that waits twice."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import quatspline as qs
from quatspline import quaternion
from quatspline.catalogue import called
from quatspline.curve import Curve
from quatspline.figures import direct, style
from quatspline.inputs.arrays import FloatArray
from quatspline.motion import Motion

SHOWN = ("slerp", "squad", "local-quintic", "monotone-quintic")
SAMPLES = 200
"""Of a segment."""
BELOW = 0.04
"""Of the axis, under its zero: who waits is not hidden by its frame."""
REST = 1e-9
"""Radians that a body at rest may turn by rounding."""


def robot(file: Path, picture: Path) -> None:
    """Draw the angular speed that schemes make of a file of keyframes, its waits shaded."""
    motion = qs.read_motion(file)
    curves = {name: qs.build(name, motion.times, motion.quaternions[:, 0]) for name in SHOWN}
    with style.applied():
        fig = Figure(figsize=(style.PAGE, 2.4))
        ax = fig.subplots()
        for wait in _waits(motion):
            _shaded(ax, *wait)
        ends = [_drawn(ax, name, curve) for name, curve in curves.items()]
        ax.set(xlabel="time (s)", ylabel="angular speed (°/s)")
        ax.set_xlim(0.0, motion.times[-1])
        ax.set_ylim(-BELOW * ax.get_ylim()[1], None)
        ax.grid(visible=False)
        fig.subplots_adjust(left=0.07, right=0.82, top=0.97, bottom=0.18)
        direct.label_ends(ax, ends)
        fig.savefig(picture, dpi=200, metadata={"Software": None})


def _waits(motion: Motion) -> Iterator[tuple[float, float]]:
    """Times between neighbours that are the same orientation."""
    q = motion.quaternions[:, 0]
    still = quaternion.distance(q[:-1], q[1:]) < REST
    return zip(motion.times[:-1][still], motion.times[1:][still], strict=True)


def _shaded(ax: Any, start: float, end: float) -> None:
    ax.axvspan(start, end, color="#ececec", lw=0)
    place = {"ha": "center", "va": "top", "transform": ax.get_xaxis_transform()}
    ax.text((start + end) / 2.0, 0.98, "waits", fontsize=7.5, color="#555555", **place)


def _drawn(ax: Any, name: str, curve: Curve) -> direct.End:
    """Draw a speed segment by segment, for slerp's leaps at keyframes; its end."""
    looks = style.scheme_style(name) | {"marker": ""}
    t, speed = _speed(curve)
    ax.plot(t, speed, **looks)
    return direct.End(t[-1], speed[-1], called(name), looks["color"], looks["linestyle"])


def _speed(curve: Curve) -> tuple[FloatArray, FloatArray]:
    t = curve.keyframes.inside(SAMPLES)
    return t, np.degrees(np.linalg.norm(curve(t, 1), axis=-1))
