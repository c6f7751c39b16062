"""What is advised of ten kinds of motion, and of what their owners are warned: schemes and reasons, not digits."""

from __future__ import annotations

import re
from functools import cache

import pytest

from report.ten_files import ANSWERS, FILES, terminal

NUMBER = r"\d+(\.\d+)?(e[+-]?\d+)?"

answer = cache(terminal)

TAKEN = {
    "robot-waypoints": "local-quintic (ours)",
    "camera-path": "local-quintic (ours)",
    "spacecraft-with-holds": "monotone-quintic (ours)",
    "noisy-slam": "smoothing-spline (ours)",
    "walk-cycle": "local-quintic (ours)",
    "turntable": "local-quintic (ours)",
    "hinge": "monotone-quintic (ours)",
    "drone": "quartic",
    "closed-loop": "local-quintic (ours)",
    "two-keyframes": "local-quintic (ours)",
}
WARNED = {
    "camera-path": ["like frame numbers"],
    "spacecraft-with-holds": ["are equal (the first of # holds). While the keyframes hold"],
    "noisy-slam": ["degrees of noise about each axis"],
    "walk-cycle": ["For a loop, use --closed"],
    "turntable": ["For a loop, use --closed"],
    "hinge": ["are equal. While the keyframes hold", "For a loop, use --closed"],
    "closed-loop": ["step between keyframes # and #"],
    "two-keyframes": ["the curve would turn the other way"],
}
REASONS = {
    "robot-waypoints": "Ruled out by --max-rate #: monotone-quintic (ours), # deg/s",
    "camera-path": "It meets your needs: C# (--smooth #), shaped by # keyframes (--local).",
    "spacecraft-with-holds": "It stands still where the keyframes do.",
    "noisy-slam": "If the curve must pass through the keyframes, noise and all, take local-quintic (ours)",
    "walk-cycle": "and is local: edits stay nearby.",
    "turntable": "the keyframes turn about one axis at a constant rate. Any of them will do.",
    "hinge": "Ruled out by --max-excursion #: ",
    "drone": "It meets your needs: waits for # keyframe (--causal #).",
    "closed-loop": "has # times the least torque of all schemes that pass through the keyframes",
    "two-keyframes": "about one axis at a constant rate",
}


def without_numbers(lines: list[str]) -> list[str]:
    """Lines with # for numbers, and one blank between the words of tables."""
    return [re.sub(r" +", " ", re.sub(NUMBER, "#", line)).strip() for line in lines]


@pytest.mark.parametrize("name", FILES)
def test_the_advice_and_its_reason(name: str) -> None:
    lines = without_numbers(answer(name))
    taken = next(line for line in lines if not line.startswith("Warning: "))
    assert taken.startswith(f"Take {TAKEN[name]}: ")
    assert any(REASONS[name] in line for line in lines), lines


@pytest.mark.parametrize("name", FILES)
def test_the_warnings(name: str) -> None:
    warned = [line for line in without_numbers(answer(name)) if line.startswith("Warning: ")]
    expected = WARNED.get(name, [])
    assert len(warned) == len(expected), warned
    for line, words in zip(warned, expected, strict=True):
        assert words in line


@pytest.mark.parametrize("name", FILES)
def test_what_is_taken_leads_the_table_of_five(name: str) -> None:
    lines = answer(name)
    start = lines.index("")
    assert lines[start + 1].startswith("scheme ")
    assert lines[start + 2].startswith(f"{TAKEN[name]} ")
    assert re.match(r"\d+ more on the page[:,] ", lines[start + 7])
    assert len(lines) == start + 8


@pytest.mark.parametrize("name", FILES)
def test_the_terminal_shows_what_is_committed(name: str) -> None:
    """To read it aloud: tests/data/compare."""
    committed = (ANSWERS / f"{name}.txt").read_text(encoding="utf-8").splitlines()
    assert without_numbers(answer(name)) == without_numbers(committed)


@pytest.mark.parametrize("name", FILES)
def test_numbers_are_written_as_people_write_them(name: str) -> None:
    text = "\n".join(line for line in answer(name) if "largest miss" not in line)
    assert not re.search(r"\de[+-]\d", text)
    assert "1.000 times" not in text
    assert "1.00 times" not in text


def test_not_all_are_given_the_same_advice() -> None:
    assert len(set(TAKEN.values())) == 4
