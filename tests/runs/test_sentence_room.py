"""What a command refuses is told in a line of bounded length, its prefix and its hint included."""

from __future__ import annotations

import pytest

from quatspline.cli.commands import main
from quatspline.system.sentence import MOST


@pytest.mark.parametrize("count", ["1" * 400, "x" * 5000, "\x1b" * 400])
def test_a_refusal_has_at_most_so_many_characters(
    count: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["sample", "k.csv", "--scheme", "slerp", "--count", count]) == 2
    said = capsys.readouterr().err
    assert len(said.rstrip("\n")) <= MOST
    assert said.endswith("(see quatspline sample --help)\n")
    assert said.rstrip("\n").isprintable()
