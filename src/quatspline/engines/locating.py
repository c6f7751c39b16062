"""Where samples lie: their segments, their local parameters, and the blocks that neighbours form."""

from __future__ import annotations

import math

import numpy as np

from quatspline.kernels.jit import BLOCK, LANES, compiled, inlined

LONG = 16
"""Samples of one segment in a row that are worth a block of their own."""

MIXED = -1
"""In the place of a block's segment: its samples lie in several."""

INSIDE = -1
"""In the place of the first bad index: all samples lie in the domain."""


@compiled
def locate(knots, closed, origin, slack, t, segment, u, where, spans, owner):
    """Local parameter and segment of each sample, and the blocks that they form.

    Returns the number of blocks, the last segment, whether any sample lies in another period, and
    the first bad index.
    """
    made, start, wraps = 0, 0, False
    while start < t.size:
        first, n = np.uint16(start), np.uint16(min(BLOCK, t.size - start))
        lo, hi = knots[segment], knots[segment + 1]
        rate = 1.0 / (hi - lo)  # a product everywhere: long and mixed blocks agree
        inside = 0
        for j in range(n):
            x = t[first + j] - origin
            u[first + j] = (x - lo) * rate
            inside += (x >= lo) & (x < hi)
        count, i = inside, segment
        if inside < n:
            count = _leading(lo, hi, origin, t[start:])
        if count < LONG and inside < n:
            stop = start + n
            segment, around, bad = _one_by_one(
                knots,
                closed,
                origin,
                slack,
                t[start:stop],
                segment,
                u[start:stop],
                where[start:stop],
            )
            if bad != INSIDE:
                return made, segment, wraps, start + bad
            wraps |= around
            count, i = _run(where[start:stop])
            if i != MIXED:
                segment = i
        spans[2 * made], spans[2 * made + 1], owner[made] = first, count, i
        made += 1
        start += count
    return made, segment, wraps, INSIDE


@inlined
def beginning(knots, x):
    """The segment of a time, the first one where it lies in none."""
    return _find(knots, x, 0) if x >= 0.0 and x < knots[-1] else 0


@compiled
def _one_by_one(knots, closed, origin, slack, t, segment, u, where):
    """Local parameters and segments of samples of any order and place; see `_locate`."""
    wraps = False
    for j in range(t.size):
        x = t[j] - origin
        if not (x >= 0.0 and x < knots[-1]):
            if closed and abs(x) < np.inf:
                x = _wrapped(x, knots[-1])
                wraps = True
            elif not closed and x >= -slack and x <= knots[-1] + slack:
                x = min(max(x, 0.0), knots[-1])
            else:
                return segment, wraps, j
        if not (x >= knots[segment] and x < knots[segment + 1]):
            segment = _find(knots, x, segment)
        where[j] = segment
        u[j] = (x - knots[segment]) * (1.0 / (knots[segment + 1] - knots[segment]))
        if x >= knots[segment + 1]:  # the end of an open curve is its last keyframe, not a rounding
            u[j] = 1.0
    return segment, wraps, INSIDE


@inlined
def _leading(lo, hi, origin, t):
    """Samples in a row from the first on that lie in a segment, at most a block less one."""
    n = 0
    while n < min(BLOCK - 1, t.size) and t[n] - origin >= lo and t[n] - origin < hi:
        n += 1
    return n


@inlined
def _run(where):
    """Samples and segment of the block that begins here: a long run, or all, mixed."""
    n = 1
    while n < where.size and where[n] == where[0]:
        n += 1
    if n >= LONG or n == where.size:
        return n, where[0]
    return min(where.size, BLOCK - LANES), MIXED


@inlined
def _wrapped(x, period):
    """The time within the first period."""
    return min(max(x - math.floor(x / period) * period, 0.0), period)


@inlined
def _find(knots, x, segment):
    """The segment of x: the next one in a sorted sweep, the one of even knots, or by bisection."""
    last = knots.size - 2
    if segment < last and x >= knots[segment + 1] and x < knots[segment + 2]:
        return segment + 1
    even = min(int(x / knots[-1] * (last + 1)), last)
    if x >= knots[even] and x < knots[even + 1]:
        return even
    low, size = 0, last + 1
    while size > 1:  # without branches: an unforeseen one costs more than the whole step
        half = size >> 1
        low = low + half if knots[low + half] <= x else low
        size -= half
    return low
