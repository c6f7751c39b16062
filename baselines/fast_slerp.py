"""Slerp without sines: Eberly's polynomial in place of the ratios of sines."""

from __future__ import annotations

from functools import cache
from typing import Annotated

import numpy as np

from quatspline.families.chords import SIZE as CHORD
from quatspline.families.chords import (
    VERSINE,
    set_chord,
    weighted_acceleration,
    weighted_point,
    weighted_velocity,
)
from quatspline.kernels.family import Family
from quatspline.kernels.jit import (
    CONSTANTS,
    REACH,
    RESULT,
    fit_kernel,
    inlined,
    rows_of,
    sample_kernel,
)
from quatspline.kernels.values import keyframe, put_quat, put_vec
from quatspline.keyframes import Keyframes
from quatspline.options import AtMost, Count
from quatspline.segments import SegmentCurve

# notation: y = 1 - cos(theta); constants of a segment: its chord, then the number of terms and the
# correction of the last term.  Rows behind them hold f and its u-derivatives for both weights.
GRID, TAIL = 257, 60
"""Points each way, and further terms that stand for the exact f: each less than half the last."""

TERMS, LAST = CHORD, CHORD + 1
SIZE = CHORD + 2

_Y = CONSTANTS + VERSINE
_F, _G = CONSTANTS + SIZE, CONSTANTS + SIZE + 3


@inlined
def _nest(s, n, order):
    """F of (2) by Horner, f = u F, at 1 - u (rows _F) and u (rows _G), with derivatives in u."""
    terms, last = int(s[CONSTANTS + TERMS, 0]), s[CONSTANTS + LAST, 0]
    for r in range(order + 1):
        for j in range(n):
            s[_F + r, j] = s[_G + r, j] = 1.0 if r == 0 else 0.0
    for k in range(terms, 0, -1):
        scale = (last if k == terms else 1.0) / (k * (2.0 * k + 1.0))
        for j in range(n):
            u, y = s[0, j], scale * s[_Y, j]
            v = 1.0 - u
            f, g = (k * k - v * v) * y, (k * k - u * u) * y
            if order > 0:
                f1, g1 = 2.0 * v * y, -2.0 * u * y
                if order > 1:
                    w = 2.0 * y
                    s[_F + 2, j] = f * s[_F + 2, j] + 2.0 * f1 * s[_F + 1, j] - w * s[_F, j]
                    s[_G + 2, j] = g * s[_G + 2, j] + 2.0 * g1 * s[_G + 1, j] - w * s[_G, j]
                s[_F + 1, j] = f * s[_F + 1, j] + f1 * s[_F, j]
                s[_G + 1, j] = g * s[_G + 1, j] + g1 * s[_G, j]
            s[_F, j] = 1.0 + f * s[_F, j]
            s[_G, j] = 1.0 + g * s[_G, j]


@sample_kernel
def ORIENTATION(sheet, n):
    """(1)."""
    s = rows_of(sheet)
    _nest(s, n, 0)
    for j in range(n):
        u, f, g = s[0, j], s[_F, j], s[_G, j]
        put_quat(s[RESULT:, j], 0, weighted_point(s[CONSTANTS:, j], (1.0 - u) * f, u * g))


@sample_kernel
def VELOCITY(sheet, n):
    """The exact omega of (1)."""
    s = rows_of(sheet)
    _nest(s, n, 1)
    for j in range(n):
        u, f, f1, g, g1 = s[0, j], s[_F, j], s[_F + 1, j], s[_G, j], s[_G + 1, j]
        v, rate = 1.0 - u, 2.0 * s[1, j]
        rates = weighted_velocity(s[CONSTANTS:, j], v * f, v * f1 - f, u * g, u * g1 + g)
        put_vec(s[RESULT:, j], 0, rate * rates)


@sample_kernel
def ACCELERATION(sheet, n):
    """The exact alpha of (1): near zero, as slerp's."""
    s = rows_of(sheet)
    _nest(s, n, 2)
    for j in range(n):
        u, f, f1, f2 = s[0, j], s[_F, j], s[_F + 1, j], s[_F + 2, j]
        g, g1, g2 = s[_G, j], s[_G + 1, j], s[_G + 2, j]
        v, rate = 1.0 - u, 2.0 * s[1, j] * s[1, j]
        a, b = (v * f, v * f1 - f, v * f2 - 2.0 * f1), (u * g, u * g1 + g, u * g2 + 2.0 * g1)
        put_vec(s[RESULT:, j], 0, rate * weighted_acceleration(s[CONSTANTS:, j], *a, *b))


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The chord from each keyframe to the next; parameters: terms, correction of the last."""
    reach = 0.0
    for i in range(h.size):
        c = segments[i]
        reach = max(reach, set_chord(c, keyframe(q, i, sign), keyframe(q, i + 1, sign)))
        c[TERMS], c[LAST] = parameters[0], parameters[1]
    report[REACH] = reach


@cache
def _balanced(terms: int) -> tuple[float, float]:
    """The factor of the last term with the least largest error, and the angle error left."""
    u, y = np.meshgrid(np.linspace(0.0, 1.0, GRID), np.linspace(0.0, 1.0, GRID)[1:], indexing="ij")
    term, kept, rest, last = u, u, np.zeros_like(u), u
    for k in range(1, terms + TAIL):
        term = term * (k * k - u * u) * y / (k * (2 * k + 1))
        if k < terms:
            kept = kept + term
        elif k == terms:
            last = term
        else:
            rest = rest + term
    low, high = 0.0, 2.0
    for _ in range(100):  # the largest error is convex in the excess: ternary search
        a, b = (2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0
        if np.abs(rest - a * last).max() < np.abs(rest - b * last).max():
            high = b
        else:
            low = a
    f = kept + (1.0 + low) * last
    theta = np.arccos(1.0 - y)
    angle = np.arctan2(f * np.sin(theta), f[::-1] + f * (1.0 - y))
    return 1.0 + low, float(2.0 * np.abs(angle - u * theta).max())


_KERNELS = (ORIENTATION, VELOCITY, ACCELERATION)


class FastSlerp(SegmentCurve):
    """Slerp by the polynomial of Eberly (2011), normalised: no sine, no branch.

    C^0, interpolating, local (two keyframes shape a segment); with y = 1 - cos(theta),

        Q(u) = (f(1 - u) q_i + f(u) q_{i+1}) / |...|,    f(u) ~ sin(u theta) / sin(theta)        (1)
        f(u) = u (1 + b_1 (1 + b_2 (1 + ... b_m))),    b_k = (k^2 - u^2) y / (k (2k + 1))        (2)

    where b_m is enlarged by the factor that makes the largest error over theta <= pi/2 least (for
    m = 8 Eberly's 1.85298109).  Largest angle from slerp over steps up to half a turn, measured:
    6e-4 rad with 4 terms, 1.7e-5 with 8, 2.5e-8 with 16, 1.5e-13 with 32 [eberly2011].

    Options
    -------
    terms
        m, the terms kept.
    """

    title = "Fast slerp by Eberly's polynomial"
    reference = "eberly2011"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "no"
    family = Family(SIZE, near=_KERNELS, far=_KERNELS)

    angle_error: float
    """The largest angle from slerp over all steps up to half a turn, measured, in rad."""

    def _fit(self, keyframes: Keyframes, *, terms: Annotated[Count, AtMost(1000)] = 8) -> None:
        last, self.angle_error = _balanced(terms)
        self._solve(FIT, np.array([terms, last]))
