"""The package PyGLM, bindings of GLM: mix of two quaternions, here on every segment."""

from __future__ import annotations

from quatspline.peers.pyglm import PyGlmCurve


class PyGlmMix(PyGlmCurve):
    """``glm.mix`` of double-precision quaternions, one call per sample.  zlib licence.

    GLM documents an interpolation that "is oriented and the rotation is performed at constant speed",
    and recommends ``slerp`` for short paths: C^0, interpolating, local (two keyframes shape a segment).
    Signs are taken as they come [pyglm].  Orientations only.
    """

    title = "PyGLM mix"
    function = "mix"
