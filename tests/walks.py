"""Keyframes that the tests share, and what they have in common."""

import sys
from collections.abc import Callable
from typing import Any

import numpy as np

import quatspline as qs
from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.options import declared_by
from quatspline.quaternion import FloatArray

TIGHT = 1e-11
"""Tolerance of iterative schemes, so that what is left of a solve disappears in other bounds."""

SHARES = (0.375, 0.75, 0.5, 1.0, 0.625, 0.5, 0.875)
"""Uneven spacings with few binary digits: sums and shifts of them stay exact."""


def applies(condition: Callable[[type[Curve]], bool]) -> Callable[..., Any]:
    """Mark a check as one for the schemes that meet a condition on their class."""

    def mark(check: Any) -> Any:
        check.condition = condition
        return check

    return mark


def checks_in(module: str) -> list[Callable[..., Any]]:
    """The checks of a module that run for every scheme."""
    return [
        function
        for name, function in vars(sys.modules[module]).items()
        if name.startswith("test_") and "scheme" in function.__code__.co_varnames[:2]
    ]


def runs_somewhere(check: Callable[..., Any]) -> bool:
    """Whether some scheme meets a check's condition and has to pass it."""
    condition = getattr(check, "condition", lambda scheme: True)
    known = map(qs.scheme, qs.schemes())
    return any(condition(scheme) and check.__name__ not in scheme.departs for scheme in known)


def curve_of(scheme: type[Curve], times: Any, quaternions: Any, **given: Any) -> Curve:
    """A scheme's curve, solved tightly where it is solved at all."""
    known = declared_by(scheme)
    given = {"tolerance": TIGHT, **given} if "tolerance" in known else given
    return scheme(times, quaternions, **given)


def excused(scheme: type[Curve]) -> dict[str, str]:
    """The option that hands back a curve that did not converge, where there is one."""
    return {"on_failure": "return"} if "on_failure" in declared_by(scheme) else {}


def uneven(count: int) -> FloatArray:
    """Uneven knots, exact in binary."""
    return np.concatenate([[0.0], np.cumsum(np.resize(SHARES, count - 1))])


def knots_of(scheme: type[Curve], count: int) -> FloatArray:
    """Uneven knots where a scheme takes them, uniform ones of spacing 0.75 otherwise."""
    return uneven(count) if scheme.non_uniform else 0.75 * np.arange(count)


def count_of(scheme: type[Curve], wanted: int = 7) -> int:
    """A number of keyframes that a scheme takes."""
    return max(wanted, scheme.min_keyframes)


def random_units(count: int, seed: int) -> FloatArray:
    """Uniform unit quaternions (count, 4)."""
    return quaternion.normalise(np.random.default_rng(seed).normal(size=(count, 4)))


def walk(count: int, degrees: float, seed: int = 1) -> FloatArray:
    """Keyframes (count, 4) from a random one on, each a turn about a random axis further."""
    rng = np.random.default_rng(seed)
    axes = rng.normal(size=(count - 1, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    q = [random_units(1, seed + 1000)[0]]
    for step in quaternion.exp(0.5 * np.radians(degrees) * axes):
        q.append(quaternion.mul(q[-1], step))
    return np.array(q)


def spin(t: FloatArray, axis: Any, rate: float, base: Any = (1.0, 0.0, 0.0, 0.0)) -> FloatArray:
    """base exp(rate t axis / 2): a constant body rate about one axis (normalised here)."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    return quaternion.mul(base, quaternion.exp(0.5 * rate * np.asarray(t)[..., None] * axis))


def loop(times: FloatArray, turns: int, wobble: float = 0.2) -> FloatArray:
    """Closed keyframes at times[:-1]: `turns` turns about a wobbling axis; s = (-1)^turns."""
    phase = 2 * np.pi * (times[:-1] - times[0]) / (times[-1] - times[0])
    nod = np.stack([np.sin(phase), np.cos(2 * phase), 0 * phase], axis=1) * wobble
    return quaternion.mul(spin(phase, (0.0, 0.0, 1.0), turns), quaternion.exp(nod))


def inside(knots: FloatArray, per_segment: int = 3) -> FloatArray:
    """Sample times inside the segments, none at a knot."""
    shares = (np.arange(per_segment) + 0.5) / per_segment
    return (knots[:-1, None] + shares * np.diff(knots)[:, None]).reshape(-1)


def apart(a: FloatArray, b: FloatArray) -> float:
    """The largest distance in R^4, NaN being infinitely far."""
    gap = np.linalg.norm(np.asarray(a) - np.asarray(b), axis=-1)
    return float(np.max(np.where(np.isnan(gap), np.inf, gap), initial=0.0))


def apart_up_to_sign(a: FloatArray, b: FloatArray) -> float:
    """The largest rotation angle between orientations, NaN being infinitely far."""
    gap = quaternion.distance(a, b)
    return float(np.max(np.where(np.isnan(gap), np.inf, gap), initial=0.0))
