"""three.js: the interpolation of quaternion tracks."""

from __future__ import annotations

from quatspline.peers.node import NodeCurve


class ThreeSlerp(NodeCurve):
    """``QuaternionLinearInterpolant``, what a ``QuaternionKeyframeTrack`` evaluates, in double precision.  MIT.

    Documented as a spherical linear interpolant: C^0, interpolating, local (two keyframes shape a segment).
    Steps below 3.6 degrees are interpolated along the chord.  Through Node.js, one call for all samples
    [threejs].  Orientations only.
    """

    title = "three.js QuaternionLinearInterpolant"
    reference = "threejs"
    peer = "npm:three"
    call = "three slerp"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "goes the short way",
    }
