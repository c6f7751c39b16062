"""What a curve of segments misses at its keyframes, measured on the constants that were written.

An iteration knows how far its equations are from being solved.  Whether the curve meets its
keyframes depends also on what was made of the solution, and where nothing is iterated on that alone.
"""

from __future__ import annotations

import math

import numpy as np
from numba import carray

from quatspline.engines.driver import SHEET
from quatspline.engines.intrinsics import call_sample, on_stack
from quatspline.kernels.jit import (
    BLOCK,
    CONSTANTS,
    RESULT,
    ROWS,
    compiled,
    inlined,
)
from quatspline.kernels.values import arc, keyframe, quat_at


@inlined
def _place(places, count, j):
    """Segment, local parameter and keyframe of sample j: an interval's start, then its end."""
    i = j // 2
    if j % 2 == 0:
        return places[i], 0.0, i
    return (places[i + 1] if i + 1 < places.size else count) - 1, 1.0, i + 1


@compiled
def _set_places(knots, keys, places):
    """The segment that begins at each keyframe, knots being those keyframes and others between."""
    s = 0
    for i in range(places.size):
        while knots[s] < keys[i]:
            s += 1
        places[i] = s


@compiled
def _worst(address, knots, segments, q, sign, places, sheet, pointer):
    """The largest miss of one track."""
    count, worst = segments.shape[0], 0.0
    for first in range(0, 2 * places.size, BLOCK):
        n = min(BLOCK, 2 * places.size - first)
        for j in range(n):
            i, u, _ = _place(places, count, first + j)
            sheet[0, j], sheet[1, j] = u, 1.0 / (knots[i + 1] - knots[i])
            for c in range(segments.shape[1]):
                sheet[CONSTANTS + c, j] = segments[i, c]
        call_sample(address, pointer, n)
        for j in range(n):
            _, _, k = _place(places, count, first + j)
            theta, _, _ = arc(quat_at(sheet[RESULT:, j], 0), keyframe(q, k, sign))
            worst = max(worst, theta) if theta == theta else math.inf
    return 2.0 * worst


@compiled
def largest_misses(address, knots, segments, tracks, keys, signs):
    """The largest angle (K,) in rad between curve and keyframes, from either side of each.

    Parameters
    ----------
    address : of the orientation kernel
    knots, segments : (count + 1,) and (K, count, constants): the curve
    tracks, signs : (K, n, 4) and (K,): the keyframes, and the sign with which the first returns
    keys : (intervals + 1,) the keyframes' times, all of them among the knots

    A number that is none counts as infinity; signs count: -q_i misses q_i by a full turn.
    """
    pointer = on_stack(SHEET)
    sheet = carray(pointer, (ROWS, BLOCK))
    places, misses = np.empty(keys.size - 1, np.int64), np.empty(tracks.shape[0])
    _set_places(knots, keys, places)
    for k in range(tracks.shape[0]):
        misses[k] = _worst(address, knots, segments[k], tracks[k], signs[k], places, sheet, pointer)
    return misses
