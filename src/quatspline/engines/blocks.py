"""What goes into the sheet of a block, the constants of its samples, and what comes out of it."""

from __future__ import annotations

from quatspline.engines.intrinsics import at_address, splat
from quatspline.engines.transposing import TOGETHER, put_together
from quatspline.kernels.jit import BLOCK, CONSTANTS, LANES, RESULT, inlined
from quatspline.kernels.values import put_quat, put_vec, quat_at, vec_at


@inlined
def spread(sheet, knots, segments, i, width):
    """The constants of segment i for all samples of a block."""
    rate = 1.0 / (knots[i + 1] - knots[i])
    for j in range(0, width, LANES):
        splat(sheet, BLOCK + j, rate)
    for c in range(segments.shape[1]):
        value = segments[i, c]
        for j in range(0, width, LANES):
            splat(sheet, BLOCK * (CONSTANTS + c) + j, value)


@inlined
def gather(sheet, knots, segments, where, first, n):
    """The constants of each sample's own segment, those of neighbours in one segment together.

    Vectors reach beyond a run, where the next run overwrites them; a mixed block leaves room for the last.
    """
    start = 0
    while start < n:
        i = where[first + start]
        stop = start + 1
        while stop < n and where[first + stop] == i:
            stop += 1
        rate = 1.0 / (knots[i + 1] - knots[i])
        if stop - start <= LANES:  # one vector each: a loop of one turn costs more than the store
            splat(sheet, BLOCK + start, rate)
            for c in range(segments.shape[1]):
                splat(sheet, BLOCK * (CONSTANTS + c) + start, segments[i, c])
        else:
            for j in range(start, stop, LANES):
                splat(sheet, BLOCK + j, rate)
            for c in range(segments.shape[1]):
                value = segments[i, c]
                for j in range(start, stop, LANES):
                    splat(sheet, BLOCK * (CONSTANTS + c) + j, value)
        start = stop


@inlined
def store(pointer, sheet, order, out, first, n):
    """The result rows of the only track, component first, into out from sample ``first`` on, sample first.

    ``pointer`` is that of the sheet.
    """
    place, whole = at_address(out.ctypes.data), n - n % TOGETHER
    if order == 0:
        for j in range(0, whole, TOGETHER):
            put_together(pointer, j, 4, place, 4 * (first + j))
        for j in range(whole, n):
            put_quat(out, 4 * (first + j), quat_at(sheet[RESULT:, j], 0))
    else:
        for j in range(0, whole, TOGETHER):
            put_together(pointer, j, 3, place, 3 * (first + j))
        for j in range(whole, n):
            put_vec(out, 3 * (first + j), vec_at(sheet[RESULT:, j], 0))


@inlined
def store_apart(sheet, order, out, first, n, tracks):
    """The same of one track of several, whose results lie beside one another; out begins with its first."""
    if order == 0:
        for j in range(n):
            put_quat(out, 4 * tracks * (first + j), quat_at(sheet[RESULT:, j], 0))
    else:
        for j in range(n):
            put_vec(out, 3 * tracks * (first + j), vec_at(sheet[RESULT:, j], 0))
