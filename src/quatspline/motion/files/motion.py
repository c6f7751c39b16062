"""A motion as files hold it: timed orientations, with positions where there are some."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quatspline import quaternion
from quatspline.inputs import stamps
from quatspline.keyframes import prepare, segment_of
from quatspline.quaternion import FloatArray

REPEATED = 1e-6
"""A last orientation within this angle (rad) of the first is the return of a closed motion."""

NEARLY, SHARE = np.radians(3.0), 0.25
"""Beyond that, a last orientation this near (rad), by this share of the median step, is ambiguous."""

Times = NDArray[Any]
"""(n,) float64, or int64 where stamps are integers that float64 does not hold."""


class KeyframeFileError(ValueError):
    """A keyframe file that cannot be read or written; the message names the file and the line."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Timed orientations, with positions where the file had them.

    Attributes
    ----------
    times : (n,), strictly increasing; (n + 1,) where the last is a closed motion's return; int64 where
        the file has integer stamps beyond 2**53, float64 otherwise
    quaternions : (n, 4), scalar first, as given: unit within `keyframes.NORM_TOLERANCE`
    positions : (len(times), 3), or None
    unread : names of what else the file has, which is not carried on
    note : what a reader of the result must know of how the motion was understood, or ""
    """

    times: Times
    quaternions: FloatArray
    positions: FloatArray | None = None
    unread: tuple[str, ...] = ()
    note: str = ""

    def sampled(self, times: Times, quaternions: FloatArray) -> Motion:
        """Samples (m,), (m, 4) of a curve through this motion; positions follow linearly."""
        if self.positions is None:
            return Motion(times, quaternions)
        t, knots = (stamps.elapsed(given, self.times[0]) for given in (times, self.times))
        return Motion(times, quaternions, _between(t, knots, self.positions))

    def opened(self) -> Motion:
        """This motion as an open one; raises ValueError where it has a time for its return."""
        t, q = self.times, self.quaternions
        if len(t) > len(q):
            raise ValueError(
                f"{len(t)} times for {len(q)} quaternions: an open motion has one time per "
                "keyframe; --closed takes the last time as that of the return"
            )
        return self

    def returning(self) -> Motion:
        """This motion closed: n keyframes and n + 1 times.

        The last row is the return where it repeats the first orientation (within `REPEATED`);
        otherwise uniform times go on for one more step.  A last row that nearly repeats the first is a
        keyframe like any other, so that none is dropped, and the note says so.  Raises ValueError
        when neither tells the time of the return.
        """
        t, q = self.times, self.quaternions
        if len(t) == len(q) + 1 or len(t) < 2:
            return self
        gap = float(quaternion.distance(*quaternion.normalise(q[[-1, 0]])))
        if gap < REPEATED:
            return replace(self, quaternions=q[:-1])
        near = f"the last row is {np.degrees(gap):.2g} degrees from the first orientation"
        ambiguous = gap < min(NEARLY, SHARE * _median_step(q))
        if not prepare(t, q).uniform:
            raise ValueError(
                "closed: times are not uniform, so the last row must repeat the first orientation "
                f"at the time of its return{f'; {near}' if ambiguous else ''}"
            )
        note = f"closed: {near}: taken as a keyframe of its own, the return follows one step later"
        return self._one_step_more(note if ambiguous else "")

    def _one_step_more(self, note: str) -> Motion:
        t, x = self.times, self.positions
        end = _one_step_after(t)
        x = None if x is None else np.concatenate([x, x[:1]])
        return replace(self, times=np.append(t, np.asarray(end, t.dtype)), positions=x, note=note)


def _between(t: FloatArray, knots: FloatArray, x: FloatArray) -> FloatArray:
    """Positions x (n, 3) at knots (n,), linearly at t (m,), which lies between the first and the last.

    Differences are halved, since those of finite positions, and slopes even more so, may overflow.
    """
    i = segment_of(knots, t)
    u = ((t - knots[i]) / (knots[i + 1] - knots[i]))[:, np.newaxis]
    step = u * (x[i + 1] / 2 - x[i] / 2)
    return np.where(u < 1.0, x[i] + step + step, x[i + 1])


def _median_step(q: FloatArray) -> float:
    q = quaternion.normalise(q)
    return float(np.median(quaternion.distance(q[1:], q[:-1])))


def _one_step_after(t: Times) -> float | int:
    """The time after uniform times: of integers, the nearest integer, without rounding to float64."""
    first, last, steps = t[0].item(), t[-1].item(), len(t) - 1
    if t.dtype.kind == "f":
        return first + (last - first) * (len(t) / steps)
    end = first + (2 * (last - first) * len(t) + steps) // (2 * steps)
    if end > np.iinfo(t.dtype).max:
        raise ValueError(f"closed: the return at {end} is beyond 64-bit integers")
    return end
