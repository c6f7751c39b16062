"""Keyframes: the one place where input is validated, normalised, aligned and closed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from quatspline.engines import engine
from quatspline.inputs import stamps
from quatspline.inputs.arrays import IntArray, at, float_array, refuse_infinite, switch
from quatspline.inputs.orientations import directions, explain_norms, orientations
from quatspline.inputs.spacings import DIGITS, LONGEST, SHORTEST, explain_times
from quatspline.kernels.jit import compiled
from quatspline.quaternion import ANTIPODAL, FLIP, FloatArray

NORM_TOLERANCE = 1e-3
"""Quaternions off the unit sphere by more than this are refused; within it they are normalised."""

UNIFORM = 1e-9
"""Spacings equal to this relative accuracy (and to the rounding of the times) count as uniform."""

TICKS = 1e-4
"""Integer stamps of even times are uneven by a tick or two: below this share of a spacing it is that."""

FLOAT: np.dtype[Any] = np.dtype(np.float64)


@dataclass(frozen=True, eq=False)
class Keyframes:
    """Validated keyframes of one or several tracks, as schemes receive them.

    Attributes
    ----------
    times : (n,) or, closed, (n + 1,), as given (`stamps.stamps`); the last of a closed set is the return
    knots : float64 times since the first, (n,) or (n + 1,): all work is done in these
    spacings : float64 knot spacings h, one per segment: (n - 1,) or, closed, (n,)
    flips : (K, n) float64, -1 where alignment flipped a keyframe's sign, otherwise 1
    digits : dtype of the given times
    tracks : (K, n, 4) float64, unit quaternions, neighbours on one hemisphere unless kept as given
    track_shape : the shape whose product is K; () for a single track
    closed : whether the last keyframe leads back to the first
    signs : (K,) float64, +1 or -1: the curve returns as sign times the first keyframe
    """

    times: NDArray[Any]
    knots: FloatArray
    spacings: FloatArray
    tracks: FloatArray
    track_shape: tuple[int, ...]
    closed: bool
    signs: FloatArray
    flips: FloatArray
    digits: np.dtype[Any] = FLOAT

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
    def plain(self) -> bool:
        """Whether times are float64, from which the driver may subtract the first itself."""
        return self.times.dtype == np.float64

    @property
    def unit(self) -> float:
        """The power of two nearest the mean spacing: knots / unit rounds nothing and suits any solver."""
        return (
            2.0 ** round(math.log2(self.knots[-1] / self.spacings.size))
            if self.spacings.size
            else 1.0
        )

    @property
    def uneven(self) -> int | None:
        """The first spacing that differs from spacing 0 by more than the times' rounding."""
        h, t = self.spacings, self.times
        rounding = 8 * stamps.resolution(t[0], t[-1], self.digits)
        rounding += min(2 * stamps.tick(t), TICKS * float(h.mean()))
        differs = np.flatnonzero(np.abs(h - h[0]) > UNIFORM * h[0] + rounding)
        return int(differs[0]) if differs.size else None

    @property
    def uniform(self) -> bool:
        """Whether all spacings are equal, up to the rounding of the given times."""
        return self.uneven is None

    def inside(self, shares: int | ArrayLike) -> FloatArray:
        """Times since the first keyframe inside every segment, (segments * n,), in the order of segments.

        Parameters
        ----------
        shares : (n,) in [0, 1] of every segment; or n, for the middles of n equal parts, which lie
            away from keyframes
        """
        if isinstance(shares, int | np.integer):
            shares = (np.arange(shares) + 0.5) / shares
        u = np.asarray(shares, dtype=float)
        return (self.knots[:-1, None] + self.spacings[:, None] * u).reshape(-1)

    def locate(self, t: FloatArray) -> tuple[IntArray, FloatArray]:
        """Segment (m,) and local parameter u (m,) in [0, 1] of times t (m,) since the first keyframe.

        A keyframe belongs to the segment that it begins, the last to the one that it ends.
        """
        segment = segment_of(self.knots, t)
        return segment, (t - self.knots[segment]) / self.spacings[segment]

    def track(self, k: int) -> Keyframes:
        """The keyframes of one track."""
        own = slice(k, k + 1)
        tracks, signs, flips = self.tracks[own], self.signs[own], self.flips[own]
        return replace(self, tracks=tracks, track_shape=(), signs=signs, flips=flips)

    def shaped(self) -> FloatArray:
        """The keyframes in the caller's shape (n, *track_shape, 4)."""
        return np.moveaxis(self.tracks, 0, 1).reshape(-1, *self.track_shape, 4)


def segment_of(knots: FloatArray, t: FloatArray) -> IntArray:
    """The segment (m,) between knots (n,) that times t (m,) lie in (see `Keyframes.locate`)."""
    return np.clip(np.searchsorted(knots, t, side="right") - 1, 0, len(knots) - 2)


def prepare(
    times: Any,
    quaternions: Any,
    *,
    closed: bool = False,
    align: bool = True,
    closing_sign: int | None = None,
    normalise: bool = False,
    min_keyframes: int = 2,
) -> Keyframes:
    """Validate, normalise and align keyframes.

    Parameters
    ----------
    times
        (n,) strictly increasing, or (n + 1,) closed: the last is where the first keyframe returns.
        Numbers, integer stamps, datetimes or timedeltas (in seconds); None means 0, 1, 2, ...
    quaternions
        (n, 4) scalar first, (n, *K, 4) for several tracks; see `orientations.orientations`.
    closed, align, closing_sign, normalise
        As in `quatspline.build`.
    min_keyframes
        Fewer than these are refused.

    Raises
    ------
    ValueError
        Names the argument, the first offending index and the value.
    """
    closed, align = switch("closed", closed), switch("align", align)
    q = orientations(quaternions, min_keyframes)
    if switch("normalise", normalise):
        q = directions(q)
    n = q.shape[0]
    t, knots, spacings, digits = _times(
        np.arange(n + closed) if times is None else times, n, closed
    )
    known = isinstance(closing_sign, int | np.integer) and closing_sign in (1, -1)
    if closing_sign is not None and (align or not closed or not known):
        raise ValueError(
            f"closing_sign={closing_sign!r}: give 1 or -1, and only with closed=True, align=False"
        )
    track_shape = q.shape[1:-1]
    rows = q.reshape(n, -1, 4)
    tracks, signs = np.empty((rows.shape[1], n, 4)), np.empty(rows.shape[1])
    flips = np.empty(tracks.shape[:2])
    filled = tracks, signs, flips
    if not engine.run(
        _take, rows.size // 4, rows, align, closed, float(closing_sign or 1), *filled
    ):
        explain_norms(q, NORM_TOLERANCE)
    keyframes = Keyframes(t, knots, spacings, tracks, track_shape, closed, signs, flips, digits)
    if not align:
        _refuse_antipodes(keyframes)
    for array in (t, knots, spacings, *filled):
        array.setflags(write=False)
    return keyframes


@compiled
def _take(q, align, closed, closing_sign, tracks, signs, flips):
    """Normalise (n, K, 4) into tracks (K, n, 4), aligned, and close them; False if one is no unit."""
    for k in range(tracks.shape[0]):
        sign = 1.0
        for i in range(tracks.shape[1]):
            w, x, y, z = q[i, k, 0], q[i, k, 1], q[i, k, 2], q[i, k, 3]
            norm = math.sqrt(w * w + x * x + y * y + z * z)
            if not abs(norm - 1.0) <= NORM_TOLERANCE:  # NaN is off too
                return False
            short = (1.0 - norm) / norm  # x / norm = x + short x, to a rounding, and cheaper
            w, x, y, z = w + short * w, x + short * x, y + short * y, z + short * z
            if align and i > 0:
                b = tracks[k, i - 1]
                dot = w * b[0] + x * b[1] + y * b[2] + z * b[3]
                sign = -sign if sign * dot < FLIP else sign
            tracks[k, i, 0] = sign * w
            tracks[k, i, 1] = sign * x
            tracks[k, i, 2] = sign * y
            tracks[k, i, 3] = sign * z
            flips[k, i] = sign
        signs[k] = closing_sign
        if closed and align:
            a, b = tracks[k, 0], tracks[k, tracks.shape[1] - 1]
            dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
            signs[k] = -1.0 if dot < FLIP else 1.0
    return True


def _times(
    given: Any, n: int, closed: bool
) -> tuple[NDArray[Any], FloatArray, FloatArray, np.dtype[Any]]:
    """Times as given, float64 times since the first, spacings, and the dtype they were given in."""
    t = stamps.stamps("times", given)
    if t.shape != (n + closed,):
        if t.dtype.kind == "f":
            refuse_infinite("times", t)
        message = f"times has shape {t.shape}: expected ({n + closed},) for {n} keyframes"
        if closed:
            message += (
                ", since the last time is that of the return to the first; where the last keyframe "
                "repeats the first, leave it out: quaternions[:-1]"
            )
        raise ValueError(message)
    kind = t.dtype
    if kind.kind == "f" and kind.itemsize <= 8:
        t = float_array("times", t)
    knots, spacings = np.empty(t.size), np.empty(t.size - 1)
    plain = t.dtype == np.float64
    since = t if plain else float_array("times", stamps.elapsed(t, t[0]))
    if not engine.run(_space, t.size, since, t[0] if plain else 0.0, knots, spacings):
        explain_times(t, knots, spacings)
    return t.copy(), knots, spacings, kind


@compiled
def _space(t, origin, knots, spacings):
    """Fill in times since the first and their spacings; whether the arithmetic can carry all."""
    for i in range(t.size):
        knots[i] = t[i] - origin
    least = max(SHORTEST, DIGITS * knots[-1])
    bad = 0
    for i in range(spacings.size):
        spacings[i] = knots[i + 1] - knots[i]
        bad += not least <= spacings[i] <= LONGEST
    return bad == 0


def _refuse_antipodes(keyframes: Keyframes) -> None:
    q = keyframes.tracks
    if keyframes.closed:
        q = np.concatenate([q, keyframes.signs[:, None, None] * q[:, :1]], axis=1)
    gaps = np.linalg.norm(q[:, 1:] + q[:, :-1], axis=-1)
    antipodal = np.argwhere(gaps.T < ANTIPODAL)
    if antipodal.size:
        i, k = (int(index) for index in antipodal[0])
        track = np.unravel_index(k, keyframes.track_shape) if keyframes.track_shape else ()
        here, there = (at("quaternions", [j, *track]) for j in (i, (i + 1) % keyframes.count))
        raise ValueError(
            f"{here} and {there} are exact antipodes, {keyframes.tracks[k, i].tolist()} and its "
            "negative: with align=False no single arc joins q and -q"
        )
