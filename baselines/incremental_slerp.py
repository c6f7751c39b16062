"""Incremental slerp: equal steps along each arc by a two-term recurrence, and the drift it has."""

from __future__ import annotations

import math
from typing import Annotated

import numpy as np

from quatspline.families.arcs import ARC, set_arc
from quatspline.kernels.jit import REACH, fit_kernel
from quatspline.kernels.values import exp, keyframe, log, norm, unit
from quatspline.keyframes import Keyframes
from quatspline.options import AtMost, Count
from quatspline.segments import SegmentCurve

MOST = 20_000_000
"""Points kept: they take 100 bytes each, of which 72 stay."""


class IncrementalSlerp(SegmentCurve):
    """Slerp by Li's incremental recurrence (iSlerp), with the rounding errors that it gathers.

    C^0, interpolating up to its drift, local (two keyframes shape a segment).  From each keyframe m
    equal steps of angle delta = theta/m go along the arc without a sine,

        p_0 = q_i,  p_1 = slerp(q_i, q_{i+1}; 1/m),  p_{k+1} = 2 cos(delta) p_k - p_{k-1}        (1)

    and samples between two points are slerped, all normalised:

        Q(u) = slerp(p_k, p_{k+1}; m u - k),    k = floor(m u)                                   (2)

    An error made at one step continues as e sin(j delta)/sin(delta) after j more, so that the drift
    from slerp grows about as m^2: over steps of 90 degrees it was 2e-13 rad with m = 64, 9e-12 with
    1024, 6e-10 with 4096 [li_islerp; barrera2004].  The points of (1) are kept from the fit, so
    that samples in any order cost the same.

    Options
    -------
    steps
        m, the steps per segment, at most 4096: beyond, the last of a segment drifts from its keyframe
        by more than 1e-9 rad.
    """

    title = "Incremental slerp by recurrence"
    reference = "li_islerp"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    practical_keyframes = 100_000
    family = ARC

    def _fit(self, keyframes: Keyframes, *, steps: Annotated[Count, AtMost(4096)] = 64) -> None:
        self.fit_kernel, self.parameters = FIT, np.array([float(steps)])
        h, tracks = keyframes.spacings, keyframes.tracks
        points = tracks.shape[0] * h.size * steps
        if points > MOST:
            raise ValueError(
                f"steps={steps}: {points:,} points are too many, at most {MOST:,} are kept"
            )
        report = np.zeros((tracks.shape[0], 4))
        segments, reach = self._fit_rows(tracks, h, keyframes.closed, report, steps)
        # Every step is a segment of its own.
        knots = np.append(keyframes.inside(np.arange(steps) / steps), keyframes.knots[-1])
        if (np.diff(knots) <= 0.0).any():
            raise ValueError(f"steps={steps}: float64 does not tell so many within a spacing apart")
        self._set_segments(segments, reach, knots)


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """(1) from every keyframe; the arc of (2) from p_k is a segment."""
    steps, reach = int(parameters[0]), 0.0
    for i in range(h.size):
        a = p = keyframe(q, i, sign)
        l = log(~p * keyframe(q, i + 1, sign))
        b = a * exp((1.0 / steps) * l)
        k = 2.0 * math.cos(norm(l) / steps)
        for j in range(i * steps, (i + 1) * steps):
            r = unit(b)
            reach = max(reach, set_arc(segments[j], 0, p, r))
            a, b, p = b, k * b - a, r
    report[REACH] = reach
