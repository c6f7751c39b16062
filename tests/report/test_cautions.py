"""What owners of keyframes are warned of: each warning where it is due, with its numbers, and nowhere else."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

import quatspline as qs
from quatspline import keyframes as kf
from quatspline import quaternion
from quatspline.comparing import COLUMNS
from quatspline.findings.cautions import cautions
from quatspline.inputs.arrays import FloatArray
from walks import walk

NOTHING = pd.DataFrame([{"scheme": "slerp", "noise": 0.0, "hold_rotation": 0.0}]).reindex(
    columns=COLUMNS
)
TIMES = np.array([0.0, 1.5, 2.5, 4.0, 5.0])


def spin(*degrees: float) -> FloatArray:
    """Orientations about one axis at these angles."""
    return quaternion.exp(0.5 * np.radians(degrees)[:, None] * [0.6, 0.0, 0.8])


def warned(
    times: object, q: FloatArray, frame: pd.DataFrame = NOTHING, **given: object
) -> list[str]:
    keyframes = kf.prepare(times, q, closed=bool(given.pop("closed", False)))
    return [finding.text for finding in cautions(keyframes, frame, **given)]  # type: ignore[arg-type]


def test_nothing_is_said_of_good_keyframes() -> None:
    assert warned(TIMES, spin(0, 20, 50, 60, 100)) == []


def test_a_hold_is_said_with_what_schemes_turn_meanwhile() -> None:
    q = spin(0, 20, 50, 50, 100)
    frame = qs.compare(TIMES, q, ["slerp", "local-quintic", "monotone-quintic"])
    turned = frame.set_index("scheme")["hold_rotation"]
    assert turned[["slerp", "monotone-quintic"]].tolist() == [0.0, 0.0]
    assert warned(TIMES, q, frame) == [
        "Warning: keyframes 2 and 3 (2.5 s and 4 s after the first) are equal. While the keyframes hold, local-quintic "
        f"(ours) turns up to {turned['local-quintic']:.3g} degrees away, monotone-quintic (ours) 0, slerp 0."
    ]


def test_many_holds_of_a_recording_are_repeated_samples() -> None:
    q = spin(*np.repeat(np.arange(0.0, 15.0), 2))
    (line,) = warned(np.arange(30) / 10.0, q)
    assert line.startswith(
        "Warning: 15 of 29 steps do not turn at all, as if samples were repeated."
    )


def test_a_body_at_rest_throughout_is_no_hold() -> None:
    assert warned(TIMES, spin(0, 0, 0, 0, 0)) == []


def test_a_gap_and_almost_a_duplicate_are_said_with_their_lengths() -> None:
    q = spin(0, 20, 30, 40, 50)
    (line,) = warned([0.0, 1.0, 2.5, 14.5, 16.0], q)
    assert line == (
        "Warning: there is a gap of 12 s between keyframes 2 and 3 (2.5 s and 14.5 s after the first), 8 times the "
        "median spacing. The keyframes do not say what happens there, so every curve invents it."
    )
    (line,) = warned([0.0, 1.0, 1.005, 2.1, 3.0], q)
    assert (
        "keyframes 1 and 2 (1 s and 1.005 s after the first) are almost duplicates: they are 0.005 s"
        in line
    )


def test_a_long_hold_is_no_gap() -> None:
    lines = warned([0.0, 1.0, 20.0, 21.0, 22.0], spin(0, 20, 20, 40, 50))
    assert not any("gap" in line for line in lines)


@pytest.mark.parametrize(
    ("degrees", "said"),
    [
        (119.0, None),
        (125.0, "is 125 degrees. Schemes differ most on such large steps"),
        (179.25, "is 179.2 degrees. With 0.75 more, the curve would turn the other way."),
        (180.0, "is exactly half a turn, so rounding decides which way the curve turns."),
        (181.0, "is 179 degrees. With 1 more"),
    ],
)
def test_wide_steps_and_half_turns(degrees: float, said: str | None) -> None:
    lines = warned(TIMES, spin(0, 20, 20 + degrees, 30 + degrees, 40 + degrees))
    if said is None or degrees == 181.0:
        assert len(lines) == (degrees == 181.0)
        return
    (line,) = lines
    assert said in line
    assert "between keyframes 1 and 2" in line


def test_the_step_that_closes_counts() -> None:
    (line,) = warned(np.arange(4.0) * 1.5, spin(0, 60, 125), closed=True)
    assert "between keyframes 2 and 0 (3 s and 4.5 s" in line


@pytest.mark.parametrize(
    ("times", "said"),
    [
        (np.arange(5), "the times are 0, 1, 2 ... 4, like frame numbers"),
        (1000 + np.arange(5), "like frame numbers"),
        (
            1_700_000_000_000_000_000 + 5_000_000 * np.arange(5),
            "are 5000000 apart (median), like nanoseconds at 200 Hz",
        ),
        (10_000.0 * np.arange(5), "like microseconds at 100 Hz"),
        (1.5e6 * np.arange(5), "if microseconds, --time-unit us"),
        (150.0 * np.arange(5), "If they are milliseconds or frames, use --time-unit ms"),
        (150.5 * np.arange(5), None),
        (60.0 * np.arange(5), None),
        (0.5 * np.arange(5), None),
    ],
)
def test_times_that_hardly_count_seconds(times: FloatArray, said: str | None) -> None:
    lines = warned(times, spin(0, 20, 30, 40, 50))
    assert len(lines) == (said is not None)
    assert all(str(said) in line for line in lines)
    assert warned(times, spin(0, 20, 30, 40, 50), told=True) == []


def test_seconds_are_those_of_the_unit_that_was_told() -> None:
    q = spin(0, 20, 20, 40, 50)
    line = warned([0, 500, 1500, 2000, 3000], q, second=1000.0, told=True)[0]
    assert "(0.5 s and 1.5 s after the first)" in line


def test_a_motion_that_ends_where_it_began_closes() -> None:
    """As a camera's loop in a CSV does: a turn, and a swing to and fro."""
    said = (
        "Warning: the last keyframe repeats the first, 5 s later. For a loop, use --closed, "
        "which takes the last row as the return."
    )
    assert warned(TIMES, spin(0, 90, 180, 270, 360)) == [said]
    assert warned(TIMES, spin(10, 30, 50, 30, 10)) == [said]
    assert warned(TIMES / 2.0, spin(0, 90, 180, 270), closed=True) == []


@pytest.mark.parametrize(
    ("degrees", "said"),
    [
        ((0, 90, 180, 270, 359), "differs from the first by 1°, 5 s later"),
        ((0, 20, 40, 20, 4), None),  # by less than a step, and not by a slip
        ((0, 0.004, 0.006, 0.002, 0.0009), None),  # never away
        ((0, 90, 0), None),
        ((0, 90), None),
    ],
)
def test_ends_that_nearly_meet(degrees: tuple[float, ...], said: str | None) -> None:
    lines = warned(TIMES[-1] * np.linspace(0.0, 1.0, len(degrees)), spin(*degrees), told=True)
    assert len(lines) == (said is not None)
    for line in lines:
        assert str(said) in line
        assert "make the last row equal to the first, and use --closed" in line


def test_a_walk_that_stays_near_its_beginning_does_not_close() -> None:
    rng = np.random.default_rng(1)
    shaken = quaternion.exp(0.5 * np.radians(0.5) * rng.normal(size=(200, 3)))
    assert not any("loop" in line for line in warned(np.arange(200) / 50.0, shaken))


def test_noise_is_said_of_recordings_and_not_of_walks() -> None:
    rng = np.random.default_rng(0)
    spun = spin(*np.linspace(0.0, 60.0, 200))
    noisy = quaternion.mul(spun, quaternion.exp(0.5 * np.radians(0.5) * rng.normal(size=(200, 3))))
    times = np.arange(200) / 50.0
    (line,) = warned(times, noisy, qs.compare(times, noisy, ["slerp"]))
    assert line.startswith("Warning: the keyframes have about 0.")
    for q in (spun, walk(200, 20.0, seed=3)):
        assert warned(times, q, qs.compare(times, q, ["slerp"])) == []
