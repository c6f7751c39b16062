"""What the wrappers of PyGLM share."""

from __future__ import annotations

from typing import Any

from quatspline.peers.pairwise import PairwiseSlerp
from quatspline.quaternion import FloatArray


class PyGlmCurve(PairwiseSlerp):
    """Two double-precision quaternions of PyGLM and a function of them, one call per sample."""

    reference = "pyglm"
    peer = "PyGLM"
    function: str
    """Its name in ``glm``."""

    def _load(self) -> None:
        from pyglm import glm

        self.library = glm
        self.call = getattr(glm, self.function)

    def _rotation(self, q: FloatArray) -> Any:
        return self.library.dquat(*q.tolist())

    def _between(self, a: Any, b: Any, u: float) -> tuple[float, ...]:
        q = self.call(a, b, u)
        return q.w, q.x, q.y, q.z
