"""Schemes that do not come with the package: in colour, with looks and rows of their own, and called nobody else's."""

from __future__ import annotations

import importlib
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from desk import SCHEME
from quatspline import catalogue
from quatspline.cli import main, ranking
from quatspline.comparing import MET
from quatspline.figures import matrix, named, rows
from quatspline.figures.looks import FAMILIES, scheme_style
from quatspline.figures.named import FEW, NAMED, coloured
from quatspline.findings.needs import Needs
from quatspline.page.motion import opening
from quatspline.page.plots import scheme_look
from quatspline.runs.experiment import Run
from walks import walk

MINE = [f"mine-{letter}" for letter in "abcdef"]


def json_of(folder: Path, key: str) -> Any:
    """What the page's scripts read."""
    page = (folder / "report.html").read_text(encoding="utf-8")
    found = re.search(rf'<script type="application/json" id="{key}">(.*?)</script>', page)
    assert found
    return json.loads(found[1])


def plug_in(folder: Path, name: str, claims: str = "pass") -> None:
    text = SCHEME.format(fit="pass", claims=claims)
    (folder / f"{name.replace('-', '_')}.py").write_text(text, encoding="utf-8")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six schemes of a user, and one more that wraps a library."""
    place = tmp_path_factory.mktemp("mine")
    for name in MINE:
        plug_in(place, name)
    plug_in(place, "wrapped", 'peer = "numpy"')
    return place


@pytest.fixture(autouse=True)
def _found(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(catalogue.FOLDERS, str(folder))


def test_a_plug_in_is_in_colour_and_takes_the_last_place_only_where_there_is_none_left() -> None:
    assert coloured(["mine-a", "squad", "kim", "hermite"]) == ("squad", "kim", "mine-a")
    assert coloured([*NAMED, "hermite", "mine-a"]) == (*NAMED[:-1], "mine-a")
    assert coloured([*NAMED, "hermite"]) == NAMED


def test_of_many_plug_ins_the_first_few_are_in_colour() -> None:
    assert coloured([*MINE, *NAMED]) == (*NAMED[: len(NAMED) - FEW], *MINE[:FEW])


def test_captions_name_what_is_in_the_figure_alone() -> None:
    assert named.said(["mine-a", "squad", "hermite"]) == (
        " In colour squad and mine-a, in grey all other schemes."
    )
    assert named.said(["mine-a", "squad", "kim"]) == ""
    assert named.said(["mine-a", "wrapped"]) == " Third-party schemes are hollow."
    told = named.said([*NAMED, "hermite"])
    assert told.endswith("and scipy-rotation-spline, in grey all other schemes; "
                         "third-party schemes are hollow.")  # fmt: skip


def test_looks_of_plug_ins_are_nobody_elses() -> None:
    members = [name for family in FAMILIES for name in family.members]
    theirs = [scheme_style(name) for name in members]
    looks = [scheme_style(name) for name in MINE[:FEW]]
    for kind in ("color", "marker"):
        assert not {look[kind] for look in looks} & {look[kind] for look in theirs}
    for kind in ("marker", "linestyle"):
        assert len({look[kind] for look in looks}) == FEW
    assert not any(scheme_look(name)["symbol"].endswith("-open") for name in MINE)


def test_a_plug_in_is_hollow_if_it_wraps_a_library() -> None:
    assert scheme_style("wrapped")["markerfacecolor"] == "white"
    assert scheme_look("wrapped")["symbol"].endswith("-open")


def test_rows_and_curves_show_a_plug_in_in_its_colour() -> None:
    names, own = ["hermite", "mine-a"], scheme_style("mine-a")
    ax = Figure().subplots()
    rows.mark(ax, pd.Series(dict.fromkeys(names, 1.0)), names)
    rows.label(ax, names, {})
    marked = ax.lines[1]
    assert (marked.get_color(), marked.get_marker()) == (own["color"], own["marker"])
    assert marked.get_markerfacecolor() == own["color"]
    assert [text.get_color() for text in ax.get_yticklabels()] == [rows.BEHIND, "black"]
    x = pd.Series([1.0, 2.0])
    ends = named.draw_curves(ax, [(name, x, x) for name in names], coloured(names))
    assert list(ends) == ["mine-a"]


def test_a_plug_in_that_answers_as_others_do_has_a_row_of_its_own() -> None:
    kinds = pd.DataFrame({"a": "holds"}, ["mine-a", "slerp", "scipy-slerp"])
    assert matrix.alike(kinds, kinds) == {"mine-a": [], "slerp": ["scipy-slerp"]}


@pytest.mark.parametrize("name", ["accuracy", "choosing", "cost", "excursion", "fairness", "speed"])
def test_captions_of_experiments_name_schemes_that_were_run_alone(name: str) -> None:
    experiment = importlib.import_module(f"experiments.{name}")
    reference = Path(__file__).parents[2] / "results" / "reference" / f"{name}.csv"
    table = pd.read_csv(reference)
    run = table[table["scheme"].isin(["squad", "kim", "hermite", "log-cubic"])]
    mine = run[run["scheme"] == "hermite"].assign(scheme="mine-a")
    caption = experiment.caption(pd.concat([run, mine]))
    assert " In colour squad, kim and mine-a, in grey all other schemes." in caption
    assert "hollow" not in caption


def test_the_player_opens_on_what_was_asked_for_then_on_plug_ins_that_were_run() -> None:
    there = ["kim", "mine-a", "nielson", "quartic", "squad"]
    assert opening((), there, ["squad", "mine-a", "kim"]) == ["mine-a", "kim"]
    assert opening((), there, ["squad", "kim"]) == ["kim", "squad"]
    assert opening((), there, [name for name in there if name != "mine-a"]) == [
        "quartic",
        "nielson",
    ]
    assert opening(("squad",), there, there) == ["squad", "mine-a"]
    assert opening(("squad",), ["kim"], ["squad"]) == ["kim"]  # where what was run does not apply


@pytest.fixture(scope="module")
def compared(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What compare makes of noisy keyframes, with a scheme of a user and one that only passes near them."""
    out, file = tmp_path_factory.mktemp("compared"), tmp_path_factory.mktemp("keys") / "keys.csv"
    rows = np.column_stack([np.arange(9.0), walk(9, 50.0)])
    np.savetxt(file, rows, delimiter=",", header="t,w,x,y,z", comments="")
    schemes = ["mine-a", "smoothing-spline", "kim", "quartic", "slerp", "local-quintic"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(catalogue.FOLDERS, str(folder))
        assert main(["compare", str(file), "--schemes", *schemes, "--out", str(out)]) == 0
    return out


def test_the_page_of_a_comparison_opens_on_the_recommended_scheme_beside_the_plug_in(
    compared: Path,
) -> None:
    best = pd.read_csv(compared / "compare.csv")["scheme"][0]
    assert f"Take {catalogue.called(best)}" in (compared / "recommendation.md").read_text(
        encoding="utf-8"
    )
    assert json_of(compared, "scenes")[0]["pair"] == [best, "mine-a"]


def test_the_table_of_a_comparison_is_ranked_as_in_the_terminal(compared: Path) -> None:
    table = pd.read_csv(compared / "compare.csv")
    lines = ranking.table(table, Needs())[1 : ranking.ROWS + 1]
    assert [line.split()[0] for line in lines] == list(table["scheme"][: ranking.ROWS])
    passes = (table["misses"] <= MET) & (table["continuity"] >= 0)
    assert passes.any()
    assert passes.is_monotonic_decreasing
    assert table.loc[~passes, "torque"].min() < table.loc[passes, "torque"].min()
    assert json_of(compared, "rankings")["compare"]["column"] is None


def test_what_was_not_measured_comes_last_whatever_it_needs(compared: Path) -> None:
    table = pd.read_csv(compared / "compare.csv")
    failed = table["scheme"] == table["scheme"][0]
    some = table.assign(failure=np.where(failed, "it failed", None))
    assert ranking.sort(some, Needs())["scheme"].iloc[-1] == table["scheme"][0]
    assert sorted(ranking.sort(some, Needs())["scheme"]) == sorted(table["scheme"])


def test_what_a_plug_in_claims_is_not_said_by_this_package() -> None:
    claims = importlib.import_module("experiments.claims")

    def sources(name: str) -> set[str]:
        return {claim.source for claim in claims._of_class(Run(quick=True), catalogue.scheme(name))}

    assert sources("mine-a") == {"plug-in"}
    assert sources("wrapped") == {"plug-in", "peer"}
    assert sources("squad") == {"ours"}
    assert sources("scipy-slerp") == {"ours", "peer"}


def test_an_unusable_plug_in_is_no_library(folder: Path) -> None:
    claims = importlib.import_module("experiments.claims")
    broken = folder / "broken.py"
    broken.write_text("import nowhere", encoding="utf-8")
    try:
        (row,) = claims.measure_cell(Run(quick=True), "broken")
    finally:
        broken.unlink()
    assert (row["source"], row["verdict"]) == ("plug-in", "not measurable")


def test_lists_say_whose_a_scheme_is(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    lines = {line.split()[0]: line for line in capsys.readouterr().out.splitlines()}
    whose = {
        "mine-a": "plug-in  Stairs",
        "wrapped": "plug-in (numpy)  Stairs",
        "quintic": "quatspline (ours)  Quintic",
        "quartic": "quatspline  ",
        "scipy-slerp": "scipy  ",
    }
    for name, said in whose.items():
        assert " ".join(said.split()) in " ".join(lines[name].split()), name
