"""Curves of motions: one batched curve for the orientations of all tracks, a spline for their positions."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from quatspline import catalogue
from quatspline.curve import Curve
from quatspline.inputs.arrays import at, real_array, switch
from quatspline.motion import positions as families
from quatspline.motion.positions import Places
from quatspline.options import declared_by
from quatspline.quaternion import FloatArray
from quatspline.solving import ConvergenceError

if TYPE_CHECKING:
    from quatspline.motion.motion import Motion

LARGE = 500
"""The exponent of two of positions whose slopes and second derivatives float64 holds."""

TANGENTS = ("in_tangents", "out_tangents")
"""Of a motion, and options of a scheme."""

EDGE = 8
"""Times this many ulp outside a piece count as its end."""


class MotionCurve:
    """The curve of a scheme through frames of a motion; see `Motion.curve`.

    Attributes
    ----------
    motion : the motion from which it was made
    pieces : the curves of the stretches between gaps
    failures : why tracks have no curve, by name; their values are NaN
    """

    def __init__(
        self, motion: Motion, scheme: str, every: int, positions: str, options: dict[str, Any]
    ) -> None:
        if isinstance(every, bool) or not isinstance(every, int | np.integer) or every < 1:
            raise ValueError(f"every={every!r}: a whole number, at least 1, is expected")
        given = dict(options)
        self.motion = motion
        self.closed = switch("closed", given.get("closed", False))
        self.hold = switch("hold", given.pop("hold", False))
        if self.closed and len(motion.edges) > 2:
            raise ValueError("closed: the motion has gaps")
        self.family = families.family(positions, catalogue.scheme(scheme), given)
        build = partial(catalogue.build, scheme, **given)
        tangents = _tangents(motion, scheme, given) if every == 1 else {}
        self.pieces = [
            _Piece(motion, a, b, every, build, self.family, tangents)
            for a, b in pairwise(motion.edges)
            if b - a > 1
        ]
        if not self.pieces:
            raise ValueError(f"a curve needs at least 2 frames, found {len(motion.stamps)}")
        self.errors: dict[str, Exception] = {}
        for piece in self.pieces:
            self.errors = piece.errors | self.errors
        self.failures = {name: str(error) for name, error in self.errors.items()}

    @property
    def orientation(self) -> Curve:
        """The curve of the orientations of all tracks that have one.

        Raises
        ------
        ValueError
            If the motion is in pieces, which have their own curves.
        """
        if len(self.pieces) > 1:
            raise ValueError(
                f"the motion is in {len(self.pieces)} pieces: each has its orientation"
            )
        return self.pieces[0].orientation

    @property
    def origin(self) -> Any:
        """The scipy B-spline of the positions, in time since the first keyframe.

        Exists for schemes with a degree (``moving-frame``).  Positions take the ends from the scheme: control
        points ``.c`` (m, J, 3) on the knots ``.t`` of ``orientation.axes``.

        Raises
        ------
        ValueError
            If there are no positions, they follow another family, or the motion is in pieces.
        """
        if self.motion.positions is None:
            raise ValueError("the motion has no positions")
        if not isinstance(self.family, families.SplineFamily):
            raise ValueError(
                "the positions are not a B-spline: only schemes with a degree make them one"
            )
        times = self.orientation.keyframes.knots
        x = self.motion.positions[self.pieces[0].index]
        return self.family.fitted(times, x, self.motion.closed and np.array_equal(x[0], x[-1]))

    @property
    def domain(self) -> tuple[float, float]:
        """From the first time to the last, in seconds since the motion's start."""
        return self.pieces[0].first, self.pieces[-1].last

    def __call__(self, t: ArrayLike) -> tuple[FloatArray, FloatArray | None]:
        """Quaternions S + (J, 4) and positions S + (J, 3) at times S, in seconds since the start.

        Raises
        ------
        ValueError
            Times outside the motion or inside one of its gaps.
        """
        times = real_array("t", t).astype(float)
        flat = times.reshape(-1)
        if self.hold and not self.closed:
            flat = np.clip(flat, *self.domain)
        tracks = len(self.motion.tracks)
        q = np.full((flat.size, tracks, 4), np.nan)
        x = None if self.motion.positions is None else np.empty((flat.size, tracks, 3))
        of = self._piece_of(flat, times.shape)
        for k, piece in enumerate(self.pieces):
            mine = of == k
            if mine.any():
                q[mine, :], places = piece(flat[mine])
                if x is not None:
                    x[mine] = places
        shape = (*times.shape, tracks)
        return q.reshape(*shape, 4), None if x is None else x.reshape(*shape, 3)

    def _piece_of(self, t: FloatArray, shape: tuple[int, ...]) -> NDArray[np.intp]:
        """Which piece times (m,) lie in; outside the domain, the curve of the nearest refuses."""
        firsts = np.array([piece.first for piece in self.pieces])
        lasts = np.array([piece.last for piece in self.pieces])
        slack = EDGE * np.spacing(lasts[-1])
        of = np.clip(np.searchsorted(firsts - slack, t, side="right") - 1, 0, len(firsts) - 1)
        lost = np.flatnonzero((t > lasts[of] + slack) & (of < len(firsts) - 1))
        if lost.size:
            i = int(lost[0])
            place = at("t", np.unravel_index(i, shape)) if shape else "t"
            gap = f"{lasts[of[i]]:.6g} to {firsts[of[i] + 1]:.6g}"
            raise ValueError(f"{place} = {t[i]:.9g}: inside a gap of the motion, {gap}")
        return of


class _Piece:
    """A curve without gaps."""

    def __init__(
        self,
        motion: Motion,
        begin: int,
        end: int,
        every: int,
        build: Callable[..., Curve],
        family: families.Family,
        tangents: dict[str, FloatArray],
    ) -> None:
        turning = end - begin - motion.closed
        index = begin + np.unique(
            [*range(0, turning, every), *([] if motion.closed else [turning - 1])]
        )
        self.index = times = np.append(index, end - 1) if motion.closed else index
        t = motion.times[times]
        self.first, self.last = float(t[0]), float(t[-1])
        q = motion.quaternions[index]
        self.tracks = q.shape[1]
        self.errors: dict[str, Exception] = {}
        self.good = np.arange(self.tracks)
        rows = {name: array[index] for name, array in tangents.items()}

        def of(tracks: NDArray[np.intp]) -> Curve:
            return build(t, q[:, tracks], **{name: row[:, tracks] for name, row in rows.items()})

        self.orientation = self._fitted(motion, of)
        self.fixed, self.moving, self.along = _places(motion, times, t, family)

    def _fitted(self, motion: Motion, of: Callable[[NDArray[np.intp]], Curve]) -> Curve:
        """The curve of all tracks, or of those that have one alone."""
        try:
            return of(self.good)
        except (ConvergenceError, ValueError) as error:
            for k, name in enumerate(motion.tracks if self.tracks > 1 else ()):
                try:
                    of(np.array([k]))
                except (ConvergenceError, ValueError) as own:
                    self.errors[name] = own
            self.good = np.array([k for k in self.good if motion.tracks[k] not in self.errors])
            if not self.errors or not self.good.size:
                raise error  # nothing goes on
        return of(self.good)

    def __call__(self, t: FloatArray) -> tuple[FloatArray, FloatArray | None]:
        q = np.full((t.size, self.tracks, 4), np.nan)
        q[:, self.good] = self.orientation(t)
        if self.fixed is None:
            return q, None
        x = np.tile(self.fixed, (t.size, 1))
        if self.along is not None:
            x[:, self.moving] = self.along(self.orientation.since(t) + self.first)
        return q, x.reshape(t.size, -1, 3)


def _tangents(motion: Motion, scheme: str, given: dict[str, Any]) -> dict[str, FloatArray]:
    """What the file's splines do between its keyframes, for a scheme that takes it and is given nothing else."""
    kept = {name: getattr(motion, name) for name in TANGENTS}
    takes = set(TANGENTS) <= set(declared_by(catalogue.scheme(scheme)))
    if not takes or given.keys() & kept or any(array is None for array in kept.values()):
        return {}
    return kept


def _places(
    motion: Motion, index: NDArray[np.intp], t: FloatArray, family: families.Family
) -> tuple[FloatArray | None, NDArray[np.intp], Places | None]:
    """Coordinates that stay (J * 3,), the columns of those that move, and their curve."""
    none = np.array([], np.intp)
    if motion.positions is None:
        return None, none, None
    x = motion.positions[index].reshape(len(index), -1)
    moving = np.flatnonzero((x != x[0]).any(axis=0))
    if not moving.size:
        return x[0], none, None
    closed = motion.closed and np.array_equal(x[0], x[-1])
    unit = _unit(x)
    along = family(t, x[:, moving] / unit, closed)
    return x[0], moving, lambda s: unit * along(s)


def _unit(x: FloatArray) -> float:
    """What makes positions no larger than `LARGE`: slopes of larger ones may overflow."""
    return 2.0 ** max(0, int(np.frexp(np.abs(x).max())[1]) - LARGE)
