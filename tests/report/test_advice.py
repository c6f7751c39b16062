"""What a comparison says, on tables made for each sentence."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd
import pytest

import quatspline as qs
from quatspline.comparing import COLUMNS, ENERGIES
from quatspline.findings.recommendation import recommendation, shown
from walks import walk

TIMES = ["seconds_set_up", "seconds_per_sample"]


def row(scheme: str, **given: object) -> dict[str, object]:
    """A good row: local, C2, fair, of a length of its own; a failed one has nothing else."""
    if "failure" in given:
        return {"scheme": scheme, **given}
    length = 1.0 + sum(map(ord, scheme)) / 1e4
    good = {"continuity": 2, "misses": 1e-15, "torque": 1.0, "jerk": 1.0, "peak": 1.0}
    good |= {"key_speed": 0.5, "peak_speed": 1.5, "length": length, "support": "4"}
    good["keyframes_length"] = 1.0
    return good | dict.fromkeys(TIMES, 1e-8) | {"scheme": scheme} | given


def table_of(*rows: dict[str, object]) -> pd.DataFrame:
    table = pd.DataFrame(list(rows)).reindex(columns=COLUMNS)
    for name in ENERGIES:
        table[f"{name}_over_least"] = table[name] / table[name].min()
    return table


def told(*rows: dict[str, object]) -> list[str]:
    return [finding.text for finding in recommendation(table_of(*rows))]


GLOBAL = {"support": "all"}
QUICK = {"seconds_per_sample": 1e-10}


def test_one_scheme_has_the_least_torque_and_nothing_to_be_compared_with() -> None:
    assert told(row("a")) == [
        "Take a: it passes through the keyframes (largest miss 1e-15 rad), is C2 as measured here, and is local: "
        "edits stay nearby."
    ]


def test_what_failed_is_not_compared_with() -> None:
    assert "of all schemes measured" not in told(row("a"), row("b", failure="no"))[0]
    assert "has the least torque of all schemes measured" in told(row("a"), row("b", torque=2.0))[0]


AT_REST = {"torque": 0.0, "jerk": 0.0, "peak": 0.0}


@pytest.mark.parametrize(
    ("energies", "length", "reason"),
    [
        (AT_REST, 3e-16, "the keyframes do not move"),
        (AT_REST, 2.0, "the keyframes turn about one axis at a constant rate"),
        ({"torque": 2.0}, 2.0, "their curves coincide on these keyframes"),
    ],
)
def test_curves_that_are_one_are_said_to_be(
    energies: dict[str, float], length: float, reason: str
) -> None:
    same = {name: value * (1.0 + 1e-8) for name, value in energies.items()}
    way = {"length": length, "keyframes_length": length}
    rows = [row("a", **energies, **way), row("b", **same, **way, **GLOBAL)]
    rows += [row("quartic", **same, **way), row("c", **way | {"torque": 2.0001})]
    rows += [row("d", failure="no")]
    lines = told(*rows)
    assert ("of all schemes measured" in lines[0]) == (energies["torque"] > 0.0)
    assert lines[1] == (
        "quartic, a and b give the same result here (torque, length and peak acceleration, to six digits): "
        f"{reason}. Any of them will do."
    )
    assert not any("quartic has" in line for line in lines)
    assert lines[2:] == ["Not measured: d (no)."]


def test_of_many_that_are_alike_the_number_is_told() -> None:
    lines = told(*(row(name, length=1.0) for name in "abcde"), row("f", torque=2.0))
    assert lines[1].startswith("5 of the 6 schemes measured give the same result here (")


def test_curves_of_one_torque_that_take_another_way_are_not_alike() -> None:
    for given in ({"peak": 1.1}, {"length": 1.2}, {"torque": 1.00001}):
        assert not any("same result" in line for line in told(row("a"), row("b", **given)))


# -- wandering ----------------------------------------------------------------------------------


def test_a_curve_that_wanders_is_passed_over_and_named() -> None:
    """Attitudes with dwells between: the fairest turn ten times as far as the keyframes need."""
    lines = told(
        row("a", length=35.8, keyframes_length=3.43),
        row("b", length=7.12, keyframes_length=3.43, torque=10.0),
        row("c", length=10.6, keyframes_length=3.43, torque=30.0),
    )
    assert lines[0].startswith("Take b: ")
    assert lines[1:] == [
        "It turns 7.12 rad, although the keyframes need only 3.43 rad.",
        "Passed over because it turns too far: a turns 35.8 rad; b has 10.0 times its torque.",
    ]


def test_a_curve_that_wanders_without_a_torque_is_no_ratio() -> None:
    lines = told(row("a", length=35.8, torque=0.0), row("b", length=1.2, torque=2.0))
    assert lines[1:] == [
        "Passed over because it turns too far: a turns 35.8 rad; it needs no torque."
    ]


@pytest.mark.parametrize(
    "evil", [{"key_speed": 0.0}, {"continuity": 1}, {"continuity": 1, "key_speed": 0.0}]
)
def test_a_stop_or_a_jump_is_a_lesser_evil_than_going_astray(evil: dict[str, float]) -> None:
    direct = row("a", torque=9.0, length=2.0, **evil)
    for length, taken in ((5.9, "b"), (6.1, "a")):
        lines = told(direct, row("b", length=length))
        assert lines[0].startswith(f"Take {taken}: ")
        stops = taken == "a" and "key_speed" in evil
        assert ("It comes to a stop at a keyframe." in lines) == stops


def test_a_longer_way_within_reason_is_no_fault() -> None:
    lines = told(row("a", length=1.49), row("b", length=1.0, torque=2.0))
    assert lines[0].startswith("Take a: ")
    assert not any("rad, although" in line for line in lines)


def test_rounding_of_a_body_at_rest_is_no_way() -> None:
    rows = [row("a", **AT_REST, length=3e-13, keyframes_length=0.0)]
    rows += [row("b", **AT_REST, length=5e-30, keyframes_length=0.0)]
    assert not any("turns" in line or "Passed" in line for line in told(*rows))


def test_a_note_is_said() -> None:
    note = "the published iteration did not converge on these keyframes"
    assert told(row("a"), row("nielson", torque=2.0, note=note))[1:] == [
        f"Note on nielson: {note}."
    ]


# -- the sentences ------------------------------------------------------------------------------


def test_a_fairer_scheme_is_named_with_what_speaks_against_it() -> None:
    lines = told(row("a", torque=1.04), row("b", **GLOBAL))
    assert (
        "has 1.04 times the least torque of all schemes measured, and is local: edits" in lines[0]
    )
    assert lines[1:] == [
        "The candidate with the least torque is b: a has 1.04 times its torque, but b is global: every keyframe shapes "
        "the whole curve."
    ]


@pytest.mark.parametrize("torque", [1.0, 1.0 + 1e-12, 1.0004, 1.0049])
def test_equal_is_said_as_equal(torque: float) -> None:
    lines = told(row("a", torque=torque), row("b", **GLOBAL))
    assert len(lines) == 1
    nearly = "" if torque == 1.0 else ", to three digits,"
    assert f"has the least torque{nearly} of all schemes measured, and " in lines[0]
    assert " times" not in lines[0]


@pytest.mark.parametrize(
    ("own", "quick", "said"),
    [
        (
            1.04,
            1.0,
            ", and its torque is also lower, 0.962 times that of a, but b is global: every",
        ),
        (
            1.0,
            1.002,
            ", at the same torque, but b is global: every keyframe shapes the whole curve.",
        ),
        (1.0, 1.5, ", but its torque is 1.50 times that of a."),
        (1.0, 12.34, ", but its torque is 12.3 times that of a."),
        (1.0, 551.0, ", but its torque is 551 times that of a."),
        (1.0, 551234.0, ", but its torque is 551000 times that of a."),
        (0.0, 1.0, ", but needs torque where a needs none."),
        (0.0, 0.0, ", at the same torque, but b is global: every keyframe shapes the whole curve."),
    ],
)
def test_a_quicker_scheme_is_better_in_both_or_costs_torque(
    own: float, quick: float, said: str
) -> None:
    rows = row("a", torque=own), row("b", torque=quick, **GLOBAL, **QUICK)
    (line,) = told(*rows)[1:]
    assert line.startswith(f"b evaluates tens of times faster than a{said}")


def test_no_word_about_speed_within_noise() -> None:
    lines = told(row("a"), row("b", torque=1.5, seconds_per_sample=0.05e-8))
    assert len(lines) == 1


def test_the_papers_curve_is_placed() -> None:
    def placed(**given: float) -> str:
        return told(row("a", **GLOBAL), row("quartic", **GLOBAL, **given))[-1]

    least = "The paper's quartic has 1.17 times the least torque and "
    assert placed(torque=1.17) == least + "the least peak acceleration of all schemes measured."
    assert placed(torque=1.17, peak=1.26) == (
        least + "1.26 times the least peak acceleration of all schemes measured."
    )
    assert placed(torque=1.0001) == (
        "The paper's quartic has the least torque, to three digits, and the least peak acceleration of all schemes "
        "measured."
    )


def test_rest_that_only_a_scheme_out_of_the_choice_has_is_not_compared_with() -> None:
    lines = told(row("a", misses=0.0), row("b", torque=0.0, key_speed=0.0))
    assert lines == [
        "Take a: it passes through the keyframes (largest miss 0 rad), is C2 as measured here, and is local: edits "
        "stay nearby."
    ]


def test_what_needs_a_peak_where_another_needs_none() -> None:
    table = table_of(row("a", **GLOBAL), row("quartic", **GLOBAL, torque=1.2))
    table["peak_over_least"] = [1.0, np.inf]
    line = recommendation(table)[-1].text
    assert line.endswith(" and some peak acceleration where another scheme needs none.")


def test_nothing_measured_is_not_blamed_on_continuity() -> None:
    reasons = ("over budget; ask for it by name", "ValueError: closed=True: {} has no closed curve")
    rows = [row(n, failure=reasons[n in "bd"].format(n)) for n in "abcd"]
    assert told(*rows) == [
        "No recommendation: nothing was measured.",
        "Not measured: a, c (over budget; ask for it by name).",
        "Not measured: b, d (ValueError: closed=True: it has no closed curve).",
    ]


def test_nothing_that_passes_is_told_as_that() -> None:
    leaps = dict.fromkeys(("torque", "jerk", "peak"), np.inf)
    for bad in ({"continuity": 0, **leaps}, {"misses": 0.1}):
        lines = told(row("a", **bad), row("nielson", failure="ConvergenceError: no"))
        assert lines == [
            "No recommendation: no scheme measured passes through these keyframes with a continuous velocity.",
            "Not measured: nielson (ConvergenceError: no).",
        ]


def test_a_failure_is_said_beside_a_recommendation() -> None:
    why = "ConvergenceError: nielson (jacobi) did not converge: residual 0.3 rad"
    lines = told(row("a"), row("nielson", failure=why), row("quartic", failure="ValueError: x"))
    assert lines[0].startswith("Take a: ")
    assert lines[1:] == [
        "Not measured: nielson (ConvergenceError: it (jacobi) did not converge: residual 0.3 rad).",
        "Not measured: quartic (ValueError: x).",
    ]


def test_only_a_schemes_own_name_is_left_out_of_its_reason() -> None:
    (_, line) = told(row("kim", failure="skimming kim-like kim: scipy-kim"))
    assert line == "Not measured: kim (skimming kim-like it: scipy-kim)."


def test_curves_of_equal_torque_are_told_apart_by_what_they_claim() -> None:
    at_rest = {"torque": 0.0, "jerk": 0.0, "peak": 0.0, "support": "2", "continuity": 3}
    names = ("slerp", "catmull-rom", "local-quintic", "quartic", "nlerp")
    rows = [row(name, **at_rest, seconds_per_sample=1e-9 * k) for k, name in enumerate(names, 1)]
    assert told(*rows)[0].startswith("Take local-quintic (ours): ")


def test_every_number_is_a_quote() -> None:
    table = table_of(row("a", torque=1.04), row("b", **GLOBAL), row("d3", failure="3 keyframes"))
    found = [*recommendation(table)]
    assert len(found) == 3
    for finding in found:
        typed = "".join(part for part in finding.parts if isinstance(part, str))
        assert not re.search(r"\d", typed.replace("C", "")), typed


def test_timings_do_not_change_what_is_said() -> None:
    """Ten runs, as far as the clock tells them apart, on a machine that others use, too."""
    names = ["local-quintic", "kim", "log-cubic", "quartic", "nielson", "squad", "min-torque"]
    table, rng = qs.compare(None, walk(9, 50.0, seed=1), names), np.random.default_rng(0)
    table[TIMES] = [1e-5, 1e-8]  # as they were seen on a quiet machine
    said = [finding.text for finding in recommendation(table)]
    for _ in range(10):
        noise = rng.uniform(0.2, 9.0, (len(table), len(TIMES)))
        jittered = table.assign(
            **dict(zip(TIMES, (table[TIMES].to_numpy() * noise).T, strict=True))
        )
        assert [finding.text for finding in recommendation(jittered)] == said
        assert shown(jittered) == shown(table)
