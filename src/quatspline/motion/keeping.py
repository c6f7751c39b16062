"""Every n-th frame of a motion kept: which frames are left out, and which joints say something of a scheme."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from quatspline import quaternion
from quatspline.inputs.arrays import BoolArray
from quatspline.motion.motion import Motion

MOVES = np.radians(1.0)
"""A joint that turns less than this from its first pose says nothing of a scheme."""


def left_out(motion: Motion, every: int) -> BoolArray:
    """Which frames (n,) are no keyframes of `Motion.curve` with this ``every``.

    Raises
    ------
    ValueError
        Where none is left out.
    """
    out = np.ones(len(motion.quaternions), dtype=bool)
    for a, b in pairwise(motion.edges):
        out[a:b:every] = out[b - 1] = False
    if not out.any():
        raise ValueError(f"--keep {every}: leaves out none of {len(out)} frames")
    return out


def moving(motion: Motion) -> list[int]:
    """Joints that turn; all where none does."""
    q = quaternion.normalise(motion.quaternions)
    ranges = quaternion.distance(q, q[:1]).max(axis=0)
    return np.flatnonzero(ranges > MOVES).tolist() or list(range(len(motion.tracks)))
