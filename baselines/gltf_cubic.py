"""Cubic Hermite interpolation of quaternions as glTF defines it: what files of animations mean."""

from __future__ import annotations

from typing import Any

import numpy as np

from quatspline.families.normalised import ARRIVING, CHORD, LEAVING, NORMALISED, set_ends
from quatspline.inputs.arrays import at, real_array, refuse_infinite
from quatspline.kernels.jit import REACH, compiled, fit_kernel
from quatspline.kernels.values import keyframe, put_quat, quat_at
from quatspline.keyframes import Keyframes
from quatspline.options import LARGEST
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve


@compiled
def slopes(q, h, closed, sign):
    """(2) at every keyframe, (n, 4)."""
    n = q.shape[0]
    v = np.empty((n, 4))
    for i in range(n):
        if closed or 0 < i < n - 1:
            before, after = h[i - 1], h[i]
            s0 = (1.0 / before) * (keyframe(q, i, sign) - keyframe(q, i - 1, sign))
            s1 = (1.0 / after) * (keyframe(q, i + 1, sign) - keyframe(q, i, sign))
            put_quat(v[i], 0, (1.0 / (before + after)) * (after * s0 + before * s1))
    if not closed:
        s0 = (1.0 / h[0]) * (quat_at(q[1], 0) - quat_at(q[0], 0))
        s1 = (1.0 / h[n - 2]) * (quat_at(q[n - 1], 0) - quat_at(q[n - 2], 0))
        put_quat(v[0], 0, 2.0 * s0 - quat_at(v[1], 0) if n > 2 else s0)
        put_quat(v[n - 1], 0, 2.0 * s1 - quat_at(v[n - 2], 0) if n > 2 else s1)
    return v


@fit_kernel
def FIT(q, h, closed, sign, parameters, segments, report):
    """Segments with the parabolas' tangents (2) on either side."""
    v = slopes(q, h, closed, sign)
    for i in range(h.size):
        a, b = keyframe(q, i, sign), keyframe(q, i + 1, sign)
        set_ends(segments[i], a, b, h[i] * keyframe(v, i, sign), h[i] * keyframe(v, i + 1, sign))
    report[REACH] = 0.0


class GltfCubic(SegmentCurve):
    """CUBICSPLINE of glTF 2.0 [gltf2]: cubic Hermite interpolation in R^4, normalised.

    C^1, interpolating, local (four keyframes shape a segment).  With u = (t - t_i) / h_i,

        x = (2u^3 - 3u^2 + 1) q_i + h_i (u^3 - 2u^2 + u) b_i
            + (3u^2 - 2u^3) q_{i+1} + h_i (u^3 - u^2) a_{i+1},    Q = x / |x|                    (1)

    where b are tangents that leave keyframes and a those that arrive.  By default both are those of the
    parabola through three keyframes, and the ends take their parabola's:

        a_i = b_i = (h_i s_{i-1} + h_{i-1} s_i) / (h_{i-1} + h_i),  s_i = (q_{i+1} - q_i) / h_i  (2)

    Options
    -------
    in_tangents, out_tangents
        a and b as a glTF file has them, scalar first, in the keyframes' shape (n, 4) or (n, *K, 4), per unit of
        time and for keyframes as given: they change sign where alignment changes their keyframe's.  The curve
        is C^0 where they differ.  The first a and the last b of an open curve serve no segment.
    """

    title = "glTF's cubic spline"
    reference = "gltf2"
    continuity = 1
    order = 3
    support = 4
    constant_rate = "no"
    family = NORMALISED

    def _fit(
        self, keyframes: Keyframes, *, in_tangents: Any = None, out_tangents: Any = None
    ) -> None:
        self._solve(FIT, whole=in_tangents is not None or out_tangents is not None)
        if in_tangents is not None:
            arriving = _tangents("in_tangents", in_tangents, keyframes)
            back = keyframes.signs[:, None, None] * arriving[:, :1]
            self._put(ARRIVING, np.concatenate([arriving[:, 1:], back], axis=1))
        if out_tangents is not None:
            leaving = _tangents("out_tangents", out_tangents, keyframes)
            self._put(LEAVING, leaving)
        if in_tangents is not None or out_tangents is not None:
            self._claim(in_tangents, out_tangents)

    def _put(self, place: int, tangents: FloatArray) -> None:
        """Write f or g of the family from tangents (K, n, 4), the last of which no open segment has."""
        h, chords = self._keyframes.spacings, self.segments[:, :, CHORD : CHORD + 4]
        self.segments[:, :, place : place + 4] = h[:, None] * tangents[:, : h.size] - chords

    def _claim(self, arriving: Any, leaving: Any) -> None:
        """With given tangents a segment knows its own ends; where they differ the curve turns sharply."""
        inner = slice(None) if self._keyframes.closed else slice(1, -1)
        both = arriving is not None and leaving is not None
        same = both and np.array_equal(np.asarray(arriving)[inner], np.asarray(leaving)[inner])
        self.continuity, self.support = int(same), 2 if both else 4


def _tangents(name: str, given: Any, keyframes: Keyframes) -> FloatArray:
    """Tangents as rows (K, n, 4), with the signs of their keyframes; refused where they are none."""
    array = real_array(name, given)
    shape = (keyframes.count, *keyframes.track_shape, 4)
    if array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}: expected {shape}, that of the keyframes")
    refuse_infinite(name, array)
    rows = np.moveaxis(array.astype(float).reshape(keyframes.count, -1, 4), 1, 0)
    longest = float(keyframes.spacings.max())
    far = np.argwhere(np.abs(array) * longest > LARGEST)
    if far.size:
        where = tuple(int(i) for i in far[0])
        raise ValueError(
            f"{at(name, where)} = {array[where]:g}: more than {LARGEST:g} on a segment of {longest:g}"
        )
    return keyframes.flips[..., None] * rows
