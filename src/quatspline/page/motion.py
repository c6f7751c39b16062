"""Motions for the player: curves of several schemes through the same keyframes, sampled.  That is drawing."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from quatspline.catalogue import found, plug_ins
from quatspline.curve import Curve
from quatspline.figures.meshes import Mesh, key_mesh, teapot_mesh
from quatspline.figures.motions import VIEWS
from quatspline.instruments.trials import reason
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.system.packing import packed
from quatspline.trajectories.paper import CASES

SAMPLES, LEAST, MOST = 2400, 2, 60
"""Samples of a motion in all, and the least and the most between two keyframes."""

BEFORE = 1e-7
"""A sample this share of a segment before each inner keyframe shows the limit from the left there."""

KEY_FACETS, TEAPOT_CELLS = 8, 5
"""Detail of the bodies, coarser than in the figures: a canvas fills some 50,000 faces a second."""

PAIR = ("quartic", "nielson")
"""What the paper compares."""

OWN_SCALE = 0.25
"""The body's length as a share of the extent of positions that a user gives."""


@dataclass(frozen=True)
class Scene:
    """A motion that the player shows.

    Attributes
    ----------
    name, title : the key, and what a reader calls it
    keyframes : a single track
    body : the mesh that moves
    positions : t (m,) to positions (m, 3), in scene units
    view : elevation and azimuth of the camera, degrees
    scale : scene units to one mesh unit
    pair : the schemes shown at first, left and right; for what is missing see `opening`
    schemes : the names offered; None means all of this package's own that apply
    """

    name: str
    title: str
    keyframes: Keyframes
    body: Mesh
    positions: Callable[[FloatArray], FloatArray]
    view: tuple[float, float] = (22.0, -62.0)
    scale: float = 1.0
    pair: Sequence[str] = ()
    schemes: Sequence[str] | None = None


def paper_scenes() -> list[Scene]:
    """The paper's key and teapot."""
    bodies = {"key": key_mesh(KEY_FACETS), "teapot": teapot_mesh(TEAPOT_CELLS)}
    scenes = []
    for name, case in CASES.items():
        view = VIEWS[name]
        camera = (view["elev"], view["azim"])
        keyframes, body = case.keyframes(), bodies[name]
        scene = Scene(name, case.title, keyframes, body, case.positions, camera, view["scale"])
        scenes.append(scene)
    return scenes


def own_scene(
    name: str,
    title: str,
    keyframes: Keyframes,
    positions: FloatArray | None = None,
    schemes: Sequence[str] | None = None,
    first: Sequence[str] = (),
) -> Scene:
    """A motion of one's own: a key that turns, along positions (one a time, joined by lines) if there are any.

    Schemes ``first`` are shown at first.
    """
    places = np.zeros((len(keyframes.times), 3)) if positions is None else positions
    extent = float(np.ptp(places, axis=0).max())

    def along(t: FloatArray) -> FloatArray:
        return np.stack([np.interp(t, keyframes.times, axis) for axis in places.T], axis=1)

    scale = OWN_SCALE * extent if extent > 0.0 else 1.0
    body = key_mesh(KEY_FACETS)
    return Scene(name, title, keyframes, body, along, scale=scale, pair=first, schemes=schemes)


def player_data(scene: Scene, measured: Collection[str] = ()) -> dict[str, Any]:
    """What the player needs of a scene, as JSON; arrays are base64 of little-endian 32-bit numbers.

    Times count from the first keyframe.  Samples hold every keyframe time, and the limit from the
    left before it.  Schemes that do not apply are listed with the reason.  The player opens on schemes
    that were measured, if it is said which.
    """
    keyframes = scene.keyframes
    t = grid(keyframes)
    curves, refused = _curves(scene)
    times = keyframes.times[0] + t
    returns = keyframes.quaternions[:1] * keyframes.sign
    poses = [keyframes.quaternions, returns] if keyframes.closed else [keyframes.quaternions]
    return {
        "name": scene.name,
        "title": scene.title,
        "start": float(keyframes.times[0]),
        "closed": keyframes.closed,
        "knots": keyframes.knots.tolist(),
        "keyframes": np.concatenate(poses).tolist(),
        "view": scene.view,
        "scale": scene.scale,
        "body": _body(scene.body),
        "t": packed(t),
        "positions": packed(scene.positions(times)),
        "curves": curves,
        "refused": refused,
        "pair": opening(scene.pair, list(curves), measured),
    }


def opening(pair: Sequence[str], there: Sequence[str], measured: Collection[str]) -> list[str]:
    """The two schemes shown at first, of those there.

    Those asked for come first; then of those that were measured a plug-in, which its author looks for, and what
    the paper compares; then any that was measured, and any at all.
    """
    of_run = [name for name in there if name in measured] if measured else there
    added = [name for name in of_run if name in plug_ins()]
    known = [name for name in PAIR if name in of_run]
    wanted = [name for name in pair if name in there]
    return list(dict.fromkeys([*wanted, *added, *known, *of_run, *there]))[:2]


def grid(keyframes: Keyframes) -> FloatArray:
    """Sample times (m,) since the first keyframe."""
    knots = keyframes.knots
    each = int(np.clip(SAMPLES // len(knots), LEAST, MOST))
    inner = keyframes.inside(np.arange(each) / each)
    left = knots[1:] - BEFORE * keyframes.spacings
    return np.sort(np.concatenate([inner, left, knots[-1:]]))


def _curves(scene: Scene) -> tuple[dict[str, Any], dict[str, str]]:
    """Samples of every scheme offered, and why others have none."""
    items = found()
    offered = scene.schemes
    if offered is None:
        offered = [name for name, item in items.items() if item.scheme and not item.scheme.peer]
    times = scene.keyframes.times[0] + grid(scene.keyframes)
    curves: dict[str, Any] = {}
    refused: dict[str, str] = {}
    for name in offered:
        try:
            cls = items[name].scheme
            if cls is None:
                raise ValueError(items[name].problem)
            curves[name] = _samples(cls.from_keyframes(scene.keyframes), times)
        except Exception as error:  # one that does not apply here; the others are shown
            refused[name] = reason(error)
    return curves, refused


def _samples(curve: Curve, times: FloatArray) -> dict[str, str]:
    """Orientations, rates and the log-curve of a scheme; rates that it lacks are NaN."""
    rates = {k: np.full((len(times), 3), np.nan) for k in (1, 2)}
    rates |= {k: curve(times, k) for k in (1, 2) if k in curve.orders}
    q, log = packed(curve(times)), packed(curve.log(times))
    rates_packed = {"omega": packed(rates[1]), "alpha": packed(rates[2])}
    return {"title": curve.title, "q": q, "log": log, **rates_packed}


def _body(mesh: Mesh) -> dict[str, str]:
    return {
        "vertices": packed(mesh.vertices),
        "cells": packed(mesh.cells, "<u2"),
        "normals": packed(mesh.normals()),
        "tint": packed(mesh.tint),
        "lift": packed(mesh.lift),
    }
