"""Rates at a keyframe, limited so that the quintics that join them do not overshoot.

A quintic from 0 to the step l h whose rates at the ends are v, a and w, b along it has the progress

    0,  h v / 5,  2 h v / 5 + h^2 a / 20,  l h - 2 h w / 5 + h^2 b / 20,  l h - h w / 5,  l h     (1)

as Bezier coefficients.  They increase, and so does the quintic, if 0 <= v <= 5/2 l and

    -4 v <= h a <= 10 l - 8 v                                                                    (2)

at its start, and the mirror image of (2) at its end.  At a keyframe the conditions of both sides have to
hold for one a.  They can, where v <= 5/4 (h_0 l_1 + h_1 l_0) / (h_0 + h_1).

Every rule is the same read backwards in time, depends continuously on the steps, and leaves the rates
of dense keyframes of a motion alone.
"""

from __future__ import annotations

from quatspline.kernels.jit import inlined
from quatspline.kernels.values import norm, unit

# notation: log units (half rotation vectors); h0, h1 the spacings before and after a keyframe, n, p the
# unit vectors of the steps there, zero where a step is, l0, l1 the steps' lengths by time

KAPPA = 1.25
"""Of the velocity over the three-point one, see above; twice that over the slower side's."""

ACCELERATION = 10.0
"""Of the acceleration over the side's velocity by its spacing: the most that (2) allows, at v = 0."""


@inlined
def bounded(v, a, l0, l1, h0, h1):
    """v and a no longer than what the sides allow; a side that holds still allows nothing."""
    three_point = (h0 * l1 + h1 * l0) / (h0 + h1)
    v = _shortened(v, min(KAPPA * three_point, 2.0 * KAPPA * min(l0, l1)))
    return v, _shortened(a, ACCELERATION * min(l0 / h0, l1 / h1))


@inlined
def _shortened(x, most):
    length = norm(x)
    return (most / length if length > most else 1.0) * x


@inlined
def forward(v, n, p):
    """v without what leads back along either step: the mean of both orders.

    The nearest such vector would jump where the steps turn through half a turn.
    """
    return 0.5 * (_ahead(_ahead(v, n), p) + _ahead(_ahead(v, p), n))


@inlined
def _ahead(v, d):
    return v - min(v @ d, 0.0) * d


@inlined
def clipped(a, v, n, p, l0, l1, h0, h1):
    """a within (2) along both steps: the mean of both orders."""
    vn, vp = max(v @ n, 0.0), max(v @ p, 0.0)
    n0, n1 = min(8.0 * vn - 10.0 * l0, 4.0 * vn) / h0, 4.0 * vn / h0
    p0, p1 = -4.0 * vp / h1, max(10.0 * l1 - 8.0 * vp, -4.0 * vp) / h1
    one = _clamped(_clamped(a, n, n0, n1), p, p0, p1)
    other = _clamped(_clamped(a, p, p0, p1), n, n0, n1)
    return 0.5 * (one + other)


@inlined
def _clamped(a, d, low, high):
    """a with its component along the unit vector d between two bounds."""
    x = a @ d
    return a + (min(max(x, low), high) - x) * d


@inlined
def monotone(v, a, s0, s1, h0, h1, strict):
    """v and a of a keyframe between the slopes s0 and s1, limited; not ``strict``, in length only."""
    n, p, l0, l1 = unit(s0), unit(s1), norm(s0), norm(s1)
    if strict:
        v = forward(v, n, p)
    v, a = bounded(v, a, l0, l1, h0, h1)
    if strict:
        a = clipped(a, v, n, p, l0, l1, h0, h1)
    return v, a
