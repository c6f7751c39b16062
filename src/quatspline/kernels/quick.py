"""Exponential and logarithm for iterations, whose vectors are mostly short: cheaper there."""

from __future__ import annotations

from quatspline.kernels.jit import inlined
from quatspline.kernels.scalars import FITTED, sinc, sinc_near
from quatspline.kernels.values import log as any_log
from quatspline.kernels.values import polar_exp, vec

SHORT = 1e-3
"""Squared length of a vector part up to which five terms of the arc sine are exact to rounding."""


@inlined
def exp(v):
    """The unit quaternion exp(v)."""
    z = v @ v
    if z < FITTED:
        s, c = sinc_near(z)
    else:
        s, c = sinc(z)
    return polar_exp(s, c, v)


@inlined
def log(q):
    """The principal logarithm of a unit quaternion."""
    n = vec(q) @ vec(q)
    if q.w > 0.0 and n < SHORT:
        return (1.0 + n * (1 / 6 + n * (3 / 40 + n * (15 / 336 + n * (105 / 3456))))) * vec(q)
    return any_log(q)
