"""How schemes look: no two alike, in figures and on the page, whatever is installed."""

from __future__ import annotations

import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from quatspline.catalogue import found
from quatspline.figures.looks import DASHES, FAMILIES, MARKERS, OTHER, scheme_style
from quatspline.figures.named import NAMED
from quatspline.page.plots import scheme_look

CONTRAST = 3.0
"""Of graphics to their ground, by WCAG 2.2."""


def luminance(color: str) -> float:
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(color)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


@pytest.mark.parametrize("second", ["marker", "linestyle"])
def test_no_two_schemes_are_alike(second: str) -> None:
    looks = {name: scheme_style(name) for name in found()}
    seen = {(look["color"], look[second]) for look in looks.values()}
    assert len(seen) == len(looks)


def test_no_two_schemes_are_alike_on_the_page() -> None:
    looks = [scheme_look(name) for name in found()]
    for ground in ("light", "dark"):
        assert len({(look[ground], look["symbol"]) for look in looks}) == len(looks)
        assert len({(look[ground], look["dash"]) for look in looks}) == len(looks)


def test_every_shipped_scheme_has_a_family_and_every_member_exists() -> None:
    members = [name for family in FAMILIES for name in family.members]
    assert len(members) == len(set(members))
    assert set(members) >= set(NAMED)
    assert set(members) == set(found())


def test_families_do_not_share_a_tint_and_hold_their_members() -> None:
    tints = [tint for family in FAMILIES for tint in family.tints]
    assert len({*tints, OTHER}) == len(tints) + 1
    for family in FAMILIES:
        assert len(family.members) <= len(DASHES) * len(family.tints)
    assert len(MARKERS) >= len(DASHES)


def test_tints_stand_out_from_white() -> None:
    for tint in [OTHER, *(tint for family in FAMILIES for tint in family.tints)]:
        assert 1.05 / (luminance(tint) + 0.05) >= CONTRAST, tint


def test_libraries_are_hollow_and_only_they() -> None:
    for name, item in found().items():
        library = item.scheme is None or item.scheme.peer is not None
        assert (scheme_style(name).get("markerfacecolor") == "white") == library, name
        assert scheme_look(name)["symbol"].endswith("-open") == library, name


def test_a_scheme_of_no_family_has_a_look_of_its_own_kind() -> None:
    look = scheme_style("somebody-elses")
    assert look == scheme_style("somebody-elses")
    assert look["color"] == OTHER
    Figure().subplots().plot([0, 1], [0, 1], **look)


@pytest.mark.parametrize("name", ["quartic", "vtk-linear", "scipy-slerp"])
def test_matplotlib_takes_every_look(name: str) -> None:
    Figure().subplots().plot([0, 1], [0, 1], **scheme_style(name))
