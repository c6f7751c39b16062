"""Figures as a journal would print them, drawn from the reference tables: sizes, and texts that can be read."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Any

import pandas as pd
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from quatspline.figures import style
from quatspline.runs.experiment import experiments
from quatspline.runs.results import Results
from tools.readme import REFERENCE

TALLEST = 9.2
"""Inches: of a page, less its margins and a caption."""
SMALLEST = 6.0
"""Points of text."""
TOUCH = 0.75
"""Of a label's height: lines of text as close as this still stand apart, for they have room for accents."""

DRAWN = {
    e.name: e.module
    for e in experiments()
    if hasattr(e.module, "draw") and (REFERENCE / f"{e.name}.csv").exists()
}


@pytest.fixture(scope="module", params=sorted(DRAWN))
def drawn(request: pytest.FixtureRequest) -> Iterator[Figure]:
    """A figure, laid out."""
    table: pd.DataFrame = Results(REFERENCE).read_table(request.param)
    module: Any = DRAWN[request.param]
    with style.applied():
        figure = module.draw(table)
        figure.draw_without_rendering()
        yield figure


def texts(figure: Figure) -> list[Text]:
    """All that are seen."""
    found = figure.findobj(lambda artist: isinstance(artist, Text) and artist.get_text().strip())
    return [text for text in found if text.get_visible()]


def test_a_page_holds_it(drawn: Figure) -> None:
    width, height = drawn.get_size_inches()
    assert width <= style.PAGE
    assert height <= TALLEST


def test_texts_can_be_read(drawn: Figure) -> None:
    assert not {text.get_text() for text in texts(drawn) if text.get_fontsize() < SMALLEST}


def test_names_of_rows_and_numbers_of_axes_stand_apart(drawn: Figure) -> None:
    for ax in drawn.axes:
        for labels in (ax.get_xticklabels(), ax.get_yticklabels()):
            boxes = [box for label in labels if (box := _seen(ax, label)) is not None]
            for a, b in combinations(boxes, 2):
                assert not a.overlaps(b) or abs(a.y0 - b.y0) >= TOUCH * a.height


def _seen(ax: Axes, label: Text) -> Any:
    """The box of a tick's label in an axes' limits; None of one that is not drawn."""
    box = label.get_window_extent()
    (x, y), frame = (0.5 * (box.x0 + box.x1), 0.5 * (box.y0 + box.y1)), ax.bbox.padded(1.0)
    inside = frame.x0 <= x <= frame.x1 or frame.y0 <= y <= frame.y1
    return box if label.get_text() and label.get_visible() and inside else None


def test_titles_and_names_are_not_cut_off(drawn: Figure) -> None:
    page = drawn.bbox.padded(1.0)
    for text in texts(drawn):
        if text.axes is None or text in _ticks(text.axes) or not text.axes.axison:
            continue
        box = text.get_window_extent()
        assert page.x0 <= box.x0 < box.x1 <= page.x1, text.get_text()
        assert page.y0 <= box.y0 < box.y1 <= page.y1, text.get_text()


def _ticks(ax: Axes) -> list[Text]:
    return [*ax.get_xticklabels(which="both"), *ax.get_yticklabels(which="both")]


def test_titles_stand_apart(drawn: Figure) -> None:
    titles = [t for ax in drawn.axes for t in (ax.title, ax._left_title, ax._right_title)]
    boxes = [title.get_window_extent() for title in titles if title.get_text()]
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))
