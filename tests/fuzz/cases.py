"""Random valid keyframes for every scheme, hard ones on purpose; case i of a seed is always the same."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal, get_args, get_origin

import numpy as np

import quatspline as qs
from quatspline import quaternion
from quatspline.options import declared_by
from quatspline.quaternion import FloatArray

Rng = np.random.Generator

SLOW = ("min-torque", "spherical-average")
"""Schemes that take a tenth of the builds."""

EXACT_AXES = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, -1], [1, 1, 1], [0.6, 0.8, 0], [1, -1, 0]])

NUMBERS: dict[str, Callable[[Rng, int], Any]] = {
    "window": lambda rng, n: int(rng.integers(1, 6)),
    "curvature": lambda rng, n: float(rng.uniform(-4.0, 4.0)),
    "reference": lambda rng, n: int(rng.integers(0, n)),
    "terms": lambda rng, n: int(rng.integers(1, 40)),
    "steps": lambda rng, n: int(rng.integers(1, 200)),
    "subintervals": lambda rng, n: int(rng.integers(1, 5)),
    "tension": lambda rng, n: rng.uniform(0.0, 2.0, n) if rng.random() < 0.5 else 0.5,
    "continuity": lambda rng, n: rng.uniform(-2.0, 2.0, n),
    "bias": lambda rng, n: float(rng.uniform(-2.0, 2.0)),
    "start_velocity": lambda rng, n: rng.normal(size=3),
    "end_velocity": lambda rng, n: rng.normal(size=3),
    "start_acceleration": lambda rng, n: rng.normal(size=3),
    "end_acceleration": lambda rng, n: rng.normal(size=3),
    "max_iterations": lambda rng, n: int(rng.integers(1, 500)),
    "tolerance": lambda rng, n: float(10.0 ** rng.uniform(-10, -4)),
}
"""Values of options that are numbers."""


@dataclass(frozen=True)
class Case:
    """Keyframes and options of one build."""

    scheme: str
    times: Any
    quaternions: FloatArray
    closed: bool = False
    align: bool = True
    options: dict[str, Any] = field(default_factory=dict)

    def build(self) -> qs.Curve:
        return qs.build(
            self.scheme,
            self.times,
            self.quaternions,
            closed=self.closed,
            align=self.align,
            **self.options,
        )


def names() -> list[str]:
    """In-house schemes, slow ones at a tenth of the others' weight."""
    own = [name for name in qs.schemes() if qs.scheme(name).peer is None]
    return [name for name in own if name not in SLOW] * 10 + [name for name in own if name in SLOW]


def case(seed: int, index: int, schemes: list[str]) -> Case:
    """Case ``index`` of a seed."""
    rng = np.random.default_rng([seed, index])
    cls = qs.scheme(schemes[int(rng.integers(len(schemes)))])
    n = int(max(cls.min_keyframes, rng.choice([2, 3, 4, 5, 7, 12, 20])))
    closed = bool(cls.closable and rng.random() < 0.3)
    align = bool(rng.random() < 0.7)
    q = _orientations(rng, n)
    if rng.random() < 0.1:
        q = np.stack([q, _orientations(rng, n)], axis=1)
    times = _times(rng, n + closed) if cls.non_uniform else _uniform(rng, n + closed)
    return Case(cls.name, times, q, closed, align, _options(rng, cls, n, closed))


# -- orientations ---------------------------------------------------------------------------------


def _orientations(rng: Rng, n: int) -> FloatArray:
    steps = _steps(rng, n - 1)
    q = [quaternion.normalise(rng.normal(size=4)) if rng.random() < 0.7 else np.eye(4)[0]]
    for step in quaternion.exp(steps):
        q.append(quaternion.mul(q[-1], step))
    keyframes = np.array(q)
    if rng.random() < 0.3:
        keyframes = _with_holds(rng, keyframes)
    if rng.random() < 0.3:
        keyframes *= rng.choice([-1.0, 1.0], n)[:, None]
    if rng.random() < 0.3:  # rounded to a few digits more or less than float64's
        keyframes = keyframes + 10.0 ** rng.uniform(-17, -13) * rng.normal(size=(n, 4))
    return keyframes


def _steps(rng: Rng, n: int) -> FloatArray:
    """Half rotation vectors of n steps."""
    axes = rng.normal(size=(n, 3))
    if rng.random() < 0.4:
        axes = np.broadcast_to(EXACT_AXES[rng.integers(len(EXACT_AXES))], (n, 3))
    elif rng.random() < 0.2:
        axes = EXACT_AXES[rng.integers(len(EXACT_AXES), size=n)]
    axes = axes / np.linalg.norm(axes, axis=1)[:, None]
    return 0.5 * _angles(rng, n)[:, None] * axes


def _angles(rng: Rng, n: int) -> FloatArray:
    kind = rng.integers(7)
    if kind == 0:
        return np.full(n, rng.uniform(0.0, np.pi))
    if kind == 1:
        return rng.uniform(-np.pi, np.pi, n)
    if kind == 2:
        return (
            2.0 * np.pi / rng.choice([1, 2, 3, 4, 6], n if rng.random() < 0.5 else 1) * np.ones(n)
        )
    if kind == 3:
        return np.pi * rng.choice([1, 1, -1, 2], n) + rng.choice([-1, 1], n) * _small(rng, n)
    if kind == 4:
        return _small(rng, n)
    if kind == 5:
        return np.where(rng.random(n) < 0.5, rng.uniform(0.0, np.pi, n), _small(rng, n))
    return rng.uniform(0.0, 2.0 * np.pi, n)


def _small(rng: Rng, n: int) -> FloatArray:
    return 10.0 ** rng.uniform(-18, 0, n)


def _with_holds(rng: Rng, q: FloatArray) -> FloatArray:
    """Poses repeated, exactly or with rounding, some to and fro."""
    q = q.copy()
    for i in range(1, len(q)):
        if rng.random() < 0.5:
            q[i] = q[int(rng.integers(max(0, i - 2), i))]
            q[i] += rng.choice([0.0, 1e-16, 1e-15, 1e-12, 1e-9]) * rng.normal(size=4)
    return q


# -- times ----------------------------------------------------------------------------------------


def _times(rng: Rng, n: int) -> Any:
    kind = rng.integers(6)
    if kind == 0:
        return None
    if kind == 1:
        return _uniform(rng, n)
    if kind == 2:  # integer stamps of today, in nanoseconds
        gaps = np.round(10.0 ** rng.uniform(0, 9, n - 1)).astype(np.int64)
        return 1_650_000_000_000_000_000 + np.append(0, np.cumsum(gaps))
    if kind == 3:  # the seconds of a clock
        return 1.3e9 + np.append(0.0, np.cumsum(rng.uniform(0.005, 0.02, n - 1)))
    span = rng.choice([1.0, 3.0, 6.0, 9.0, 12.0])
    gaps = 10.0 ** rng.uniform(0.0, span, n - 1)
    return np.append(0.0, np.cumsum(gaps)) * 10.0 ** rng.uniform(-9, 9)


def _uniform(rng: Rng, n: int) -> FloatArray:
    return np.arange(n) * 10.0 ** rng.uniform(-9, 9)


# -- options --------------------------------------------------------------------------------------


def _options(rng: Rng, cls: type[qs.Curve], n: int, closed: bool) -> dict[str, Any]:
    options: dict[str, Any] = {}
    if rng.random() < 0.5:
        return options
    for name, parameter in declared_by(cls).items():
        kind = parameter.annotation
        if name == "on_failure" or rng.random() < 0.5:
            continue
        words = next((k for k in (kind, *get_args(kind)) if get_origin(k) is Literal), None)
        if words is not None:
            options[name] = get_args(words)[rng.integers(len(get_args(words)))]
        elif name in NUMBERS:
            options[name] = NUMBERS[name](rng, n)
    return _consistent(options, n, closed)


def _consistent(options: dict[str, Any], n: int, closed: bool) -> dict[str, Any]:
    """Without what a scheme refuses together."""
    if closed and options.get("ends") in ("clamped", "stationary"):
        del options["ends"]
    if closed or options.get("ends") not in ("clamped", "complete"):
        options = {
            k: v for k, v in options.items() if not k.endswith(("_velocity", "_acceleration"))
        }
    if options.get("degree", 3) == 3:
        options = {k: v for k, v in options.items() if not k.endswith("_acceleration")}
    if options.get("degree", 3) > 3 or options.get("ends") == "not-a-knot":
        options = {k: v for k, v in options.items() if n > 9 or k not in ("degree", "ends")}
        if "ends" not in options:
            options = {k: v for k, v in options.items() if not k.startswith(("start_", "end_"))}
    return options
