"""The error of moving frames and its constant, against what is known of splines in flat space.

A spline of odd degree k = 2m - 1 through a smooth F on uniform knots, away from the ends, is off by

    h^(2m) F^(2m) (B_2m(u) - B_2m) / (2m)!                                                         (1)

to leading order, B Bernoulli's polynomials, and by no more than h^(2m) max |F^(2m)| |E_2m| / (2^2m (2m)!), E Euler's
numbers, whatever F is.  An error E of the frame turns the nearest rotation by vee(R^T E) / 2.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.catalogue import build
from quatspline.instruments.trials import Row
from quatspline.quaternion import FloatArray
from quatspline.trajectories.rolling import PERIOD, rolling, rolling_matrices

BERNOULLI = {4: 1 / 30, 6: 1 / 42, 8: 1 / 30, 10: 5 / 66}
EULER = {4: 5, 6: 61, 8: 1385, 10: 50521}
"""Their absolute values."""

SAMPLES = 9
"""Samples of a segment, the middle, where (1) is largest, among them."""

ROUNDING = 1e-14
"""Errors in rad below are rounding, of which no order and no constant is read."""


def smooth_constant(degree: int) -> float:
    """max |B_2m(u) - B_2m| / (2m)!, at u = 1/2."""
    m = degree + 1
    return (2.0 - 2.0 ** (1 - m)) * BERNOULLI[m] / math.factorial(m)


def worst_constant(degree: int) -> float:
    """|E_2m| / (2^2m (2m)!): that of the worst function on uniform knots."""
    m = degree + 1
    return EULER[m] / (2.0**m * math.factorial(m))


def frame_error(degree: int, ends: str, keyframes: int) -> Row:
    """Of moving frames through so many keyframes of a period of `rolling`.

    ``ends`` is "closed", "given" (complete with the motion's own velocities and, from degree 5, accelerations),
    or an option of the scheme.  angle: largest error in rad; constant: over h^(k+1); expected: that of (1);
    axis_constant: largest error of a matrix entry over h^(k+1) max |R^(k+1)|; axis_bound: `worst_constant`.
    """
    closed = ends == "closed"
    times = np.linspace(0.0, PERIOD, keyframes + closed)
    options: dict[str, Any] = {"degree": degree, "closed": closed}
    if ends == "given":
        options |= _end_rates(degree)
    elif not closed:
        options["ends"] = ends
    curve: Any = build("moving-frame", times, rolling(times[:keyframes]), **options)
    t, h = curve.keyframes.inside(SAMPLES), float(times[1])
    power, bound = degree + 1, rolling_matrices(t, degree + 1)
    angle = float(quaternion.distance(curve(t), rolling(t)).max())
    entries = np.stack([axis(t) for axis in curve.axes], axis=-1) - rolling_matrices(t)
    known = angle > ROUNDING
    return {
        "spacing": h,
        "angle": angle,
        "constant": angle / h**power if known else None,
        "expected": smooth_constant(degree) * float(_turned(t, bound).max()),
        "axis_constant": float(np.abs(entries).max() / (h**power * np.abs(bound).max()))
        if known
        else None,
        "axis_bound": worst_constant(degree),
    }


def _turned(t: FloatArray, change: FloatArray) -> FloatArray:
    """|vee(R^T E)| / 2 of changes (m, 3, 3) of the motion's matrices at t."""
    s = np.swapaxes(rolling_matrices(t), -1, -2) @ change
    v = np.stack(
        [s[:, 2, 1] - s[:, 1, 2], s[:, 0, 2] - s[:, 2, 0], s[:, 1, 0] - s[:, 0, 1]], axis=-1
    )
    return np.asarray(0.5 * np.linalg.norm(v, axis=-1))


def _end_rates(degree: int) -> dict[str, FloatArray]:
    """What the motion does at its ends: omega = vee(R^T R'), alpha = vee(R^T R'' - [omega]^2)."""
    rates = {}
    for name, at in (("start", 0.0), ("end", PERIOD)):
        r, r1, r2 = (rolling_matrices(np.array([at]), order)[0] for order in range(3))
        spin = r.T @ r1
        for rate, s in (("velocity", spin), ("acceleration", r.T @ r2 - spin @ spin)):
            rates[f"{name}_{rate}"] = np.array([s[2, 1], s[0, 2], s[1, 0]])
    return {name: v for name, v in rates.items() if degree > 3 or name.endswith("velocity")}
