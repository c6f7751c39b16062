"""Rates at a keyframe, limited so that the quintics that join them do not overshoot.

A quintic from 0 to l h with the rates v, a at its start and w, b at its end has a derivative whose Bezier
coefficients are, by the spacing h,

    v,  d = v + h a / 4,  5 l - (v + d) - (w + e),  e = w - h b / 4,  w                          (1)

It increases if v, d, w, e >= 0 and the middle one is at least -4/3 sqrt(d e).  So it does if each end, for
itself, keeps to one of

    v + d <= (5/2 + c) l  and  d >= 3/2 c l,     or     v + d <= (5/2 - c) l                     (2)

with one c >= 0, the slack: two ends of the first kind have 4/3 sqrt(d e) >= 2 c l.  With c = 0 all
coefficients are positive.  The second kind is taken up to v = 5/2 (1 - c) l and left gradually below
it.  At a keyframe the conditions of both sides have to hold for one a; they can, where

    v <= (5/4 + c/2) (h_0 l_1 + h_1 l_0) / (h_0 + h_1),     v <= (5/2 - c/2) min(l_0, l_1)        (3)

Every rule is the same read backwards in time, depends continuously on the steps, and leaves the rates
of dense keyframes of a motion alone.
"""

from __future__ import annotations

from quatspline.kernels.jit import inlined
from quatspline.kernels.values import norm, unit

# notation: log units (half rotation vectors); h0, h1 the spacings before and after a keyframe, n, p the
# unit vectors of the steps there, zero where a step is, l0, l1 the steps' lengths by time

HALF = 2.5
"""Of l: what an end may have of (1)'s middle."""

AHEAD, WITHIN = 24, 8
"""How often `forward` and `clipped` are applied: once leaves a part of what leads back, off one axis."""

GRADUAL = 3.0
"""How many times faster than v the least d rises with it."""


@inlined
def bounded(v, a, l0, l1, h0, h1, slack):
    """v within (3), a no longer than (2) allows at v = 0; a side that holds still allows nothing."""
    most = HALF + slack
    three_point = (h0 * l1 + h1 * l0) / (h0 + h1)
    v = _shortened(v, min(0.5 * most * three_point, (HALF - 0.5 * slack) * min(l0, l1)))
    return v, _shortened(a, 4.0 * most * min(l0 / h0, l1 / h1))


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
def clipped(a, v, n, p, l0, l1, h0, h1, slack):
    """a within (2) along both steps: the mean of both orders."""
    n0, n1 = interval(max(v @ n, 0.0), l0, slack)
    p0, p1 = interval(max(v @ p, 0.0), l1, slack)
    n0, n1, p0, p1 = -n1 / h0, -n0 / h0, p0 / h1, p1 / h1
    one = _clamped(_clamped(a, n, n0, n1), p, p0, p1)
    other = _clamped(_clamped(a, p, p0, p1), n, n0, n1)
    return 0.5 * (one + other)


@inlined
def interval(v, l, slack):
    """The least and the largest h a after a keyframe by (2); before it, negated."""
    held = 1.5 * slack * l
    least = min(max(held - GRADUAL * (HALF * (1.0 - slack) * l - v), 0.0), held)
    low = 4.0 * (least - v)
    return low, max(4.0 * ((HALF + slack) * l - 2.0 * v), low)


@inlined
def _clamped(a, d, low, high):
    """a with its component along the unit vector d between two bounds."""
    x = a @ d
    return a + (min(max(x, low), high) - x) * d


@inlined
def monotone(v, a, s0, s1, h0, h1, strict, slack):
    """v and a of a keyframe between the slopes s0 and s1, limited; not ``strict``, in length only."""
    n, p, l0, l1 = unit(s0), unit(s1), norm(s0), norm(s1)
    if strict:
        for _ in range(AHEAD):
            if v @ n >= 0.0 and v @ p >= 0.0:
                break
            v = forward(v, n, p)
    v, a = bounded(v, a, l0, l1, h0, h1, slack)
    if strict:
        for _ in range(WITHIN):
            given, a = a, clipped(a, v, n, p, l0, l1, h0, h1, slack)
            if (a - given) @ (a - given) == 0.0:
                break
    return v, a
