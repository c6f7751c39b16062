"""Choosing: fronts by definition, decisions tied to cells, a table derived from those of a folder."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from quatspline.catalogue import called
from quatspline.cli import running
from quatspline.figures import style
from quatspline.findings import decisions
from quatspline.findings.findings import findings, reader
from quatspline.runs.experiment import Run, experiments, files
from quatspline.runs.results import Results
from quatspline.system.loading import load

LESS = {"a": -1, "b": -1}


@pytest.fixture
def module():
    return load(files()["choosing"], "experiment")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Small tables in which what is to be said is plain."""
    results = Results(tmp_path)
    names = ["slerp", "quartic", "local-quintic"]
    fair = {"data": "committed", "scheme": names, "median": [np.inf, 1.6, 1.01]}
    results.table("fairness", pd.DataFrame({**fair, "worst": [np.inf, 3.0, 1.1]}))
    smooth = {"case": "60 degrees, uniform", "scheme": names, "measured_k": [0, 2, 2]}
    results.table("continuity", pd.DataFrame(smooth))
    costs = [
        {"task": task, "size": size, "scheme": name, "exps": 1, "logs": 2, "slerps": 3}
        | {"seconds_median": seconds * size}
        for task, size in (("evaluation", 10_000), ("evaluation", 100), ("set-up", 1000))
        for name, seconds in zip(names, (1e-9, 4e-9, 2e-9), strict=True)
    ]
    results.table("cost", pd.DataFrame(costs))
    return tmp_path


# -- fronts -------------------------------------------------------------------------------------


def test_a_front_is_what_nothing_beats() -> None:
    """Against the definition, row by row, on random whole numbers with ties."""
    rng = np.random.default_rng(0)
    table = pd.DataFrame(rng.integers(0, 5, (40, 2)), columns=["a", "b"])
    marks = decisions.pareto(table, LESS)
    for i, (a, b) in enumerate(table.to_numpy()):
        others = table.to_numpy()
        beaten = any((x <= a and y <= b and (x < a or y < b)) for x, y in others)
        assert marks[i] == ("no" if beaten else "yes")


def test_more_may_be_better_and_equals_stay_together() -> None:
    table = pd.DataFrame({"a": [1.0, 1.0, 2.0], "b": [5.0, 5.0, 4.0]})
    assert list(decisions.pareto(table, {"a": -1, "b": 1})) == ["yes", "yes", "no"]


def test_what_is_unknown_is_neither_on_a_front_nor_off() -> None:
    table = pd.DataFrame({"a": [1.0, np.nan, np.inf], "b": [5.0, 1.0, 1.0]})
    assert list(decisions.pareto(table, LESS).isna()) == [False, True, False]
    assert list(decisions.pareto(table, LESS).dropna()) == ["yes", "yes"]
    assert decisions.pareto(table, {"c": 1}).isna().all()


def test_orders_are_compared_as_whole_numbers() -> None:
    table = pd.DataFrame({"order": [4.1, 3.9], "torque": [1.2, 1.1]})
    assert list(decisions.pareto(table, {"torque": -1, "order": 1})) == ["no", "yes"]


# -- decisions ----------------------------------------------------------------------------------


def test_every_clause_points_at_a_cell() -> None:
    table = pd.DataFrame(
        {
            "scheme": ["a", "b", "c"],
            "passes_keys": ["yes", "yes", "no"],
            "smooth_k": [2, 2, 2],
            "smooth_k_worst": [2, 2, 2],
            "support": ["all", "8", "8"],
            "torque": [1.0, 1.2, 0.5],
            "order": [4.0, np.nan, 4.0],
        }
    )
    sentences = list(decisions.decisions(table))
    local = sentences[0]
    quotes = [part for part in local if not isinstance(part, str)]
    assert [quote.source.column for quote in quotes] == ["scheme", "torque", "support"]
    assert {quote.source.row["scheme"] for quote in quotes} == {"b"}
    assert "torque energy 1.2 times" in "".join(map(str, local))
    assert not any(
        ch.isdigit() for part in local if isinstance(part, str) for ch in part.replace("C2", "")
    )
    assert str(sentences[1][1]) == "a"
    assert "`choosing.csv[scheme=b]`, `torque`, `support`" in next(decisions.lines(table))


def test_nothing_is_said_where_nothing_fits() -> None:
    assert list(decisions.decisions(pd.DataFrame({"scheme": ["a"], "torque": [1.0]}))) == []
    unfit = {"scheme": ["a"], "torque": [np.nan], "passes_keys": ["yes"]}
    assert list(decisions.decisions(pd.DataFrame(unfit))) == []


QUICK = pd.DataFrame(
    {
        "scheme": ["a", "b", "c"],
        "passes_keys": "yes",
        "closes": "yes",
        "smooth_k": 2,
        "smooth_k_worst": [2, 2, np.nan],
        "support": ["all", "8", "4"],
        "torque": [1.02, 1.03, 1.0],
        "nanoseconds_per_sample": [10.0, 18.0, 21.0],
        "operations_sample": [3, 1, 2],
    }
)


def told(table: pd.DataFrame) -> dict[str, str]:
    """Sentences by how they begin."""
    parts = ("".join(map(str, sentence)) for sentence in decisions.decisions(table))
    return dict(text.split(": ", 1) for text in parts)


def test_quick_size_leaves_open_what_hangs_on_little() -> None:
    full, quick = told(QUICK.assign(run_size="full")), told(QUICK.assign(run_size="quick"))
    assert set(quick) == set(full)
    open_ones = {wish for wish, answer in quick.items() if answer == "not decided at quick size."}
    assert all(quick[wish] == full[wish] for wish in set(quick) - open_ones)
    assert {wish.split()[0] for wish in open_ones} == {"Closed", "The", "C2"}
    fewest = next(wish for wish in quick if "fewest operations" in wish)
    assert quick[fewest].startswith("b ")
    lines = list(decisions.lines(QUICK.assign(run_size="quick")))
    assert sum("not decided at quick size. Cells: `choosing.csv[" in line for line in lines) == len(
        open_ones
    )


def test_a_table_of_a_quick_source_is_quick(module, folder: Path) -> None:
    def sized() -> str:
        table = module.derive(Run(quick=True), reader(folder))
        return str(table["run_size"].unique().item())

    assert sized() == "full"
    cost = Results(folder).read_table("cost")
    Results(folder, force=True).table("cost", cost.assign(run_size="quick"))
    assert sized() == "quick"
    Results(folder, force=True).table("cost", cost.assign(run_size="full"))
    fair = Results(folder).read_table("fairness")
    Results(folder, force=True).table("fairness", fair.assign(sets=6))
    assert sized() == "quick"
    Results(folder, force=True).table("fairness", fair.assign(sets=200))
    assert sized() == "full"


# -- the table ----------------------------------------------------------------------------------


def test_derived_from_the_tables_that_are_there(module, folder: Path) -> None:
    table = module.derive(Run(quick=True), reader(folder)).set_index("scheme")
    assert list(table.columns) == module.COLUMNS[1:]
    assert table.loc["quartic", "torque"] == 1.6
    assert table.loc["quartic", "smooth_k_worst"] == 2
    assert table.loc["quartic", "nanoseconds_per_sample"] == pytest.approx(4.0)
    assert table.loc["quartic", "microseconds_per_keyframe"] == pytest.approx(4e-3)
    assert table.loc["quartic", "times_fastest_sample"] == pytest.approx(4.0)
    assert table.loc["quartic", "operations_sample"] == 1 + 2 + 2 * 3
    missing = table["missing"].unique().item().split(", ")
    assert missing == ["claims", "accuracy", "locality", "edge-cases", "convergence"]


def test_only_schemes_asked_for(module, folder: Path) -> None:
    table = module.derive(Run(quick=True, schemes=["slerp"]), reader(folder))
    assert list(table["scheme"]) == ["slerp"]


def test_an_empty_folder_is_told(module, tmp_path: Path) -> None:
    with pytest.raises(
        ValueError, match=r"claims, continuity, .* is in the folder: run them first"
    ):
        module.derive(Run(quick=True), reader(tmp_path))


def test_counts_are_left_out_where_a_scheme_does_other_things(module, folder: Path) -> None:
    """Square roots in a sample, or a set-up that no kernel does."""
    counts = {
        ("quartic", "evaluation"): (1, 2, 3),
        ("quartic", "set-up"): (0, 1, 0),
        ("nlerp", "evaluation"): (0, 0, 0),
        ("nlerp", "set-up"): (0, 1, 0),
        ("min-torque", "evaluation"): (1, 0, 0),
        ("min-torque", "set-up"): (np.nan, np.nan, np.nan),
    }
    rows = [
        {"task": task, "scheme": name, "seconds_median": 1.0, "size": 100}
        | dict(zip(("exps", "logs", "slerps"), each, strict=True))
        for (name, task), each in counts.items()
    ]
    Results(folder, force=True).table("cost", pd.DataFrame(rows))
    table = module.derive(Run(quick=True), reader(folder)).set_index("scheme")
    found = table.loc[["quartic", "nlerp", "min-torque"]]
    assert found["operations_sample"].fillna(-1).tolist() == [1 + 2 + 2 * 3, -1, 1]
    assert found["operations_keyframe"].fillna(-1).tolist() == [1, 1, -1]


def test_the_worst_failure_is_the_gravest(module, folder: Path) -> None:
    edges = pd.DataFrame(
        [
            ("slerp", "x", "wrong", 0.5, None),
            ("slerp", "y", "wrong", 2.0, None),
            ("slerp", "z", "NaN", np.nan, "velocity is not a number"),
            ("quartic", "x", "wrong", 0.25, None),
            ("local-quintic", "x", "error", np.nan, "ValueError: no closed curve"),
        ],
        columns=["scheme", "case", "result", "relative", "failure"],
    )
    Results(folder, force=True).table("edge-cases", edges)
    table = module.derive(Run(quick=True), reader(folder)).set_index("scheme")
    assert table["worst_failure"].dropna().to_dict() == {
        "slerp": "NaN: z; off by 2 of the step: y",
        "quartic": "off by 0.25 of the step: x",  # a refusal is no failure
    }


def test_what_a_scheme_claims_is_no_failure(module, folder: Path) -> None:
    """The quartic's missing constant rate at the ends, under each of four names, and the worst of each cause."""
    cases = ["Unix times", "sign-flipped", "near half-turn", "tiny rotations"]
    off = {"case": cases, "relative": 0.051, "failure": None}
    rows = [
        pd.DataFrame({"scheme": "quartic", "result": "as claimed", **off}),
        pd.DataFrame(
            {"scheme": "local-quintic", "result": ["exact", "exact", "wrong", "NaN"], **off}
        ),
    ]
    Results(folder, force=True).table("edge-cases", pd.concat(rows))
    leap = {"case": "170 degrees, uneven", "scheme": "local-quintic", "measured_k": -1}
    tables = [Results(folder).read_table("continuity"), pd.DataFrame([leap])]
    Results(folder, force=True).table("continuity", pd.concat(tables))
    table = module.derive(Run(quick=True), reader(folder)).set_index("scheme")
    assert pd.isna(table.loc["quartic", "worst_failure"])
    said = (
        "leaps: 170 degrees, uneven; NaN: tiny rotations; off by 0.051 of the step: near half-turn"
    )
    assert table.loc["local-quintic", "worst_failure"] == said


def test_the_best_method_of_a_scheme_counts(module, folder: Path) -> None:
    base = {"scheme": "quartic", "keyframes": 5, "unevenness": 1.0}
    rows = [
        {**base, "method": "m", "step_degrees": 60, "share_converged": 0.5},
        {**base, "method": "n", "step_degrees": 60, "share_converged": 1.0},
        {**base, "method": "n", "step_degrees": 170, "share_converged": 0.25},
    ]
    Results(folder).table("convergence", pd.DataFrame(rows))
    table = module.derive(Run(quick=True), reader(folder)).set_index("scheme")
    told = "solves 25 %: 5 keyframes, 170 degrees, unevenness 1"
    assert table["worst_failure"].dropna().to_dict() == {"quartic": told}


def test_run_writes_table_decisions_and_figure(folder: Path) -> None:
    assert running.run(["choosing"], out=folder) == []
    text = (folder / "choosing.md").read_text(encoding="utf-8")
    assert text.index("| scheme |") < text.index("## Decisions")
    assert (folder / "choosing.svg").is_file()
    before = (folder / "choosing.csv").read_bytes()
    assert running.run(["choosing"], out=folder) == []
    assert (folder / "choosing.csv").read_bytes() == before
    said = [found for found in findings(reader(folder)) if found.topic == decisions.TABLE]
    assert len(said) == text.count("- ") - text[: text.index("## Decisions")].count("- ")


def test_derived_experiments_come_last() -> None:
    assert experiments()[-1].name == "choosing"
    assert [e.name for e in experiments(["choosing", "noise"])] == ["noise", "choosing"]


def test_names_in_the_figure_keep_apart(module, folder: Path) -> None:
    """Six of one time, three of them of nearly one height."""
    names = ["slerp", "quartic", "local-quintic", "kim", "squad", "nielson"]
    excess = [1e-3, 0.30, 0.31, 0.9, 0.99, 1.0]
    fair = {"scheme": names, "median": 1.0 + np.array(excess), "worst": 3.0, "data": "committed"}
    Results(folder, force=True).table("fairness", pd.DataFrame(fair))
    cost = {"task": "evaluation", "scheme": names, "size": 100, "seconds_median": 1.0}
    cost |= dict.fromkeys(("exps", "logs", "slerps"), 1)
    Results(folder, force=True).table("cost", pd.DataFrame(cost))
    table = module.derive(Run(quick=True), reader(folder))
    with style.applied():
        axes = module.draw(table).axes[0]
    assert {text.get_text() for text in axes.texts} == set(map(called, names))
    boxes = [text.get_window_extent() for text in axes.texts]
    assert not any(a.overlaps(b) for a, b in combinations(boxes, 2))


def test_schemes_of_infinite_energy_are_not_drawn(module, folder: Path) -> None:
    table = module.derive(Run(quick=True), reader(folder))
    with style.applied():
        names = {text.get_text() for text in module.draw(table).axes[0].texts}
    assert names == {"quartic", called("local-quintic")}
