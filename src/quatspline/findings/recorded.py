"""Findings on recorded motion: what schemes are worth where motion is not smooth."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from quatspline.findings.quotes import Ledger, Part, Quote, said
from quatspline.instruments.summary import ALL
from quatspline.trajectories.clips import CONTROLS, OWN

TOPIC = "reconstruct"

SCHEMES = ("kim", "local-quintic", "squad", "quartic")
CIRCULAR = ("circular-blend", "biarc")
EVERY, RAW = 16, "none"
"""Of the experiment reconstruct: which frames are kept, and which filter is none."""

DENSE, CALM = 4, "6 Hz"
"""Where keyframes are dense, and motion without its noise."""

ALLOWED, STEADY = 0.5, "10 Hz"
"""Of the experiment reduce: degrees, and motion without its noise."""


def worth(cell: Ledger) -> tuple[Part, ...]:
    """What schemes gain over slerp on recordings and on analytic motion."""
    where: dict[str, Any] = {"filter": RAW, "every": EVERY}
    slerp = {"clip": ALL, "scheme": "slerp", **where}
    return said(
        f"Rebuilt from every {{every:d}}th frame, {whose(cell)} are off by these multiples of slerp's rms angle "
        f"(geometric mean): {_listed('r', '.2f')}. On the analytic motion {{tumble}}, with the same frames kept, the "
        f"multiples are {_listed('t', '.3f')}.",
        every=cell("reconstruct", "every", **slerp),
        joints=cell("reconstruct", "compared_joints", **slerp),
        tumble=cell("reconstruct", "clip", clip="tumble", scheme="slerp", **where),
        **_over_slerp(cell, "r", clip=ALL, **where),
        **_over_slerp(cell, "t", clip="tumble", **where),
    )


def cause(cell: Ledger) -> tuple[Part, ...]:
    """What is fast is the cause, the noise with it."""
    raw: dict[str, Any] = {"filter": RAW, "every": DENSE}
    calm: dict[str, Any] = {"clip": ALL, "filter": CALM, "every": DENSE}
    return said(
        "The cause is fast motion and noise. With every {every:d}th frame kept, the multiples for the motion below "
        f"{{calm}} are {_listed('c', '.3f')}; for the motion as recorded, {_listed('r', '.2f')}; for noise without "
        f"motion, {_listed('n', '.2f')}.",
        calm=cell("reconstruct", "filter", scheme="slerp", **calm),
        every=cell("reconstruct", "every", scheme="slerp", **calm),
        **_over_slerp(cell, "c", **calm),
        **_over_slerp(cell, "r", clip=ALL, **raw),
        **_over_slerp(cell, "n", clip="white noise", **raw),
    )


def circles(cell: Ledger) -> tuple[Part, ...]:
    """Schemes through circles, on hinges that reverse."""
    return said(
        "Where a hinge reverses, a circle through three keyframes may go the long way round. With every {every:d}th "
        f"frame kept, the largest error of a joint is {{v0:.1f}} degrees for {CIRCULAR[0]}, {{v1:.1f}} for "
        f"{CIRCULAR[1]} and {{v2:.1f}} for slerp.",
        every=cell("reconstruct", "every", clip=ALL, scheme="slerp", filter=RAW, every=EVERY),
        **{f"v{i}": _largest(cell, name) for i, name in enumerate((*CIRCULAR, "slerp"))},
    )


def _largest(cell: Ledger, scheme: str) -> Quote:
    """The largest angle of all clips that a scheme was measured on."""
    where = {"scheme": scheme, "filter": RAW, "every": EVERY}
    clips = cell.values("reconstruct", "clip", **where)
    angles = [
        cell("reconstruct", "largest_degrees", clip=clip, **where)
        for clip in clips
        if clip not in (ALL, *CONTROLS)
    ]
    measured = tuple(angle for angle in angles if not math.isnan(angle.value))
    if not measured:
        raise LookupError(f"reconstruct: {scheme} was measured on no clip")
    return Quote(measured, "most")


def keyframes(cell: Ledger) -> tuple[Part, ...]:
    """Keyframes that an error needs."""
    raw: dict[str, Any] = {"clip": ALL, "filter": RAW, "error_degrees": ALLOWED}
    steady = {**raw, "filter": STEADY}
    return said(
        "To rebuild every frame within {allowed:g} degrees, schemes need these multiples of slerp's number of "
        f"keyframes (geometric mean over {{joints:.0f}} joints): for the motion as recorded, {_listed('r', '.2f')}; "
        f"below {{steady}}, {_listed('s', '.2f')}.",
        allowed=cell("reduce", "error_degrees", scheme="slerp", **raw),
        joints=cell("reduce", "compared_joints", scheme="slerp", **raw),
        steady=cell("reduce", "filter", scheme="slerp", **steady),
        **_over_slerp(cell, "r", "reduce", **raw),
        **_over_slerp(cell, "s", "reduce", **steady),
    )


def whose(cell: Ledger) -> str:
    """Whose joints they are, as the subject of a sentence that quotes how many."""
    made = cell.values("reconstruct", "clip", scheme="slerp") == sorted([ALL, OWN, *CONTROLS])
    return (
        "the {joints:.0f} joints of the walk that this project generates (no recording was given)"
        if made
        else "{joints:.0f} recorded joints"
    )


def _over_slerp(
    cell: Ledger, prefix: str, table: str = "reconstruct", **where: Any
) -> dict[str, Any]:
    """Cells by the names that `_listed` gives them; a scheme that was not compared leaves the sentence out."""
    cells = [cell(table, "over_slerp", scheme=name, **where) for name in SCHEMES]
    if any(math.isnan(each.value) for each in cells):
        raise LookupError(f"{table}: not all of {SCHEMES} were compared where {where}")
    return {f"{prefix}{i}": each for i, each in enumerate(cells)}


def _listed(prefix: str, spec: str) -> str:
    """A template that names quantities r0, r1, ... after the schemes."""
    return ", ".join(f"{name} {{{prefix}{i}:{spec}}}" for i, name in enumerate(SCHEMES))


SENTENCES: tuple[tuple[str, Callable[[Ledger], tuple[Part, ...]]], ...] = tuple(
    (TOPIC, sentence) for sentence in (worth, cause, circles, keyframes)
)
