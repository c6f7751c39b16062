"""Ten motions of the kinds that people bring, each as seeded keyframes of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from quatspline import comparing, quaternion
from quatspline.cli import compare
from quatspline.engines.engine import always_compiled
from quatspline.findings.needs import Needs
from quatspline.quaternion import FloatArray

Z = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class File:
    """Keyframes with what their owner asks for."""

    times: FloatArray
    quaternions: FloatArray
    closed: bool = False
    needs: Needs = field(default_factory=Needs)


def _turned(vectors: FloatArray) -> FloatArray:
    """Orientations (n, 4) of rotation vectors (n, 3)."""
    return quaternion.exp(0.5 * np.asarray(vectors))


def _walked(steps: FloatArray) -> FloatArray:
    """Orientations (n + 1, 4) of steps (n, 3), rotation vectors in the body's frame."""
    q = [np.array([1.0, 0.0, 0.0, 0.0])]
    for step in _turned(steps):
        q.append(quaternion.mul(q[-1], step))
    return quaternion.normalise(np.array(q))


def _oblique(rng: np.random.Generator, degrees: FloatArray) -> FloatArray:
    """Steps (n, 3) of given angles about random axes."""
    axes = rng.normal(size=(len(degrees), 3))
    return np.radians(degrees)[:, None] * axes / np.linalg.norm(axes, axis=1, keepdims=True)


def robot_waypoints() -> File:
    """Eight poses of a tool; the drive of the wrist turns 21 degrees a second at most."""
    rng = np.random.default_rng(1)
    times = np.cumsum(np.append(0.0, rng.uniform(1.5, 3.0, 7)))
    poses = _walked(_oblique(rng, rng.uniform(15.0, 45.0, 7)))
    return File(times, poses, needs=Needs(smooth=2, max_rate=21.0))


def camera_path() -> File:
    """Twelve views of a tour, in frames of a timeline; moved by hand, one at a time."""
    t = np.arange(12.0)
    vectors = np.stack([0.3 * np.sin(0.5 * t), 0.25 * t, 0.15 * np.cos(0.8 * t)], axis=1)
    return File(t, _turned(vectors), needs=Needs(smooth=2, local=True))


def spacecraft_with_holds() -> File:
    """Attitudes held for minutes, with slews of half a minute between."""
    rng = np.random.default_rng(3)
    poses = _walked(_oblique(rng, np.array([60.0, 85.0, 40.0])))
    times = np.array([0.0, 240.0, 270.0, 510.0, 540.0, 780.0, 810.0, 1050.0])
    return File(times, np.repeat(poses, 2, axis=0))


def noisy_slam() -> File:
    """A hand-held camera at 10 Hz, its orientations off by 0.3 degrees about each axis."""
    rng = np.random.default_rng(4)
    t = np.arange(300) / 10.0
    vectors = np.stack([0.4 * np.sin(0.6 * t), 0.3 * np.cos(0.5 * t), 0.1 * t], axis=1)
    errors = _turned(np.radians(0.3) * rng.normal(size=(300, 3)))
    return File(t, quaternion.mul(_turned(vectors), errors))


def walk_cycle() -> File:
    """A thigh over two strides at 30 Hz, as a motion capture has it when it is clean."""
    t = np.arange(61) / 30.0
    swing = np.radians(25.0) * np.sin(2 * np.pi * t) + np.radians(6.0) * np.sin(4 * np.pi * t + 1)
    roll = np.radians(5.0) * np.cos(2 * np.pi * t)
    return File(t, _turned(np.stack([swing, roll, 0.5 * roll], axis=1)))


def turntable() -> File:
    """A turn about one axis at a constant rate, in steps of 30 degrees."""
    t = np.arange(13) * 0.5
    return File(t, _turned(np.radians(30.0) * np.arange(13)[:, None] * Z))


def hinge() -> File:
    """A door that opens, stops, swings back and must not go beyond its frame by half a degree."""
    angles = np.radians([0.0, 70.0, 70.0, 95.0, 20.0, 0.0])
    times = np.array([0.0, 1.0, 1.5, 2.2, 3.4, 4.0])
    return File(times, _turned(angles[:, None] * Z), needs=Needs(max_excursion=0.5))


def drone() -> File:
    """Attitude commands that arrive in flight: a segment is flown when one more is known."""
    rng = np.random.default_rng(8)
    times = np.cumsum(np.append(0.0, rng.uniform(0.2, 0.4, 14)))
    tilts = np.radians(20.0) * rng.normal(size=(15, 3)) * [1.0, 1.0, 0.5]
    return File(times, _turned(tilts), needs=Needs(causal=1))


def closed_loop() -> File:
    """A camera that circles an object and returns, over and over; one of its steps is 150 degrees."""
    rng = np.random.default_rng(9)
    poses = _walked(_oblique(rng, np.array([50.0, 60.0, 150.0, 45.0, 40.0])))
    return File(np.arange(7) * 2.0, poses, closed=True)


def two_keyframes() -> File:
    """From one pose to the opposite one, nearly."""
    return File(np.array([0.0, 2.0]), _turned(np.radians([0.0, 179.5])[:, None] * Z))


FILES: dict[str, Callable[[], File]] = {
    make.__name__.replace("_", "-"): make
    for make in (
        robot_waypoints,
        camera_path,
        spacecraft_with_holds,
        noisy_slam,
        walk_cycle,
        turntable,
        hinge,
        drone,
        closed_loop,
        two_keyframes,
    )
}

SCHEMES = (
    *("slerp", "squad", "catmull-rom", "nielson", "kim", "spherical-average", "log-cubic"),
    *("quartic", "quintic", "local-quintic", "monotone-quintic", "smoothing-spline"),
)
"""What is compared on them: in-house schemes of every kind, on any machine the same."""

ANSWERS = Path(__file__).parents[1] / "data" / "compare"
"""What the terminal shows of each; timings are all the same."""


def terminal(name: str) -> list[str]:
    """What ``quatspline compare`` would print of a file, with every timing 10 ns."""
    file = FILES[name]()
    keyframes = comparing.prepared(file.times, file.quaternions, file.closed)
    with always_compiled():
        table, _ = comparing.compared(keyframes, SCHEMES)
    table["seconds_per_sample"] = 1e-8
    return compare.spoken(compare.answer(keyframes, table, file.needs), table, file.needs)


def main() -> None:
    """Write the texts anew: ``python -m report.ten_files`` in the folder of the tests."""
    for name in FILES:
        (ANSWERS / f"{name}.txt").write_text("\n".join(terminal(name)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
