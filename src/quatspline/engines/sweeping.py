"""Long runs of one track's samples: located, evaluated and stored block by block.

Sorted times that lie densely need no batch: a block's samples are compared with the ends of one segment, all at once,
and their local parameters are written where the kernel reads them.  Reading, arithmetic and writing alternate
every few dozen samples, so that memory works while the kernel does.
"""

from __future__ import annotations

from numba import carray

from quatspline.engines.blocks import spread, store
from quatspline.engines.intrinsics import call_sample
from quatspline.engines.locating import LONG, MIXED
from quatspline.engines.transposing import TOGETHER
from quatspline.kernels.jit import BLOCK, ROWS, compiled, inlined


@compiled
def sweep(address, order, knots, segments, origin, t, out, segment, pointer):
    """Evaluate samples from the first on, while they come in long runs; how many did, and a segment to go on from.

    Runs lie in ``segment`` and those that follow it; what comes otherwise, or outside the domain, is left.
    """
    sheet = carray(pointer, (ROWS, BLOCK))
    start, filled, last = 0, MIXED, knots.size - 2
    while start < t.size:
        n = _placed(knots, segment, origin, t[start:], sheet)
        if n == 0:
            break
        if n < LONG and not _follows(knots, segment + 1, origin, t[start + n :]):
            break
        if segment != filled:
            spread(pointer, knots, segments, segment, BLOCK)
            filled = segment
        # A kernel takes a remainder one by one: rather a vector in full, of samples that nothing asked for.
        whole = (n + TOGETHER - 1) // TOGETHER * TOGETHER
        for j in range(n, whole):
            sheet[0, j] = 0.0
        call_sample(address, pointer, whole)
        store(pointer, sheet, order, out, start, n)
        start += n
        if n < BLOCK and segment < last:
            segment += 1
    return start, segment


@inlined
def _placed(knots, segment, origin, t, sheet):
    """Write local parameters of the next block; how many of its samples, from the first on, lie in the segment."""
    lo, hi = knots[segment], knots[segment + 1]
    if t.size >= BLOCK:
        inside = _place(lo, hi, origin, t, sheet, BLOCK)  # unrolled, the number being a constant
        if inside == BLOCK:
            return inside
    else:
        _place(lo, hi, origin, t, sheet, t.size)
    n, most = 0, min(t.size, BLOCK)
    while n < most and t[n] - origin >= lo and t[n] - origin < hi:
        n += 1
    return n


@inlined
def _place(lo, hi, origin, t, sheet, n):
    """Local parameters of n samples, and how many of them lie in the segment."""
    rate = 1.0 / (hi - lo)  # a product everywhere: all blocks agree
    inside = 0
    for j in range(n):
        x = t[j] - origin
        sheet[0, j] = (x - lo) * rate
        inside += (x >= lo) & (x < hi)
    return inside


@inlined
def _follows(knots, segment, origin, t):
    """Whether a long run in a segment seems to begin here: its first sample and its last lie there."""
    if t.size < LONG or segment + 1 == knots.size:
        return False
    lo, hi = knots[segment], knots[segment + 1]
    first, last = t[0] - origin, t[LONG - 1] - origin
    return first >= lo and first < hi and last >= lo and last < hi
