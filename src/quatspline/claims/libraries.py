"""What third-party libraries say beyond what the classes of their wrappers claim, each with its probes.

What a claim departs from is the library's own words, or the method that it names; docs/peers.md has the
sources and the same in calls of the library alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from quatspline.claims import probes
from quatspline.claims.claim import Claim, Probe, Source, above, below

STILL = 1e-6
"""A speed below this share of the mean is none; differences of a library leave 1e-9."""

MOVED = 1.0
"""Degrees from which a curve has moved."""
MENDED = 1e-6
"""Degrees below which it has not."""

UNIT = 1e-9
"""A length of 1 as a library may leave it that takes no roots."""
SAME = 1e-6
"""Degrees below which two curves are one."""

FLIP = "a keyframe of the other sign moves the curve (degrees)"


def claims() -> Iterator[Claim]:
    """All of them."""
    for found in (_rests, _signs, _lengths, _squads):
        yield from found()


def _rests() -> Iterator[Claim]:
    name = "interpolatepy-squad-c2"
    said = "at rest at the ends (and there alone)"
    speeds = [Probe(probes.least_key_speed, name, count=n) for n in (3, 4)]
    yield Claim(name, "peer", said, "moves at keyframes", speeds, partial(above, STILL))


def _signs() -> Iterator[Claim]:
    """Documented: quaternions are taken with the sign that they come with, unless an option is set."""
    options = {
        "numpy-quaternion-squad": "unflip",
        "spatialmath-qslerp": "shortest",
        "pyglm-mix": "",
    }
    for name, option in options.items():
        given = [Probe(probes.moved_by_a_flip, name, count=n) for n in (3, 5)]
        yield Claim(name, "peer", FLIP, "moves", given, partial(above, MOVED))
        if option:
            said = f"{option} mends a keyframe of the other sign (degrees)"
            mend = {option: True}
            mended = [Probe(probes.moved_by_a_flip, name, count=n, **mend) for n in (3, 5)]
            yield Claim(name, "peer", said, "does not move", mended, partial(below, MENDED))
    name = "quat-numpy-squad"  # its slerp "always takes the shortest arc"
    given = [Probe(probes.moved_by_a_flip, name, count=n) for n in (3, 5)]
    yield Claim(name, "peer", FLIP, "does not move", given, partial(below, MENDED))


def _lengths() -> Iterator[Claim]:
    """Documented: interpolation on the unit sphere."""
    name = "vtk-spline"
    lengths = [Probe(probes.norm_error, name, count=n, degrees=20) for n in (3, 4)]
    said = "quaternions of length 1 (how far off)"
    yield Claim(name, "peer", said, "0 off", lengths, partial(below, UNIT))


def _squads() -> Iterator[Claim]:
    """Squad by its published formula, whose slerps go from a to b, and not to -b where that is nearer."""
    squad = "the squad of [shoemake1987] (degrees off)"
    said: dict[str, tuple[Source, str]] = {
        "vtk-spline": ("peer", f"is {squad}"),
        "quat-numpy-squad": ("peer", f"is {squad}"),
        "gl-matrix-sqlerp": ("ours", f"with inner quaternions as control points it is {squad}"),
    }
    for name, (source, text) in said.items():
        off = partial(Probe, probes.off_another, name, "squad", ends="secant")
        cases = [off(count=n, degrees=d) for d in (20, 60, 120, 150) for n in (3, 4)]
        yield Claim(name, source, text, "0 off", cases, partial(below, SAME), float)
