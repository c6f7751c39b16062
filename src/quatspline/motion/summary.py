"""What a motion is, in one screen: tracks, rate, gaps, steps, and the noise in them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from quatspline import keyframes, quaternion
from quatspline.fitting.told_noise import LEAST, told_noise
from quatspline.motion.motion import Motion

GAP = 5.0
"""Spacings over this many medians are gaps."""

STAMPS = {1: "s", 10**3: "ms", 10**6: "us", 10**9: "ns"}
"""Units of stamps by their number in a second."""

NAMED = 8
"""Names of tracks, or of what is not read, that are listed."""


def summary(motion: Motion) -> list[str]:
    """Lines about a motion."""
    rows = {
        "tracks": _tracks(motion),
        "frames": f"{len(motion.quaternions)}{', closed' if motion.closed else ''}",
        "start": f"{motion.start!r} {STAMPS[motion.per_second]}",
        "positions": _positions(motion),
    }
    if len(motion.times) > 1:
        rows |= {"duration": f"{motion.times[-1]:.6g} s", **_spacings(motion)}
    if len(motion.quaternions) > 1:
        rows["largest step"] = _step(motion)
    if len(motion.quaternions) >= LEAST:
        rows["noise"] = _noise(motion)
    if motion.unread:
        rows["not read"] = _first(motion.unread)
    if motion.interpolation:
        rows["interpolation"] = motion.interpolation
    width = max(map(len, rows))
    return [f"{name:{width}}  {text}" for name, text in rows.items()]


def _tracks(motion: Motion) -> str:
    hung = ", a skeleton" if motion.skeleton is not None else ""
    return f"{len(motion.tracks)}{hung}: {_first(motion.tracks)}"


def _first(names: Sequence[str]) -> str:
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return f"{', '.join(names[:NAMED])}{more}"


def _positions(motion: Motion) -> str:
    if motion.positions is None:
        return "none"
    moving = (np.ptp(motion.positions, axis=0) > 0.0).any(axis=-1)
    unit = "metres" if motion.unit == "m" else "the file's unit"
    return f"in {unit}, {int(moving.sum())} of {moving.size} changing"


def _spacings(motion: Motion) -> dict[str, str]:
    steps = np.diff(motion.times)
    median = float(np.median(steps))
    gaps = np.flatnonzero(steps > GAP * median)
    shortest, longest = f"{steps.min():.4g}", f"{steps.max():.4g}"
    spread = "even" if shortest == longest else f"median; spacings {shortest} to {longest} s"
    rate = f"{1.0 / median:.6g} Hz ({spread})"
    if not gaps.size:
        return {"rate": rate, "gaps": "none"}
    worst = int(steps.argmax())
    told = f"{gaps.size} over {GAP:g} median spacings, the longest {steps[worst]:.4g} s"
    return {"rate": rate, "gaps": f"{told} after frame {worst}"}


def _step(motion: Motion) -> str:
    q = quaternion.normalise(motion.quaternions)
    steps = quaternion.distance(q[1:], q[:-1])
    frame, track = map(int, np.unravel_index(int(steps.argmax()), steps.shape))
    angle = np.degrees(steps[frame, track])
    return f"{angle:.4g} degrees, {motion.tracks[track]!r} from frame {frame} to {frame + 1}"


def _noise(motion: Motion) -> str:
    """Of the noisiest track, as ``compare`` tells it."""
    q = motion.quaternions
    levels = np.degrees(told_noise(keyframes.prepare(motion.stamps[: len(q)], q)))
    track = int(levels.argmax())
    if not levels[track]:
        return "none told from the motion"
    told = f"{levels[track]:.3g} degrees about each axis at most"
    return f"{told} ({motion.tracks[track]!r}, from third differences)"
