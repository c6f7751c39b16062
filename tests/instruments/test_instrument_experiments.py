"""The experiments that run an instrument over schemes: cells, tables and figures of a few of them."""

from __future__ import annotations

import json

import pandas as pd
import pytest

from desk import Desk
from quatspline import catalogue
from quatspline.cli import running
from quatspline.figures import style
from quatspline.runs.experiment import Run, files
from quatspline.runs.results import Results
from quatspline.system.loading import load

SCHEMES = ["slerp", "squad", "shoemake-bezier"]
"""One that is local, one with neighbours, and one that refuses uneven times."""

COLUMNS = {
    "accuracy": {"knots", "keyframes", "slope", "slope_alpha", "spacing_0.1deg", "unreached"},
    "continuity": {
        "case",
        "order",
        "quantity",
        "jump",
        "measured_k",
        "claimed_k",
        "least_key_speed",
    },
    "denoise": {"clip", "every", "noise_degrees", "over_slerp", "told_degrees", "omega"},
    "edge-cases": {"case", "result", "checked", "deviation", "failure"},
    "excursion": {
        "data",
        "segments",
        "off_median",
        "over_worst",
        "back_q95",
        "overshot",
        "wander_worst",
        "failure",
    },
    "fairness": {
        "data",
        "sets",
        "median",
        "jerk_median",
        "length_median",
        "curvature_median",
        "curvature_infinite",
        "peak_median",
        "failure",
    },
    "invariance": {"property", "deviation", "relative", "invariant"},
    "locality": {
        "offset",
        "response",
        "support",
        "decay",
        "agrees",
        "lookahead",
        "lookahead_agrees",
    },
    "noise": {"error", "gain", "gain_omega", "gain_alpha"},
    "reconstruct": {"clip", "filter", "every", "over_slerp", "worst_joint", "end_cm", "alpha"},
    "reduce": {"clip", "filter", "error_degrees", "keyframes", "over_slerp", "worst_joint"},
}


@pytest.fixture(scope="module", params=list(COLUMNS))
def measured(request, tmp_path_factory):
    """An experiment, its cells, and its table as read back from the file."""
    name = request.param
    module = load(files()[name], "experiment")
    run = Run(quick=True, schemes=SCHEMES)
    cells = module.cells(run)
    rows = [row for cell in cells for row in _rows(module, run, cell)]
    table = pd.DataFrame(rows)
    table = module.gather(run, table) if hasattr(module, "gather") else table
    results = Results(tmp_path_factory.mktemp(name))
    return name, module, cells, results.table(name, table, keys=module.KEYS)


def _rows(module, run, cell):
    """Through JSON, as a worker's are."""
    return json.loads(json.dumps(module.measure_cell(run, **cell)))


def test_cells_are_distinct_and_travel(measured):
    _, _, cells, _ = measured
    keys = [json.dumps(cell, sort_keys=True) for cell in cells]
    assert len(set(keys)) == len(keys)
    assert [json.loads(key) for key in keys] == cells


def test_tables_have_their_columns_and_schemes(measured):
    name, module, _, table = measured
    assert COLUMNS[name] <= set(table.columns)
    assert set(SCHEMES) <= set(table["scheme"])
    assert set(module.FORMATS) <= set(table.columns)


def test_a_scheme_that_does_not_apply_is_a_row_with_its_reason(measured):
    name, _, _, table = measured
    rows = table[table["scheme"] == "shoemake-bezier"]
    if name in ("invariance", "locality"):  # it is given uniform times there
        assert "failure" not in table or rows["failure"].isna().all()
    else:
        assert rows["failure"].str.contains("uniform times only").any()


def test_figures_are_drawn_from_the_table(measured):
    _, module, _, table = measured
    with style.applied():
        figure = module.draw(table)
    assert figure.axes
    assert all(len(line) > 40 for line in [module.caption(table), module.NOTE])


def test_a_cell_gives_the_same_rows_again(measured):
    _, module, cells, _ = measured
    run = Run(quick=True, schemes=SCHEMES)
    assert json.dumps(_rows(module, run, cells[0])) == json.dumps(_rows(module, run, cells[0]))


def test_where_nothing_can_be_measured_there_is_a_table_of_reasons(tmp_path, monkeypatch):
    desk = Desk(tmp_path)
    desk.scheme("stubborn", 'raise TypeError("no such option")')
    monkeypatch.setenv(catalogue.FOLDERS, desk.environment[catalogue.FOLDERS])
    out = tmp_path / "results"
    assert running.run(["noise"], schemes=["stubborn"], size="quick", out=out, jobs=1) == []
    table = Results(out).read_table("noise")
    assert set(table["failure"]) == {"TypeError: no such option"}
    assert not (out / "noise.png").exists()


@pytest.mark.parametrize(("name", "order"), [("kim", 3), ("quartic", 2), ("local-quintic", 4)])
def test_quick_orders_are_those_of_full_size(name, order):
    """They are read between the two finest levels; between 41 and 81 keyframes kim's is 3.50."""
    module = load(files()["accuracy"], "experiment")
    quick, full = (
        module.gather(run, pd.DataFrame(module.measure_cell(run, "uniform", name)))
        for run in (Run(quick=True), Run(quick=False))
    )
    assert quick["slope"].iloc[-1] == full["slope"].iloc[-1] == pytest.approx(order, abs=0.1)


def test_quick_size_measures_libraries_at_fewer_keyframes():
    module = load(files()["accuracy"], "experiment")
    levels = [
        module.levels(Run(quick=True), kind, name)
        for kind, name in [("uniform", "kim"), ("jittered", "kim"), ("uniform", "scipy-slerp")]
    ]
    assert levels == [module.FULL, module.QUICK, module.QUICK]
