"""Nodes of a glTF: which hang on which, where they rest, and what stands fixed between those that move."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.motion.errors import warn
from quatspline.motion.files.buffers import Document
from quatspline.motion.files.forms import ORTHOGONAL
from quatspline.motion.skeleton import ROOT, Mounts, Skeleton
from quatspline.quaternion import FloatArray

IDENTITY = (1.0, 0.0, 0.0, 0.0)

END = "end"
"""What this project's GLB calls a node that is an end site, in its extras."""


class Nodes:
    """Rest poses of all nodes: turns (N, 4) scalar first, places (N, 3), scales (N,), parents."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.nodes = document.items("nodes")
        self.parents = self._parents()
        self.turns = np.empty((len(self.nodes), 4))
        self.places = np.empty((len(self.nodes), 3))
        self.scales = np.empty(len(self.nodes))
        for i, node in enumerate(self.nodes):
            self.turns[i], self.places[i], self.scales[i] = self._rest(i, node)

    def names(self, path: Path, joints: list[int]) -> list[str]:
        """Names of nodes; one without a name, and one that is not the first of its name, by its index."""
        given = [self.nodes[joint].get("name") for joint in joints]
        names: list[str] = []
        for joint, name in zip(joints, given, strict=True):
            plain = name if isinstance(name, str) and name else f"node {joint}"
            names.append(f"{plain} (node {joint})" if plain in names else plain)
        again = [name for name in names if name.endswith(")") and name not in given]
        if again:
            warn(path, f"names of nodes come twice: {', '.join(again)}")
        return names

    def skeleton(self, joints: list[int]) -> tuple[Skeleton, FloatArray]:
        """The joints among the nodes, and the product (J,) of all scales above each."""
        track = {joint: i for i, joint in enumerate(joints)}
        chains = [self._chain(joint, track) for joint in joints]
        parents = [track[chain[0]] if chain and chain[0] in track else ROOT for chain in chains]
        scales = np.array([self._scale(joint) for joint in joints])
        turns, places = np.tile(IDENTITY, (len(joints), 1)), np.zeros((len(joints), 3))
        for i, chain in enumerate(chains):
            for node in chain[0 if parents[i] == ROOT else 1 :]:
                step = self._scale(node) * self.places[node]
                places[i] += quaternion.rotate(turns[i], step)
                turns[i] = quaternion.mul(turns[i], self.turns[node])
        fixed = bool((np.abs(turns - IDENTITY) > 0.0).any() or places.any())
        offsets = self.places[joints] * scales[:, np.newaxis]
        ends = self._ends(track)
        mounts = Mounts(turns, places) if fixed else None
        names = ("",) * len(joints)
        return Skeleton(np.array(parents, dtype=np.int64), offsets, names, ends, mounts), scales

    def _chain(self, node: int, track: dict[int, int]) -> list[int]:
        """Nodes above one, from the nearest that moves (or the root) downwards."""
        chain: list[int] = []
        above = self.parents[node]
        while above != ROOT:
            chain.insert(0, above)
            if above in track:
                break
            above = self.parents[above]
        return chain

    def _scale(self, node: int) -> float:
        """The product of the scales above a node."""
        product, above = 1.0, self.parents[node]
        while above != ROOT:
            if np.isnan(self.scales[above]):
                self.document.refuse(
                    f"nodes[{above}] is scaled by axis: what hangs on it is not rigid"
                )
            product *= float(self.scales[above])
            above = self.parents[above]
        return product

    def _ends(self, track: dict[int, int]) -> dict[int, FloatArray]:
        """End sites that this project wrote."""
        return {
            track[parent]: self.places[i] * self._scale(i)
            for i, (node, parent) in enumerate(zip(self.nodes, self.parents, strict=True))
            if node.get("extras") == {"quatspline": END} and parent in track
        }

    def _parents(self) -> list[int]:
        parents = [ROOT] * len(self.nodes)
        for i, node in enumerate(self.nodes):
            children = node.get("children", [])
            if not isinstance(children, list):
                self.document.refuse(f"children of nodes[{i}] are no list")
            for child in children:
                self.document.item("nodes", child)
                if parents[child] != ROOT:
                    self.document.refuse(f"nodes[{child}] hangs on two others")
                parents[child] = i
        for i in range(len(parents)):
            self._check_above(i, parents)
        return parents

    def _check_above(self, node: int, parents: list[int]) -> None:
        above, steps = parents[node], 0
        while above != ROOT:
            above, steps = parents[above], steps + 1
            if steps > len(parents):
                self.document.refuse(f"nodes[{node}] hangs on itself")

    def _rest(self, index: int, node: dict[str, Any]) -> tuple[FloatArray, FloatArray, float]:
        """A node's turn, place and scale: NaN where it scales axes differently."""
        vector = self.document.vector
        if "matrix" in node:
            m = vector(node, "matrix", (0.0,) * 16).reshape(4, 4).T
            return self._of_matrix(index, m)
        turn = np.roll(vector(node, "rotation", (0.0, 0.0, 0.0, 1.0)), 1)
        scale = vector(node, "scale", (1.0, 1.0, 1.0))
        if abs(float(np.linalg.norm(turn)) - 1.0) > ORTHOGONAL:
            self.document.refuse(f"nodes[{index}] has a rotation that is no unit quaternion")
        even = scale[0] if np.ptp(scale) <= ORTHOGONAL * abs(scale[0]) else np.nan
        return quaternion.normalise(turn), vector(node, "translation", (0.0, 0.0, 0.0)), float(even)

    def _of_matrix(self, index: int, m: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        from scipy.spatial.transform import Rotation

        lengths = np.linalg.norm(m[:3, :3], axis=0)
        if not lengths.all() or np.linalg.det(m[:3, :3]) <= 0.0:
            self.document.refuse(f"nodes[{index}] has a matrix that mirrors or flattens")
        turn = Rotation.from_matrix(m[:3, :3] / lengths).as_quat(scalar_first=True)
        sheared = (
            np.abs((m[:3, :3] / lengths).T @ (m[:3, :3] / lengths) - np.eye(3)).max() > ORTHOGONAL
        )
        even = np.ptp(lengths) <= ORTHOGONAL * lengths[0] and not sheared
        return turn, m[:3, 3], float(lengths[0] if even else np.nan)
