"""The loops of families over the samples of a block: templates, copied for each function (see `family`)."""

from __future__ import annotations

from typing import Any

from quatspline.kernels.jit import CONSTANTS, RESULT, ROWS, rows_of
from quatspline.kernels.values import put_quat, put_vec, quat_at, restored

ROUGH = 5e-7
"""Squares of lengths off 1 by more than this are restored by a root: to 1e-13 without one."""

# Constants are s[CONSTANTS:ROWS], with the end: without one, numba's slice keeps loops from vectorising.

FUNCTION: Any = None
SPARE: Any = None
COUNT: Any = None
"""What a copy of a template finds in their place."""


def orientation(sheet, n):
    """Order 0, of functions whose values are of unit length."""
    s = rows_of(sheet)
    for j in range(n):
        put_quat(s[RESULT:, j], 0, FUNCTION(s[CONSTANTS:ROWS, j], s[0, j]))


def unit_orientation(sheet, n):
    """Order 0, of functions whose values are nearly of unit length."""
    s = rows_of(sheet)
    rough = 0
    for j in range(n):
        q = FUNCTION(s[CONSTANTS:ROWS, j], s[0, j])
        # off by e, 1.5 - |q|^2 / 2 restores the length to 3/2 e^2, without a root and a division
        fine = abs(q @ q - 1.0) <= ROUGH
        put_quat(s[RESULT:, j], 0, (1.5 - 0.5 * (q @ q) if fine else 1.0) * q)
        rough += 0 if fine else 1
    if rough > 0:
        for j in range(n):
            spare = SPARE(s[CONSTANTS:ROWS, j], s[0, j])
            put_quat(s[RESULT:, j], 0, restored(quat_at(s[RESULT:, j], 0), spare))


def velocity(sheet, n):
    """Order 1."""
    s = rows_of(sheet)
    for j in range(COUNT(n)):
        put_vec(s[RESULT:, j], 0, (2.0 * s[1, j]) * FUNCTION(s[CONSTANTS:ROWS, j], s[0, j]))


def acceleration(sheet, n):
    """Order 2."""
    s = rows_of(sheet)
    for j in range(COUNT(n)):
        rate = 2.0 * s[1, j] * s[1, j]
        put_vec(s[RESULT:, j], 0, rate * FUNCTION(s[CONSTANTS:ROWS, j], s[0, j]))
