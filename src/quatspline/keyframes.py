"""Keyframes: the one place where input is validated, normalised, aligned and closed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from quatspline._jit import compiled
from quatspline.quaternion import ANTIPODAL, FloatArray

NORM_TOLERANCE = 1e-3
"""Quaternions off the unit sphere by more than this are refused; within it they are normalised."""

UNIFORM = 1e-9
"""Spacings equal to this relative accuracy (and to the rounding of the times) count as uniform."""


@dataclass(frozen=True, eq=False)
class Keyframes:
    """Validated keyframes of one or several tracks, as schemes receive them.

    Attributes
    ----------
    times : (n,) or, closed, (n + 1,) float64, as given; the last of a closed set is the return
    knots : times since the first, (n,) or (n + 1,): all work is done in these
    spacings : knot spacings h, one a segment: (n - 1,) or, closed, (n,)
    tracks : (K, n, 4) float64, unit quaternions, neighbours on one hemisphere unless kept as given
    track_shape : the shape whose product is K; () for a single track
    closed : whether the last keyframe leads back to the first
    signs : (K,) float64, +1 or -1: the curve returns as sign times the first keyframe
    """

    times: FloatArray
    knots: FloatArray
    spacings: FloatArray
    tracks: FloatArray
    track_shape: tuple[int, ...]
    closed: bool
    signs: FloatArray

    @property
    def quaternions(self) -> FloatArray:
        """The keyframes (n, 4) of a single track (`track` picks one of several)."""
        if self.tracks.shape[0] != 1:
            raise ValueError(f"{self.tracks.shape[0]} tracks: pick one with track(k)")
        return self.tracks[0]

    @property
    def count(self) -> int:
        """The number of keyframes n."""
        return self.tracks.shape[1]

    @property
    def sign(self) -> float:
        """The closing sign of a single track."""
        return float(self.signs[0])

    @property
    def uneven(self) -> int | None:
        """The first spacing that differs from spacing 0 by more than the times' rounding."""
        h = self.spacings
        rounding = 8 * np.spacing(np.abs(self.times[[0, -1]]).max())
        differs = np.flatnonzero(np.abs(h - h[0]) > UNIFORM * h[0] + rounding)
        return int(differs[0]) if differs.size else None

    @property
    def uniform(self) -> bool:
        """Whether all spacings are equal, up to the rounding of the given times."""
        return self.uneven is None

    def track(self, k: int) -> Keyframes:
        """The keyframes of one track."""
        own = slice(k, k + 1)
        return replace(self, tracks=self.tracks[own], track_shape=(), signs=self.signs[own])

    def shaped(self) -> FloatArray:
        """The keyframes in the caller's shape (n, *track_shape, 4)."""
        return np.moveaxis(self.tracks, 0, 1).reshape(-1, *self.track_shape, 4)


def prepare(
    times: ArrayLike | None,
    quaternions: Any,
    *,
    closed: bool = False,
    align: bool = True,
    closing_sign: int | None = None,
    min_keyframes: int = 2,
) -> Keyframes:
    """Validate, normalise and align keyframes.

    Parameters
    ----------
    times
        (n,) strictly increasing, or (n + 1,) closed: the last is where the first keyframe returns.
        None means 0, 1, 2, ...
    quaternions
        (n, 4) scalar first, (n, *K, 4) for several tracks, or a scipy ``Rotation``.
    closed, align, closing_sign
        As in `quatspline.build`.
    min_keyframes
        Fewer than these are refused.

    Raises
    ------
    ValueError
        Names the argument, the first offending index and the value.
    """
    q = _quaternions(quaternions, min_keyframes)
    n = q.shape[0]
    t, knots, spacings = _times(np.arange(n + closed) if times is None else times, n, closed)
    if closing_sign is not None and (align or not closed or closing_sign not in (1, -1)):
        raise ValueError(
            f"closing_sign={closing_sign!r}: give 1 or -1, and only with closed=True, align=False"
        )
    track_shape = q.shape[1:-1]
    rows = q.reshape(n, -1, 4)
    tracks, signs = np.empty((rows.shape[1], n, 4)), np.empty(rows.shape[1])
    if not _take(rows, bool(align), bool(closed), float(closing_sign or 1), tracks, signs):
        _explain(q)
    keyframes = Keyframes(t, knots, spacings, tracks, track_shape, bool(closed), signs)
    if not align:
        _refuse_antipodes(keyframes)
    for array in (t, knots, spacings, tracks, signs):
        array.setflags(write=False)
    return keyframes


def _array(name: str, given: Any) -> FloatArray:
    """A float64 array of real numbers, or a sentence that says why not."""
    try:
        array = np.asarray(given)
    except ValueError:
        raise ValueError(f"{name}: rows of unequal length, or not numbers") from None
    if array.dtype.kind not in "iuf":
        kind = "complex" if array.dtype.kind == "c" else "not real numbers"
        raise ValueError(f"{name}: {kind} (dtype {array.dtype})")
    array = np.asarray(array, dtype=float, order="C")
    return array if array.flags.writeable else array.copy()  # one compiled signature serves all


def _refuse_infinite(name: str, array: FloatArray) -> None:
    if not np.isfinite(array).all():
        first = np.argwhere(~np.isfinite(array))[0]
        raise ValueError(f"{_at(name, first)} = {array[tuple(first)]}: not a finite number")


def _at(name: str, index: Any) -> str:
    return f"{name}[{', '.join(str(int(i)) for i in np.atleast_1d(index))}]"


def _quaternions(given: Any, least: int) -> FloatArray:
    if hasattr(given, "as_quat"):
        given = given.as_quat(scalar_first=True)
    q = _array("quaternions", given)
    if q.ndim < 2 or q.shape[-1] != 4:
        _refuse_infinite("quaternions", q)
        raise ValueError(f"quaternions has shape {q.shape}: expected (n, 4) or (n, ..., 4)")
    if q.shape[0] < least:
        raise ValueError(f"quaternions has {q.shape[0]} keyframes: at least {least} are needed")
    if q.size == 0:
        raise ValueError(f"quaternions has shape {q.shape}: no track in it")
    return q


@compiled
def _take(q, align, closed, closing_sign, tracks, signs):
    """Normalise (n, K, 4) into tracks (K, n, 4), aligned, and close them; False if one is no unit."""
    for k in range(tracks.shape[0]):
        sign = 1.0
        for i in range(tracks.shape[1]):
            w, x, y, z = q[i, k, 0], q[i, k, 1], q[i, k, 2], q[i, k, 3]
            norm = math.sqrt(w * w + x * x + y * y + z * z)
            if not abs(norm - 1.0) <= NORM_TOLERANCE:  # NaN is off too
                return False
            if align and i > 0:
                dot = (
                    w * q[i - 1, k, 0]
                    + x * q[i - 1, k, 1]
                    + y * q[i - 1, k, 2]
                    + z * q[i - 1, k, 3]
                )
                sign = -sign if dot < 0.0 else sign
            short = (1.0 - norm) / norm  # x / norm = x + short x, to a rounding, and cheaper
            tracks[k, i, 0] = sign * (w + short * w)
            tracks[k, i, 1] = sign * (x + short * x)
            tracks[k, i, 2] = sign * (y + short * y)
            tracks[k, i, 3] = sign * (z + short * z)
        signs[k] = closing_sign
        if closed and align:
            a, b = tracks[k, 0], tracks[k, tracks.shape[1] - 1]
            dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
            signs[k] = -1.0 if dot < 0.0 else 1.0
    return True


def _explain(q: FloatArray) -> None:
    """Refuse quaternions of which one is not finite or not of unit length."""
    _refuse_infinite("quaternions", q)
    with np.errstate(over="ignore"):
        norms = np.linalg.norm(q, axis=-1)
    off = np.argwhere(~(np.abs(norms - 1.0) <= NORM_TOLERANCE))[0]
    raise ValueError(
        f"{_at('quaternions', off)} = {q[tuple(off)].tolist()} has norm {norms[tuple(off)]:.6g}: "
        f"not a unit quaternion (off by more than {NORM_TOLERANCE:g})"
    )


def _times(given: Any, n: int, closed: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times, times since the first, and spacings."""
    t = _array("times", given)
    if t.shape != (n + closed,):
        _refuse_infinite("times", t)
        wanted = f"({n + closed},)" + (" (one more than keyframes: the return)" if closed else "")
        raise ValueError(f"times has shape {t.shape}: expected {wanted} for {n} keyframes")
    knots, spacings = np.empty(t.size), np.empty(t.size - 1)
    if not _space(t, knots, spacings):
        _explain_times(t, knots)
    return t.copy(), knots, spacings


@compiled
def _space(t, knots, spacings):
    """Fill in times since the first and their spacings; whether all are positive and finite."""
    for i in range(t.size):
        knots[i] = t[i] - t[0]
    bad = 0
    for i in range(spacings.size):
        spacings[i] = knots[i + 1] - knots[i]
        bad += not 0.0 < spacings[i] < math.inf
    return bad == 0


def _explain_times(t: FloatArray, knots: FloatArray) -> None:
    """Refuse times that do not increase, or of which float64 cannot tell the spacings."""
    _refuse_infinite("times", t)
    stuck = np.flatnonzero(t[1:] <= t[:-1])
    if stuck.size:
        i = int(stuck[0]) + 1
        raise ValueError(
            f"times[{i}] = {float(t[i])!r} does not exceed times[{i - 1}] = {float(t[i - 1])!r}: "
            "times must strictly increase"
        )
    if not np.isfinite(knots[-1]):
        raise ValueError(f"times span {float(t[0])!r} to {float(t[-1])!r}: too long for float64")
    i = int(np.flatnonzero(knots[1:] <= knots[:-1])[0]) + 1
    raise ValueError(
        f"times[{i}] = {float(t[i])!r} is too close to times[{i - 1}] = {float(t[i - 1])!r}, "
        f"{float(knots[i])!r} after times[0]: float64 does not tell them apart"
    )


def _refuse_antipodes(keyframes: Keyframes) -> None:
    q = keyframes.tracks
    if keyframes.closed:
        q = np.concatenate([q, keyframes.signs[:, None, None] * q[:, :1]], axis=1)
    gaps = np.linalg.norm(q[:, 1:] + q[:, :-1], axis=-1)
    antipodal = np.argwhere(gaps.T < ANTIPODAL)
    if antipodal.size:
        i, k = (int(index) for index in antipodal[0])
        track = np.unravel_index(k, keyframes.track_shape) if keyframes.track_shape else ()
        here, there = (_at("quaternions", [j, *track]) for j in (i, (i + 1) % keyframes.count))
        raise ValueError(
            f"{here} and {there} are exact antipodes, {keyframes.tracks[k, i].tolist()} and its "
            "negative: with align=False no single arc joins q and -q"
        )
