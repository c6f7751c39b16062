"""`qs.compare` and `quatspline compare`: the table, the recommendation, files, and hard keyframes."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.cli import commands
from quatspline.comparing import COLUMNS
from quatspline.findings.candidates import CANDIDATES, rank
from quatspline.findings.questions import Table
from quatspline.findings.quotes import Quote
from quatspline.findings.recommendation import recommendation
from quatspline.instruments.rescue import unsolved
from quatspline.keyframes import Keyframes
from quatspline.motion.files import Motion, write
from quatspline.solving import SolveReport, require_converged
from quatspline.trajectories.edge_cases import edge_cases
from walks import walk

NAMES = ["quartic", "local-quintic", "squad", "slerp", "nielson", "min-torque"]


def advice(table: pd.DataFrame) -> list[str]:
    """The lines of the recommendation."""
    return [finding.text for finding in recommendation(table)]


def chosen_among(table: pd.DataFrame) -> list[str]:
    """The candidates, the fairest first."""
    return Table("compare", table, table).asked(CANDIDATES, rank).rows["scheme"].tolist()


@pytest.fixture(scope="module")
def table() -> pd.DataFrame:
    return qs.compare(None, walk(9, 50.0, seed=1), NAMES)


def test_one_row_a_scheme_sorted_by_torque(table: pd.DataFrame) -> None:
    assert list(table.columns) == COLUMNS
    assert sorted(table["scheme"]) == sorted(NAMES)
    assert table["failure"].isna().all()
    assert table["torque"].is_monotonic_increasing
    assert table["scheme"].iloc[0] == "min-torque"
    k = table.set_index("scheme")["continuity"]
    assert (k["quartic"], k["squad"], k["slerp"], k["nielson"]) == (2, 1, 0, 1)
    assert np.isinf(table.set_index("scheme").loc["slerp", "torque"])
    assert (table["misses"] < 1e-9).all()


def test_a_constant_spin_costs_what_it_must() -> None:
    """Keyframes of one constant rate: no torque, an arc of known length, even speed."""
    q = quaternion.exp(np.outer(np.arange(6.0), [0.1, 0.2, 0.2]))  # 0.6 rad a keyframe
    row = qs.compare(None, q, ["local-quintic"]).iloc[0]
    assert row["length"] == pytest.approx(3.0, rel=1e-12)
    assert row["torque"] < 1e-20
    assert row["key_speed"] == pytest.approx(1.0)
    assert row["peak_speed"] == pytest.approx(1.0)


def test_closed_keyframes_and_what_does_not_apply() -> None:
    found = qs.compare(np.arange(7.0), walk(6, 50.0, seed=2), ["quartic", "log-cubic"], closed=True)
    assert found.set_index("scheme")["failure"].isna().to_dict() == {
        "quartic": True,
        "log-cubic": False,
    }


def test_bad_input_is_refused() -> None:
    with pytest.raises(ValueError, match="schemes is empty"):
        qs.compare(None, walk(5, 50.0, seed=1), [])
    with pytest.raises(ValueError, match=r"unknown scheme 'quartik'.*quartic"):
        qs.compare(None, walk(5, 50.0, seed=1), ["quartik"])
    with pytest.raises(ValueError, match="tracks"):
        qs.compare(None, np.stack([walk(5, 50.0, seed=1)] * 2, axis=1), ["quartic"])
    with pytest.raises(ValueError, match=r"quaternions\[1\]"):
        qs.compare(None, [[1, 0, 0, 0], [2, 0, 0, 0]], ["quartic"])


def test_every_number_of_the_recommendation_is_a_cell(table: pd.DataFrame) -> None:
    found = recommendation(table)
    assert found[0].text.startswith("Take local-quintic (ours): ")
    quotes = [part for finding in found for part in finding.parts if isinstance(part, Quote)]
    assert quotes
    for quote in quotes:
        for cell in quote.cells:
            (row,) = table[table["scheme"] == cell.row["scheme"]].to_dict("records")
            assert row[cell.column] == cell.value
    for finding in found:
        typed = "".join(part for part in finding.parts if isinstance(part, str))
        assert not re.search(r"\d", typed.replace("C", "")), typed


def test_stopping_at_keyframes_or_missing_them_is_not_recommended(table: pd.DataFrame) -> None:
    spoilt = table.copy()
    spoilt.loc[spoilt["scheme"] == "local-quintic", "key_speed"] = 0.0
    assert "local-quintic" not in chosen_among(spoilt)
    spoilt = table.copy()
    spoilt.loc[spoilt["scheme"] == "local-quintic", "misses"] = 0.1
    assert "local-quintic" not in chosen_among(spoilt)


MISSES = {"jacobi": 0.3, "newton": np.inf}


def test_a_failure_that_readers_know_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fit(self: qs.Curve, keyframes: Keyframes, *, method: str = "jacobi") -> None:
        report = SolveReport(method, "residual", 77, 1e-16, MISSES[method], False, 1e-9)
        require_converged("nielson", report, tracks=False)

    monkeypatch.setattr(qs.scheme("nielson"), "_fit", fit)
    keyframes = tmp_path / "keys.npz"
    np.savez(keyframes, times=[0.0, 2.0, 2.1], quaternions=walk(3, 40.0, seed=1))
    names = ["nielson", "kim"]
    for schemes in (names, names[:1]):
        out = tmp_path / f"out{len(schemes)}"
        arguments = ["compare", "--schemes", *schemes, str(keyframes), "--out", str(out)]
        assert commands.main(arguments) == 0
        told = capsys.readouterr().out.split("\n\n")[0].splitlines()
        head = "Take kim: " if "kim" in schemes else "No recommendation: nothing was measured."
        assert told[0].startswith(head)
        assert told[-1] == (
            "Not measured: nielson (the published iteration did not converge: after 77 iterations it still misses "
            "keyframes by 0.3 rad; nor did Newton's method: after 77 iterations it still misses keyframes by an "
            "unknown amount)."
        )
        written = (out / "recommendation.md").read_text().splitlines()
        assert written[2:] == [f"- {line}" for line in told]
        assert "did not converge" in (out / "report.html").read_text()


def test_command_writes_table_figures_advice_and_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motion = Motion(
        np.arange(7.0), walk(7, 60.0, seed=3), np.random.default_rng(0).normal(size=(7, 3))
    )
    keyframes, out = tmp_path / "keys.tum", tmp_path / "out"
    write(keyframes, motion)
    status = commands.main(["compare", str(keyframes), "--schemes", *NAMES, "--out", str(out)])
    assert status == 0
    assert "\nTake local-quintic (ours): " in capsys.readouterr().out
    names = {path.name for path in out.iterdir()}
    assert {"compare.csv", "compare.md", "compare.svg", "rates.svg", "recommendation.md"} <= names
    assert {"report.html", "manifest.json"} <= names
    files = json.loads((out / "manifest.json").read_text())["files"]
    assert "report.html" in files
    assert "Take local-quintic" in (out / "report.html").read_text()


FAILS = [
    [0.0, 2.19166667, 2.3],
    [
        [0.963736255, 0.250763154, 0.0912703239, 0.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.918865601, 0.370775139, 0.134951114, 0.0],
    ],
]
"""Uneven by 1 to 20: Nielson's iteration ends at a wrong fixed point."""


def test_a_scheme_is_judged_and_not_its_iteration() -> None:
    with pytest.raises(qs.ConvergenceError):
        qs.build("nielson", *FAILS)
    table = qs.compare(*FAILS, ["nielson", "kim"]).set_index("scheme")
    row = table.loc["nielson"]
    assert pd.isna(row["failure"])
    assert row["misses"] < 1e-9
    assert row["torque"] > 0.0
    assert table["solver"].to_dict() == {"nielson": "newton", "kim": "newton"}
    assert re.fullmatch(
        r"the published iteration did not converge on these keyframes \(after \d+ iterations it still misses "
        r"keyframes by 0\.\d+ rad\); the curve was found by Newton's method",
        row["note"],
    )
    assert pd.isna(table.loc["kim", "note"])
    assert f"Note on nielson: {row['note']}." in advice(table.reset_index())


@pytest.mark.parametrize(
    ("change", "residual", "said"),
    [
        (7.17e-17, 0.311, "it still misses keyframes by 0.31 rad"),
        (0.157, np.inf, "it still misses keyframes by an unknown amount"),
        (0.157, np.nan, "it still misses keyframes by an unknown amount"),
        (1.22e-7, 1e-15, "it has not settled: the last changed it by 1e-07 of its size"),
        (np.inf, 1e-15, "its numbers overflow"),
    ],
)
def test_what_did_not_converge_is_said_plainly(change: float, residual: float, said: str) -> None:
    for count, after in ((2000, "after 2000 iterations "), (1, "after 1 iteration ")):
        report = SolveReport("newton", "residual", count, change, residual, False, 1e-9)
        assert unsolved(report) == after + said


def test_the_keyframes_own_way_closes_where_the_curve_does() -> None:
    q = [[1, 0, 0, 0], [np.cos(0.2), np.sin(0.2), 0, 0], [np.cos(0.5), np.sin(0.5), 0, 0]]
    for closed, times in ((False, None), (True, [0, 1, 2, 3])):
        table = qs.compare(times, q, ["slerp"], closed=closed)
        assert table["keyframes_length"][0] == pytest.approx(1.0 + closed)
        assert table["length"][0] == pytest.approx(1.0 + closed)


def test_a_curve_that_turns_round_and_round_is_said_to() -> None:
    """A step of 74 degrees within a five-hundredth of a dwell: quartic turns 272 rad, not 1.29."""
    keyframes = [[1, 0, 0, 0], [1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.8, 0.6, 0, 0]]
    table = qs.compare([0, 10, 10.02, 20], keyframes, ["quartic"])
    lines = advice(table)
    assert lines[1:] == [
        "It turns 272 rad, although the keyframes need only 1.29 rad.",
        "While the keyframes stand still, it turns up to 358 degrees away; no candidate stands still.",
    ]


def test_of_attitudes_with_dwells_between_the_curve_that_wanders_least_is_taken() -> None:
    turns = np.cumsum([0.0, 0.0, 1.2, 0.0, 0.9])
    tilted = [quaternion.exp(np.array([0.1 * k, a / 2, 0.0])) for k, a in enumerate(turns)]
    keyframes = np.array(tilted)[[0, 0, 2, 2, 4]]
    names = ["kim", "local-quintic", "moving-frame", "quartic"]
    table = qs.compare([0, 240, 270, 510, 540], keyframes, names).set_index("scheme")
    taken = chosen_among(table.reset_index())
    shortest = table["length"].min()
    assert table["torque"].idxmin() not in taken
    assert taken == [name for name in table.index if table.loc[name, "length"] <= 1.5 * shortest]


def test_rounding_of_curves_at_rest_is_not_compared() -> None:
    """A body at rest needs no torque: what rounding leaves differs by fifty orders of magnitude."""
    table = qs.compare(
        None, np.tile([0.36, 0.48, -0.8, 0.0], (6, 1)), ["quartic", "nielson", "squad"]
    )
    assert (table[["torque", "jerk", "peak"]] == 0.0).all(axis=None)
    assert (table[["torque_over_least", "peak_over_least"]] == 1.0).all(axis=None)
    assert not any("torque is" in line for line in advice(table))


def test_times_of_a_clock_compare_as_times_from_zero() -> None:
    times, keyframes = np.arange(9) / 64.0, walk(9, 50.0, seed=1)
    columns = ["continuity", "torque", "key_speed", "failure"]
    near, far = (qs.compare(times + start, keyframes, NAMES)[columns] for start in (0.0, 2.0**31))
    pd.testing.assert_frame_equal(near, far)


def test_rounding_of_a_constant_rate_is_not_compared() -> None:
    spin = [[np.cos(a), np.sin(a), 0, 0] for a in 0.3 * np.arange(8)]
    table = qs.compare(
        None, spin, ["slerp", "local-quintic", "kim", "quartic", "scipy-rotation-spline"]
    )
    known = table.set_index("scheme")
    assert (known.drop(index="quartic")["torque"] == 0.0).all()
    assert (known.drop(index="quartic")["continuity"] == 3).all()
    assert known.loc["quartic", "torque"] > 0.01  # the ends' rates differ from the spin's
    assert "inf" not in "".join(advice(table))


def test_a_leap_is_not_taken_for_rest() -> None:
    """moving-frame rests at half-turns and leaps between them."""
    keyframes = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]
    table = qs.compare(None, keyframes, ["moving-frame", "kim"]).set_index("scheme")
    assert table.loc["moving-frame", ["continuity", "torque"]].tolist() == [-1, np.inf]
    assert table.loc["kim", "torque_over_least"] == 1.0


@pytest.mark.parametrize("case", edge_cases())
def test_the_edge_pack_never_shows_a_traceback(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    edge = edge_cases()[case]
    keyframes = tmp_path / "keys.npz"
    np.savez(keyframes, times=edge.times, quaternions=edge.keyframes)
    closed = ["--closed"] if edge.closed else []
    arguments = [
        "compare",
        str(keyframes),
        "--schemes",
        "quartic",
        "local-quintic",
        "nielson",
        *closed,
    ]
    status = commands.main([*arguments, "--out", str(tmp_path / "out")])
    told = capsys.readouterr()
    assert "Traceback" not in told.err
    assert status in (0, 2)
    if status == 2:
        assert len(told.err.strip().splitlines()) == 1
        return
    table = pd.read_csv(tmp_path / "out" / "compare.csv")
    assert table.set_index("scheme")["failure"].isna()["local-quintic"], told.out
    first = next(line for line in told.out.splitlines() if not line.startswith("Warning: "))
    assert first.startswith(("Take ", "No recommendation")), told.out


HINGE = "t_ms,qw,qx,qy,qz\n0,1,0,0,0\n1000,0.8,0.6,0,0\n1500,0.8,0.6,0,0\n2200,0.6,0.8,0,0\n"


def test_the_command_takes_needs_in_seconds(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    keyframes = tmp_path / "hinge.csv"
    keyframes.write_text(HINGE.replace("t_ms", "t"))
    names = ["slerp", "local-quintic", "monotone-quintic"]
    call = ["compare", str(keyframes), "--schemes", *names, "--force", "--time-unit", "ms"]
    call += ["--max-excursion", "0.5"]
    for limit, taken in (("200", "Take monotone-quintic (ours): "), ("60", "No scheme measured")):
        out = tmp_path / limit
        assert commands.main([*call, "--max-rate", limit, "--out", str(out)]) == 0
        lines = capsys.readouterr().out.splitlines()
        assert lines[0].startswith("Warning: keyframes 1 and 2 (1 s and 1.5 s after the first)")
        assert lines[1].startswith(taken)
        page = (out / "report.html").read_text(encoding="utf-8")
        assert "While the keyframes hold" in page
        assert lines[-1] not in page  # a line of the table, which the page has whole
    table = pd.read_csv(tmp_path / "200" / "compare.csv").set_index("scheme")
    peak = 1000 * table["peak_rate"].to_dict()["slerp"]  # of degrees a millisecond
    assert peak == pytest.approx(2 * np.degrees(np.arccos(0.8)))


@pytest.mark.parametrize(
    "given",
    [
        ["--smooth", "3"],
        ["--causal", "-1"],
        ["--max-rate", "0"],
        ["--max-excursion", "nan"],
        ["--time-unit", "fortnight"],
        ["--time-unit", "1/0 s"],
    ],
)
def test_bad_needs_are_refused_in_a_line(
    given: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert commands.main(["compare", "keys.csv", *given]) == 2
    told = capsys.readouterr().err.strip().splitlines()
    assert len(told) == 1
    assert given[0] in told[0]
