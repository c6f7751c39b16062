"""scipy's RotationSpline: cubic rotation vectors, C^2 by iteration."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve
from quatspline.quaternion import FloatArray


class ScipyRotationSpline(PeerCurve):
    """``scipy.spatial.transform.RotationSpline``, one vectorised call for all times.

    Published as C^2 (continuous angular rate and acceleration), interpolating, global; cubic rotation
    vectors between keyframes, coefficients by a fixed-point iteration that ends after ten rounds without
    a report [scipy; mayorov2018].  All orders, body frame.  Open curves only.
    """

    title = "scipy RotationSpline"
    reference = "scipy"
    peer = "scipy"
    continuity = 2
    order = 4
    support = None
    constant_rate = "everywhere"
    closable = False
    orders = (0, 1, 2)
    departs = {
        "test_keeps_given_signs": "rotations carry no sign",
        "test_spacing_ratios": "its rates overflow, or it misses keyframes by 1e-7, at ratios of 1e9",
        "test_time_scale": "its iteration ends at a change of rates of 1e-9, whatever the unit of time",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        from scipy.spatial.transform import Rotation, RotationSpline

        rotations = Rotation.from_quat(keyframes.quaternions, scalar_first=True)
        self.curve = RotationSpline(keyframes.knots, rotations)

    def _orientation(self, t: FloatArray) -> FloatArray:
        return self.curve(t).as_quat(scalar_first=True)

    def _velocity(self, t: FloatArray) -> FloatArray:
        return self.curve(t, 1)

    def _acceleration(self, t: FloatArray) -> FloatArray:
        return self.curve(t, 2)
