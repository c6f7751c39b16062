"""Labels beside curves and points: apart, in order, near; and long curves drawn by their peaks."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from quatspline import build, quaternion
from quatspline.catalogue import called, schemes
from quatspline.figures import comparison, looks, named, style
from quatspline.figures.comparison import STRETCHES, largest
from quatspline.figures.direct import (
    GREY,
    End,
    label_curves,
    label_ends,
    label_points,
    spread,
)


@pytest.mark.parametrize("seed", range(5))
def test_spread_places_keep_order_and_gap_and_are_nearest(seed: int) -> None:
    """Nearest: no other places with that gap have a smaller sum of squares, tried at random."""
    rng = np.random.default_rng(seed)
    wanted = rng.uniform(size=8)
    places = spread(wanted, 0.1)
    order = np.argsort(wanted)
    assert np.diff(places[order]).min() >= 0.1 - 1e-12
    least = ((places - wanted) ** 2).sum()
    for _ in range(200):
        other = np.sort(places[order] + rng.normal(scale=0.05, size=8))
        other = np.maximum.accumulate(other - 0.1 * np.arange(8)) + 0.1 * np.arange(8)
        assert ((other - wanted[order]) ** 2).sum() >= least - 1e-12


def test_spread_leaves_alone_what_is_apart() -> None:
    np.testing.assert_array_equal(spread([0.0, 5.0, 2.0], 1.0), [0.0, 5.0, 2.0])


def test_ends_are_labelled_in_their_order() -> None:
    """So that no two leaders from ends above one another cross."""
    ax = Figure().subplots()
    ax.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
    heights = [0.5, 0.51, 0.1, 0.52, 0.9]
    label_ends(ax, [End(1.0, y, str(y), "black") for y in heights])
    shown = {float(t.get_text()): t.get_window_extent().y0 for t in ax.texts}
    assert sorted(shown, key=shown.__getitem__) == sorted(heights)
    boxes = [t.get_window_extent().y0 for t in ax.texts]
    assert min(abs(a - b) for a, b in combinations(boxes, 2)) > 5.0


def test_labels_of_points_keep_apart_and_inside() -> None:
    ax = Figure().subplots()
    ax.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
    at = [(0.01, 0.5), (0.99, 0.5), (0.5, 0.5), (0.52, 0.5), (0.5, 0.53)]
    label_points(ax, [End(x, y, "a scheme", "black") for x, y in at])
    boxes = [text.get_window_extent() for text in ax.texts]
    assert len(boxes) == len(at)
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))
    assert all(ax.bbox.x0 <= box.x0 and box.x1 <= ax.bbox.x1 for box in boxes)


def test_labels_cover_no_mark_without_a_name_and_leave_room_to_the_confined() -> None:
    """The second has only its right, if the first, which comes before it, does not take that."""
    ax = Figure().subplots()
    ax.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
    at, marks = [(0.1, 0.5), (0.1, 0.56)], [(0.12, 0.61), (0.1, 0.63), (0.15, 0.62)]
    label_points(ax, [End(x, y, "a scheme", "black") for x, y in at], marks)
    boxes = [text.get_window_extent() for text in ax.texts]
    assert not boxes[0].overlaps(boxes[1])
    for x, y in ax.transData.transform([*at, *marks]):
        assert not any(box.contains(x, y) for box in boxes)


def test_names_of_ends_are_inside_the_figure_however_long() -> None:
    fig, panels = style.axes(style.PAGE, 3.0, 1, 2)
    for ax in panels[0]:
        ax.plot([0.0, 1.0], [0.0, 1.0])
    text = "a scheme with a name that takes room"
    named.name_ends(fig, {ax: {"a": End(1.0, 1.0, text, "black")} for ax in panels[0]})
    first, second = (ax.texts for ax in panels[0])
    assert [label.get_text() for label in (*first, *second)] == [text, text]
    assert first[0].get_window_extent().x1 <= panels[0, 1].get_tightbbox().x0
    assert second[0].get_window_extent().x1 <= fig.bbox.x1


def test_axes_without_ends_stay_as_they_are() -> None:
    fig, panels = style.axes(style.PAGE, 3.0)
    named.name_ends(fig, {panels[0, 0]: {}})
    assert not panels[0, 0].texts


def test_curves_are_named_beside_themselves_and_over_none() -> None:
    ax = Figure().subplots()
    x = np.linspace(0.0, 1.0, 201)
    curves = {"up": x, "down": 1.0 - x, "low": 0.1 * x * (1.0 - x)}
    for name, y in curves.items():
        ax.plot(x, y, label=name)
    label_curves(ax)
    assert {text.get_text() for text in ax.texts} == set(curves)
    for text in ax.texts:
        box = text.get_window_extent()
        away = {
            name: np.linalg.norm(
                ax.transData.transform(np.c_[x, y]) - np.mean([box.min, box.max], axis=0), axis=1
            ).min()
            for name, y in curves.items()
        }
        assert min(away, key=away.__getitem__) == text.get_text()
        assert ax.bbox.x0 <= box.x0
        assert box.x1 <= ax.bbox.x1
        for y in curves.values():
            assert not any(box.contains(*dot) for dot in ax.transData.transform(np.c_[x, y]))


@pytest.mark.parametrize(("limits", "shown"), [((0.9, 30.0), "2"), ((1e-3, 1e4), "$")])
def test_short_logarithmic_axes_have_plain_numbers(limits: tuple[float, float], shown: str) -> None:
    ax = Figure().subplots()
    ax.set(xscale="log", xlim=limits)
    style.plain_log(ax.xaxis)
    ax.figure.draw_without_rendering()
    assert any(text.get_text().startswith(shown) for text in ax.get_xticklabels())


def test_rates_are_sizes_from_zero_named_at_their_ends() -> None:
    rng = np.random.default_rng(1)
    q = quaternion.exp(rng.normal(scale=0.3, size=(6, 3)))
    curves = {name: build(name, np.arange(6.0), q) for name in ("slerp", "local-quintic")}
    panels = comparison.rates(curves, curves["slerp"].keyframes).axes
    for ax in panels:
        assert ax.get_ylim()[0] <= 0.0
        assert {text.get_text() for text in ax.texts} == {"slerp", called("local-quintic")}


def test_torques_are_drawn_in_colour_where_rates_are_and_written_where_far_below_the_least() -> (
    None
):
    names = ["quartic", "squad", "smoothing-spline"]
    table = pd.DataFrame({"scheme": names, "torque_over_least": [1.0, 1.5, 3e-5]})
    table = table.assign(continuity=2.0, failure=None)
    ax = comparison.bars(table, ["squad"]).axes[0]
    assert ax.get_yticklabels()[0].get_text().startswith(called("smoothing-spline"))
    (written,) = ax.texts
    assert "3e-5" in written.get_text()
    low, high = ax.get_xlim()
    assert all(low < line.get_xdata()[0] < high for line in ax.get_lines())
    colours = [line.get_color() for line in ax.get_lines()]
    assert colours == [GREY, looks.scheme_style("squad")["color"]]


def test_torques_of_no_scheme_are_an_empty_figure() -> None:
    table = pd.DataFrame({"scheme": ["a"], "torque_over_least": [np.nan], "failure": ["lost"]})
    assert not comparison.bars(table.assign(continuity=np.nan)).axes[0].get_lines()


def test_hollow_is_third_party_and_nothing_else() -> None:
    for name in schemes():
        hollow = named.looks(name, [name]).get("markerfacecolor") == "white"
        assert hollow == looks.third_party(name)


def test_a_long_curve_is_drawn_by_its_peaks() -> None:
    t = np.linspace(0.0, 10.0, 20_001)
    size = np.abs(np.sin(40.0 * t)) + 0.001 * np.random.default_rng(3).uniform(size=len(t))
    x, y = largest(t, size)
    assert len(x) == STRETCHES
    assert y.max() == size.max()
    np.testing.assert_array_equal(size[np.searchsorted(t, x)], y)
    stretches = np.split(size, np.searchsorted(t, np.linspace(0.0, 10.0, STRETCHES + 1)[1:-1]))
    np.testing.assert_array_equal(y, [part.max() for part in stretches])
