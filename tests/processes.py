"""Processes of their own, for what only a process shows: what it imports, forks, its end, locks."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from quatspline import discovery

STUCK = 120
"""Seconds after which a process counts as stuck."""


def environment(*beside: Path, **more: str) -> dict[str, str]:
    """This process's environment, in which the sources under test are imported, and modules ``beside``."""
    paths = os.pathsep.join(map(str, [discovery.PACKAGE.parent, *beside]))
    return {**os.environ, "PYTHONPATH": paths, **more}


def command(*arguments: object) -> list[str]:
    """The command line."""
    return [sys.executable, "-m", "quatspline", *map(str, arguments)]


def python(code: str, *beside: Path, **more: str) -> str:
    """What a fresh interpreter prints; warnings are errors there too."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        capture_output=True,
        text=True,
        env=environment(*beside, **more),
        timeout=STUCK,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()
