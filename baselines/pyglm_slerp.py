"""The package PyGLM, bindings of GLM: slerp between two quaternions, here on every segment."""

from __future__ import annotations

from quatspline.peers.pyglm import PyGlmCurve


class PyGlmSlerp(PyGlmCurve):
    """``glm.slerp`` of double-precision quaternions, one call per sample.  zlib licence.

    GLM documents that "the interpolation always take the short path and the rotation is performed at
    constant speed": C^0, interpolating, local (two keyframes shape a segment) [pyglm].  Orientations only.
    """

    title = "PyGLM slerp"
    function = "slerp"
    departs = {"test_keeps_given_signs": "goes the short way"}
