"""InterpolatePy's LogQuaternionInterpolation."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.interpolatepy import InterpolatePyCurve
from quatspline.quaternion import FloatArray


class InterpolatePyLog(InterpolatePyCurve):
    """``interpolatepy.LogQuaternionInterpolation``: a cubic B-spline of rotation vectors.

    Published as C^2 and interpolating; global.  Keyframes become rotation vectors, made continuous
    past half a turn, and one cubic B-spline goes through them [interpolatepy; parker2023].  Rates are the
    library's ``get_physical_kinematics`` (its ``evaluate_velocity`` is the derivative of the rotation
    vector) from its Python backend, world frame, turned into the body frame here; one call per sample.
    Open curves only.
    """

    title = "InterpolatePy LogQuaternionInterpolation"
    continuity = 2
    order = 4
    support = None
    constant_rate = "no"
    practical_keyframes = 2000  # one dense system of all keyframes: time grows with their cube
    departs = {
        "test_equivariance_at_half_turns": "takes logarithms at a fixed reference",
        "test_spacing_ratios": "its linear system is in raw units: rank-deficient at ratios of 1e9",
        "test_time_scale": "its linear system is in raw units: rank-deficient in nanoseconds",
        "test_equivariance": "takes logarithms at a fixed reference",
        "test_keeps_given_signs": "puts neighbours on one hemisphere itself",
        "test_order": "4 only from several hundred keyframes on; 4.5 at fewer",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        from interpolatepy import LogQuaternionInterpolation

        self._construct(LogQuaternionInterpolation)

    def _velocity(self, t: FloatArray) -> FloatArray:
        return self._rates(lambda x: self.curve.get_physical_kinematics(x)[0], t)

    def _acceleration(self, t: FloatArray) -> FloatArray:
        return self._rates(lambda x: self.curve.get_physical_kinematics(x)[1], t)
