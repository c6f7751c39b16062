"""How far schemes that stand in for slerp are off it, on one arc in many frames.

Angles of an arc are taken on S^3: a rotation by twice the angle.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.catalogue import scheme
from quatspline.trajectories.walks import directions

SAMPLES = 8193
"""Samples of the arc, ends included: among them all points of a recurrence of up to 4096 steps."""


def largest_error(
    name: str, theta: float, rng: np.random.Generator, frames: int = 10, **options: Any
) -> float:
    """The largest angle in rad, as a rotation, between a scheme and slerp over one arc of S^3.

    Parameters
    ----------
    name : the scheme; ``options`` are its own
    theta : the arc's angle on S^3 in rad, 0 < theta < pi; the step is the rotation by 2 theta
    rng : draws the arcs: where they begin, and their axes
    frames : arcs tried, of which the worst counts

    Raises
    ------
    ValueError
        An arc that is none, and what the scheme refuses.
    """
    if not 0.0 < theta < math.pi:
        raise ValueError(f"theta={theta!r}: expected an angle between 0 and pi")
    begin = quaternion.normalise(rng.normal(size=(frames, 4)))
    axis = directions(rng, (frames,))
    u = np.linspace(0.0, 1.0, SAMPLES)
    # The short way is the scheme's only for arcs up to a right angle: signs are kept as given.
    ends = np.stack([begin, quaternion.mul(begin, quaternion.exp(theta * axis))])
    curve = scheme(name)(None, ends, align=False, **options)
    truth = quaternion.mul(begin, quaternion.exp(theta * u[:, None, None] * axis))
    return float(quaternion.distance(curve(u), truth).max())


def nlerp_error(theta: float) -> float:
    """The largest angle in rad, as a rotation, between nlerp and slerp over an arc theta of S^3.

    At u nlerp has come to atan2(u sin(theta), 1 - u + u cos(theta)) on the same arc.  It lags most
    where its rate is slerp's, at u (1 - u) = (1 - sin(theta)/theta) / (2 (1 - cos(theta))).
    """
    versine = 2.0 * math.sin(0.5 * theta) ** 2
    product = (1.0 - math.sin(theta) / theta) / (2.0 * versine)
    u = 0.5 - math.sqrt(0.25 - product)
    come = math.atan2(u * math.sin(theta), 1.0 - u * versine)
    return 2.0 * (u * theta - come)
