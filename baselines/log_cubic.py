"""A cubic spline in one global logarithmic chart: simple, C^2, folded by the first full turn."""

from __future__ import annotations

from typing import Literal

import numpy as np

from quatspline import quaternion
from quatspline.families.rotation_vector import PHI, Q0, ROTATION_VECTOR
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve


class LogCubicSpline(SegmentCurve):
    """Log-space cubic spline [parker2023]: C^2, interpolating, global.

    An ordinary cubic spline X in R^3 through the logarithms of the keyframes,

        x_i = ln(q_ref^-1 q_i),    Q(t) = q_ref exp(X(t))                                        (1)

    Bi-invariant, since the reference is a keyframe, but dependent on which.  The logarithm ends at
    a full turn from the reference: beyond it the points x_i jump to the other side, and the curve
    with them, which is shown and not refused.  Open only: where a loop returns as -q_0, an odd
    number of turns later, no periodic X exists.

    Options
    -------
    reference
        Index of the keyframe q_ref.
    ends
        "natural" (X'' = 0) or "not-a-knot".
    """

    title = "Log-space cubic spline"
    reference = "parker2023"
    continuity = 2
    order = 4
    support = None
    constant_rate = "no"
    closable = False
    family = ROTATION_VECTOR

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        reference: int = 0,
        ends: Literal["natural", "not-a-knot"] = "natural",
    ) -> None:
        from scipy.interpolate import CubicSpline  # slow to import: others need not wait

        q, h = np.moveaxis(keyframes.tracks, 1, 0), keyframes.spacings
        if not 0 <= reference < len(q):
            raise ValueError(f"reference={reference}: the keyframes are 0 to {len(q) - 1}")
        if keyframes.closed and (keyframes.signs < 0).any():
            raise ValueError(
                "closed=True: log-cubic closes only curves that return as +q_0, not -q_0"
            )
        base = q[reference]
        x = _logs(q, reference)
        c = CubicSpline(keyframes.knots / keyframes.unit, x, bc_type=ends).c[::-1]
        # coefficients (power from 0 to 3, segment, track, component) of t become those of u
        for power in range(4):
            c[power] *= ((h / keyframes.unit) ** power)[:, None, None]
        segments = np.zeros((len(base), h.size, self.family.constants))
        segments[:, :, Q0:PHI] = base[:, None]
        phi = segments[:, :, PHI:].reshape(*segments.shape[:2], 3, 6)
        # one after the other, as all at once would take as much memory as the curve: `polynomials` (1)
        constants = (lambda: x[:-1], lambda: x[1:] - x[:-1], lambda: -c[2] - c[3], lambda: -c[3])
        for i, constant in enumerate(constants):
            phi[..., i] = np.moveaxis(constant(), 1, 0)
        self._set_segments(segments, _bound(c))


def _bound(c: FloatArray) -> float:
    """Of |phi| for the coefficients (4, segments, K, 3): the largest of Bernstein's coefficients."""
    hull = (
        lambda: c[0],
        lambda: c[0] + c[1] / 3,
        lambda: c[0] + (2 * c[1] + c[2]) / 3,
        lambda: c.sum(axis=0),
    )
    return max(float(np.linalg.norm(each(), axis=-1).max()) for each in hull)


def _logs(q: FloatArray, reference: int) -> FloatArray:
    """x_i of (1) for keyframes (n, K, 4); a full turn from the reference goes on as its neighbour."""
    relative = quaternion.mul(quaternion.conj(q[reference]), q)
    x = quaternion.log(relative)
    opposite = np.flatnonzero((np.abs(relative[..., 0] + 1.0) < quaternion.OPPOSITE).any(axis=1))
    for i in sorted(opposite, key=lambda i: abs(i - reference)):
        x[i] = quaternion.log_towards(relative[i], x[i - 1 if i > reference else i + 1])
    return x
