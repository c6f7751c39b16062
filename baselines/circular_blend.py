"""Circular blending of Kim & Nam: circles through three keyframes, blended by slerp."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from quatspline._jit import compiled, fit_kernel
from quatspline.families.circles import BLEND, SPLIT, combine, dot, set_circle, unit
from quatspline.families.segments import SegmentCurve
from quatspline.families.tangents import keyframe
from quatspline.keyframes import Keyframes

FLAT = 4 * np.finfo(float).eps
"""Three points whose triangle is lower than this hold only two: a great circle goes through them."""

BLENDS = {"smooth": (0.0, 3.0, -2.0), "linear": (1.0, 0.0, 0.0)}
"""Coefficients of f from u^1 to u^3."""


class CircularBlend(SegmentCurve):
    """Circular blending of Kim & Nam (1995): slerp between circles through three keyframes.

    C^2, interpolating, local (four keyframes shape a segment), order 3.  C_i is the circle on S^3 through
    q_{i-1}, q_i, q_{i+1}, run through in this order, its angle the quadratic in t that meets them at
    their times; on the segment from q_i to q_{i+1}

        Q(u) = slerp(C_i(t), C_{i+1}(t); f(u)),    f = 3u^2 - 2u^3                                 (1)

    and one circle alone on the first and on the last segment.  The quadratic angle is our choice
    [kim1995circular].  Where the motion turns back, the circle is nearly a full one; at an exact
    return, or at a repeated keyframe, the great circle through the two points is taken to and fro.

    Options
    -------
    blend
        "smooth": f of (1).  "linear": f = u, which is C^1.
    """

    title = "Circular blending"
    reference = "kim1995circular"
    continuity = 2
    order = 3
    support = 4
    constant_rate = "everywhere"
    family = BLEND
    operations = {"circle points per sample": 2, "slerps per sample": 1}

    def _fit(self, keyframes: Keyframes, *, blend: Literal["smooth", "linear"] = "smooth") -> None:
        self.continuity = 2 if blend == "smooth" else 1
        self._solve(FIT, np.array(BLENDS[blend]))


@compiled
def _circle(a, b, c):
    """The circle through a, b, c as seen from b: X, Y of `circles` (1) and the angles of a and c."""
    ab, ac, bc = combine(1.0, b, -1.0, a), combine(1.0, c, -1.0, a), combine(1.0, c, -1.0, b)
    size = dot(ab, ab)
    height = combine(1.0, ac, -dot(ab, ac) / size if size > 0.0 else 0.0, ab)
    if size == 0.0 or dot(height, height) <= FLAT * FLAT:
        return _great(a, b, c)
    # inscribed angles are half of the arcs, r = |ab| |bc| |ac| / (2 |ab x ac|)
    area = math.sqrt(size * dot(height, height))
    before, after = -2.0 * math.atan2(area, dot(ac, bc)), 2.0 * math.atan2(area, dot(ab, ac))
    r = 0.5 * math.sqrt(size * dot(bc, bc) * dot(ac, ac)) / area
    # in the plane: towards = ab/|ab|, away = height/|height|; the centre sees ab at half its angle
    towards, away = unit(ab), unit(height)
    half = 0.5 * before
    x = combine(r * math.cos(half), towards, -r * math.sin(half), away)
    y = combine(r * math.sin(half), towards, r * math.cos(half), away)
    return x, y, before, after


@compiled
def _great(a, b, c):
    """The great circle through b and the farther of a and c, for triples that hold two points."""
    ba, bc = combine(1.0, a, -1.0, b), combine(1.0, c, -1.0, b)
    far = bc if dot(bc, bc) >= dot(ba, ba) else ba
    x = unit(combine(1.0, far, 0.5 * dot(far, far), b))  # far . b = -|far|^2 / 2
    before, after = math.atan2(dot(ba, x), dot(a, b)), math.atan2(dot(bc, x), dot(c, b))
    return x, combine(-1.0, b, 0.0, b), before, after


@compiled
def _set(segments, i, k, q, j, sign, closed, h):
    """Circle k of segment i: the one through q_j and its neighbours, with its angle in u."""
    b = keyframe(q, j, sign)
    if q.shape[0] == 2 and not closed:
        x, y, _, after = _great(b, b, keyframe(q, j + 1, sign))
        set_circle(segments, i, k, b, x, y, 0.0, after, 0.0)
        return
    x, y, before, after = _circle(keyframe(q, j - 1, sign), b, keyframe(q, j + 1, sign))
    # angle = s (p + r s) with s = t - t_j: Newton's form through (-h_0, before), (0, 0), (h_1, after)
    n = h.size
    h0, h1, own = h[(j - 1) % n], h[j % n], h[i]
    left, right = before / -h0, after / h1
    r = (right - left) / (h0 + h1)
    p = left + r * h0
    s = 0.0 if i == j else -h0  # the segment begins at t_j or at t_{j-1}
    set_circle(segments, i, k, b, x, y, s * (p + r * s), own * (p + 2.0 * r * s), own * own * r)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The two circles of every segment."""
    n = q.shape[0]
    for i in range(h.size):
        first = i if closed else max(i, 1)
        second = i + 1 if closed else min(i + 1, n - 2)
        if n == 2 and not closed:
            first = second = 0
        _set(segments, i, 0, q, min(first, second), sign, closed, h)
        _set(segments, i, 1, q, max(first, second), sign, closed, h)
        for c in range(3):
            segments[i, SPLIT + c] = parameters[c]
