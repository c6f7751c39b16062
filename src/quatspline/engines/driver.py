"""The compiled driver of all segment curves: times in, blocks of samples to a kernel, results out.

A batch of samples is located first: the local parameter u and the segment of each, and the blocks
that it falls into.  Neighbouring samples of one segment form a block that needs that segment's
constants once (sorted samples); where segments change every few samples, a mixed block gathers
constants sample by sample.  Then every track evaluates all blocks of the batch.
"""

from __future__ import annotations

import math

import numpy as np
from numba import carray

from quatspline.engines.compiler import machine
from quatspline.engines.intrinsics import at_address, call_fit, call_sample, on_stack, splat
from quatspline.engines.locating import INSIDE, LONG, MIXED, locate
from quatspline.inputs.arrays import FloatArray, IntArray
from quatspline.kernels.jit import (
    BLOCK,
    CONSTANTS,
    LANES,
    OVERWRITTEN,
    REACH,
    RESULT,
    ROWS,
    UNREPORTED,
    compiled,
    inlined,
)
from quatspline.kernels.values import put_quat, put_vec, quat_at, vec_at

BATCH = 1024
"""Samples located at once, before their tracks are evaluated: within the first-level cache."""

SHARE = 8
"""Tracks that share a whole batch; of more, batches are smaller, so that their results stay within the
second-level cache until all tracks have written theirs beside one another."""

SHEET = ROWS * BLOCK
BLOCKS = BATCH // LONG + 2
"""The most blocks that a batch falls into: all but the last are long or mixed and full."""

UNTOUCHED = -7.25e299
"""What no fit writes."""

KNOTS, COUNT, SEGMENTS, TRACKS, CONSTANT_COUNT, SIGNS, CLOSED = range(7)


def described(knots: FloatArray, segments: FloatArray, signs: FloatArray, closed: bool) -> IntArray:
    """A curve as the driver takes it: addresses and lengths of its arrays, which must be kept alive.

    knots (count + 1,) since the first keyframe, segments (K, count, constants), signs (K,).

    Raises
    ------
    ValueError
        Where they do not fit together: arrays made of addresses have no bounds that anything checks.
    """
    shapes = knots.shape, segments.shape[:2], signs.shape
    if shapes != ((segments.shape[1] + 1,), (signs.size, segments.shape[1]), (signs.size,)):
        raise ValueError(f"knots, segments and signs have shapes {shapes}: they do not fit")
    for array in (knots, segments, signs):
        if array.dtype != np.float64 or not array.flags.c_contiguous:
            raise ValueError("knots, segments and signs: C-contiguous float64 is expected")
    places = np.empty(CLOSED + 1, np.int64)
    machine(_describe)(knots, segments, signs, closed, places)
    return places


@compiled
def _describe(knots, segments, signs, closed, places):
    places[KNOTS], places[SEGMENTS] = knots.ctypes.data, segments.ctypes.data
    places[SIGNS], places[CLOSED] = signs.ctypes.data, closed
    places[TRACKS], places[COUNT], places[CONSTANT_COUNT] = segments.shape


@compiled
def fit_tracks(address, tracks, h, closed, signs, parameters, segments, report, beyond):
    """Call a fit kernel on every track (K, n, 4); the largest reach, UNREPORTED where one reports none.

    ``beyond`` is the memory that follows the segments: OVERWRITTEN says that a kernel wrote there, for nothing
    checks the bounds of rows in compiled code.
    """
    reach = 0.0
    for j in range(beyond.size):
        beyond[j] = UNTOUCHED
    if not tracks.shape[0] == segments.shape[0] == report.shape[0] == signs.size:
        raise ValueError("tracks, segments, report and signs: one of each per track is expected")
    if segments.shape[1] % h.size or tracks.shape[1] + closed != h.size + 1:
        raise ValueError("spacings: one from each keyframe to the next is expected")
    for k in range(tracks.shape[0]):
        report[k, REACH] = UNREPORTED
        call_fit(address, tracks[k], h, closed, signs[k], parameters, segments[k], report[k])
        if report[k, REACH] == UNREPORTED:
            return UNREPORTED
        reach = max(reach, report[k, REACH])
    for j in range(beyond.size):
        if beyond[j] != UNTOUCHED:
            return OVERWRITTEN
    return reach


@compiled
def sample(address, order, curve, origin, slack, t, out):
    """Evaluate all tracks at t (m,) into out (m * K * width,); the first bad index, or -1.

    ``curve`` as made by `described`: one array, because each adds a tenth of a microsecond to a call.
    """
    count, tracks, closed = curve[COUNT], curve[TRACKS], curve[CLOSED] != 0
    knots = carray(at_address(curve[KNOTS]), (count + 1,))
    segments = carray(at_address(curve[SEGMENTS]), (tracks, count, curve[CONSTANT_COUNT]))
    signs = carray(at_address(curve[SIGNS]), (tracks,))
    width = 3 if order else 4
    if out.size != width * tracks * t.size:
        raise ValueError("out has another size than the samples")
    pointer = on_stack(SHEET)
    sheet = carray(pointer, (ROWS, BLOCK))
    u = carray(on_stack(BATCH), (BATCH,))
    # Unsigned: LLVM then knows that no index is negative, and the loops over samples vectorise.
    where = carray(on_stack(BATCH), (BATCH,)).view(np.uint32)
    spans = carray(on_stack(BLOCKS), (BLOCKS,)).view(np.uint16)  # first sample, number of samples
    owner = carray(on_stack(BLOCKS), (BLOCKS,)).view(np.int64)  # the segment of a block
    segment, step = 0, max(min(BATCH, BATCH * SHARE // tracks), BLOCK)
    for start in range(0, t.size, step):
        batch = t[start : start + step]
        made, segment, wraps, bad = locate(
            knots, closed, origin, slack, batch, segment, u, where, spans, owner
        )
        if bad != INSIDE:
            return start + bad
        for k in range(tracks):
            own = out[width * (start * tracks + k) :]
            filled = MIXED
            for b in range(made):
                first, n, i = spans[2 * b], spans[2 * b + 1], owner[b]
                for j in range(n):
                    sheet[0, j] = u[first + j]
                if i == MIXED:
                    _gather(pointer, knots, segments[k], where, first, n)
                elif i != filled:
                    _spread(pointer, knots, segments[k], i, BLOCK if t.size > 1 else LANES)
                filled = i
                call_sample(address, pointer, n)
                _store(sheet, order, own, first, n, tracks)
            if order == 0 and wraps and signs[k] < 0.0:
                _flip(batch, origin, knots[-1], own, tracks)
    return INSIDE


@inlined
def _spread(sheet, knots, segments, i, width):
    """The constants of segment i for all samples of a block."""
    rate = 1.0 / (knots[i + 1] - knots[i])
    for j in range(0, width, LANES):
        splat(sheet, BLOCK + j, rate)
    for c in range(segments.shape[1]):
        value = segments[i, c]
        for j in range(0, width, LANES):
            splat(sheet, BLOCK * (CONSTANTS + c) + j, value)


@inlined
def _gather(sheet, knots, segments, where, first, n):
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
def _store(sheet, order, out, first, n, tracks):
    """The result rows, component first, into out, sample first."""
    if order == 0 and tracks == 1:  # a constant stride, and no value between: the stores vectorise
        for j in range(n):
            at = 4 * (first + j)
            out[at] = sheet[RESULT, j]
            out[at + 1] = sheet[RESULT + 1, j]
            out[at + 2] = sheet[RESULT + 2, j]
            out[at + 3] = sheet[RESULT + 3, j]
    elif order == 0:
        for j in range(n):
            put_quat(out, 4 * tracks * (first + j), quat_at(sheet[RESULT:, j], 0))
    elif tracks == 1:
        for j in range(n):
            put_vec(out, 3 * (first + j), vec_at(sheet[RESULT:, j], 0))
    else:
        for j in range(n):
            put_vec(out, 3 * tracks * (first + j), vec_at(sheet[RESULT:, j], 0))


@compiled
def _flip(t, origin, period, out, tracks):
    """The sign of samples an odd number of periods away, on a track that returns as -q."""
    for j in range(t.size):
        if math.floor((t[j] - origin) / period) % 2.0 == 1.0:
            for c in range(4):
                out[4 * tracks * j + c] *= -1.0
