"""How schemes look, in figures and on the page: a colour by family, a dash and a marker of their own.

Where a family has more members than there are dashes, the next take its second tint.  No two schemes share
tint and dash, none tint and marker.  Schemes that no family names, which are plug-ins, have a colour and
markers that no family has.
"""

from __future__ import annotations

import zlib
from functools import cache
from typing import Any, NamedTuple

from quatspline.catalogue import found

RED, BLUE = "#c62828", "#1f5fbf"
"""The paper's colours of the quartic and of the B-spline."""

Dash = str | tuple[int, tuple[float, ...]]

DASHES: tuple[Dash, ...] = (
    *("-", "--", "-.", ":"),
    *((0, (9.0, 3.0)), (0, (9.0, 3.0, 1.5, 3.0)), (0, (5.0, 1.5, 1.0, 1.5, 1.0, 1.5))),
)
MARKERS = ("o", "s", "^", "D", "v", "<", ">", "p", "h", "P", "X", "*")
"""All can be hollow, the last three only where they are large."""
STRANGERS = ("P", "X", "*", "p", "h")
"""Of them, the markers of schemes that no family names."""
HOLLOW = ("p", "h")
"""Of those, the markers of third-party schemes."""


class Family(NamedTuple):
    """Schemes of one kind: tints, the first for the first members, and the members in order."""

    tints: tuple[str, ...]
    members: tuple[str, ...]


FAMILIES = (
    Family((RED,), ("quartic", "quintic")),
    Family(("#5d3a9b",), ("local-quintic", "monotone-quintic", "smoothing-spline")),
    Family((BLUE,), ("nielson", "kim", "spherical-average", "least-squares")),
    Family(("#96690a",), ("min-torque",)),
    Family(
        ("#6f6f6f", "#8c7853", "#5c7a8c", "#87627f"),
        (
            *("slerp", "nlerp", "fast-slerp", "incremental-slerp"),
            *("scipy-slerp", "pytransform3d-slerp", "rowan-slerp", "ahrs-slerp", "babylon-slerp"),
            *(
                "drake-slerp",
                "gl-matrix-slerp",
                "gtsam-slerp",
                "pinocchio-interpolate",
                "pyglm-mix",
            ),
            *("pyglm-slerp", "pyquaternion-slerp", "spatialmath-qslerp", "spiceypy-ck3"),
            *("three-slerp", "transformations-slerp", "transforms3d-slerp", "usd-orient"),
            "vtk-linear",
        ),
    ),
    Family(
        ("#cc5500", "#a8452c"),
        (
            *("squad", "splines-squad", "quaternionic-squad", "numpy-quaternion-squad"),
            *("interpolatepy-squad-c2", "quat-numpy-squad", "gl-matrix-sqlerp"),
            *("interpolatepy-quaternion-spline", "vtk-spline"),
        ),
    ),
    Family(
        ("#b0458c",),
        (
            *("catmull-rom", "kochanek-bartels", "barry-goldman", "shoemake-bezier"),
            *("splines-catmull-rom", "splines-kochanek-bartels", "splines-barry-goldman"),
        ),
    ),
    Family(
        ("#00805a",),
        (
            *("log-cubic", "moving-frame", "park-ravani"),
            *("scipy-rotation-spline", "interpolatepy-log"),
        ),
    ),
    Family(("#007a8a",), ("hermite", "gltf-cubic", "normalised-cubic", "babylon-hermite")),
    Family(("#3d8fc0",), ("circular-blend", "biarc")),
)
"""Families, the first member of each being the one that most figures show."""

OTHER = "#7a4a2b"
"""The colour of schemes that no family names."""


@cache
def _curated() -> dict[str, dict[str, Any]]:
    looks = {}
    for tints, members in FAMILIES:
        for place, name in enumerate(members):
            tint, k = divmod(place, len(DASHES))
            looks[name] = {"color": tints[tint], "marker": MARKERS[k], "linestyle": DASHES[k]}
    return looks


def scheme_style(name: str) -> dict[str, Any]:
    """Colour, marker and line style of a scheme: the same in every figure.

    Those of a plug-in depend on the others that are found.  Markers of third-party schemes are hollow.
    """
    look = _curated().get(name) or _of_no_family(name)
    return look | ({"markerfacecolor": "white"} if third_party(name) else {})


def _of_no_family(name: str) -> dict[str, Any]:
    """By the scheme's place among those of no family that are equally hollow; by lot, if it is not found."""
    hollow = third_party(name)
    others = [n for n in found() if n not in _curated() and third_party(n) == hollow]
    place = others.index(name) if name in others else zlib.crc32(name.encode())
    markers = HOLLOW if hollow else STRANGERS
    dash = DASHES[place % len(DASHES)]
    return {"color": OTHER, "marker": markers[place % len(markers)], "linestyle": dash}


def third_party(name: str) -> bool:
    """Whether a scheme runs somebody else's library: also where that is not installed."""
    item = found().get(name)
    return item is not None and (item.scheme is None or item.scheme.peer is not None)
