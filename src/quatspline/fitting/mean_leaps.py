"""Leaps of spherical means along a segment: where they are not unique.

The mean of four points that lie in one open half of S^3 is unique [buss2001] and moves smoothly with
its weights.  Beyond that the sum from which it is sought may vanish, and it leaps.
"""

from __future__ import annotations

import math

from quatspline.families.means import mean
from quatspline.kernels.jit import compiled, inlined
from quatspline.kernels.scalars import arc_angle

LEAP = 0.05
"""Half angle by which a mean moves at a leap, or else in a step that is too long ..."""
STRIDE, FINEST = 2.0**-6, 2.0**-16
"""... of the first of these shares of a segment, halved down to the second."""
FAINT, CAREFUL = 0.3, 2.0**-12
"""Length of a weighted sum of controls below which its direction says little of their mean, which may
lie elsewhere for a moment: steps are this short there."""


@inlined
def _weights_at(before, c, after, u):
    """B_{i-1} ... B_{i+2} at u."""
    v = 1.0 - u
    first, last = before * v * v * v, after * u * u * u
    inner = ((c[3] * u + c[2]) * u + c[1]) * u + c[0]
    return first, 1.0 - first - inner, inner - last, last


@inlined
def _dot(p, q):
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]


@compiled
def share_a_half(points):
    """Whether the four controls lie within a quarter turn of S^3 of their sum."""
    a, b, c, d = points
    s = (
        a[0] + b[0] + c[0] + d[0],
        a[1] + b[1] + c[1] + d[1],
        a[2] + b[2] + c[2] + d[2],
        a[3] + b[3] + c[3] + d[3],
    )
    return min(_dot(a, s), _dot(b, s), _dot(c, s), _dot(d, s)) > 0.0


@inlined
def _length(points, w):
    """The length of the weighted sum of four points."""
    total = 0.0
    for k in range(4):
        x = w[0] * points[0][k] + w[1] * points[1][k] + w[2] * points[2][k] + w[3] * points[3][k]
        total += x * x
    return math.sqrt(total)


@compiled
def leaps(points, before, c, after):
    """Whether the mean leaps on a segment: it moves by LEAP however short the step is made."""
    a, b, e, d = points
    u, step = 0.0, STRIDE
    here = mean(a, b, e, d, _weights_at(before, c, after, u))
    while u < 1.0:
        w = _weights_at(before, c, after, min(1.0, u + step))
        there = mean(a, b, e, d, w)
        theta, _, _ = arc_angle(*here, *there)
        longest = CAREFUL if _length(points, w) < FAINT else STRIDE
        if step > longest:
            step = longest
        elif theta < LEAP:
            u, here, step = u + step, there, min(2.0 * step, longest)
        elif step > FINEST:
            step *= 0.5
        else:
            return True
    return False
