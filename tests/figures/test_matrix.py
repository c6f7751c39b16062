"""Matrices of answers: who shares a row, what the key explains, and that a page holds them."""

from __future__ import annotations

import pandas as pd
import pytest
from matplotlib.colors import to_rgb

from quatspline.catalogue import called, found
from quatspline.figures import matrix, style
from quatspline.runs.experiment import files
from quatspline.system.loading import load
from tools.readme import REFERENCE

COLOURS = {"holds": "#88cc88", "departs": "#cc5500", "unknown": "#bbbbbb"}
KINDS = pd.DataFrame(
    {"a": ["holds", "holds", "holds", "departs"], "b": ["holds", "holds", None, "holds"]},
    index=["scipy-slerp", "slerp", "nlerp", "local-quintic"],
)
TEXTS = pd.DataFrame({"a": ["1", "1", "1", "2"], "b": ["x", "x", None, "x"]}, index=KINDS.index)
TALLEST = 9.0
"""Inches that a journal's page leaves."""


def test_rows_are_shared_by_those_with_the_same_cells_alone() -> None:
    assert matrix.alike(KINDS, TEXTS) == {
        "slerp": ["scipy-slerp"],
        "nlerp": [],
        "local-quintic": [],
    }
    told_apart = TEXTS.copy()
    told_apart.loc["slerp", "b"] = "y"
    assert matrix.alike(KINDS, told_apart) == {name: [] for name in KINDS.index}


def test_a_key_explains_every_colour_that_is_there_and_no_other() -> None:
    fig = matrix.draw(KINDS, TEXTS, COLOURS, heads=["a", "b"], head=0.3, dark="departs")
    key = fig.legends[0]
    named = {
        text.get_text(): patch for text, patch in zip(key.texts, key.get_patches(), strict=True)
    }
    assert set(named) == {"holds", "departs"}
    image = fig.axes[0].images[0]
    for i, j, kind in ((0, 0, "holds"), (2, 0, "departs")):
        cell = image.cmap(image.norm(image.get_array()[i, j]))
        assert cell[:3] == pytest.approx(to_rgb(COLOURS[kind]), abs=0.01)
        assert named[kind].get_facecolor()[:3] == pytest.approx(to_rgb(COLOURS[kind]))


def test_rows_say_whose_they_are() -> None:
    fig = matrix.draw(KINDS, TEXTS, COLOURS, heads=["a", "b"], head=0.3, dark="departs")
    shown = [text.get_text() for text in fig.axes[0].get_yticklabels()]
    assert shown == ["slerp + 1 more", "nlerp", called("local-quintic")]
    assert matrix.said(matrix.alike(KINDS, TEXTS)).endswith("scipy-slerp with slerp.")
    assert matrix.said({"slerp": []}) == ""


@pytest.mark.parametrize("name", ["claims", "edge-cases"])
def test_all_schemes_fit_a_page_and_each_is_named(name: str) -> None:
    table = pd.read_csv(REFERENCE / f"{name}.csv", keep_default_na=False, na_values=[""])
    module = load(files()[name], "experiment")
    with style.applied():
        fig = module.draw(table)
    assert fig.get_figheight() <= TALLEST
    rows = {text.get_text().split(" ")[0] for text in fig.axes[0].get_yticklabels()}
    caption = module.caption(table)
    schemes = set(table["scheme"]) & set(found())
    assert {name for name in schemes if name not in rows and name not in caption} == set()
