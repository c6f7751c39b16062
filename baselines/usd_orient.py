"""OpenUSD's orient operation with time samples."""

from __future__ import annotations

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, with_return
from quatspline.quaternion import FloatArray


class UsdOrient(PeerCurve):
    """An ``orient`` operation of double precision, its attribute read once per sample.  TOST 1.0.

    A stage's interpolation is linear unless it is told otherwise; between quaternions that is a slerp: C^0,
    interpolating, local (two keyframes shape a segment) [openusd].  Orientations only.
    """

    title = "OpenUSD time samples"
    reference = "openusd"
    peer = "usd-core"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "goes the short way",
        "test_time_scale": "holds the earlier of two time samples less than 1e-6 apart",
        "test_very_uneven_times": "small steps go along the chord as it is: norms off by 1e-8",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        from pxr import Gf, Usd, UsdGeom

        self.stage = Usd.Stage.CreateInMemory()  # an attribute does not keep its stage
        form = UsdGeom.Xform.Define(self.stage, "/body")
        orient = form.AddOrientOp(UsdGeom.XformOp.PrecisionDouble)
        for time, q in zip(keyframes.knots.tolist(), with_return(keyframes).tolist(), strict=True):
            orient.Set(Gf.Quatd(*q), time)
        self.attribute = orient.GetAttr()

    def _orientation(self, t: FloatArray) -> FloatArray:
        values = map(self.attribute.Get, t.tolist())
        q = [(value.GetReal(), *value.GetImaginary()) for value in values]
        return np.array(q, dtype=float).reshape(-1, 4)
