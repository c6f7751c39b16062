"""Needs as filters of a recommendation: what meets them, what breaks them and by how much, and the nearest."""

from __future__ import annotations

import pandas as pd
import pytest

from quatspline.comparing import COLUMNS, ENERGIES
from quatspline.findings.needs import Needs, significant
from quatspline.findings.recommendation import recommendation

GOOD = {"continuity": 2, "misses": 0.0, "torque": 1.0, "jerk": 1.0, "peak": 1.0, "length": 1.0}
GOOD |= {"key_speed": 0.5, "peak_speed": 1.5, "keyframes_length": 1.0, "support": "4", "noise": 0.0}
GOOD |= {"lookahead": "1", "excursion": 5.0, "peak_rate": 30.0, "peak_acceleration": 50.0}
GOOD |= {"seconds_set_up": 1e-8, "seconds_per_sample": 1e-8}


def told(needs: Needs, **rows: dict[str, object]) -> list[str]:
    table = pd.DataFrame([{"scheme": name, **GOOD, **given} for name, given in rows.items()])
    table = table.reindex(columns=COLUMNS)
    for name in ENERGIES:
        table[f"{name}_over_least"] = table[name] / table[name].min()
    return [finding.text for finding in recommendation(table, needs)]


CALM = {"torque": 2.0}
"""A fallback that costs torque."""


@pytest.mark.parametrize(
    ("needs", "bad", "met", "broken"),
    [
        (Needs(smooth=2), {"continuity": 1}, "C2 (--smooth 2)", "--smooth 2: a, C1."),
        (
            Needs(local=True),
            {"support": "all"},
            "shaped by 4 keyframes (--local)",
            "--local: a, shaped by all keyframes.",
        ),
        (
            Needs(causal=2),
            {"lookahead": "3"},
            "waits for 1 keyframe (--causal 2)",
            "--causal 2: a, waits for 3 keyframes.",
        ),
        (
            Needs(causal=1),
            {"lookahead": "all"},
            "waits for 1 keyframe (--causal 1)",
            "--causal 1: a, waits for all keyframes.",
        ),
        (
            Needs(max_rate=30.0),
            {"peak_rate": 41.234},
            "30.0 deg/s (--max-rate 30)",
            "--max-rate 30: a, 41.2 deg/s.",
        ),
        (
            Needs(max_accel=60.0),
            {"peak_acceleration": float("inf")},
            "50.0 deg/s^2 (--max-accel 60)",
            "--max-accel 60: a, unbounded.",
        ),
        (
            Needs(max_excursion=5.0),
            {"excursion": 5.01},
            "5.00 deg (--max-excursion 5)",
            "--max-excursion 5: a, 5.01 deg.",
        ),
    ],
)
def test_what_breaks_a_need_is_not_taken_and_is_named_with_its_value(
    needs: Needs, bad: dict[str, object], met: str, broken: str
) -> None:
    assert told(Needs(), a=bad | {"continuity": 2}, b=CALM)[0].startswith("Take a: ")
    lines = told(needs, a=bad, b=CALM)
    assert lines[0].startswith("Take b: ")
    assert lines[1] == f"It meets your needs: {met}."
    assert f"Ruled out by {broken}" in lines


def test_rates_are_per_second_whatever_the_times_count() -> None:
    needs = Needs(max_rate=30.0, max_accel=60.0, second=1000.0)
    fine = {"peak_rate": 0.02, "peak_acceleration": 5e-5}
    lines = told(needs, a=fine | {"peak_rate": 0.04}, b=fine | CALM)
    assert lines[0].startswith("Take b: ")
    assert "20 deg/s (--max-rate 30), 50 deg/s^2 (--max-accel 60)." in lines[1]
    assert "Ruled out by --max-rate 30: a, 40 deg/s." in lines


def test_a_corner_may_be_taken_where_it_is_allowed_and_nothing_smoother_will_do() -> None:
    corner = {"continuity": 0, "excursion": 0.0, "peak_acceleration": float("inf")}
    corner |= dict.fromkeys(("torque", "jerk", "peak"), float("inf"))
    assert told(Needs(smooth=0), a=corner, b={})[0].startswith("Take b: ")
    strict = Needs(smooth=0, max_excursion=1.0)
    assert told(strict, a=corner, b={})[0].startswith("Take a: it passes through the keyframes")
    assert "--smooth 1: a, C0" in " ".join(told(Needs(smooth=1), a=corner, b={}))


def test_what_is_less_smooth_may_be_taken_where_that_is_asked() -> None:
    rows = {"a": {"continuity": 1}, "b": CALM}
    assert told(Needs(), **rows)[0].startswith("Take b: ")
    assert told(Needs(smooth=1), **rows)[0].startswith("Take a: ")


def test_the_nearest_is_named_where_none_meets_all() -> None:
    needs = Needs(smooth=2, causal=1, max_rate=10.0)
    lines = told(
        needs,
        far={"peak_rate": 30.0},
        near={"peak_rate": 11.0},
        late={"peak_rate": 10.5, "lookahead": "3"},
    )
    assert lines[0] == (
        "No scheme measured meets your needs (--smooth 2, --causal 1, --max-rate 10). The nearest is "
        "near: 11.0 deg/s (--max-rate 10)."
    )
    assert lines[1:] == [
        "Ruled out by --causal 1: late, waits for 3 keyframes.",
        "Ruled out by --max-rate 10: late, 10.5 deg/s; near, 11.0 deg/s; far, 30.0 deg/s.",
    ]


def test_five_are_named_and_the_others_counted() -> None:
    rows = {f"s{k}": {"peak_rate": 20.0 + k} for k in range(8)}
    line = told(Needs(max_rate=15.0), **rows)[1]
    assert line.endswith("; s4, 24.0 deg/s; and 3 more.")


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.0, "0"), (0.01234, "0.0123"), (9.996, "10"), (551.2, "551"), (123456.0, "123000")],
)
def test_three_digits_in_plain_notation(value: float, said: str) -> None:
    assert significant(value) == said


def test_noise_asks_for_a_curve_near_the_keyframes_unless_needs_forbid_it() -> None:
    rows = {
        "smoothing-spline": {"noise": 0.3, "misses": 0.01, "support": "all", "torque": 0.01},
        "b": {"noise": 0.3},
    }
    lines = told(Needs(), **rows)
    assert lines[0].startswith(
        "Take smoothing-spline (ours): the keyframes have about 0.300 degrees of noise"
    )
    assert "passes within 0.573 degrees of each keyframe" in lines[0]
    assert lines[1].startswith("If the curve must pass through the keyframes, noise and all, take ")
    assert told(Needs(local=True), **rows)[0].startswith("Take b: ")
    calm = {name: row | {"noise": 0.0} for name, row in rows.items()}
    assert told(Needs(), **calm)[0].startswith("Take b: ")


def test_what_stands_still_is_taken_where_keyframes_hold() -> None:
    rows = {"a": {"hold_rotation": 75.0}, "b": CALM | {"hold_rotation": 0.0, "key_speed": 0.0}}
    lines = told(Needs(), **rows)
    assert lines[0].startswith("Take b: ")
    assert lines[1] == "It stands still where the keyframes do."
    (first, second, *_) = told(Needs(), a=rows["a"])
    assert first.startswith("Take a: ")
    assert second == (
        "While the keyframes stand still, it turns up to 75.0 degrees away; no candidate stands still."
    )
