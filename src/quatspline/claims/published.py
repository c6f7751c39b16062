"""What publications say beyond what classes claim, each with its probes; libraries: `claims.libraries`.

A saying that cannot be put to the test stands here with the reason.  Keys are schemes, or entries of the
bibliography where nothing of the kind could be built.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from quatspline.claims import libraries, paper_probes, probes
from quatspline.claims.claim import Claim, Probe, above, below
from quatspline.trajectories.paper import CASES

IDENTITY = 1e-6
"""Derivatives by a fitted polynomial are good to 1e-7; what a formula gets wrong is per cents."""

HALF = 0.5
"""Operations are not seconds: half of a printed ratio counts as that ratio."""

SYMMETRIC = 1e-7
"""Deviations below this share of a step are none, as in the table of invariance."""

POWER = 0.3
"""How far a slope over one halving may be off the whole number that it tends to."""

PAPER_KEY = "no keyframes are printed, and ours are chosen so that the count is met"
NOT_READ = "only the abstract could be read, not the construction"


def published(name: str) -> Iterator[Claim]:
    """The claims about a scheme or a work, in order."""
    for claims in (_quartic, _paper_splines, _constructions, libraries.claims, _unread):
        yield from (claim for claim in claims() if claim.scheme == name)


def works() -> list[str]:
    """Bibliography keys of works that make claims and could not be built."""
    return [claim.scheme for claim in _unread()]


# -- the paper ----------------------------------------------------------------------------------


def _quartic() -> Iterator[Claim]:
    claim = partial(Claim, "quartic", "paper")
    exact = partial(below, IDENTITY)
    error = partial(Probe, paper_probes.derivative_error)
    yield claim("printed Q' at a knot is the curve's", "0 off", [error(order=1)], exact)
    printed = "printed Q'' at a knot is the curve's"
    one_axis = [error(order=2, one_axis=True)]
    yield claim(f"{printed}, steps about one axis", "0 off", one_axis, exact)
    yield claim(f"{printed}, steps about any axes", "0 off", [error(order=2)], exact)
    ruled = [error(order=2, product_rule=True)]
    yield claim("Q'' at a knot by the product rule is the curve's", "0 off", ruled, exact)
    continuity = [Probe(probes.continuity, "quartic", count=n) for n in (4, 6)]
    yield claim("C2 at equidistant knots", "at least C2", continuity, partial(above, 1))
    yield claim("not C3 at knots", "below C3", continuity, partial(below, 2))
    inside = [Probe(probes.inner_continuity, "quartic", n, d) for n in (4, 6) for d in (60, 120)]
    yield claim("C-infinity inside segments", "C6 as far as told", inside, partial(above, 5))
    yield claim("local control", 4, [Probe(probes.support, "quartic")], partial(below, 4))
    torque = [Probe(probes.torque_ratio, "quartic", "nielson")]
    yield claim("less fair than the B-spline", "more torque", torque, partial(above, 1.0))


def _paper_splines() -> Iterator[Claim]:
    for case in CASES.values():
        steps = case.rows[0].iterations
        yield Claim("nielson", "paper", f"iterations, {case.name}", steps, unknown=PAPER_KEY)
    rows = [(case, row) for case in CASES.values() for row in case.rows if not row.rendered]
    for name in ("nielson", "kim"):
        for case, row in rows:
            for protocol, text in (
                ("per-frame", "fitted for every frame"),
                ("solve-once", "fitted once"),
            ):
                ask = Probe(
                    paper_probes.operations_over_quartic, name, protocol, case.name, row.frames
                )
                said = f"cost over the quartic's, {row.frames} {case.name} orientations, {text}"
                yield Claim(name, "paper", said, row.ratio, [ask], partial(above, HALF * row.ratio))


# -- other publications -------------------------------------------------------------------------


def _constructions() -> Iterator[Claim]:
    continuity = partial(Probe, probes.continuity)
    said = "a cubic B-spline by nested slerps is not C2 [kim1995bspline]"
    smooth = [continuity("nielson", count=n) for n in (3, 4)]
    yield Claim("nielson", "paper", said, "below C2", smooth, partial(below, 1))
    said = "power of the spacing that the acceleration's jump falls with"
    falling = [Probe(probes.jump_order, "nielson", n) for n in (41, 81)]
    yield Claim("nielson", "ours", said, 3, falling, lambda slope: abs(slope - 3.0) <= POWER)
    said = "keyframes in reverse order give another curve [kim1996hermite]"
    reverse = [Probe(probes.reversal_deviation, "kim", degrees=d) for d in (60, 120)]
    yield Claim("kim", "paper", said, "another", reverse, partial(above, SYMMETRIC))
    said = "two arcs meet inside a segment: the acceleration jumps there"
    inside = [Probe(probes.inner_continuity, "biarc", n) for n in (4, 6)]
    yield Claim("biarc", "ours", said, "below C2", inside, partial(below, 1))
    smooth = [continuity("squad", count=n) for n in (3, 4, 6)]
    yield Claim("squad", "paper", "C1 [shoemake1987]", "at least C1", smooth, partial(above, 0))


def _unread() -> Iterator[Claim]:
    said = {
        "xing2018c3": ("set-up 73 % below Nielson's", "C3, 73 % less"),
        "tan2018": ("G2 with local tension, without equations", "G2"),
        "ge2007": ("control quaternions without iteration", "C2"),
        "ramamoorthi1997": ("up to three orders of magnitude faster than barr1992", "1000 times"),
    }
    for work, (text, value) in said.items():
        yield Claim(work, "paper", text, value, unknown=NOT_READ)
