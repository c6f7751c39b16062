"""glMatrix: sqlerp, a squad whose control quaternions the caller brings along."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.controls import inner_quaternions
from quatspline.peers.node import NodeCurve
from quatspline.quaternion import FloatArray


class GlMatrixSqlerp(NodeCurve):
    """``quat.sqlerp`` in double precision, one call per sample.  MIT.

    Documented as "a spherical linear interpolation with two control points".  They are squad's inner
    quaternions for uneven times, with which squad is C^1, interpolating, local (four keyframes shape a
    segment).  Through Node.js, which gets all samples at once [gl_matrix; shoemake1987].  Orientations only.
    """

    title = "glMatrix sqlerp"
    reference = "gl_matrix"
    peer = "npm:gl-matrix"
    call = "gl-matrix sqlerp"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "everywhere"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "its slerps go the short way",
        "test_log_of_a_spin_goes_on": "small steps go along the chord as it is: norms off by 1e-7",
        "test_spacing_ratios": "small steps go along the chord as it is: norms off by 1e-7",
        "test_very_uneven_times": "small steps go along the chord as it is: norms off by 1e-7",
    }

    def _more(self, keyframes: Keyframes) -> tuple[FloatArray, ...]:
        return inner_quaternions(keyframes)
