"""What naive costs: the numbers are those of the tables, and the sentences need both schemes there."""

import re

import numpy as np
import pandas as pd
import pytest

from quatspline.findings.findings import findings
from quatspline.findings.headlines import headlines
from quatspline.findings.naive import CAREFUL, LARGE, NAIVE, SENTENCES, sentence
from quatspline.findings.quotes import Ledger

FAIRNESS = pd.DataFrame(
    {
        "scheme": [NAIVE, CAREFUL] * 2 + ["local-quintic", "quartic"],
        "data": ["committed"] * 2 + [LARGE] * 2 + ["committed"] * 2,
        "sets": [6, 6, 1, 1, 6, 6],
        "median": [2.5, 1.25, 7.5, 3.25, 1.125, 1.5],
    }
)
SPEED = pd.DataFrame(
    {
        "scheme": [NAIVE, CAREFUL] * 2,
        "task": ["evaluate"] * 2 + ["set-up"] * 2,
        "keyframes": 1000,
        "nanoseconds_per_item": [4.0, 600.0, 50.0, 5500.0],
    }
)


def reader(**changed):
    tables = {"fairness": FAIRNESS, "speed": SPEED} | changed

    def read(name):
        if name not in tables:
            raise FileNotFoundError(name)
        return tables[name]

    return read


def told(found) -> str:
    return "\n".join(finding.text for finding in found if NAIVE in finding.text)


def test_the_numbers_are_those_of_the_tables():
    text = told(findings(reader()))
    assert f"in the median of 6 committed keyframe sets, {NAIVE} has 2.5000 and" in text
    assert "RotationSpline 1.2500; at steps of 170 degrees, 7.5 and 3.25." in text
    assert "4 ns" in text
    assert "600 ns" in text
    assert "50 and 5500 ns per keyframe, with 1000 keyframes" in text


def test_the_headline_tells_how_many_times_as_long_the_careful_one_takes():
    text = told(headlines(reader()))
    assert (
        "1.125 times the least torque; the paper's `quartic` has 1.50. "
        f"Naive `{NAIVE}` has 2.500 (7.5 at steps of 170 degrees); scipy's "
        "`RotationSpline` has 1.250 (3.25) at 150 times the time per sample."
    ) in text


@pytest.mark.parametrize("each", [*(each for _, each in SENTENCES), sentence])
def test_no_digit_is_written_by_hand(each):
    written = [part for part in each(Ledger(reader())) if isinstance(part, str)]
    assert not re.search(r"\d", "".join(written))


LESS = {
    "a scheme is not in the table": {
        "fairness": FAIRNESS[FAIRNESS["scheme"] != NAIVE],
        "speed": SPEED[SPEED["scheme"] != CAREFUL],
    },
    "a scheme has no number": {
        "fairness": FAIRNESS.assign(median=[2.5, np.inf] * 2 + [1.125, 1.5]),
        "speed": SPEED.assign(nanoseconds_per_item=[np.nan, 600.0, np.nan, 5500.0]),
    },
}


@pytest.mark.parametrize("tables", LESS.values(), ids=LESS.keys())
def test_they_are_left_out_without_both_schemes(tables):
    assert not told(findings(reader(**tables)))
    assert not told(headlines(reader(**tables)))
    assert headlines(reader(**tables))[0].text.endswith("quartic` has 1.50.")


def test_a_folder_without_speed_keeps_the_rest():
    def read(name):
        if name != "fairness":
            raise FileNotFoundError(name)
        return FAIRNESS

    assert "quartic` has 1.50." in headlines(read)[0].text
