"""glMatrix: slerp between two quaternions, here on every segment."""

from __future__ import annotations

from quatspline.peers.node import NodeCurve


class GlMatrixSlerp(NodeCurve):
    """``quat.slerp`` in double precision, one call per sample.  MIT.

    Documented as "a spherical linear interpolation between two quat": C^0, interpolating, local (two
    keyframes shape a segment).  Through Node.js, which gets all samples at once [gl_matrix].  Orientations only.
    """

    title = "glMatrix slerp"
    reference = "gl_matrix"
    peer = "npm:gl-matrix"
    call = "gl-matrix slerp"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "goes the short way",
        "test_very_uneven_times": "small steps go along the chord as it is: norms off by 1e-8",
    }
