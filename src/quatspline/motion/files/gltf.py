"""glTF 2.0 and GLB: what an animation does to the rotations and translations of nodes.

Quaternions are stored scalar last.  LINEAR is slerp, the short way; STEP holds; CUBICSPLINE is the Hermite
cubic of four numbers, normalised, its tangents times the step [glTF 2.0, Appendix C].
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.keyframes import segment_of
from quatspline.motion.errors import warn
from quatspline.motion.files.buffers import Document
from quatspline.motion.files.nodes import Nodes
from quatspline.motion.files.reading import Reading
from quatspline.motion.motion import Motion
from quatspline.options import nearest
from quatspline.quaternion import FloatArray

WIDTHS = {"rotation": "VEC4", "translation": "VEC3"}
MODES = ("LINEAR", "STEP", "CUBICSPLINE")


@dataclass(frozen=True)
class Sampler:
    """Keyframes of one property of one node; tangents (n, width) or None."""

    times: FloatArray
    values: FloatArray
    mode: str
    tangents: tuple[FloatArray, FloatArray] | None
    turns: bool

    def at(self, t: FloatArray) -> FloatArray:
        """Values (m, width) at times (m,), the ends' beyond them."""
        if np.array_equal(t, self.times):
            return self.values
        if len(self.times) == 1:
            return np.repeat(self.values, len(t), axis=0)
        t = np.clip(t, self.times[0], self.times[-1])
        k = segment_of(self.times, t)
        if self.mode == "STEP":
            return self.values[np.searchsorted(self.times, t, side="right") - 1]
        step = (self.times[k + 1] - self.times[k])[:, np.newaxis]
        u = (t - self.times[k])[:, np.newaxis] / step
        return self._cubic(k, u, step) if self.tangents else self._linear(k, u)

    def _linear(self, k: Any, u: FloatArray) -> FloatArray:
        a, b = self.values[k], self.values[k + 1]
        if not self.turns:
            return (1.0 - u) * a + u * b
        dots = np.einsum("ni,ni->n", a, b)[:, np.newaxis]
        return quaternion.slerp(a, np.where(dots < 0.0, -b, b), u[:, 0])

    def _cubic(self, k: Any, u: FloatArray, step: FloatArray) -> FloatArray:
        assert self.tangents is not None
        into, out = self.tangents
        value = (
            (2 * u**3 - 3 * u**2 + 1) * self.values[k]
            + step * (u**3 - 2 * u**2 + u) * out[k]
            + (3 * u**2 - 2 * u**3) * self.values[k + 1]
            + step * (u**3 - u**2) * into[k + 1]
        )
        return quaternion.normalise(value) if self.turns else value


def read_gltf(path: Path, reading: Reading) -> Motion:
    """Read an animation's rotations and translations: one track for each node that it moves."""
    document = Document(path)
    _check_version(document)
    animation = _chosen(document, reading.animation)
    samplers = _samplers(document, animation)
    nodes = Nodes(document)
    joints = sorted({node for node, _ in samplers})
    times = _common_times(path, list(samplers.values()))
    q, x = np.empty((len(times), len(joints), 4)), np.empty((len(times), len(joints), 3))
    for track, node in enumerate(joints):
        q[:, track], x[:, track] = nodes.turns[node], nodes.places[node]
        for kind, values in (("rotation", q), ("translation", x)):
            if (node, kind) in samplers:
                values[:, track] = samplers[node, kind].at(times)
    skeleton, scales = nodes.skeleton(joints)
    turning = [samplers.get((node, "rotation")) for node in joints]
    return Motion(
        times,
        q,
        x * scales[:, np.newaxis],
        nodes.names(path, joints),
        skeleton,
        "m",
        **_tangents(turning, times),
    )


def _check_version(document: Document) -> None:
    asset = document.json.get("asset")
    version = asset.get("version") if isinstance(asset, dict) else None
    if not isinstance(version, str) or version.partition(".")[0] != "2":
        document.refuse(f"asset.version is {str(version)[:20]}: glTF 2 is read")
    required = document.json.get("extensionsRequired")
    if required:
        document.refuse(f"it requires extensions, which are not read: {str(required)[:60]}")


def _chosen(document: Document, wanted: str | int | None) -> dict[str, Any]:
    """The animation by name or index, or the only one."""
    animations = document.items("animations")
    names = [str(item.get("name", i)) for i, item in enumerate(animations)]
    told = ", ".join(map(repr, names))
    if not animations:
        document.refuse("no animation in it")
    if wanted is None and len(animations) > 1:
        document.refuse(f"{len(animations)} animations, {told}: name one with animation=")
    if isinstance(wanted, str) and wanted not in names:
        document.refuse(f"no animation {wanted!r}: {nearest(wanted, names)}")
    if isinstance(wanted, str) and names.count(wanted) > 1:
        document.refuse(f"more than one animation is called {wanted!r}: give its index")
    index = names.index(wanted) if isinstance(wanted, str) else wanted or 0
    return document.item("animations", index)


def _samplers(document: Document, animation: dict[str, Any]) -> dict[tuple[int, str], Sampler]:
    """Samplers by node and property; others are told of."""
    found: dict[tuple[int, str], Sampler] = {}
    others: set[str] = set()
    for channel in document.items("channels", animation):
        target = channel.get("target")
        if not isinstance(target, dict):
            document.refuse("a channel of the animation has no target")
        kind = str(target.get("path"))[:40]
        if kind not in WIDTHS or "node" not in target:
            others.add(kind)
            continue
        node = document.whole(target, "node")
        document.item("nodes", node)
        if (node, kind) in found:
            document.refuse(f"two channels move the {kind} of nodes[{node}]")
        sampler = document.item("samplers", channel.get("sampler"), animation)
        found[node, kind] = _sampler(document, sampler, kind)
    if not found:
        document.refuse("its animation moves no node's rotation or translation")
    if others:
        warn(document.path, f"not carried: channels of {', '.join(sorted(others))}")
    return found


def _sampler(document: Document, sampler: dict[str, Any], kind: str) -> Sampler:
    mode = sampler.get("interpolation", "LINEAR")
    if mode not in MODES:
        document.refuse(f"interpolation {str(mode)[:20]!r}: {', '.join(MODES)} are read")
    times = document.accessor(sampler.get("input"), "SCALAR", "an animation's input")[:, 0]
    values = document.accessor(sampler.get("output"), WIDTHS[kind], f"an animation's {kind}")
    rows = 3 if mode == "CUBICSPLINE" else 1
    if not len(times) or len(values) != rows * len(times):
        document.refuse(f"{len(times)} times and {len(values)} values of a {kind} ({mode})")
    _check_numbers(document, times, values)
    if rows == 1:
        return Sampler(times, _unit(document, values, kind), mode, None, kind == "rotation")
    into, values, out = (_first(values[i::3], kind) for i in range(3))
    values = _unit(document, values, kind, first=False)
    return Sampler(times, values, mode, (into, out), kind == "rotation")


def _check_numbers(document: Document, times: FloatArray, values: FloatArray) -> None:
    if not np.isfinite(times).all() or not np.isfinite(values).all():
        document.refuse("an animation has values that are not finite numbers")
    stuck = np.flatnonzero(np.diff(times) <= 0.0)
    if stuck.size:
        i = int(stuck[0]) + 1
        document.refuse(f"an animation's time {i}, {times[i]:g}, does not exceed the one before it")


def _unit(document: Document, values: FloatArray, kind: str, first: bool = True) -> FloatArray:
    """Values of a kind; quaternions scalar first, of length 1 but for the rounding of float32."""
    values = _first(values, kind) if first else values
    if kind != "rotation":
        return values
    norms = np.linalg.norm(values, axis=1)
    if (np.abs(norms - 1.0) > ROUNDED).any():
        i = int(np.argmax(np.abs(norms - 1.0) > ROUNDED))
        document.refuse(f"rotation {i} of an animation has norm {norms[i]:.6g}, not 1")
    return quaternion.normalise(values)


ROUNDED = 2e-2
"""Quaternions of normalised bytes are off the unit sphere by up to this."""


def _first(values: FloatArray, kind: str) -> FloatArray:
    """Quaternions scalar first."""
    return np.roll(values, 1, axis=1) if kind == "rotation" else values


def _common_times(path: Path, samplers: list[Sampler]) -> FloatArray:
    """The union of all times; a warning where they differ."""
    first = samplers[0].times
    if all(np.array_equal(sampler.times, first) for sampler in samplers):
        return first
    times = np.unique(np.concatenate([sampler.times for sampler in samplers]))
    warn(
        path,
        f"its nodes have times of their own: all are brought to {len(times)} by its own interpolation",
    )
    return times


def _tangents(samplers: list[Sampler | None], times: FloatArray) -> dict[str, Any]:
    """What the file does between keyframes, where all rotations have one rule and these times."""
    kept = [sampler for sampler in samplers if sampler is not None]
    modes = {sampler.mode for sampler in kept}
    if len(modes) != 1 or not all(np.array_equal(sampler.times, times) for sampler in kept):
        return {}
    if modes != {"CUBICSPLINE"}:
        return {"interpolation": modes.pop()}
    still = np.zeros((len(times), 4))
    pairs = [(still, still) if s is None else s.tangents or (still, still) for s in samplers]
    into, out = (np.stack([pair[i] for pair in pairs], axis=1) for i in range(2))
    return {"interpolation": "CUBICSPLINE", "in_tangents": into, "out_tangents": out}
