"""Babylon.js: an animation of a quaternion."""

from __future__ import annotations

from quatspline.peers.node import NodeCurve


class BabylonSlerp(NodeCurve):
    """``Animation.evaluate`` on quaternion keys without tangents, one call per sample.  Apache-2.0.

    Documented as interpolation by ``Quaternion.Slerp``: C^0, interpolating, local (two keyframes shape a
    segment).  Through Node.js, which gets all samples at once [babylonjs].  Orientations only.
    """

    title = "Babylon.js Animation"
    reference = "babylonjs"
    peer = "npm:@babylonjs/core"
    call = "babylon animation"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "goes the short way",
        "test_very_uneven_times": "small steps go along the chord as it is: norms off by 1e-8",
    }
