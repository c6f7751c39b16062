"""A recorded motion: timed local orientations of one body or of the joints of a skeleton."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from quatspline import quaternion
from quatspline.inputs import stamps
from quatspline.motion.skeleton import Skeleton
from quatspline.quaternion import FloatArray

if TYPE_CHECKING:
    from quatspline.motion.motion_curve import MotionCurve
    from quatspline.motion.reducing import Reduction

Times = NDArray[Any]
"""(n,) float64, or int64 where stamps are integers that float64 does not hold."""

UNITS = (1, 10**3, 10**6, 10**9)
"""Units of stamps in a second."""

BODY = ("body",)
"""The one track of a motion without a skeleton."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Timed orientations of tracks, with positions and a skeleton if there are any.

    A single track may be given as (n, 4) and (n, 3).

    Attributes
    ----------
    stamps : (n,), strictly increasing, as in the file: int64 for integers beyond 2**53, float64
        otherwise; (n + 1,) for a closed motion, whose last stamp is that of the return
    quaternions : (n, J, 4) local, scalar first, as given: unit within `keyframes.NORM_TOLERANCE`
    positions : (len(stamps), J, 3) local, or None
    tracks : the names of joints in the file's order; one body's is "body"
    skeleton : the hierarchy of joints, or None
    unit : unit of positions: "m", or "file" if the file does not say
    per_second : stamps per second; 1 if the file names no other unit
    max_gap : seconds between frames beyond which the motion is split into pieces, or None
    unread : names of other content of the file, which is not carried along
    note : how an ambiguity in the file was resolved, or ""
    interpolation : how a glTF file interpolates between keyframes: "LINEAR", "STEP", "CUBICSPLINE"; or None
    in_tangents, out_tangents : tangents of a CUBICSPLINE's rotations (n, J, 4), scalar first, or None

    Examples
    --------
    >>> import numpy as np, quatspline as qs
    >>> motion = qs.Motion(np.array([10.0, 10.5]), np.array([[1.0, 0, 0, 0], [0.8, 0.6, 0, 0]]))
    >>> motion.start, motion.times, motion.quaternions.shape
    (10.0, array([0. , 0.5]), (2, 1, 4))
    """

    stamps: Times
    quaternions: FloatArray
    positions: FloatArray | None = None
    tracks: Sequence[str] = BODY
    skeleton: Skeleton | None = None
    unit: str = "file"
    per_second: int = 1
    max_gap: float | None = None
    unread: tuple[str, ...] = ()
    note: str = ""
    interpolation: str | None = None
    in_tangents: FloatArray | None = None
    out_tangents: FloatArray | None = None

    def __post_init__(self) -> None:
        kept = {"stamps": stamps.stamps("stamps", self.stamps), "tracks": list(self.tracks)}
        for name in ("quaternions", "positions"):
            array = getattr(self, name)
            if array is not None:
                array = np.asarray(array, dtype=float)
                kept[name] = array[:, np.newaxis] if array.ndim == 2 else array
        for name, value in kept.items():
            object.__setattr__(self, name, value)
        _check_shapes(self)

    # -- what it is -------------------------------------------------------------------------------

    @property
    def start(self) -> float | int:
        """The first stamp as the file has it."""
        start: float | int = self.stamps[0].item()
        return start

    @cached_property
    def times(self) -> FloatArray:
        """Seconds since the start (n,): integers are subtracted as integers."""
        return stamps.elapsed(self.stamps, self.stamps[0]) / self.per_second

    @property
    def closed(self) -> bool:
        """Whether the last time marks the return to the first orientation."""
        return len(self.stamps) > len(self.quaternions)

    def world(self) -> tuple[FloatArray, FloatArray]:
        """Quaternions (n, J, 4) and positions (n, J, 3) of the joints in the world.

        A body without positions stays at the origin.
        """
        x = self._places()
        if self.skeleton is not None:
            return self.skeleton.world(self.quaternions, x)
        places = np.zeros((*self.quaternions.shape[:2], 3)) if x is None else x.copy()
        return quaternion.normalise(self.quaternions), places

    def ends(self) -> dict[str, FloatArray]:
        """World positions of end effectors, (n, 3), by the name of their joint.

        The end site of a joint that has one; otherwise the joint itself, if it has no children.
        """
        turns, places = self.world()
        ends = {} if self.skeleton is None else self.skeleton.ends
        leaves = range(len(self.tracks)) if self.skeleton is None else self.skeleton.leaves
        found = {}
        for joint in sorted({*leaves, *ends}):
            tip = quaternion.rotate(turns[:, joint], ends.get(joint, np.zeros(3)))
            found[self.tracks[joint]] = places[:, joint] + tip
        return found

    def _places(self) -> FloatArray | None:
        return None if self.positions is None else self.positions[: len(self.quaternions)]

    # -- parts of it ------------------------------------------------------------------------------

    def frames(self, index: slice | NDArray[Any]) -> Motion:
        """The motion of some frames, in order; the file's tangents are kept if no frame between is left out."""
        held = ("stamps", "quaternions", "positions", "in_tangents", "out_tangents")
        arrays = {name: getattr(self, name) for name in held}
        picked = {name: a[index] for name, a in arrays.items() if a is not None}
        part = dataclasses.replace(self, **picked)
        if self.interpolation != "CUBICSPLINE" or _is_run(index, len(self.stamps)):
            return part
        return part.without_tangents()

    def without_tangents(self) -> Motion:
        """The motion without the tangents and interpolation of the file."""
        kept = None if self.interpolation == "CUBICSPLINE" else self.interpolation
        return dataclasses.replace(self, interpolation=kept, in_tangents=None, out_tangents=None)

    def aligned(self) -> Motion:
        """The motion with neighbours in time on one hemisphere, and tangents to match."""
        q = quaternion.align(self.quaternions)
        flips = np.where((q == self.quaternions).all(axis=-1, keepdims=True), 1.0, -1.0)
        tangents = {
            name: flips * getattr(self, name)
            for name in ("in_tangents", "out_tangents")
            if getattr(self, name) is not None
        }
        return dataclasses.replace(self, quaternions=q, **tangents)

    @cached_property
    def edges(self) -> list[int]:
        """The frames at which pieces begin, and the number of frames."""
        gaps = np.array([], int)
        if self.max_gap is not None:
            gaps = np.flatnonzero(np.diff(self.times) > self.max_gap) + 1
        return [0, *gaps.tolist(), len(self.stamps)]

    def pieces(self) -> list[Motion]:
        """The motion between gaps longer than ``max_gap``; all of it where there are none."""
        if len(self.edges) == 2:
            return [self]
        return [self.frames(slice(a, b)) for a, b in pairwise(self.edges)]

    def moved(self, times: Times, quaternions: FloatArray, positions: FloatArray | None) -> Motion:
        """The motion of the same tracks at other stamps."""
        return dataclasses.replace(
            self,
            stamps=times,
            quaternions=quaternions,
            positions=positions,
            interpolation=None,
            in_tangents=None,
            out_tangents=None,
        )

    # -- curves -----------------------------------------------------------------------------------

    def curve(
        self, scheme: str, every: int = 1, positions: str = "matched", **options: Any
    ) -> MotionCurve:
        """The curve of a scheme through every n-th frame and the last one, for all tracks at once.

        Parameters
        ----------
        scheme : a name of `quatspline.schemes`
        every : keyframes are the frames 0, every, 2 every, ... and the last
        positions : "matched" uses the counterpart of the scheme for positions, with the degree and ends of
            a global scheme; or a family by name: "linear", "catmull-rom", "cubic", "local-quintic", "quartic"
        **options : options of the scheme, and ``closed``, ``align``; ``gltf-cubic`` uses the file's own
            tangents if there are any, none are given, and no frame is left out

        Raises
        ------
        ValueError
            For an unknown scheme or option, or input that the scheme cannot take.
        """
        from quatspline.motion.motion_curve import MotionCurve

        return MotionCurve(self, scheme, every, positions, options)

    def resample(
        self,
        rate: float | None = None,
        scheme: str = "slerp",
        *,
        times: ArrayLike | None = None,
        positions: str = "matched",
        **options: Any,
    ) -> Motion:
        """The motion at another rate (Hz), or at given times in seconds since the start.

        Raises
        ------
        ValueError
            If neither or both of rate and times are given, or for times outside the motion or in its gaps.
        ConvergenceError
            If a solver fails on a track; the error names the track.
        """
        from quatspline.motion.resampling import resampled

        return resampled(self, rate, scheme, times, positions, options)

    def reduce(
        self, scheme: str = "slerp", *, error: float, together: bool = False, **options: Any
    ) -> Reduction:
        """Keyframes from which a scheme rebuilds the motion within an angle.

        Parameters
        ----------
        scheme : a name of `quatspline.schemes`
        error : the largest local angle (rad) at the frames left out
        together : use one set of keyframes for all joints instead of one per joint
        **options : options of the scheme

        Raises
        ------
        ValueError
            Where the motion has gaps.
        """
        from quatspline.motion.reducing import reduction

        return reduction(self, scheme, error, together, options)


def _is_run(index: slice | NDArray[Any], count: int) -> bool:
    """Whether an index picks frames that follow each other, of so many."""
    return bool((np.diff(np.arange(count)[index]) == 1).all())


def _check_shapes(motion: Motion) -> None:
    q, x, n = motion.quaternions, motion.positions, len(motion.stamps)
    tracks = len(motion.tracks)
    if q.shape[1:] != (tracks, 4) or n - len(q) not in (0, 1) or not len(q):
        raise ValueError(
            f"quaternions has shape {q.shape}: expected ({n}, {tracks}, 4) for {n} stamps, {tracks} tracks"
        )
    if len(set(motion.tracks)) < tracks:
        again = next(name for name in motion.tracks if list(motion.tracks).count(name) > 1)
        raise ValueError(f"tracks: two are called {again!r}")
    if motion.per_second not in UNITS:
        raise ValueError(f"per_second = {motion.per_second}: one of {UNITS} is expected")
    if motion.skeleton is not None and len(motion.skeleton.parents) != tracks:
        raise ValueError(
            f"the skeleton has {len(motion.skeleton.parents)} joints for {tracks} tracks"
        )
    for name in ("in_tangents", "out_tangents"):
        tangents = getattr(motion, name)
        if tangents is not None and np.shape(tangents) != q.shape:
            raise ValueError(f"{name} has shape {np.shape(tangents)}: expected {q.shape}")
    if x is not None and x.shape != (n, tracks, 3):
        raise ValueError(f"positions has shape {x.shape}: expected ({n}, {tracks}, 3)")
