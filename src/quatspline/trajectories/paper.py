"""The paper's two cases, reconstructed: it prints no keyframes, only frame and iteration counts.

9 = 4*2 + 1, 101 = 4*25 + 1 and 201 = 4*50 + 1 frames: the key has 5 keyframes, open.  12 = 6*2,
150 = 6*25 and 300 = 6*50: the teapot has 6, a closed loop.  That is an inference.  The orientations
are round numbers found by `tools.paper_search`, for which Nielson's iteration takes the
paper's 16 and 40 steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from quatspline import quaternion
from quatspline.keyframes import Keyframes, prepare
from quatspline.quaternion import FloatArray

RECONSTRUCTED = (
    "The paper prints no keyframes: these are reconstructed, in round numbers, so that Nielson's "
    "iteration takes the paper's 16 (key) and 40 (teapot) steps."
)

SOLVE: dict[str, Any] = {"stop": "change", "tolerance": 1e-6}
"""How the paper's B-splines are solved: Nielson's published stop rule at the paper's tolerance."""


@dataclass(frozen=True)
class PaperRow:
    """A row of the paper's Table 1; seconds in Matlab 7.11 on a Core i5-3210M at 2.5 GHz."""

    frames: int
    rendered: bool
    iterations: int
    seconds: float
    quartic_seconds: float
    ratio: float


@dataclass(frozen=True)
class PaperCase:
    """A rigid motion of the paper: orientations at unit spacing along a path.

    ``euler`` (n, 3) holds yaw, pitch, roll of the keyframes in degrees (intrinsic z-y'-x'').
    """

    name: str
    title: str
    euler: tuple[tuple[int, int, int], ...]
    closed: bool
    rows: tuple[PaperRow, ...]

    @property
    def quaternions(self) -> FloatArray:
        """Keyframe orientations (n, 4)."""
        return orientations(np.array(self.euler, dtype=float))

    @property
    def times(self) -> FloatArray:
        """0, 1, 2, ...; closed, one more."""
        return np.arange(len(self.euler) + self.closed, dtype=float)

    def keyframes(self) -> Keyframes:
        """The keyframes as schemes receive them."""
        return prepare(self.times, self.quaternions, closed=self.closed)

    def frames(self, count: int) -> FloatArray:
        """Times of evenly spaced frames; a loop does not repeat its first."""
        return np.linspace(0.0, self.times[-1], count, endpoint=not self.closed)

    def positions(self, t: FloatArray) -> FloatArray:
        """Positions (m, 3): a straight line, or a circle that a period runs through once."""
        t = np.asarray(t, dtype=float)
        if not self.closed:
            return np.stack([t, np.zeros_like(t), np.zeros_like(t)], axis=-1)
        angle = 2.0 * np.pi * t / self.times[-1]
        return 2.0 * np.stack([np.cos(angle), np.sin(angle), np.zeros_like(t)], axis=-1)


KEY = PaperCase(
    "key",
    "Key, 5 keyframes, open, on a straight line",
    ((0, 0, 0), (-10, -20, 110), (20, 20, 160), (-20, -20, 250), (-20, -20, 340)),
    False,
    (
        PaperRow(9, True, 16, 0.428924, 0.232556, 1.84),
        PaperRow(101, False, 16, 2.269482, 0.054245, 41.8),
        PaperRow(201, False, 16, 4.056699, 0.059091, 68.7),
    ),
)

TEAPOT = PaperCase(
    "teapot",
    "Utah teapot, 6 keyframes, closed, on a circle",
    ((0, 0, 0), (60, -10, -130), (120, 10, -10), (180, 20, 90), (240, 10, 140), (300, -20, -110)),
    True,
    (
        PaperRow(12, True, 40, 1.067959, 0.261552, 4.08),
        PaperRow(150, False, 40, 3.830228, 0.068203, 56.2),
        PaperRow(300, False, 40, 6.129554, 0.069013, 88.8),
    ),
)

CASES = {case.name: case for case in (KEY, TEAPOT)}


def orientations(euler: FloatArray) -> FloatArray:
    """Unit quaternions (..., 4) of yaw, pitch, roll (..., 3) in degrees."""
    flat = Rotation.from_euler("ZYX", euler.reshape(-1, 3), degrees=True)
    return flat.as_quat(scalar_first=True).reshape(*euler.shape[:-1], 4)


def steps(quaternions: FloatArray, closed: bool) -> FloatArray:
    """Rotation angles in degrees (K, segments) between neighbours of (K, n, 4)."""
    after = np.roll(quaternions, -1, axis=1)
    angles = np.degrees(quaternion.distance(quaternions, after))
    return angles if closed else angles[:, :-1]
