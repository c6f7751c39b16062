"""Labels beside curves and points: apart, in order, near; and long curves drawn by their peaks."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from matplotlib.figure import Figure

from quatspline.catalogue import schemes
from quatspline.figures import looks, named
from quatspline.figures.comparison import STRETCHES, largest
from quatspline.figures.direct import End, label_ends, label_points, spread


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


def test_hollow_is_third_party_and_nothing_else() -> None:
    for name in schemes():
        hollow = named.looks(name).get("markerfacecolor") == "white"
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
