"""Babylon.js: an animation of a quaternion with tangents, as glTF's cubic spline is played."""

from __future__ import annotations

from quatspline.keyframes import Keyframes
from quatspline.peers.controls import hermite_tangents
from quatspline.peers.node import NodeCurve
from quatspline.quaternion import FloatArray


class BabylonHermite(NodeCurve):
    """``Animation.evaluate`` on quaternion keys with tangents, one call per sample.  Apache-2.0.

    ``Quaternion.Hermite``, a cubic in R^4, and normalised, which is how the library plays a CUBICSPLINE of
    glTF.  Tangents are those of the parabola through three keyframes: C^1, interpolating, local (four
    keyframes shape a segment).  Through Node.js, which gets all samples at once [babylonjs].  Orientations only.
    """

    title = "Babylon.js Animation with tangents"
    reference = "babylonjs"
    peer = "npm:@babylonjs/core"
    call = "babylon animation"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "no"

    def _more(self, keyframes: Keyframes) -> tuple[FloatArray, ...]:
        return (hermite_tangents(keyframes),)
