"""Park & Ravani's cubic in rotation vectors: each segment starts with the rates the last one ended with."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from quatspline.families.rotation_vector import ROTATION_VECTOR, half_acceleration, set_cubic
from quatspline.fitting.tangents import chart_velocity
from quatspline.inputs.arrays import at, real_array, refuse_infinite
from quatspline.kernels.jacobians import coefficients, right_jacobian
from quatspline.kernels.jit import REACH, fit_kernel
from quatspline.kernels.values import Vec, quat_at, turn, vec_at
from quatspline.keyframes import Keyframes
from quatspline.options import LARGEST
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve

START, OMEGA, ALPHA, PARAMETERS = 0, 1, 4, 7
CHORD, GIVEN, PARABOLA = range(3)
WORDS = {"chord": CHORD, "zero": GIVEN, "parabola": PARABOLA}

LARGE = 1e60
"""Constants beyond have accelerations, their squares over h^2, that float64 does not hold."""


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """The march (1) to (3) from the first keyframe to the last, in log units (half rotation vectors)."""
    c1, c2 = Vec(0.0, 0.0, 0.0), Vec(0.0, 0.0, 0.0)
    reach = 0.0
    for i in range(h.size):
        theta, axis = turn(quat_at(q[i], 0), quat_at(q[i + 1], 0))
        step = theta * axis
        if i == 0:
            c1 = (0.5 * h[0]) * vec_at(parameters, OMEGA)
            c2 = (0.25 * h[0] * h[0]) * vec_at(parameters, ALPHA)
            if parameters[START] == CHORD:
                c1 = step
            if parameters[START] == PARABOLA:
                c1 = h[0] * chart_velocity(q, h, False, 1.0, 0, 3, np.empty((5, 4)))
        reach = max(reach, set_cubic(segments[i], quat_at(q[i], 0), step, c1, c2))
        if i + 1 < h.size:
            c3, ratio = step - c1 - c2, h[i + 1] / h[i]
            d, e = c1 + 2.0 * c2 + 3.0 * c3, 2.0 * c2 + 6.0 * c3
            c1 = ratio * right_jacobian(step, d)
            bent = half_acceleration(coefficients(step @ step), step, d, e)
            c2 = (0.5 * ratio * ratio) * bent
    report[REACH] = reach


class ParkRavani(SegmentCurve):
    """Cubic in rotation vectors of Park & Ravani (1997): C^2 by marching from the first keyframe to the last.

    C^2, interpolating; a segment is shaped by all keyframes before it.  With r_i = 2 L_i the rotation
    vector of a step,

        Q(u) = q_i exp((a u^3 + b u^2 + c u) / 2),    a = r_i - b - c,                           (1)
        c_{i+1} = (h_{i+1} / h_i) Jr(r_i) (3 a + 2 b + c),                                       (2)
        b_{i+1} = (h_{i+1} / h_i)^2 alpha / 2,  alpha the acceleration by u at u = 1             (3)

    Nothing is solved, and the price is stability: an error of b and c grows by -2 - sqrt(3) = -3.73 per keyframe
    on a straight line, so that some ten keyframes on the curve turns wildly between its keyframes.  Open only.

    Options
    -------
    start
        The angular velocity at the first keyframe: "chord", that of slerp; "zero"; "parabola", that of the
        parabola through three keyframes; or (3,) in rad per time.  The acceleration is zero there, or the
        second row of (2, 3).

    Raises
    ------
    ValueError
        Where the march leaves float64, with the keyframe.
    """

    title = "Cubic in rotation vectors of Park & Ravani"
    reference = "park1997"
    continuity = 2
    order = 4
    support = None
    lookahead = 0
    constant_rate = "everywhere"
    closable = False
    family = ROTATION_VECTOR
    practical_keyframes = 8
    departs = dict.fromkeys(
        (
            "test_order",
            "test_support",
            "test_lookahead",
            "test_continuity_holds",
            "test_spacing_ratios",
            "test_log_of_a_spin_goes_on",
        ),
        "an error of the start grows by 3.73 per keyframe: the march leaves float64 on these keyframes, "
        "or what is small against their turns",
    )

    def _fit(
        self, keyframes: Keyframes, *, start: Literal["chord", "zero", "parabola"] | Any = "chord"
    ) -> None:
        parameters = np.zeros(PARAMETERS)
        if isinstance(start, str) and start in WORDS:
            parameters[START] = WORDS[start]
        else:
            parameters[START] = GIVEN
            rates = _rates(start, float(keyframes.spacings[0]))
            parameters[OMEGA : OMEGA + rates.size] = rates.reshape(-1)
        self._solve(FIT, parameters)
        self._refuse_infinite(keyframes)

    def _refuse_infinite(self, keyframes: Keyframes) -> None:
        lost = np.argwhere(~(np.abs(np.moveaxis(self.segments, 1, 0)) < LARGE).all(axis=-1))
        if lost.size:
            i, k = (int(x) for x in lost[0])
            track = np.unravel_index(k, keyframes.track_shape) if keyframes.track_shape else ()
            raise ValueError(
                f"{at('quaternions', [i, *track])}: the march brings rates there that float64 does not hold; "
                "an error of the start grows by 3.73 per keyframe"
            )


def _rates(given: Any, h: float) -> FloatArray:
    """(3,) or (2, 3) finite numbers, refused otherwise."""
    if isinstance(given, str) or given is None:
        raise ValueError(f"start={given!r}: expected 'chord', 'zero', 'parabola' or rates (3,)")
    rates = real_array("start", given)
    if rates.shape not in ((3,), (2, 3)):
        raise ValueError(
            f"start has shape {rates.shape}: expected (3,), or (2, 3) with an acceleration"
        )
    refuse_infinite("start", rates)
    if (np.abs(rates) * h > LARGEST).any():
        raise ValueError(f"start: more than {LARGEST:g} rad on the first segment of {h:g}")
    return rates.astype(float)
