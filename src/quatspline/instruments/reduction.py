"""Reduction: how many keyframes of a dense motion a scheme needs to rebuild it within an angle."""

from __future__ import annotations

import numpy as np

from quatspline.instruments.summary import LISTS
from quatspline.instruments.trials import Row, reason
from quatspline.motion import Motion
from quatspline.solving import ConvergenceError


def reduction(tracks: Motion, scheme: str, error: float) -> Row:
    """Keyframes of each track by itself; see `Motion.reduce`.

    frames, keyframes: of all tracks that did not fail, and the ratio of these, share; per_second: keyframes of
    a track a second; worst_joint: the one that needs most; largest_degrees: the error that is left.

    Raises
    ------
    ValueError, ConvergenceError
        Where no track is reduced, what the scheme raised on the first.
    """
    counts: list[int | None] = []
    left, errors = [0.0], []
    for k, name in enumerate(tracks.tracks):
        own = Motion(
            tracks.stamps, tracks.quaternions[:, k], None, [name], per_second=tracks.per_second
        )
        try:
            reduced = own.reduce(scheme, error=error)
        except (ConvergenceError, ValueError) as failure:
            counts.append(None)
            errors.append(failure)
        else:
            counts.append(len(reduced.frames[name]))
            left.append(reduced.largest)
    known = {name: n for name, n in zip(tracks.tracks, counts, strict=True) if n is not None}
    if not known:
        raise errors[0]
    frames, keyframes = len(known) * len(tracks.times), sum(known.values())
    return {
        "joints": len(counts),
        "frames": frames,
        "keyframes": keyframes,
        "share": keyframes / frames,
        "per_second": keyframes / (len(known) * float(np.ptp(tracks.times))),
        "worst_joint": max(known, key=lambda name: known[name]),
        "largest_degrees": float(np.degrees(max(left))),
        "failed_joints": len(errors),
        "first_failure": reason(errors[0]) if errors else None,
        LISTS: counts,
    }
