"""Moving frames of Jiang & Ma: a spline through the frames' axes, then the nearest rotation.

The columns of the keyframes' matrices R_i are interpolated, entry by entry, by a spline B(t) of odd
degree k (`fitting.frame_splines`).  The curve is the rotation C(t) nearest to B(t), the one that maximises
tr(C^T B) [jiang2000, (3.4)], found by an iteration on its Cayley parameters (`families.nearest_rotation`).
The published text available to us ends before its own iteration.
"""

from __future__ import annotations

from typing import Any, Literal, NamedTuple

import numpy as np

from quatspline import quaternion
from quatspline.families.frames import FRAMES
from quatspline.fitting.end_conditions import fewest, interpolated, natural
from quatspline.fitting.frame_splines import Rates, axes_of, complete, constants
from quatspline.inputs.arrays import at, real_array, refuse_infinite
from quatspline.keyframes import Keyframes
from quatspline.options import LARGEST
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve


class Axes(NamedTuple):
    """The splines of a frame's axes, scipy's ``BSpline`` each, in time since the first keyframe."""

    e_x: Any
    e_y: Any
    e_z: Any


class MovingFrame(SegmentCurve):
    """Moving frames of Jiang & Ma (2000): spline of the frames' axes, then the nearest rotation.

    C^(k-1) for degree k, interpolating, global, order k + 1.  Nothing is solved but a banded linear
    system; each sample finds a nearest rotation by an iteration of its own (see the module).  A frame
    carries no sign: every step goes the short way, with ``align=False`` too.  The axes shorten and
    their spline cuts corners where steps are large: beyond about 120 degrees it is of little use.

    Options
    -------
    degree
        k = 3, 5, 7 or 9.
    ends
        "natural": derivatives (k + 1)/2 ... k - 1 vanish at the ends.  "not-a-knot": needs k + 1
        keyframes.  "complete": derivatives 1 ... (k - 1)/2 are set, velocity, acceleration, jerk and its
        derivative; those not given are estimated from the polynomial through k + 1 keyframes in
        the chart of the end.  By default natural, or complete where a rate is given.  Closed curves
        are periodic.
    start_velocity, end_velocity, start_acceleration, end_acceleration
        Body rates (3,) or (*K, 3) in rad per time and per its square; accelerations from degree 5 on.

    Attributes
    ----------
    axes
        The three splines before the nearest rotation is taken: ``curve.axes.e_x.c`` are control points
        (m, *K, 3), ``.t`` the knots, in time since the first keyframe.
    """

    title = "Moving frames of Jiang & Ma"
    reference = "jiang2000"
    continuity = 2
    order = 4
    support = None
    constant_rate = "no"
    family = FRAMES[3]
    departs = {"test_keeps_given_signs": "a frame carries no sign"}

    def _fit(
        self,
        keyframes: Keyframes,
        *,
        degree: Literal[3, 5, 7, 9] = 3,
        ends: Literal["natural", "not-a-knot", "complete"] | None = None,
        start_velocity: Any = None,
        end_velocity: Any = None,
        start_acceleration: Any = None,
        end_acceleration: Any = None,
    ) -> None:
        self.continuity, self.order = degree - 1, degree + 1
        self.family = FRAMES[degree]
        given = {
            "start_velocity": start_velocity,
            "start_acceleration": start_acceleration,
            "end_velocity": end_velocity,
            "end_acceleration": end_acceleration,
        }
        given = {name: rate for name, rate in given.items() if rate is not None}
        ends = ends or ("complete" if given else "natural")
        _check_ends(keyframes, degree, ends, given)
        t, q = keyframes.knots / keyframes.unit, np.moveaxis(keyframes.tracks, 0, 1)
        if keyframes.closed:
            q = np.concatenate([q, keyframes.signs[:, None] * q[:1]])
        q = quaternion.align(q)
        axes = axes_of(q)
        if keyframes.closed:
            axes[-1], conditions = axes[0], "periodic"
        else:
            rates = {name: _rates(name, rate, keyframes) for name, rate in given.items()}
            conditions = _conditions(t, q, degree, ends, rates)
        self._spline = interpolated(t, axes, degree, conditions)
        self._set_segments(constants(self._spline, t, q, axes), 0.0)

    @property
    def axes(self) -> Axes:
        """The splines of the axes; see the class."""
        from scipy.interpolate import BSpline

        frames, spline = self._keyframes, self._spline
        c = spline.c.reshape(len(spline.c), *frames.track_shape, 3, 3)
        columns = (c[..., j, :] for j in range(3))
        knots = spline.t * frames.unit
        beyond: Literal["periodic"] | bool = "periodic" if frames.closed else False
        return Axes(*(BSpline(knots, column, spline.k, extrapolate=beyond) for column in columns))


def _check_ends(keyframes: Keyframes, degree: int, ends: str, given: dict[str, Any]) -> None:
    """Refuse rates that the ends do not take, and too few keyframes."""
    for name in given:
        if keyframes.closed:
            raise ValueError(f"{name}: a closed curve has no ends")
        if ends != "complete":
            raise ValueError(f"{name}: only with ends='complete', not ends={ends!r}")
        if degree == 3 and name.endswith("acceleration"):
            raise ValueError(f"{name}: degree=3 takes velocities only at its ends")
    least = fewest(degree, ends)
    if keyframes.count < least and not keyframes.closed:
        raise ValueError(
            f"quaternions has {keyframes.count} keyframes: degree={degree} with ends={ends!r} "
            f"needs {least}"
        )


def _rates(name: str, given: Any, keyframes: Keyframes) -> FloatArray:
    """Rates (3,) or (*K, 3) as rows (K, 3) in units of the spline's time; refused where they are none."""
    array = real_array(name, given)
    shapes = sorted({(3,), (*keyframes.track_shape, 3)}, key=len)
    if array.shape not in shapes:
        expected = " or ".join(map(str, shapes))
        raise ValueError(f"{name} has shape {array.shape}: expected {expected}")
    refuse_infinite(name, array)
    power = 2 if name.endswith("acceleration") else 1
    h = float(keyframes.spacings[0 if name.startswith("start") else -1])
    far = np.argwhere(np.abs(array) * h**power > LARGEST)
    if far.size:
        where = tuple(int(i) for i in far[0])
        raise ValueError(
            f"{at(name, where)} = {array[where]:g}: more than {LARGEST:g} rad on a segment of {h:g}"
        )
    rows = array.astype(float).reshape(-1, 3) * keyframes.unit**power
    return np.ascontiguousarray(np.broadcast_to(rows, (keyframes.tracks.shape[0], 3)))


def _conditions(
    t: FloatArray, q: FloatArray, degree: int, ends: str, rates: dict[str, FloatArray]
) -> Any:
    """The end conditions as scipy takes them: (derivative, values) at either end."""
    if ends == "not-a-knot":
        return None
    if ends == "natural":
        return natural(degree, (q.shape[1], 3, 3))
    start: Rates = rates.get("start_velocity"), rates.get("start_acceleration")
    end: Rates = rates.get("end_velocity"), rates.get("end_acceleration")
    return complete(t, q, degree, start), complete(t[::-1], q[::-1], degree, end)
