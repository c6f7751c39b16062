"""Circular blending of Kim & Nam: circles through three keyframes, blended by slerp."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from quatspline.families.circles import BLEND, SPLIT, combine, dot, set_circle, unit
from quatspline.fitting.tangents import keyframe
from quatspline.kernels.jit import compiled, fit_kernel, inlined
from quatspline.kernels.operations import Operations, Per
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve

SAME = 1e-12
"""Keyframes nearer than this are one: the direction from one to the other is rounding."""

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
    operations = Operations(slerps=Per(sample=1), others={"circle points": Per(sample=2)})

    def _fit(self, keyframes: Keyframes, *, blend: Literal["smooth", "linear"] = "smooth") -> None:
        self.continuity = 2 if blend == "smooth" else 1
        self._solve(FIT, np.array(BLENDS[blend]))


@inlined
def _chord(b, p):
    """p - b, its part along b that of the sphere, whatever rounding says."""
    d = combine(1.0, p, -1.0, b)
    return combine(1.0, d, -dot(d, b) - 0.5 * dot(d, d), b)


@compiled
def _circle(a, b, c):
    """The circle through a, b, c as seen from b: X, Y of `circles` (1) and the angles of a and c.

    In the plane with b at the origin and the farther of a and c at (l, 0), the other one at (x, y),
    the centre is (l/2, k).  What is small is taken from the shortest of the three chords.
    """
    ba, bc = _chord(b, a), _chord(b, c)
    ac = combine(1.0, bc, -1.0, ba)
    if min(dot(ba, ba), dot(bc, bc), dot(ac, ac)) < SAME * SAME:
        return _great(a, b, c)
    onward = dot(bc, bc) > dot(ba, ba)  # c is the farther one
    far, near = (bc, ba) if onward else (ba, bc)
    back = combine(1.0, near, -1.0, far)
    ahead, length = unit(far), math.sqrt(dot(far, far))
    x = dot(near, ahead)
    short = near if dot(near, near) < dot(back, back) else back
    aside = combine(1.0, short, -dot(short, ahead), ahead)
    aside = combine(1.0, aside, -dot(aside, ahead), ahead)
    y = math.sqrt(dot(aside, aside))
    if y == 0.0:
        return _great(a, b, c)
    k = 0.5 * (x * dot(back, ahead) / y + y)
    # X points to the side on which c comes before a; a chord p is seen at half the angle of its arc,
    # atan2(p . Y, p . X), from the centre, with p . Y = |p|^2 / 2
    e, f = (k, -0.5 * length) if onward else (-k, 0.5 * length)
    aside = unit(aside)
    tangent, centre = combine(e, ahead, f, aside), combine(0.5 * length, ahead, k, aside)
    square, along = 0.5 * length * length, length * e
    square_near, along_near = 0.5 * (x * x + y * y), x * e + y * f
    if onward:
        return (
            tangent,
            centre,
            -2.0 * math.atan2(square_near, -along_near),
            2.0 * math.atan2(square, along),
        )
    return (
        tangent,
        centre,
        -2.0 * math.atan2(square, -along),
        2.0 * math.atan2(square_near, along_near),
    )


@compiled
def _great(a, b, c):
    """The great circle through b and the farther of a and c, for triples that hold two points."""
    ba, bc = combine(1.0, a, -1.0, b), combine(1.0, c, -1.0, b)
    if max(dot(ba, ba), dot(bc, bc)) < SAME * SAME:  # a point
        return combine(0.0, b, 0.0, b), combine(-1.0, b, 0.0, b), 0.0, 0.0
    far = c if dot(bc, bc) >= dot(ba, ba) else a
    x = unit(combine(1.0, far, -dot(far, b), b))
    x = unit(combine(1.0, x, -dot(x, b), b))  # twice: b may be nearly its antipode
    before, after = math.atan2(dot(a, x), dot(a, b)), math.atan2(dot(c, x), dot(c, b))
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
    # the quadratic in t through (-h_0, before), (0, 0), (h_1, after) bends by r = (slopes' step) / time
    n = h.size
    h0, h1, own = h[(j - 1) % n], h[j % n], h[i]
    r = (after / h1 + before / h0) / (h0 + h1)
    bend = -r * own * own
    if i == j:  # the segment begins at t_j, or at t_{j-1}
        set_circle(segments, i, k, b, x, y, 0.0, after, bend)
    else:
        set_circle(segments, i, k, b, x, y, before, -before, bend)


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
