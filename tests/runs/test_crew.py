"""Processes of a crew whose command has ended: they end as well, and say nothing."""

from __future__ import annotations

import os
from multiprocessing import connection

import pytest
from joblib.externals.loky.backend.process import LokyProcess

from quatspline.system.crew import serve


def test_a_process_that_begins_when_nobody_waits_any_more_says_nothing(
    capfd: pytest.CaptureFixture[str],
) -> None:
    """The command may be killed while a process that it started still imports."""
    ours, theirs = connection.Pipe()
    process = LokyProcess(target=serve, args=(theirs, os.getpid(), 1 << 40))
    process.start()
    ours.close()
    theirs.close()
    process.join(60)
    assert process.exitcode == 0
    assert capfd.readouterr().err == ""
