"""Rows of schemes: which libraries share one, what stands there, and what is hollow or grey."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from quatspline.figures import rows
from quatspline.figures.looks import third_party
from quatspline.figures.named import NAMED

LIKE_SLERP = [0.5, 2.0]


def drawn(**more: list[float]) -> pd.DataFrame:
    """Two columns that extend from 0 to 1 and from 1 to 3."""
    values = {"slerp": LIKE_SLERP, "kim": [0.0, 1.0], "nielson": [1.0, 3.0]}
    values |= {name.replace("_", "-"): row for name, row in more.items()}
    return pd.DataFrame.from_dict(values, orient="index", columns=["a", "b"])


def test_a_library_shares_the_row_of_a_scheme_it_comes_out_as() -> None:
    near = [0.5 + 0.5 * rows.ALIKE, 2.0]
    assert rows.shared(drawn(ahrs_slerp=near))["slerp"] == ["ahrs-slerp"]
    assert "ahrs-slerp" not in rows.shared(drawn(ahrs_slerp=near))


def test_a_library_that_differs_anywhere_keeps_its_row() -> None:
    far = [0.5, 2.0 + 4.0 * rows.ALIKE]
    assert list(rows.shared(drawn(ahrs_slerp=far))) == ["slerp", "kim", "nielson", "ahrs-slerp"]


def test_a_missing_number_is_alike_to_a_missing_one_alone() -> None:
    lacking = drawn(ahrs_slerp=[0.5, np.nan], nlerp=[0.5, np.nan])
    assert rows.shared(lacking)["nlerp"] == ["ahrs-slerp"]
    assert rows.shared(lacking)["slerp"] == []


def test_infinite_numbers_are_alike() -> None:
    found = rows.shared(drawn(ahrs_slerp=[0.5, np.inf], nlerp=[0.5, np.inf]))
    assert found["nlerp"] == ["ahrs-slerp"]


def test_schemes_of_this_package_other_families_and_what_is_coloured_keep_their_rows() -> None:
    same = drawn(nlerp=LIKE_SLERP, splines_squad=LIKE_SLERP, scipy_rotation_spline=LIKE_SLERP)
    same.loc["log-cubic"] = LIKE_SLERP
    assert list(rows.shared(same)) == list(same.index)


def test_the_nearest_is_chosen_and_of_equally_near_ones_the_first_of_the_family() -> None:
    near = drawn(nlerp=[0.51, 2.0], ahrs_slerp=[0.51, 2.0], drake_slerp=[0.5, 2.0])
    near.loc["fast-slerp"] = [0.5 + 1e-9, 2.0]
    found = rows.shared(near)
    assert found["nlerp"] == ["ahrs-slerp"]
    assert found["slerp"] == ["drake-slerp"]


def test_a_column_without_numbers_or_without_extent_says_nothing() -> None:
    flat = pd.DataFrame({"a": [1.0, 1.0, np.nan], "b": np.nan}, ["slerp", "ahrs-slerp", "kim"])
    assert rows.shared(flat) == {"slerp": ["ahrs-slerp"], "kim": []}


def test_labels_count_the_libraries_and_captions_name_them() -> None:
    sharing = {"slerp": ["ahrs-slerp", "drake-slerp"], "quintic": ["a"], "kim": []}
    ax = Figure().subplots()
    rows.label(ax, list(sharing), sharing)
    labels = [text.get_text() for text in ax.get_yticklabels()]
    assert labels == ["slerp + 2 libraries", "quintic (ours) + 1 library", "kim"]
    assert "ahrs-slerp, drake-slerp with slerp; a with quintic" in rows.said(sharing)
    assert rows.said({"kim": []}) == ""


def test_marks_are_hollow_for_libraries_and_grey_unless_chosen() -> None:
    names = ["slerp", "hermite", "ahrs-slerp", "scipy-rotation-spline"]
    ax = Figure().subplots()
    rows.mark(ax, pd.Series(dict.fromkeys(names, 1.0)), names)
    assert [line.get_ydata()[0] for line in ax.lines] == [0, 1, 2, 3]
    for name, line in zip(names, ax.lines, strict=True):
        assert (line.get_markerfacecolor() == "white") == third_party(name)
        assert (line.get_color() == rows.looks("hermite", ())["color"]) == (name not in NAMED)


def test_marks_are_black_where_colours_stand_for_something_else() -> None:
    names = ["slerp", "hermite", "scipy-rotation-spline"]
    assert {rows.look(name, None)["color"] for name in names} == {"black"}
    assert [rows.look(name, None).get("markerfacecolor") for name in names] == [None, None, "white"]
