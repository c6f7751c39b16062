"""What the wrappers of VTK share."""

from __future__ import annotations

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, with_return
from quatspline.quaternion import FloatArray


class VtkCurve(PeerCurve):
    """A ``vtkQuaternionInterpolator`` in one of its modes, one call per sample."""

    reference = "vtk"
    peer = "vtk"
    mode: str
    """Linear or Spline."""

    def _fit(self, keyframes: Keyframes) -> None:
        from vtkmodules.vtkCommonMath import vtkQuaternionInterpolator

        self.curve = vtkQuaternionInterpolator()
        getattr(self.curve, f"SetInterpolationTypeTo{self.mode}")()
        for time, q in zip(keyframes.knots.tolist(), with_return(keyframes).tolist(), strict=True):
            self.curve.AddQuaternion(time, q)

    def _orientation(self, t: FloatArray) -> FloatArray:
        q = np.empty((t.size, 4))
        row = [0.0] * 4
        for k, time in enumerate(t.tolist()):
            self.curve.InterpolateQuaternion(time, row)
            q[k] = row
        return q
