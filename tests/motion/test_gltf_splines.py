"""CUBICSPLINE of a GLB: its curve is `gltf-cubic` with the file's own tangents, where no frame is left out."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from clips import gltf, put

import quatspline as qs
from quatspline import quaternion
from quatspline.motion.closing import returning
from quatspline.quaternion import FloatArray

TIMES = np.array([0.0, 0.5, 0.75, 2.0, 2.5])
OF = ("in_tangents", "out_tangents")


def glb(document: dict[str, Any]) -> bytes:
    """A GLB of its JSON chunk alone."""
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text), len(text), 0x4E4F534A) + text


def keys(closed: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Tangents that arrive, values, tangents that leave (5, 4), scalar last; one value has the other sign."""
    rng = np.random.default_rng(3)
    q = quaternion.normalise(np.array([0.0, 0.0, 0.0, 1.0]) + 0.4 * rng.normal(size=(5, 4)))
    if closed:
        q[-1] = -q[0]
    q[2] *= -1.0
    return rng.normal(size=(5, 4)), q, rng.normal(size=(5, 4))


def read(tmp_path: Path, closed: bool = False, nodes: int = 1) -> qs.Motion:
    rows = np.stack(keys(closed), axis=1).reshape(-1, 4)
    turn = {"path": "rotation", "mode": "CUBICSPLINE", "times": TIMES, "values": rows}
    samplers = [{**turn, "node": k} for k in range(nodes)]
    named = [{"name": f"node {k}"} for k in range(nodes)]
    return qs.read_motion(put(tmp_path / "a.glb", glb(gltf(samplers, named))))


def hermite(t: FloatArray, closed: bool = False) -> FloatArray:
    """The file's rule, after the format's specification, on keyframes of one hemisphere."""
    into, q, out = (np.roll(x.astype("<f4").astype(float), 1, axis=1) for x in keys(closed))
    signs = np.cumprod([1.0, *np.where(np.sum(q[1:] * q[:-1], axis=1) < 0.0, -1.0, 1.0)])[:, None]
    into, q, out = signs * into, signs * q, signs * out
    i = np.clip(np.searchsorted(TIMES, t, side="right") - 1, 0, 3)
    h = np.diff(TIMES)[i]
    u, h = ((t - TIMES[i]) / h)[:, None], h[:, None]
    x = (2 * u**3 - 3 * u**2 + 1) * q[i] + h * (u**3 - 2 * u**2 + u) * out[i]
    x += (3 * u**2 - 2 * u**3) * q[i + 1] + h * (u**3 - u**2) * into[i + 1]
    return quaternion.normalise(x)


def apart(a: FloatArray, b: FloatArray) -> float:
    return float(quaternion.distance(a, b).max())


X = np.linspace(0.0, 2.5, 101)


@pytest.mark.parametrize("nodes", [1, 3])
def test_the_files_own_curve(tmp_path: Path, nodes: int) -> None:
    motion = read(tmp_path, nodes=nodes)
    curve = motion.curve("gltf-cubic")
    for k in range(nodes):
        assert apart(curve(X)[0][:, k], hermite(X)) < 1e-6  # values are float32
    assert apart(motion.aligned().curve("gltf-cubic")(X)[0][:, 0], hermite(X)) < 1e-6
    assert apart(motion.resample(times=X, scheme="gltf-cubic").quaternions[:, 0], hermite(X)) < 1e-6


def test_a_cubic_of_sampled_frames_is_another(tmp_path: Path) -> None:
    """What others give, or frames left out or sampled anew, have no tangents of the file."""
    motion = read(tmp_path)
    plain = qs.build("gltf-cubic", TIMES, motion.quaternions[:, 0])
    assert apart(plain(X), hermite(X)) > 0.1
    given = {name: np.zeros((5, 1, 4)) for name in OF}
    still = qs.build("gltf-cubic", TIMES, motion.quaternions, **given)
    assert apart(motion.curve("gltf-cubic", **given)(X)[0], still(X)) < 1e-12
    half = qs.build("gltf-cubic", TIMES, motion.quaternions, in_tangents=given["in_tangents"])
    one = motion.curve("gltf-cubic", in_tangents=given["in_tangents"])
    assert apart(one(X)[0], half(X)) < 1e-12
    kept = [0, 2, 4]
    thinned = qs.build("gltf-cubic", TIMES[kept], motion.quaternions[kept])
    assert apart(motion.curve("gltf-cubic", every=2)(X)[0], thinned(X)) < 1e-12
    picked = motion.frames(np.array(kept))
    assert picked.in_tangents is picked.out_tangents is picked.interpolation is None
    assert apart(picked.curve("gltf-cubic")(X)[0], thinned(X)) < 1e-12
    anew = motion.resample(times=X, scheme="slerp")
    assert anew.in_tangents is None
    wanted = qs.build("gltf-cubic", X, anew.quaternions)
    y = X[:-1] + 0.01
    assert apart(anew.curve("gltf-cubic")(y)[0], wanted(y)) < 1e-12


def test_a_stretch_of_frames_keeps_its_tangents(tmp_path: Path) -> None:
    part = read(tmp_path).frames(slice(1, 4))
    assert part.interpolation == "CUBICSPLINE"
    t = np.linspace(0.5, 2.0, 51)
    assert apart(part.curve("gltf-cubic")(t - 0.5)[0][:, 0], hermite(t)) < 1e-6


def test_other_schemes_take_none(tmp_path: Path) -> None:
    motion = read(tmp_path)
    wanted = qs.build("slerp", TIMES, motion.quaternions)
    assert apart(motion.curve("slerp")(X)[0], wanted(X)) < 1e-12


def test_a_file_that_returns_is_closed_by_its_own_tangents(tmp_path: Path) -> None:
    motion = returning(read(tmp_path, closed=True))
    assert motion.closed
    curve = motion.curve("gltf-cubic", closed=True)
    assert apart(curve(X)[0][:, 0], hermite(X, closed=True)) < 1e-6


def test_a_step_more_has_no_tangents(tmp_path: Path) -> None:
    even = np.arange(5.0)
    rows = np.stack(keys(False), axis=1).reshape(-1, 4)
    turn = {"node": 0, "path": "rotation", "mode": "CUBICSPLINE", "times": even, "values": rows}
    file = put(tmp_path / "a.glb", glb(gltf([turn], [{"name": "body"}])))
    motion = returning(qs.read_motion(file))
    assert motion.closed
    assert motion.in_tangents is motion.interpolation is None
    wanted = qs.build("gltf-cubic", np.arange(6.0), motion.quaternions, closed=True)
    x = np.linspace(0.0, 4.9, 40)
    assert apart(motion.curve("gltf-cubic", closed=True)(x)[0], wanted(x)) < 1e-12
