"""A closed motion whose matrices can be differentiated any number of times: a spin times a roll.

R(t) = exp[A t] exp[B t] with [A] x = A x x of constant vectors, closed after `PERIOD`, has the derivatives

    R^(m) = sum_j binom(m, j) [A]^j R_A R_B [B]^(m - j).                                           (1)
"""

from __future__ import annotations

import math

import numpy as np

from quatspline import quaternion
from quatspline.quaternion import FloatArray

SPIN, ROLL = np.array([0.6, 0.0, 0.8]), np.array([0.0, 2.0, 0.0])
"""A and B in rad per time: one turn and two in a period."""

PERIOD = 2.0 * math.pi


def rolling(t: FloatArray) -> FloatArray:
    """Orientations (m, 4) at t (m,)."""
    half = 0.5 * t[:, None]
    return quaternion.mul(quaternion.exp(half * SPIN), quaternion.exp(half * ROLL))


def rolling_matrices(t: FloatArray, order: int = 0) -> FloatArray:
    """(1): derivative ``order`` of the matrices, (m, 3, 3), at t (m,)."""
    a, b = ([np.linalg.matrix_power(_hat(v), j) for j in range(order + 1)] for v in (SPIN, ROLL))
    turns = _matrices(quaternion.exp(0.5 * t[:, None] * SPIN)) @ _matrices(
        quaternion.exp(0.5 * t[:, None] * ROLL)
    )
    terms = (math.comb(order, j) * a[j] @ turns @ b[order - j] for j in range(order + 1))
    return sum(terms, np.zeros_like(turns))


def _hat(v: FloatArray) -> FloatArray:
    """[v], with [v] x = v x x."""
    return -np.cross(np.eye(3), v).T


def _matrices(q: FloatArray) -> FloatArray:
    """R(q) of q (m, 4)."""
    return np.swapaxes(quaternion.rotate(q[:, None], np.eye(3)), -1, -2)
