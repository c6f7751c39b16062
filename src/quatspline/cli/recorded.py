"""The commands on recorded motion: ``sample``, ``reduce``, ``info``."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from quatspline.cli.notes import naming_file, note, noted
from quatspline.motion import closing, files
from quatspline.motion.files import Reading
from quatspline.motion.resampling import grid, sampled, stamps_since
from quatspline.system.atomic import naming, same_file
from quatspline.system.stdout import STDOUT, output, say

if TYPE_CHECKING:
    from quatspline.motion import Motion
    from quatspline.motion.motion_curve import MotionCurve

REBUILT = (".bvh", ".glb")
"""Formats of one rate: a reduction is written into them rebuilt at its source's times."""


FLAGS = {"rate": "--frame-rate"}
"""Flags that are not spelled as the option of `read_motion` is."""


class _Flags(Reading):
    """Options that were given as flags, which messages name as such."""

    clocks = ("rate",)

    def named(self, option: str, value: object = "") -> str:
        flag = FLAGS.get(option, f"--{option.replace('_', '-')}")
        return f"{flag} {value}".rstrip()


def motion_of(arguments: argparse.Namespace) -> Motion:
    """The motion of the file that a command was given, open or closed as asked."""
    from quatspline.keyframes import prepare

    path = arguments.keyframes
    motion = _read(path, _reading(arguments))
    closed = getattr(arguments, "closed", False)
    with naming_file(path):
        motion = closing.returning(motion) if closed else closing.opened(motion)
        align = getattr(arguments, "align", True)
        prepare(motion.stamps, motion.quaternions, closed=closed, align=align)
    if motion.note:
        note(f"{path}: {motion.note}")
    return motion


def tell_unread(arguments: argparse.Namespace, motion: Motion) -> None:
    """Name the columns or arrays that the file has besides, which a command that was refused need not say."""
    if motion.unread:
        note(f"{arguments.keyframes}: not read: {', '.join(map(repr, motion.unread))}")


def _read(path: str, reading: Reading) -> Motion:
    with noted():
        return files.read(path, reading)


def _reading(arguments: argparse.Namespace) -> Reading:
    return _Flags(
        skeleton=arguments.skeleton,
        rate=arguments.frame_rate,
        skip=arguments.skip,
        max_gap=arguments.max_gap,
    )


def _write(path: str, motion: Motion) -> None:
    with noted():
        files.write(path, motion)


def _check_out(arguments: argparse.Namespace) -> None:
    """Refuse a file to write that no format has, or that is read, before any work is done."""
    files.check_suffix(arguments.file)
    if same_file(arguments.keyframes, arguments.file):
        raise ValueError(f"{arguments.file}: is also read here, so it is not overwritten")


# -- sample ---------------------------------------------------------------------------------------


def sample(arguments: argparse.Namespace) -> None:
    """Serve ``quatspline sample``."""
    from quatspline.cli import options

    given = options.of_scheme(arguments.scheme, arguments.options)  # before a long file is read
    if arguments.file is not None:
        _check_out(arguments)
    motion = motion_of(arguments)
    with naming_file(arguments.keyframes):
        given |= {name: getattr(arguments, name) for name in ("closed", "hold", "align")}
        curve = motion.curve(arguments.scheme, positions=arguments.positions, **given)
    if arguments.at is None:
        samples = sampled(curve, grid(curve, arguments.rate, arguments.count))
    else:
        samples = _at(curve, arguments.at)
    tell_unread(arguments, motion)
    if arguments.file is not None:
        _write(arguments.file, samples)
        return
    with naming(STDOUT):
        files.write_csv(output(), samples)


def _at(curve: MotionCurve, path: str) -> Motion:
    """Samples at the times of another file, by the clock that both have."""
    other, motion = _read(path, Reading(duplicates="first")), curve.motion
    since = other.start / other.per_second - motion.start / motion.per_second
    if (other.per_second, other.stamps.dtype) == (motion.per_second, motion.stamps.dtype):
        return sampled(curve, other.stamps)
    times = since + other.times
    return sampled(curve, stamps_since(motion, times), times)


# -- reduce ---------------------------------------------------------------------------------------


def reduce(arguments: argparse.Namespace) -> None:
    """Serve ``quatspline reduce``: a line for each joint, and the file asked for."""
    from quatspline.cli import options
    from quatspline.motion.files.keyframes import check_keyframe_suffix, write_keyframes
    from quatspline.motion.reducing import reduction

    given = options.of_scheme(arguments.scheme, arguments.options)
    rebuilt = arguments.file is not None and Path(arguments.file).suffix.lower() in REBUILT
    if arguments.file is not None:
        _check_out(arguments)
    motion = motion_of(arguments)
    if arguments.file is not None and not rebuilt:
        check_keyframe_suffix(arguments.file, motion)
    tell_unread(arguments, motion)
    with naming_file(arguments.keyframes):
        wanted = arguments.scheme, arguments.error, arguments.together
        found = reduction(motion, *wanted, given, _bar)
    for joint, reason in found.failures.items():
        note(f"{joint}: keeps all frames: {reason}")
    say(_lines(found.frames, len(motion.times), found.largest))
    if rebuilt:
        _write(arguments.file, found.motion)
    elif arguments.file is not None:
        write_keyframes(arguments.file, motion, found.frames)


def _bar(groups: list[slice]) -> Iterable[slice]:
    from quatspline.runs.experiment import Run

    return Run(quick=True).progress(groups, label="reduce")


def _lines(frames: dict[str, np.ndarray], count: int, largest: float) -> list[str]:
    width = max(map(len, [*frames, "all"]))
    kept = {joint: len(index) for joint, index in frames.items()}
    lines = [f"{joint:{width}}  {n:7d} of {count} frames" for joint, n in kept.items()]
    whole, all_kept = count * len(frames), sum(kept.values())
    share = f"{all_kept:7d} of {whole}: one in {whole / all_kept:.1f}"
    return [*lines, f"{'all':{width}}  {share}, off by {np.degrees(largest):.3g} degrees at most"]


# -- info -----------------------------------------------------------------------------------------


def info(arguments: argparse.Namespace) -> None:
    """Serve ``quatspline info``: what a file is, in one screen."""
    from quatspline.motion.summary import summary

    reading, path = _reading(arguments), arguments.keyframes
    refused = None
    try:
        motion = _read(path, reading)
    except files.MotionFileError as error:
        refused = error
        try:
            motion = _read(path, files.lenient(path, reading))
        except ValueError:
            raise refused from None
        if motion.closed:
            raise refused from None
    if refused is not None:
        say([f"refused as it stands: {refused}", "without what is refused:"])
    say(summary(motion))
