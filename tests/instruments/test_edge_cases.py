"""The pack of edge cases, and its verdicts on schemes whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

import quatspline as qs
from quatspline import quaternion
from quatspline.instruments import edge_cases as module
from quatspline.instruments.edge_cases import SAMPLES, edge_result
from quatspline.trajectories.edge_cases import BASE, edge_cases
from toys import Toy

CASES = edge_cases()
ASKED = (
    *("equal keys", "antipodes", "near half-turn", "sign-flipped", "tiny rotations"),
    *("extreme uneven times", "two keys", "closed full turn"),
)


def test_the_pack_holds_what_it_should():
    assert set(ASKED) <= set(CASES)
    assert all(name == case.name and case.difficulty for name, case in CASES.items())
    assert np.linalg.norm(BASE) == pytest.approx(1.0)


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_keyframes_lie_on_the_truth(case):
    keys = case.keyframes
    np.testing.assert_allclose(np.linalg.norm(keys, axis=1), 1.0, atol=1e-14)
    assert len(case.times) == len(keys) + case.closed
    if case.truth is not None:
        assert quaternion.distance(case.truth(case.times[: len(keys)]), keys).max() < 1e-12
    if case.closed:
        np.testing.assert_allclose(case.truth(case.times[-1:]), -keys[:1], atol=1e-14)


@pytest.mark.parametrize("case", CASES.values(), ids=list(CASES))
def test_slerp_is_exact(case):
    row = edge_result(case, "slerp")
    assert row["result"] == "exact", row
    assert row["checked"] == ("keys" if case.truth is None else "truth")


def test_nlerp_is_wrong_by_its_closed_form():
    """Two keys a rad apart: the chord's point at u is at atan2(u sin h, 1 - u + u cos h), h = 1/2."""
    u, half = np.arange(SAMPLES) / SAMPLES, 0.5
    angle = 2.0 * np.arctan2(u * np.sin(half), 1.0 - u + u * np.cos(half))
    row = edge_result(CASES["two keys"], "nlerp")
    assert (row["result"], row["checked"]) == ("as claimed", "keys")  # it claims no constant rate
    assert row["deviation"] == pytest.approx(np.abs(angle - u).max(), rel=1e-9)
    assert row["relative"] == pytest.approx(row["deviation"], rel=1e-9)


def test_a_refusal_is_an_error_with_its_reason():
    row = edge_result(CASES["closed full turn"], "log-cubic")
    assert row["result"] == "error"
    assert "closed" in row["failure"]


class _Hole(Toy):
    """Slerp, but not a number in the last segment; or of norm 2; or off by 0.1 rad."""

    def _orientation(self, t):
        segment, u = self.keyframes.locate(t)
        return self.spoilt(self.slerped(segment, u), segment)


SPOILT = {
    "NaN": lambda q, segment: np.where((segment == 2)[:, None], np.nan, q),
    "wrong": lambda q, segment: quaternion.mul(q, quaternion.exp([0.05, 0.0, 0.0])),
    "norm": lambda q, segment: 2.0 * q,
}


@pytest.mark.parametrize("fault", SPOILT)
def test_faults_are_told_apart(monkeypatch, fault):
    broken = type("_Broken", (_Hole,), {"spoilt": staticmethod(SPOILT[fault]), "name": "toy"})
    monkeypatch.setattr(module, "scheme", lambda name: broken)
    row = edge_result(CASES["there and back"], "toy")
    assert row["result"] == ("NaN" if fault == "NaN" else "wrong")
    if fault == "wrong":
        assert row["deviation"] == pytest.approx(0.1)
    if fault == "norm":
        assert row["failure"] == "norm is off 1 by 1"


def test_rates_that_are_not_numbers_count(monkeypatch):
    class Rates(Toy):
        def _orientation(self, t):
            return self.slerped(*self.keyframes.locate(t))

        def _acceleration(self, t):
            return np.full((len(t), 3), np.nan)

    monkeypatch.setattr(module, "scheme", lambda name: Rates)
    row = edge_result(CASES["equal keys"], "toy")
    assert (row["result"], row["failure"]) == ("NaN", "acceleration is not a number")


# -- judged by what is claimed ------------------------------------------------------------------

SPINS = ["Unix times", "sign-flipped", "near half-turn", "tiny rotations", "extreme uneven times"]


@pytest.mark.parametrize("case", [*SPINS, "two keys"])
def test_the_quartics_missing_rate_at_the_ends_is_its_claim(case):
    """Off by 0.051 of the step in end segments (6/125 (1 + ...) by its ghosts), and exact between."""
    row = edge_result(CASES[case], "quartic")
    assert (row["result"], row["checked"]) == ("as claimed", "truth inside"), row
    assert 0.005 < row["relative"] < 0.052


@pytest.mark.parametrize("name", ["quartic", "quintic", "nlerp", "moving-frame"])
def test_what_closes_has_no_ends_and_what_rests_stays(name):
    closed = edge_result(CASES["closed full turn"], name)
    claims_none = qs.scheme(name).constant_rate == "no"
    assert closed["result"] == ("as claimed" if claims_none else "exact")
    for case in ("equal keys", "antipodes"):
        row = edge_result(CASES[case], name)
        assert (row["result"], row["checked"]) == ("exact", "truth")


def test_a_fold_of_a_chart_is_a_fault_without_any_claim():
    row = edge_result(CASES["near half-turn"], "log-cubic")
    assert (row["result"], row["checked"]) == ("wrong", "keys")
    assert row["relative"] > 0.9


class _Bent(Toy):
    """A constant rate, off it by 1 % of the step in one segment, with keyframes met."""

    segment = 0

    def _orientation(self, t):
        segment, u = self.keyframes.locate(t)
        bump = np.where(segment == self.segment, 0.04 * u * (1.0 - u), 0.0)
        return self.slerped(segment, u + bump)


@pytest.mark.parametrize(
    ("claim", "segment", "result"),
    [
        ("interior", 0, "as claimed"),
        ("interior", 4, "as claimed"),
        ("interior", 1, "wrong"),
        ("interior", 3, "wrong"),
        ("everywhere", 0, "wrong"),
        ("no", 2, "as claimed"),
    ],
)
def test_a_deviation_counts_where_none_is_claimed(monkeypatch, claim, segment, result):
    claims = {"constant_rate": claim, "segment": segment, "support": 4, "name": "toy"}
    monkeypatch.setattr(module, "scheme", lambda name: type("_", (_Bent,), claims))
    row = edge_result(CASES["sign-flipped"], "toy", align=True)
    assert row["result"] == result
    assert row["relative"] == pytest.approx(0.01)


def test_keyframes_are_no_truth_to_a_curve_that_passes_near_them(monkeypatch):
    class Far(Toy):
        def _orientation(self, t):
            away = quaternion.exp([1.0, 0.0, 0.0])  # more than half of any step
            return quaternion.mul(self.slerped(*self.keyframes.locate(t)), away)

    for interpolates, results in ((True, ("wrong", "wrong")), (False, ("wrong", "as claimed"))):
        cls = type("_", (Far,), {"interpolates": interpolates, "name": "toy"})
        monkeypatch.setattr(module, "scheme", lambda name, cls=cls: cls)
        cases = ("sign-flipped", "there and back")
        assert tuple(edge_result(CASES[case], "toy")["result"] for case in cases) == results


def test_a_missed_keyframe_is_a_fault_unless_none_is_met(monkeypatch):
    class Off(Toy):
        def _orientation(self, t):
            return quaternion.mul(
                self.slerped(*self.keyframes.locate(t)), quaternion.exp([0.01, 0.0, 0.0])
            )

    for interpolates, result in ((True, "wrong"), (False, "as claimed")):
        cls = type("_", (Off,), {"interpolates": interpolates, "name": "toy"})
        monkeypatch.setattr(module, "scheme", lambda name, cls=cls: cls)
        for case in ("sign-flipped", "there and back"):
            assert edge_result(CASES[case], "toy")["result"] == result
