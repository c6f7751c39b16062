"""What a measurement depends on besides its sources: versions, processor, revision, time."""

from __future__ import annotations

import os
import platform
import subprocess
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from quatspline import __version__
from quatspline.peers import installed

LIBRARIES = ("numpy", "scipy", "numba", "pandas", "matplotlib")


def provenance() -> dict[str, Any]:
    """Versions, processor and git revision."""
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return {
        "versions": versions(),
        "cpu": {"model": cpu_model(), "cores": os.cpu_count(), "usable": usable},
        "platform": platform.platform(),
        "git": git_revision(),
    }


def versions() -> dict[str, str]:
    """Of Python, this package, the libraries under it and the third-party schemes there are."""
    from quatspline.catalogue import found

    schemes = (item.scheme for item in found().values())
    peers = {scheme.peer for scheme in schemes if scheme is not None and scheme.peer is not None}
    known = {"python": platform.python_version(), "quatspline": __version__}
    return known | {name: installed.version(name) for name in (*LIBRARIES, *sorted(peers))}


def cpu_model() -> str:
    """The processor's name, as far as the system tells."""
    with suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def git_revision() -> dict[str, Any] | None:
    """Revision of the checkout that this package runs from, and whether it was edited since."""
    root = Path(__file__).resolve().parents[3]
    if not (root / ".git").exists():  # an installed package may lie inside somebody else's checkout
        return None

    def git(*arguments: str) -> str:
        command = ["git", "-C", str(root), *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    with suppress(OSError, subprocess.CalledProcessError):
        return {"revision": git("rev-parse", "HEAD"), "dirty": bool(git("status", "--porcelain"))}
    return None


def now() -> str:
    """The time, UTC, to the second."""
    return datetime.now(UTC).isoformat(timespec="seconds")
