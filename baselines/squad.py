"""Spherical and quadrangle interpolation (squad), with three choices of its inner points."""

from __future__ import annotations

from typing import Literal

import numpy as np

from quatspline.families.arcs import SIZE as ARC
from quatspline.families.arcs import set_arc
from quatspline.families.nested import SQUAD
from quatspline.fitting.tangents import CHART, SECANT, chart_velocities, step
from quatspline.kernels.jit import REACH, compiled, fit_kernel
from quatspline.kernels.values import exp, keyframe, log, put_vec, vec_at
from quatspline.keyframes import Keyframes
from quatspline.segments import SegmentCurve

TWO_A, SINGLE_A, TEXTBOOK = 0.0, 1.0, 2.0


class Squad(SegmentCurve):
    """Spherical and quadrangle interpolation (squad), Shoemake (1987), on arbitrary knots.

    C^1 where every |h v - L| < 2 pi, interpolating, local (four keyframes shape a segment); order 3 inside:

        Q(u) = slerp(slerp(q_i, q_{i+1}; u), slerp(a_i^+, a_{i+1}^-; u); 2u(1 - u))              (1)

    with L_i = ln(q_i^-1 q_{i+1}), half a rotation vector, on a segment of duration h_i.  It leaves
    with velocity (L_i + 2 ln(q_i^-1 a_i^+))/h_i: v_i and v_{i+1} are met by

        a_i^+ = q_i exp((h_i v_i - L_i)/2),    a_{i+1}^- = q_{i+1} exp((L_i - h_i v_{i+1})/2)    (2)

    with v_i the slope of the parabola through three keyframes in the chart at q_i
    (`fitting.tangents` (1)) [shoemake1987].

    Options
    -------
    inner
        "two-a": (2).  "single-a": one point at each keyframe, a_i = a_i^+ = a_i^-, which forces
        v_i = (L_{i-1} + L_i)/(h_{i-1} + h_i): C^1, but order 2 on non-uniform knots.  "textbook":
        the published a_i = q_i exp((L_{i-1} - L_i)/4), which knows no times: C^0 on such knots.
    ends
        "chart": the parabola through the end's three keyframes; "secant": v_0 = L_0 / h_0, the published
        a_0 = q_0.  Default: "chart" with two-a, "secant" with the others.
    """

    title = "Spherical and quadrangle interpolation (squad)"
    reference = "shoemake1987"
    continuity = 1
    order = 3
    support = 4
    constant_rate: Literal["everywhere", "no"] = "everywhere"
    family = SQUAD

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        inner: Literal["two-a", "single-a", "textbook"] = "two-a",
        ends: Literal["chart", "secant"] | None = None,
    ) -> None:
        if inner == "textbook" and not keyframes.uniform:
            self.continuity, self.order, self.constant_rate = 0, 1, "no"
        secant = ends == "secant" or (ends is None and inner != "two-a")
        code = {"two-a": TWO_A, "single-a": SINGLE_A, "textbook": TEXTBOOK}[inner]
        self._solve(FIT, np.array([code, SECANT if secant else CHART]))


@compiled
def _pull(q, h, sign, i, textbook, v):
    """The velocities v[0] after and v[1] before keyframe i by which (2) gives the single point

    a_i = q_i exp((h_i L_{i-1} - h_{i-1} L_i) / (2 (h_{i-1} + h_i))); the textbook takes h = 1.      (3)
    """
    l0, l1 = step(q, i - 1, i, sign), step(q, i, i + 1, sign)  # L_{i-1}, L_i
    h0, h1 = h[(i - 1) % h.size], h[i]
    k0, k1 = (1.0, 1.0) if textbook else (h0, h1)
    pull = (1.0 / (k0 + k1)) * (k1 * l0 - k0 * l1)  # (3): 2 ln(q_i^-1 a_i)
    put_vec(v[0], 0, (1.0 / h1) * (l1 + pull))  # (2) for a_i^+, solved for v_i
    put_vec(v[1], 0, (1.0 / h0) * (l0 - pull))  # (2) for a_i^-


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The two arcs of (1) by (2); parameters: inner, ends."""
    n, inner = q.shape[0], parameters[0]
    slopes = chart_velocities(q, h, closed, sign, 3, parameters[1])
    v = np.empty((n, 2, 3))  # v_i after and before every keyframe
    for i in range(n):
        v[i, 0], v[i, 1] = slopes[i], slopes[i]
        if inner != TWO_A and (closed or 0 < i < n - 1):
            _pull(q, h, sign, i, inner == TEXTBOOK, v[i])
    reach = 0.0
    for i in range(h.size):
        p, r = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        l = log(~p * r)  # L_i, from p = q_i to r = q_{i+1}
        a = p * exp(0.5 * (h[i] * vec_at(v[i, 0], 0) - l))  # (2): a_i^+
        b = r * exp(0.5 * (l - h[i] * vec_at(v[(i + 1) % n, 1], 0)))  # (2): a_{i+1}^-
        # (1): slerp(p, r; u) and slerp(a, b; u); the family blends them.
        reach = max(reach, set_arc(segments[i], 0, p, r), set_arc(segments[i], ARC, a, b))
    report[REACH] = reach  # the largest half angle: which sines the family takes
