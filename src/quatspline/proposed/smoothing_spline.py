"""What to do about noise: Reinsch's smoothing spline on rotations, near its keyframes, not through them."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import numpy as np

from quatspline.families.rotation_vector import ROTATION_VECTOR
from quatspline.fitting.noise_level import noise_level
from quatspline.fitting.smoothing import REST, Smoothing, Solution
from quatspline.fitting.smoothing_search import Criterion, Search, gcv, reached, risk
from quatspline.fitting.weights import positive
from quatspline.kernels.jit import REACH
from quatspline.keyframes import Keyframes
from quatspline.options import AtLeast, Iterations, OnFailure, Positive
from quatspline.segments import SegmentCurve

Choice = Annotated[float, AtLeast(0.0)] | Literal["gcv", "auto"]


class SmoothingSpline(SegmentCurve):
    """Smoothing spline on rotations, after [reinsch1967]: C^2, global, not interpolating.

    Smoothed keyframes r_i minimise

        sum w_i |2 ln(r_i^-1 q_i)|^2 + lambda d^T R^-1 d                                         (1)

    whose second term is the energy of the acceleration that the turns between them ask for
    (`reinsch`); on one axis it is the natural cubic smoothing spline.  Quintic segments join the r_i
    at the velocities and accelerations that the solve ends with (docs: smoothing-spline.md).

    Options
    -------
    smoothing
        lambda in cubed units of time: 0 interpolates, the larger the straighter.  "gcv" is generalised
        cross-validation; "auto", the default, the smaller of that and of what the noise told from the
        keyframes (`noise_level`) asks for.
    noise
        Standard deviation of the keyframes' rotation errors, in rad about every axis, where it is known:
        lambda is then of least expected error.
    weights
        w, of one keyframe each: 1 over the variance of its errors in units of the noise's.
    tolerance, max_iterations, on_failure
        The solve stops when an update turns no keyframe by more than the tolerance, in rad: that is
        the report's residual; one that comes to rest above it, at rounding, has converged too.  What
        does not converge from the keyframes themselves is reached by growing lambda, where that goes;
        a search ends at the first lambda that does not.

    Attributes
    ----------
    smoothing : lambda of every track, (*K,)
    freedom : parameters spent an axis, from n for interpolation down to 2, or 1 on closed curves; (*K,)
    noise : standard deviation of errors in rad an axis, by what the curve misses; (*K,)
    """

    title = "Smoothing spline on rotations"
    reference = "reinsch1967"
    interpolates = False
    continuity = 2
    order = 3
    support = None
    constant_rate = "everywhere"
    iterative = True
    measures_itself = True
    min_keyframes = 3
    family = ROTATION_VECTOR

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        smoothing: Choice = "auto",
        noise: Positive | None = None,
        weights: Any = None,
        tolerance: Positive = 1e-10,
        max_iterations: Iterations = 100,
        on_failure: OnFailure = "raise",
    ) -> None:
        if noise is not None and smoothing != "auto":
            raise ValueError(
                f"noise={noise!r}: it chooses lambda, and so does smoothing={smoothing!r}"
            )
        w = positive(weights, keyframes.count)
        tracks, told, rest = keyframes.tracks.shape[0], [], []
        segments = np.empty((tracks, keyframes.spacings.size, self.family.constants))
        report = np.empty((tracks, 4))
        for k in range(tracks):
            own = keyframes.track(k)
            problem = Smoothing(own.quaternions, own.spacings / own.unit, own.closed, own.sign, w)
            if isinstance(smoothing, str):
                criteria = _criteria(smoothing, noise, own)
                weight, start = Search(problem, max_iterations).least(*criteria)
                found = problem.solve(weight, tolerance, max_iterations, start)
            else:
                weight = float(smoothing) / own.unit**3
                found = reached(problem, weight, tolerance, max_iterations)
            report[k, :REACH] = found.iterations, found.change, found.residual
            report[k, REACH] = problem.write(found.state, segments[k])
            rest.append(found.rest)
            told.append(_told(problem, weight * own.unit**3, problem.trace(weight), found))
        shape = keyframes.track_shape
        self.smoothing, self.freedom, self.noise = np.transpose(told).reshape(3, *shape)
        self._set_segments(segments, report[:, REACH].max())
        judged = "gauss-newton", "residual", tolerance, report, on_failure
        self._report(*judged, within=max(tolerance, REST), settled=np.array(rest))


def _criteria(smoothing: str, noise: float | None, keyframes: Keyframes) -> list[Criterion]:
    """What lambda is searched by; the smallest that one of them asks for is taken."""
    if noise is not None:
        return [risk(float(noise))]
    if smoothing == "gcv":
        return [gcv]
    return [gcv, risk(float(noise_level(keyframes)))]


def _told(
    problem: Smoothing, weight: float, trace: float, found: Solution
) -> tuple[float, float, float]:
    """lambda, the trace, and the noise by what is left: sqrt(rss / 3 (n - tr))."""
    free = 3.0 * max(len(problem.q) - trace, 0.0)
    return weight, trace, math.sqrt(found.state.rss / free) if free > 0.0 else 0.0
