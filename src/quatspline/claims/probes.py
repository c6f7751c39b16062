"""Probes: one number of one scheme on one case, by a call that fits on a line.

Every argument is a scalar, so that a call stands in a table as code that anybody can run again.  Keyframes
are walks of a step angle, times uniform or log-uniform over a factor e^2; ``seed`` draws both.
Schemes are built with default options, iterative ones solved to 1e-11.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.catalogue import build, scheme
from quatspline.claims import own
from quatspline.curve import Curve
from quatspline.instruments import lookahead as ahead
from quatspline.instruments.accuracy import inner_angle, measured_order
from quatspline.instruments.continuity import jumps, measured_continuity, speeds
from quatspline.instruments.fairness import fairness
from quatspline.instruments.locality import locality, responses
from quatspline.instruments.smoothness import inner_jumps, inner_smoothness
from quatspline.instruments.trials import builder
from quatspline.quaternion import FloatArray
from quatspline.trajectories.sets import torque_sets
from quatspline.trajectories.smooth import SPAN, tumble
from quatspline.trajectories.walks import walk

MANY = 41
"""Keyframes on which support is measured: a decay of 0.27 a segment dies out before the ends."""

SAMPLES = 8
"""Samples per segment."""

CONSTANT = 1e-8
"""Departures from a constant spin below this share of a step are none: acos loses that much."""
EDGE = 4
"""Segments at either end that count as ends: no ghost reaches farther."""
AXIS, OBLIQUE = np.array([0.6, 0.0, 0.8]), np.array([0.3, -0.5, 0.4])
"""Of a spin, and the half rotation vector that it starts at: charts at the identity see both."""

MET = 1e-6
"""The largest angle in rad by which a closed curve may miss where it returns."""

MOST = 8
"""Keyframes that every scheme accepts."""


def walked(
    count: int, degrees: float, uneven: bool = False, seed: int = 0
) -> tuple[FloatArray, FloatArray]:
    """Times (count,) and keyframes (count, 4)."""
    rng = np.random.default_rng(seed)
    keyframes = walk(rng, count, degrees)[:, 0]
    spacings = np.exp(rng.uniform(-1.0, 1.0, count - 1)) if uneven else np.ones(count - 1)
    return np.concatenate([[0.0], np.cumsum(spacings)]), keyframes


# -- what classes claim -------------------------------------------------------------------------


def continuity(
    name: str, count: int = 4, degrees: float = 60, uneven: bool = False, seed: int = 0
) -> int:
    """k of C^k at keyframes; -1 where the curve leaps, 3 where no derivative up to the third jumps."""
    return measured_continuity(jumps(builder(name)(*walked(count, degrees, uneven, seed))))


def inner_continuity(
    name: str, count: int = 4, degrees: float = 60, uneven: bool = False, seed: int = 0
) -> int:
    """k of C^k inside segments; 6 where no derivative up to the sixth jumps, and 1 at least."""
    curve = builder(name)(*walked(count, degrees, uneven, seed))
    return inner_smoothness(inner_jumps(curve))


def miss(
    name: str, count: int = 4, degrees: float = 60, uneven: bool = False, seed: int = 0
) -> float:
    """The largest angle in rad by which keyframes are missed."""
    return _miss(builder(name)(*walked(count, degrees, uneven, seed)))


def miss_through_half_turn(name: str) -> float:
    """The same for four rotations about one axis, by 160, 170, 190 and 200 degrees."""
    half = np.radians([160.0, 170.0, 190.0, 200.0]) / 2.0
    return _miss(builder(name)(np.arange(4.0), quaternion.exp(half[:, None] * np.eye(3)[0])))


def _miss(curve: Curve) -> float:
    return float(quaternion.distance(curve(curve.times), curve.quaternions).max())


def order(name: str, keyframes: int = 161) -> float:
    """Interior order on a smooth motion over two halvings of the spacing that end at so many keyframes."""
    curves = [_tumbling(name, (keyframes - 1) // halved + 1) for halved in (4, 2, 1)]
    spacings = [curve.keyframes.spacings[0] for curve in curves]
    return measured_order(spacings, [inner_angle(curve) for curve in curves])


def _tumbling(name: str, count: int) -> Curve:
    """Through evenly spaced keyframes of the smooth motion."""
    times = np.linspace(0.0, SPAN, count)
    return builder(name)(times, tumble(times))


def support(name: str, degrees: float = 30) -> int | str:
    """Keyframes that shape a segment; "all" where the response has a tail that decays."""
    found = locality(responses(builder(name), *walked(MANY, degrees)))
    return "all" if np.isfinite(found["decay"]) else found["support"]


def lookahead(name: str, degrees: float = 30) -> int | str:
    """Keyframes after a segment's own two that shape it; "all" where the last one is always felt."""
    found = ahead.lookahead(ahead.moved(builder(name), *walked(ahead.COUNT, degrees)))
    return "all" if found is None else found


def constant_rate(name: str, degrees: float = 50, uneven: bool = False, count: int = 17) -> str:
    """Where keyframes of a constant spin give that spin: "everywhere", "interior" or "no".

    ``degrees`` are those of the mean step; the spin's axis and the first orientation are oblique.
    """
    times, _ = walked(count, degrees, uneven)
    times *= (count - 1) / times[-1]

    def spin(at: FloatArray) -> FloatArray:
        half = np.radians(degrees) / 2.0 * at[:, None]
        return quaternion.mul(quaternion.exp(OBLIQUE), quaternion.exp(half * AXIS))

    curve = builder(name)(times, spin(times))
    t = curve.keyframes.inside(SAMPLES)
    off = quaternion.distance(curve(t), spin(t)) / np.radians(degrees)
    inner = (t > times[EDGE]) & (t < times[-1 - EDGE])
    if off.max() <= CONSTANT:
        return "everywhere"
    return "interior" if off[inner].max() <= CONSTANT else "no"


def takes_uneven_times(name: str) -> bool:
    """Whether uneven times are taken; refused, the answer is no."""
    return _accepted(name, *walked(4, 60.0, uneven=True))


def closes(name: str) -> bool:
    """Whether a closed curve can be had, and returns to its first keyframe; refused, it is no."""
    times, keyframes = walked(5, 60.0)
    try:
        curve = scheme(name)(np.append(times, 5.0), keyframes, closed=True)
    except ValueError:
        return False
    ends = curve([0.0, 5.0])
    return bool(quaternion.distance(ends[0], ends[1]) <= MET)


def fewest_keyframes(name: str) -> int:
    """The least number of keyframes that is taken."""
    counts = range(1, MOST + 1)
    return next(count for count in counts if _accepted(name, *walked(count, 60.0)))


def reports_a_solve(name: str) -> bool:
    """Whether a curve carries the report of an iteration."""
    return builder(name)(*walked(5, 60.0)).solve_report is not None


def _accepted(name: str, times: FloatArray, keyframes: FloatArray) -> bool:
    try:
        curve = scheme(name)(times, keyframes)
    except ValueError:
        return False
    return bool(np.isfinite(curve(times)).all())


# -- what else is said of curves ----------------------------------------------------------------


def rate_error(name: str, quantity: str = "omega", count: int = 4, degrees: float = 60) -> float:
    """How far published rates ("omega" or "alpha") are off the curve's own, as a share of the largest.

    Raises LookupError where none are published.
    """
    rows = own.own_rates(builder(name)(*walked(count, degrees)))
    relative = {row["quantity"]: row["relative"] for row in rows}
    if quantity not in relative:
        raise LookupError(f"{name} publishes no {quantity}")
    return float(relative[quantity])


def least_key_speed(name: str, count: int = 4, degrees: float = 60) -> float:
    """Least speed at an inner keyframe over the mean speed: 0 is a stop."""
    return float(speeds(builder(name)(*walked(count, degrees)))["least_key_speed"])


def jump_order(name: str, keyframes: int = 81) -> float:
    """The power of the spacing that the acceleration's jump falls with, over its last halving."""
    curves = [_tumbling(name, count) for count in ((keyframes - 1) // 2 + 1, keyframes)]
    spacings = [curve.keyframes.spacings[0] for curve in curves]
    return measured_order(spacings, [jumps(curve, [2])["jump"].iloc[0] for curve in curves])


def torque_ratio(name: str, other: str = "min-torque", sets: int = 6) -> float:
    """Median of the torque energy over that of another scheme, on the first committed keyframe sets."""
    ratios = [_torque(name, t, q) / _torque(other, t, q) for t, q, _ in torque_sets(sets)]
    return float(np.median(ratios))


def _torque(name: str, times: FloatArray, keyframes: FloatArray) -> float:
    return fairness(builder(name, tolerance=1e-9)(times, keyframes))["torque"]


def reversal_deviation(name: str, count: int = 4, degrees: float = 60) -> float:
    """The largest angle, over the step, between a curve and that of the keyframes in reverse order."""
    times, keyframes = walked(count, degrees)
    forth, back = (builder(name)(times, q) for q in (keyframes, keyframes[::-1]))
    t = forth.keyframes.inside(SAMPLES)
    apart = quaternion.distance(forth(t), back(times[-1] - t))
    return float(apart.max() / np.radians(degrees))


def moved_by_a_flip(name: str, count: int = 5, degrees: float = 60, **options: Any) -> float:
    """Degrees by which a curve moves when the middle keyframe is given with the other sign."""
    times, keyframes = walked(count, degrees)
    flipped = quaternion.align(keyframes)
    straight = build(name, times, flipped)
    flipped[count // 2] *= -1.0
    astray = build(name, times, flipped, align=False, **options)
    t = straight.keyframes.inside(SAMPLES)
    return float(np.degrees(quaternion.distance(straight(t), astray(t)).max()))


def norm_error(name: str, count: int = 4, degrees: float = 60) -> float:
    """How far the length of a quaternion on the curve is off 1, at most."""
    curve = builder(name)(*walked(count, degrees))
    q = curve(curve.keyframes.inside(SAMPLES))
    return float(np.abs(np.linalg.norm(q, axis=-1) - 1.0).max())


def off_another(
    name: str, other: str, count: int = 4, degrees: float = 60, **options: Any
) -> float:
    """The largest angle in degrees between the curves of two schemes; options are the other's."""
    times, keyframes = walked(count, degrees)
    curve, wanted = builder(name)(times, keyframes), build(other, times, keyframes, **options)
    t = curve.keyframes.inside(SAMPLES)
    return float(np.degrees(quaternion.distance(curve(t), wanted(t)).max()))
