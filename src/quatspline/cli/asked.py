"""What the flags of ``compare`` ask for, in the unit of a file's times."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from quatspline.findings.needs import Needs
    from quatspline.motion import Motion


OF_JOINTS = ("excursion", "support", "lookahead")
"""The columns of needs that several tracks have, too."""


def needs(arguments: argparse.Namespace, motion: Motion) -> Needs:
    """The needs; ``--time-unit`` overrules what the file says of its times."""
    from quatspline.findings.needs import Needs

    unit = arguments.time_unit
    return Needs(
        smooth=arguments.smooth,
        local=arguments.local,
        causal=arguments.causal,
        max_rate=arguments.max_rate,
        max_accel=arguments.max_accel,
        max_excursion=arguments.max_excursion,
        second=float(motion.per_second) if unit is None else 1.0 / unit,
        table="compare" if len(motion.tracks) == 1 else "kept",
    )


def told(arguments: argparse.Namespace, motion: Motion) -> bool:
    """Whether it is known what the times count."""
    known = motion.per_second != 1 or motion.skeleton is not None
    return known or arguments.time_unit is not None or arguments.frame_rate is not None


def check_tracks(arguments: argparse.Namespace, motion: Motion, needs: Needs) -> None:
    """Refuse what is not asked of several tracks, or asked of one alone."""
    count, file = len(motion.tracks), arguments.keyframes
    if count > 1 and arguments.keep is None:
        raise ValueError(
            f"{file}: {count} tracks need --keep K: they are compared at the frames that it leaves out"
        )
    alone = [limit.flag for limit in needs.limits if limit.column not in OF_JOINTS]
    if count > 1 and alone:
        raise ValueError(
            f"{file}: {alone[0]} applies to a single track, and there are {count}: leave it out, or compare the "
            "keyframes of one joint in a file of their own"
        )
