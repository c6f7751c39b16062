"""The speed targets on speed tables made by hand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from quatspline.findings import targets
from quatspline.findings.targets import ROTATION_SPLINE, Verdict

SHARE = "`quartic`, a million sorted samples, as a share of what one core attains"
PEER = f"set-up of `kim` to 1e-9 over `{ROTATION_SPLINE}`"
IMPORT = "`import quatspline` after `import numpy`"


def table(share: float = 70.0, peer: float = 1200.0, failure: str | None = None) -> pd.DataFrame:
    """A speed table with the rows that three targets need."""
    rows = [
        {
            "task": "evaluate",
            "scheme": "quartic",
            "nanoseconds_per_item": 9.0,
            "timed_share": share,
        },
        {"task": "set-up", "scheme": "kim", "nanoseconds_per_item": 100.0},
        {"task": "set-up", "scheme": ROTATION_SPLINE, "nanoseconds_per_item": peer},
        {"task": "start", "scheme": "import quatspline", "seconds_median": 0.1},
    ]
    rows[2]["failure"] = failure
    return pd.DataFrame(rows)


def judged(speed: pd.DataFrame) -> dict[str, Verdict]:
    return {verdict.target.text: verdict for verdict in targets.verdicts(lambda name: speed)}


@pytest.mark.parametrize(("seconds", "met"), [(0.09, True), (0.1, True), (0.11, False)])
def test_a_value_is_to_stay_at_or_below_its_bound(seconds, met):
    speed = table()
    speed.loc[speed["task"] == "start", "seconds_median"] = seconds
    verdict = judged(speed)[IMPORT]
    assert verdict.value == seconds
    assert verdict.met is met
    assert str(verdict) == ("met" if met else "falls short")


@pytest.mark.parametrize(("share", "met"), [(64.0, False), (65.0, True), (90.0, True)])
def test_a_share_is_to_reach_its_bound(share, met):
    assert judged(table(share=share))[SHARE].met is met


@pytest.mark.parametrize(
    ("share", "peer", "said"),
    [
        (130.0, 2000.0, "met"),
        (129.0, 1900.0, targets.UNDECIDED),
        (60.0, 900.0, targets.UNDECIDED),
    ],
)
def test_quick_size_decides_only_what_is_clear(share, peer, said):
    speed = table(share=share, peer=peer).assign(run_size="quick")
    found = judged(speed)
    assert (str(found[SHARE]), str(found[PEER])) == (said, said)
    full = judged(speed.assign(run_size="full"))
    assert said == targets.UNDECIDED or str(full[SHARE]) == str(full[PEER]) == said


@pytest.mark.parametrize(("peer", "met"), [(1200.0, True), (1000.0, True), (990.0, False)])
def test_a_ratio_is_to_reach_its_bound(peer, met):
    verdict = judged(table(peer=peer))[PEER]
    assert verdict.value == pytest.approx(peer / 100.0)
    assert verdict.met is met


def test_every_target_has_a_verdict():
    found = [verdict.target for verdict in targets.verdicts(lambda name: table())]
    assert tuple(found) == targets.TARGETS
    missing = judged(table())["one sample of `quartic`"]
    assert missing.value is None
    assert not missing.met
    assert str(missing).startswith("not measured: no row ")


def test_a_row_without_a_number_gives_its_reason():
    verdict = judged(table(peer=np.nan, failure="over budget"))[PEER]
    assert verdict.value is None
    assert str(verdict) == f"not measured: {ROTATION_SPLINE}, set-up: over budget"


def test_a_lacking_column_is_named():
    assert str(judged(table().drop(columns="timed_share"))[SHARE]) == "not measured: timed_share"


def test_without_a_table_nothing_is_measured():
    def read(name: str) -> pd.DataFrame:
        raise FileNotFoundError(name)

    assert {str(v) for v in targets.verdicts(read)} == {"not measured: there is no table of speed"}


def test_the_markdown_says_all_three():
    lines = targets.markdown(lambda name: table(share=60.0)).splitlines()
    assert len(lines) == 2 + len(targets.TARGETS)
    assert f"| {SHARE} | ≥ 65 % | 60 % | **falls short** |" in lines
    assert f"| {PEER} | ≥ 10 x | 12 x | met |" in lines
    assert f"| {IMPORT} | ≤ 0.1 s | 0.1 s | met |" in lines
    assert sum("| not measured: " in line for line in lines) == len(targets.TARGETS) - 3


def test_the_sentence_on_accuracy_is_what_a_test_asserts():
    source = (Path(__file__).parents[1] / "schemes" / "test_paper.py").read_text(encoding="utf-8")
    test = source.partition("def test_ten_thousand_random_samples_err_by_four_ulp_at_most")[2]
    body = test.partition("\ndef ")[0]
    assert "qs.QuarticSpline" in body
    assert "assert worst < 1e-15" in body
    assert "179.0), 500)" in body
    assert "1 << 40, 20)" in body
    assert "DIGITS = 50\n" in source


MACHINE = {"model": "A 1", "cores": 2, "usable": 2}


@pytest.mark.parametrize(
    ("run", "said"),
    [
        ({}, "Measured on a machine that no manifest names."),
        (
            {"cpu": MACHINE, "versions": {"python": "3.1", "numpy": "2", "numba": "0.6"}}
            | {"end": "2026-01-02T03:04:05", "sizes": {"speed": "full"}},
            "Measured on A 1, 2 cores, Python 3.1, numba 0.6, 2026-01-02.",
        ),
        (
            {"cpu": MACHINE, "end": None, "sizes": {"speed": "quick"}},
            "Measured on A 1, 2 cores. At quick size: fewer tasks and shorter rounds than the targets ask for. A bound "
            "counts as met there that is kept by a factor of 2; others are not decided.",
        ),
    ],
)
def test_the_machine_is_named_and_a_quick_run_is_said_to_be_one(run, said):
    assert targets.measured_on(run) == said
