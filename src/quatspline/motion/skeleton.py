"""The skeleton of a motion: joints that hang on joints, and where that puts them in the world."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quatspline import quaternion
from quatspline.motion.euler import AXES
from quatspline.quaternion import FloatArray

ROOT = -1
"""The parent of a joint that hangs on none."""


class Mounts(NamedTuple):
    """What is fixed between each joint and its parent: nodes of a glTF that nothing animates."""

    turns: FloatArray
    places: FloatArray


@dataclass(frozen=True, eq=False)
class Skeleton:
    """A hierarchy of joints.

    Attributes
    ----------
    parents : (J,) the index of each joint's parent, -1 for a root
    offsets : (J, 3) the rest position of each joint in its parent's frame
    orders : the order of each joint's Euler axes in its file, such as "ZXY": intrinsic, the first one first; ""
        if the file has no such order
    ends : the position (3,) of each end site in its joint's frame, by the joint's index
    mounts : fixed rotations (J, 4) and positions (J, 3) between parent and joint, or None
    """

    parents: NDArray[np.int64]
    offsets: FloatArray
    orders: tuple[str, ...]
    ends: Mapping[int, FloatArray] = field(default_factory=dict)
    mounts: Mounts | None = None

    def __post_init__(self) -> None:
        joints = len(self.parents)
        shapes = {"offsets": (joints, 3), "orders": (joints,)}
        for name, shape in shapes.items():
            found = np.shape(getattr(self, name))
            if found != shape:
                raise ValueError(f"{name} has shape {found}: expected {shape}")
        if not set(self.ends) <= set(range(joints)):
            raise ValueError("ends do not belong to the joints")
        tips = np.array([*self.ends.values(), *self.offsets])
        if not np.isfinite(tips).all():
            raise ValueError("offsets: not finite numbers")
        for joint, order in enumerate(self.orders):
            if not set(order) <= set(AXES) or len(set(order)) < len(order):
                raise ValueError(
                    f"orders[{joint}] = {order!r}: X, Y and Z at most once are expected"
                )
        self.outward  # noqa: B018 refuses joints that hang on each other

    @cached_property
    def outward(self) -> list[int]:
        """Joints in an order in which each follows its parent.

        Raises
        ------
        ValueError
            Where joints hang on each other in a circle.
        """
        children: dict[int, list[int]] = {}
        for joint, parent in enumerate(self.parents.tolist()):
            children.setdefault(parent, []).append(joint)
        order, waiting = [], children.get(ROOT, [])[::-1]
        while waiting:
            order.append(joint := waiting.pop())
            waiting += children.get(joint, [])[::-1]
        if len(order) < len(self.parents):
            stuck = sorted(set(range(len(self.parents))) - set(order))
            raise ValueError(f"parents[{stuck[0]}] leads to no root")
        return order

    @property
    def leaves(self) -> list[int]:
        """Joints without children."""
        return sorted(set(range(len(self.parents))) - set(self.parents.tolist()))

    def world(self, q: FloatArray, x: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Forward kinematics of local quaternions (n, J, 4) and positions (n, J, 3), all frames at once.

        Without positions, joints are at their offsets.
        """
        local = np.ascontiguousarray(np.moveaxis(quaternion.normalise(q), 1, 0))
        given = np.broadcast_to(self.offsets, (len(q), *self.offsets.shape)) if x is None else x
        turns, places = np.empty_like(local), np.array(np.moveaxis(given, 1, 0))
        for joint in self.outward:
            turn, place = self._mounted(joint, turns, places)
            turns[joint] = quaternion.mul(turn, local[joint])
            places[joint] = place + quaternion.rotate(turn, places[joint])
        return np.moveaxis(turns, 0, 1).copy(), np.moveaxis(places, 0, 1).copy()

    def _mounted(
        self, joint: int, turns: FloatArray, places: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """The frame in which a joint moves, in the world."""
        parent = int(self.parents[joint])
        turn, place = np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)
        if parent != ROOT:
            turn, place = turns[parent], places[parent]
        if self.mounts is None:
            return turn, place
        place = place + quaternion.rotate(turn, self.mounts.places[joint])
        return quaternion.mul(turn, self.mounts.turns[joint]), place
