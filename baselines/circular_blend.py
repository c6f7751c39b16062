"""Circular blending of Kim & Nam: circles through three keyframes, blended by slerp."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from quatspline.families.circles import BLEND, FIRST, SECOND, SPLIT, set_circle
from quatspline.kernels.jit import REACH, compiled, fit_kernel, inlined
from quatspline.kernels.values import keyframe, norm, unit
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

    def _fit(self, keyframes: Keyframes, *, blend: Literal["smooth", "linear"] = "smooth") -> None:
        self.continuity = 2 if blend == "smooth" else 1
        self._solve(FIT, np.array(BLENDS[blend]))


@inlined
def _chord(b, p):
    """p - b, its part along b that of the sphere, whatever rounding says."""
    d = p - b
    return d - (d @ b + 0.5 * (d @ d)) * b


@compiled
def _circle(a, b, c):
    """The circle through a, b, c as seen from b: X, Y of `circles` (1) and the angles of a and c.

    In the plane with b at the origin and the farther of a and c at (l, 0), the other one at (x, y),
    the centre is (l/2, k).  What is small is taken from the shortest of the three chords.
    """
    ba, bc = _chord(b, a), _chord(b, c)
    ac = bc - ba
    if min(ba @ ba, bc @ bc, ac @ ac) < SAME * SAME:
        return _great(a, b, c)
    onward = bc @ bc > ba @ ba  # c is the farther one
    far, near = (bc, ba) if onward else (ba, bc)
    back = near - far
    ahead, length = unit(far), norm(far)
    x = near @ ahead
    short = near if near @ near < back @ back else back
    aside = short - (short @ ahead) * ahead
    aside = aside - (aside @ ahead) * ahead
    y = norm(aside)
    if y == 0.0:
        return _great(a, b, c)
    k = 0.5 * (x * (back @ ahead) / y + y)
    # X points to the side on which c comes before a; a chord p is seen at half the angle of its arc,
    # atan2(p . Y, p . X), from the centre, with p . Y = |p|^2 / 2
    e, f = (k, -0.5 * length) if onward else (-k, 0.5 * length)
    aside = unit(aside)
    tangent, centre = e * ahead + f * aside, (0.5 * length) * ahead + k * aside
    distant = 0.5 * length * length, length * e
    close = 0.5 * (x * x + y * y), x * e + y * f
    of_a, of_c = (close, distant) if onward else (distant, close)
    before, after = -2.0 * math.atan2(of_a[0], -of_a[1]), 2.0 * math.atan2(of_c[0], of_c[1])
    return tangent, centre, before, after


@compiled
def _great(a, b, c):
    """The great circle through b and the farther of a and c, for triples that hold two points."""
    ba, bc = a - b, c - b
    if max(ba @ ba, bc @ bc) < SAME * SAME:  # a point
        return 0.0 * b, -b, 0.0, 0.0
    far = c if bc @ bc >= ba @ ba else a
    x = unit(far - (far @ b) * b)
    x = unit(x - (x @ b) * b)  # twice: b may be nearly its antipode
    return x, -b, math.atan2(a @ x, a @ b), math.atan2(c @ x, c @ b)


@compiled
def _set(c, k, q, i, j, sign, closed, h):
    """A circle of segment i at places k ...: the one through q_j and its neighbours, its angle in u."""
    b = keyframe(q, j, sign)
    if q.shape[0] == 2 and not closed:
        x, y, _, after = _great(b, b, keyframe(q, j + 1, sign))
        set_circle(c, k, b, x, y, (0.0, after, 0.0))
        return
    x, y, before, after = _circle(keyframe(q, j - 1, sign), b, keyframe(q, j + 1, sign))
    # the quadratic in t through (-h_0, before), (0, 0), (h_1, after) bends by r = (slopes' step) / time
    n = h.size
    h0, h1, own = h[(j - 1) % n], h[j % n], h[i]
    r = (after / h1 + before / h0) / (h0 + h1)
    bend = -r * own * own
    if i == j:  # the segment begins at t_j, or at t_{j-1}
        set_circle(c, k, b, x, y, (0.0, after, bend))
    else:
        set_circle(c, k, b, x, y, (before, -before, bend))


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The two circles of every segment."""
    n = q.shape[0]
    for i in range(h.size):
        first = i if closed else max(i, 1)
        second = i + 1 if closed else min(i + 1, n - 2)
        if n == 2 and not closed:
            first = second = 0
        _set(segments[i], FIRST, q, i, min(first, second), sign, closed, h)
        _set(segments[i], SECOND, q, i, max(first, second), sign, closed, h)
        for k in range(3):
            segments[i, SPLIT + k] = parameters[k]
    report[REACH] = 0.0
