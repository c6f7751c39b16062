"""Leaps of spherical means along a segment: where they are not unique.

The mean of four points that lie in one open half of S^3 is unique [buss2001] and moves smoothly with
its weights.  Beyond that the sum from which it is sought may vanish, and it leaps.
"""

from __future__ import annotations

from quatspline.families.means import basis, mean, mixed
from quatspline.kernels.jit import compiled
from quatspline.kernels.values import arc, norm

LEAP = 0.05
"""Half angle by which a mean moves at a leap, or else in a step that is too long ..."""
STRIDE, FINEST = 2.0**-6, 2.0**-16
"""... of the first of these shares of a segment, halved down to the second."""
FAINT, CAREFUL = 0.3, 2.0**-12
"""Length of a weighted sum of controls below which its direction says little of their mean, which may
lie elsewhere for a moment: steps are this short there."""


@compiled
def share_a_half(points):
    """Whether the four controls lie within a quarter turn of S^3 of their sum."""
    a, b, c, d = points
    s = a + b + c + d
    return min(a @ s, b @ s, c @ s, d @ s) > 0.0


@compiled
def leaps(points, before, c, after):
    """Whether the mean leaps on a segment: it moves by LEAP however short the step is made."""
    u, step = 0.0, STRIDE
    w, _, _ = basis(before, c, after, u)
    here = mean(points, w)
    while u < 1.0:
        w, _, _ = basis(before, c, after, min(1.0, u + step))
        there = mean(points, w)
        theta, _, _ = arc(here, there)
        longest = CAREFUL if norm(mixed(w, points)) < FAINT else STRIDE
        if step > longest:
            step = longest
        elif theta < LEAP:
            u, here, step = u + step, there, min(2.0 * step, longest)
        elif step > FINEST:
            step *= 0.5
        else:
            return True
    return False
