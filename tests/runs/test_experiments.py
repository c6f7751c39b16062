"""The paper's cases and experiments: counts, columns, blending functions, pictures, the README."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from desk import Desk
from quatspline import quaternion
from quatspline.catalogue import found, scheme, schemes
from quatspline.discovery import shipped
from quatspline.figures import motions
from quatspline.findings.findings import findings, reader
from quatspline.instruments.blending import blending
from quatspline.runs.experiment import Run, crossed, files
from quatspline.system.loading import load
from quatspline.timing.interleaved import interleaved
from quatspline.timing.protocols import PROTOCOLS, frames
from quatspline.trajectories.paper import CASES, KEY, SOLVE, TEAPOT
from quatspline.trajectories.walks import loop, walk
from tools import paper_search
from tools.readme import BLOCKS, QUOTING, REFERENCE, ROOT, renewed

COLUMNS = [
    *("case", "frames", "scheme", "protocol", "iterations", "tolerance", "slerps", "exps", "logs"),
    *("seconds_median", "seconds_iqr", "repeats", "ratio_to_quartic"),
    *("paper_iterations", "paper_seconds", "paper_ratio"),
    *(f"{key}_{part}" for key in ("slerps", "exps", "logs") for part in ("updates", "rest")),
]


def experiment(name: str):
    return load(shipped("experiments") / f"{name}.py", "experiment")


@pytest.mark.parametrize(("case", "steps"), [(KEY, 16), (TEAPOT, 40)])
def test_nielson_takes_the_papers_steps_to_the_right_solution(case, steps):
    curve = scheme("nielson").from_keyframes(case.keyframes(), **SOLVE)
    assert curve.solve_report.iterations == steps
    assert curve.solve_report.converged
    exact = scheme("nielson").from_keyframes(case.keyframes(), tolerance=1e-12)
    t = np.linspace(*curve.domain, 101)
    assert quaternion.distance(curve(t), exact(t)).max() < 1e-4


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_cases_are_round_numbers_of_the_search(case):
    euler = np.array(case.euler)
    assert (euler % 10 == 0).all()
    assert case.keyframes().signs[0] == 1.0
    assert np.all(paper_search.steps(case.quaternions[None], case.closed) < 180.0)


def test_search_finds_the_committed_key():
    found, hits = paper_search.calmest(paper_search.key_candidates, 16, False, 5)
    np.testing.assert_array_equal(found, KEY.euler)
    assert hits > 1000


def test_loops_have_equal_steps():
    q = loop(np.random.default_rng(5), 6, 80.0, 7)
    angles = paper_search.steps(np.moveaxis(q, 1, 0), True)
    assert q.shape == (6, 7, 4)
    np.testing.assert_allclose(angles, 80.0, rtol=1e-9)


@pytest.mark.parametrize("cumulative", [False, True])
def test_blending_functions_are_the_papers(cumulative):
    u = np.linspace(0.0, 1.0, 11)
    b = np.array(
        [
            0.5 * u**4 - 1.5 * u**3 + 1.5 * u**2 - 0.5 * u,
            -0.5 * u**4 + 2.5 * u**3 - 3 * u**2 + 1,
            -0.5 * u**4 - 0.5 * u**3 + 1.5 * u**2 + 0.5 * u,
            0.5 * u**4 - 0.5 * u**3,
        ]
    )
    expected = np.cumsum(b[::-1], axis=0)[::-1] if cumulative else b
    table = blending(scheme("quartic"), u, cumulative=cumulative)
    np.testing.assert_allclose(table[["B0", "B1", "B2", "B3"]].T, expected, atol=1e-13)


@pytest.mark.parametrize("protocol", PROTOCOLS)
@pytest.mark.parametrize("name", ["quartic", "nielson", "kim"])
def test_protocols_generate_the_curves_own_frames(name, protocol):
    options = SOLVE if scheme(name).iterative else {}
    t = TEAPOT.frames(12)
    generated = frames(scheme(name), TEAPOT.keyframes(), t, protocol, **options)(2)
    expected = scheme(name).from_keyframes(TEAPOT.keyframes(), **options)(t)
    np.testing.assert_array_equal(generated, expected)


def test_interleaved_rounds_time_every_contender_as_often():
    calls = {"short": 0, "long": 0}

    def contender(name):
        def run(loops):
            calls[name] += 1
            sum(range(1000 * loops))

        return run

    timings = interleaved({name: contender(name) for name in calls}, 5, least=1e-4)
    assert {t.rounds for t in timings.values()} == {5}
    assert all(t.median > 0.0 and t.iqr >= 0.0 for t in timings.values())


def test_table1_has_its_columns_rows_and_counts(monkeypatch):
    drawn = []
    monkeypatch.setattr(motions, "render", lambda case, t, q: drawn.append(len(t)))
    table = experiment("table1").measure(Run(quick=True))
    assert list(table.columns) == COLUMNS
    rows = table[table["case"].isin(["key", "teapot"])]
    assert len(rows) == 6 * 3 * 2
    assert set(rows["protocol"]) == {"per-frame", "solve-once"}
    steps = rows[rows["scheme"] == "nielson"].groupby("case")["iterations"].unique()
    assert steps["key"].tolist() == [16]
    assert steps["teapot"].tolist() == [40]
    assert set(drawn) == {9, 12}
    per_frame = rows[(rows["protocol"] == "per-frame") & (rows["scheme"] == "quartic")]
    assert (per_frame["exps"] == 3 * per_frame["frames"]).all()


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_frames_are_really_rendered(case):
    t = case.frames(case.rows[0].frames)[:1]
    q = scheme("quartic").from_keyframes(case.keyframes())(t)
    assert motions.render(case, t, q) == 320 * 240 * 4


def test_figures_are_drawn_from_their_tables_alone(tmp_path):
    module = experiment("figure3")
    table = module.measure(Run(quick=True))
    table.to_csv(tmp_path / "figure3.csv", index=False)
    figure = module.draw(pd.read_csv(tmp_path / "figure3.csv"))
    assert len(figure.axes) == 4
    assert "reconstructed" in module.caption(table)
    keys = table[table.panel == "keyframes"]
    assert len(keys) == 5
    frames_of = table[(table.panel == "frames") & (table.scheme == "quartic")]
    assert len(frames_of) == 9


PLUGIN = '''
import numpy as np
from quatspline.curve import Curve

class Mine(Curve):
    """Holds each keyframe until the next."""
    title = "Hold"
    reference = "none"
    continuity = -1
    order = 1
    support = 1
    constant_rate = "no"

    def _fit(self, keyframes):
        self.q, self.knots = keyframes.quaternions, keyframes.knots

    def _orientation(self, t):
        last = len(self.q) - 1
        return self.q[np.minimum(np.searchsorted(self.knots, t, side="right") - 1, last)]
'''


def test_a_scheme_is_one_file_and_stands_in_the_tables(tmp_path):
    desk = Desk(tmp_path)
    (tmp_path / "schemes" / "hold_it.py").write_text(PLUGIN, encoding="utf-8")
    done = desk("run", "continuity", "--quick", "--schemes", "hold-it,slerp", "--jobs", 1)
    assert done.returncode == 0, done.stderr
    table = pd.read_csv(tmp_path / "results" / "continuity.csv")
    assert set(table["scheme"]) == {"hold-it", "slerp"}
    assert (table.loc[table["scheme"] == "hold-it", "measured_k"] == -1).all()
    assert (table.loc[table["scheme"] == "slerp", "measured_k"] == 0).all()


def test_walks_are_reproducible_and_have_their_step():
    a, b = (walk(np.random.default_rng(1), 8, 70.0, 3) for _ in range(2))
    np.testing.assert_array_equal(a, b)
    np.testing.assert_allclose(paper_search.steps(np.moveaxis(a, 1, 0), False), 70.0, rtol=1e-12)


def test_readme_quotes_the_reference_tables():
    """Line by line: a scheme that somebody adds stands in no committed table yet, nor is every library here.

    What `compare` prints quotes no table; test_docs runs it.
    """
    tables = {name: block for name, block in BLOCKS.items() if name != "compare"}
    absent = tuple(f"| [`{n}`]" for n, item in found().items() if item.scheme is None)
    for file in QUOTING:
        text = file.read_text(encoding="utf-8")
        lines = {line for line in text.splitlines() if not line.startswith(absent)}
        assert lines <= set(renewed(text, tables).splitlines()), file
    assert len(findings(reader(REFERENCE))) >= 5


def test_findings_name_cells_that_exist():
    read = reader(Path(REFERENCE))
    for finding in findings(read):
        assert finding.cells
        for cell in finding.cells:
            rows = read(cell.table)
            for key, value in cell.row.items():
                rows = rows[rows[key] == value]
            assert rows.iloc[0][cell.column] == cell.value


def test_cells_cross_all_values():
    run = Run(quick=True, schemes=["slerp", "nlerp"])
    assert crossed(scheme=run.names, degrees=(10, 60)) == [
        {"scheme": "slerp", "degrees": 10},
        {"scheme": "slerp", "degrees": 60},
        {"scheme": "nlerp", "degrees": 10},
        {"scheme": "nlerp", "degrees": 60},
    ]
    assert set(schemes()) <= set(Run(quick=True).names)


def test_docs_point_to_tables_that_experiments_make():
    known = set(files())
    for page in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]:
        named = re.findall(r"results/(\w[\w-]*)\.csv", page.read_text(encoding="utf-8"))
        assert set(named) <= known, page


def test_schemes_that_do_not_apply_are_rows_of_table1(monkeypatch):
    monkeypatch.setattr(motions, "render", lambda case, t, q: len(t))
    module = experiment("table1")
    names = ("quartic", "log-cubic", "nlerp")
    table = module.group(Run(quick=True), TEAPOT, TEAPOT.rows[1], "solve-once", names)
    assert set(table["scheme"]) == set(names)
    row = table[table["scheme"] == "log-cubic"].iloc[0]
    assert "closed" in row["failure"]


def test_tension_gives_up_the_constant_rate():
    spin = quaternion.exp(np.outer(np.arange(6) * 0.3, [0.0, 0.6, 0.8]))
    curve = scheme("nielson")(None, spin, tension=5.0)
    assert curve.constant_rate == "no"
    assert np.ptp(np.linalg.norm(curve(np.linspace(0.0, 5.0, 101), 1), axis=-1)) > 0.01
