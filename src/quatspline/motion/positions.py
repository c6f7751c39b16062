"""Curves through positions: the family that is to positions what a scheme is to orientations.

Orientations and positions stay apart: on recorded motion, screws that join them lose to cubics.  Each
family is a function of knots (n,), positions (n, k) and whether they are those of a closed motion, whose
last repeats the first; it gives a function of times (m,) -> (m, k).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from quatspline.curve import Curve
from quatspline.fitting.end_conditions import derivatives, fewest, interpolated, natural
from quatspline.keyframes import segment_of
from quatspline.options import declared_by, nearest
from quatspline.quaternion import FloatArray

Places = Callable[[FloatArray], FloatArray]
Family = Callable[[FloatArray, FloatArray, bool], Places]

WINDOW = 5
"""Keyframes from which `local_quintic` takes derivatives: order 4, as its scheme's."""

KAPPA = 3.0
"""The curvature weight of the paper's curve: its second derivative at a keyframe is three times that of
the parabola through three."""

AROUND = 4
"""Keyframes of the turns before and after that a closed motion is continued by."""


def linear(knots: FloatArray, x: FloatArray, closed: bool) -> Places:
    """Straight lines.  Differences are halved: those of finite positions may overflow."""

    def places(t: FloatArray) -> FloatArray:
        i = segment_of(knots, t)
        u = ((t - knots[i]) / (knots[i + 1] - knots[i]))[:, np.newaxis]
        step = u * (x[i + 1] / 2 - x[i] / 2)
        return np.where(u < 1.0, x[i] + step + step, x[i + 1])

    return places


def catmull_rom(knots: FloatArray, x: FloatArray, closed: bool) -> Places:
    """The non-uniform Catmull-Rom spline: C^1, parabolas through three positions give its tangents."""
    from scipy.interpolate import CubicHermiteSpline

    if len(knots) < 3:
        return linear(knots, x, closed)
    knots, x = _continued(knots, x, closed)
    return _scipy(CubicHermiteSpline(knots, x, _parabolas(knots, x)))


def cubic(knots: FloatArray, x: FloatArray, closed: bool) -> Places:
    """The natural cubic spline, or the periodic one: C^2."""
    from scipy.interpolate import CubicSpline

    return _scipy(CubicSpline(knots, x, bc_type="periodic" if closed else "natural"))


def local_quintic(knots: FloatArray, x: FloatArray, closed: bool) -> Places:
    """Quintic Hermite segments: C^2, derivatives from the polynomial through five positions."""
    knots, x = _continued(knots, x, closed)
    n, width = len(knots), min(WINDOW, len(knots))
    first = np.clip(np.arange(n) - width // 2, 0, n - width)
    window = first[:, np.newaxis] + np.arange(width)
    since = knots[window] - knots[:, np.newaxis]
    unit = np.abs(since).max(axis=1, keepdims=True)  # powers of spacings in any unit stay near 1
    powers = (since / unit)[..., np.newaxis] ** np.arange(width)
    c = np.linalg.solve(powers, x[window])
    slope = c[:, 1] / unit
    bend = 2.0 * c[:, 2] / unit**2 if width > 2 else np.zeros_like(x)
    return _quintic(knots, x, slope, bend)


def quartic(knots: FloatArray, x: FloatArray, closed: bool) -> Places:
    """The paper's curve in flat space: its blending functions, ghosts that repeat the ends."""
    knots, x = _continued(knots, x, closed)
    h = np.diff(knots)
    h = np.concatenate([h[:1], h, h[-1:]])[:, np.newaxis]
    s = np.pad(np.diff(x, axis=0), ((1, 1), (0, 0))) / h
    slope = (h[1:] * s[:-1] + h[:-1] * s[1:]) / (h[1:] + h[:-1])
    bend = 2.0 * KAPPA * (s[1:] - s[:-1]) / (h[1:] + h[:-1])
    return _quintic(knots, x, slope, bend)


@dataclass(frozen=True)
class SplineFamily:
    """B-splines of an odd degree k on the keyframes' times, C^(k-1), periodic where they close.

    Attributes
    ----------
    degree : k; lower for keyframes too few for it
    ends : "natural", "not-a-knot", "complete" (derivatives from k + 1 positions beside the end) or
        "stationary" (at rest)
    """

    degree: int
    ends: str

    def __call__(self, knots: FloatArray, x: FloatArray, closed: bool) -> Places:
        """A curve through x (n, k)."""
        spline, first = self.fitted(knots, x, closed), knots[0]
        return lambda t: np.asarray(spline(t - first))

    def fitted(self, knots: FloatArray, x: FloatArray, closed: bool) -> Any:
        """scipy's spline, in time since the first keyframe."""
        from scipy.interpolate import BSpline

        unit = 2.0 ** round(math.log2((knots[-1] - knots[0]) / (len(knots) - 1)))
        t = (knots - knots[0]) / unit  # exact, and the spline's linear system is well scaled
        degree, conditions = self._conditions(t, x, closed)
        spline = interpolated(t, x, degree, conditions)
        return BSpline(
            unit * spline.t, spline.c, degree, extrapolate="periodic" if closed else True
        )

    def _conditions(self, t: FloatArray, x: FloatArray, closed: bool) -> tuple[int, Any]:
        """The degree that so many keyframes allow, and the end conditions as scipy takes them."""
        if closed:
            return self.degree, "periodic"
        degree, ends = self.degree, "complete" if self.ends == "stationary" else self.ends
        while degree > 3 and fewest(degree, ends) > len(t):
            degree -= 2
        if fewest(degree, ends) > len(t):
            ends = "natural"
        if ends != "complete":
            return degree, natural(degree, x.shape[1:]) if ends == "natural" else None
        if self.ends == "stationary":
            rest = [(m, np.zeros(x.shape[1:])) for m in range(1, (degree + 1) // 2)]
            return degree, (rest, rest)
        return degree, (derivatives(t, x, degree), derivatives(t[::-1], x[::-1], degree))


FAMILIES: dict[str, Family] = {
    "linear": linear,
    "catmull-rom": catmull_rom,
    "cubic": cubic,
    "local-quintic": local_quintic,
    "quartic": quartic,
}

MATCHED = "matched"


def family(name: str, scheme: type[Curve], options: Mapping[str, Any] | None = None) -> Family:
    """The family of a name; for "matched" the one with a scheme's smoothness, order and locality.

    ``options`` are the scheme's: where all keyframes shape its curve, positions have its degree and ends.
    """
    if name == MATCHED:
        return _matched(scheme, options or {})
    if name not in FAMILIES:
        raise ValueError(f"positions={name!r}: {nearest(name, [MATCHED, *FAMILIES])}")
    return FAMILIES[name]


def _matched(scheme: type[Curve], options: Mapping[str, Any]) -> Family:
    if scheme.continuity < 1:
        return linear
    if scheme.support is None:
        return _global(scheme, options)
    if scheme.continuity < 2 or scheme.order < 2:
        return catmull_rom
    return quartic if scheme.order == 2 else local_quintic


def _global(scheme: type[Curve], options: Mapping[str, Any]) -> Family:
    """A B-spline where the scheme itself has a degree, or has other ends than natural ones."""
    chosen = {name: parameter.default for name, parameter in declared_by(scheme).items()}
    chosen |= {name: value for name, value in options.items() if name in chosen}
    clamped = any(
        value is not None and name.startswith(("start_", "end_")) for name, value in chosen.items()
    )
    ends = chosen.get("ends") or ("complete" if clamped else "natural")
    ends = {"clamped": "complete"}.get(ends, ends)
    if "degree" in chosen or ends != "natural":
        return SplineFamily(chosen.get("degree", 3), ends)
    return cubic


def _continued(knots: FloatArray, x: FloatArray, closed: bool) -> tuple[FloatArray, FloatArray]:
    """Keyframes of a closed motion with some of the turns before and after."""
    if not closed:
        return knots, x
    period, n = knots[-1] - knots[0], len(knots) - 1
    index = np.arange(-AROUND, n + AROUND + 1)
    return knots[index % n] + period * (index // n), x[index % n]


def _parabolas(knots: FloatArray, x: FloatArray) -> FloatArray:
    """Slopes (n, k) of parabolas through three positions."""
    h = np.diff(knots)[:, np.newaxis]
    s = np.diff(x, axis=0) / h
    slope = np.empty_like(x)
    slope[1:-1] = (h[1:] * s[:-1] + h[:-1] * s[1:]) / (h[1:] + h[:-1])
    slope[0], slope[-1] = 2 * s[0] - slope[1], 2 * s[-1] - slope[-2]
    return slope


def _quintic(knots: FloatArray, x: FloatArray, slope: FloatArray, bend: FloatArray) -> Places:
    """Quintic Hermite segments, by their Bernstein coefficients."""
    from scipy.interpolate import BPoly

    h = np.diff(knots)[:, np.newaxis]
    a, b = slice(None, -1), slice(1, None)
    coefficients = [
        x[a],
        x[a] + h * slope[a] / 5,
        x[a] + 2 * h * slope[a] / 5 + h**2 * bend[a] / 20,
        x[b] - 2 * h * slope[b] / 5 + h**2 * bend[b] / 20,
        x[b] - h * slope[b] / 5,
        x[b],
    ]
    return _scipy(BPoly(np.array(coefficients), knots))


def _scipy(spline: Any) -> Places:
    return lambda t: np.asarray(spline(t))
