"""A small part of the trials of ``torture.py``: each kind, few times."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

import pytest
from hostile import files
from torture import Tally, Torture

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")


@pytest.fixture(scope="module")
def torture(tmp_path_factory: pytest.TempPathFactory) -> Torture:
    return Torture(tmp_path_factory.mktemp("torture"))


def clean(tally: Tally, least: int = 1) -> None:
    assert tally.tried >= least
    assert tally.clean, "\n".join(tally.notes)


def test_a_run_that_was_killed_goes_on(torture: Torture) -> None:
    clean(torture.kills(signal.SIGTERM, 1))
    clean(torture.writes(1))


def test_a_corrupted_file(torture: Torture) -> None:
    clean(torture.corruptions(1))


def test_bad_plug_ins_cost_their_own_rows(torture: Torture) -> None:
    """In both experiments, with a limit that a busy machine does not reach."""
    bad = ("interrupt", "end", "prints", "double", "cell_exit", "cell_end")
    clean(torture.plug_ins(bad, limits=120.0))


def test_files_are_hostile_in_every_format(tmp_path: Path, torture: Torture) -> None:
    made = list(files(tmp_path / "made", torture.rng, 1, 1))
    assert len({"".join(path.suffixes) for path in made}) == 10
    for path in made[:3]:
        clean(torture.files([path]))
