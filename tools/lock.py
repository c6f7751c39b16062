"""Locked releases with their hashes, from pyproject.toml: ``make lock``, or ``python -m tools.lock``.

One resolution for every Python, system and extra (uv's universal one), written as requirement files that pip
installs with ``--require-hashes``: ``run.txt`` is what the package and its build need, and each extra's file what
it adds to that.  Releases that are locked stay where they still serve, unless ``--upgrade`` is given.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import tempfile
import tomllib
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]
LOCKS = ROOT / "locks"
PROJECT = ROOT / "pyproject.toml"
RUN, RESOLVER = "run", "uv"
EDITABLE = "editables"
"""What hatchling asks for besides, where a checkout is installed as it stands."""

REGISTRY = "https://pypi.org/simple"
PINNED = re.compile(r"^([A-Za-z0-9._-]+)==", re.MULTILINE)
PACKAGES = (ROOT / "src/quatspline/peers/javascript", ROOT / "tests/gltf")


def project() -> dict[str, dict]:
    """pyproject.toml as it is parsed."""
    return tomllib.loads(PROJECT.read_text(encoding="utf-8"))


def builders() -> list[str]:
    """Requirements of the build: its backend, and what an editable install needs."""
    return [*project()["build-system"]["requires"], EDITABLE]


def extras() -> list[str]:
    """Names of the package's extras."""
    return sorted(project()["project"]["optional-dependencies"])


def lock(folder: Path, upgrade: bool) -> None:
    """Write all lock files into a folder; without upgrade, what stands there is kept where it serves."""
    with tempfile.TemporaryDirectory() as new:
        whole, tool = Path(new) / "whole", Path(new) / f"{RESOLVER}.txt"
        _resolve([str(PROJECT), "--all-extras"], builders(), _kept(folder, whole, upgrade))
        _resolve([], [RESOLVER], _kept(folder, tool, upgrade))
        base = Path(new) / f"{RUN}.txt"
        within = ["--constraint", str(whole)]
        _resolve([str(PROJECT), *within], builders(), base)
        without = [f"--no-emit-package={name}" for name in PINNED.findall(base.read_text())]
        for extra in extras():
            target = Path(new) / f"{extra}.txt"
            _resolve([str(PROJECT), "--extra", extra, *within, *without], [], target)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for file in sorted(Path(new).glob("*.txt")):
            shutil.move(file, folder / file.name)


def _kept(folder: Path, target: Path, upgrade: bool) -> Path:
    """A file to resolve into that holds what is locked: uv prefers the releases that it finds there."""
    locked = [] if upgrade else sorted(folder.glob("*.txt"))
    target.write_text("".join(file.read_text() for file in locked), encoding="utf-8")
    return target


def _resolve(sources: Sequence[str], further: Sequence[str], target: Path) -> None:
    """Releases for some sources and further requirements, with hashes, into a file."""
    options = [
        "--universal",
        "--python-version",
        _oldest(),
        "--default-index",
        REGISTRY,
        "--no-config",
    ]
    style = ["--generate-hashes", "--no-annotate", "--custom-compile-command", "make lock"]
    command = [
        RESOLVER,
        "--quiet",
        "pip",
        "compile",
        *options,
        *style,
        "--output-file",
        str(target),
    ]
    given = "\n".join(further)
    subprocess.run(
        [*command, *sources, *(["-"] if further else [])], input=given, text=True, check=True
    )


def _oldest() -> str:
    """The oldest Python that the package takes."""
    return project()["project"]["requires-python"].removeprefix(">=")


def lock_javascript(folder: Path) -> None:
    """Write the lock file of a folder's packages of JavaScript: npm checks its hashes as it installs."""
    quiet = ["--silent", "--no-audit", "--no-fund", "--package-lock-only"]
    subprocess.run(
        ["npm", "install", *quiet, "--omit-lockfile-registry-resolved"], cwd=folder, check=True
    )


def main(arguments: list[str] | None = None) -> int:
    """Write every lock; those of JavaScript where npm is."""
    parser = argparse.ArgumentParser(prog="python -m tools.lock", description=__doc__)
    parser.add_argument("--upgrade", action="store_true", help="take the newest releases")
    given = parser.parse_args(arguments)
    lock(LOCKS, given.upgrade)
    for folder in PACKAGES if shutil.which("npm") else ():
        lock_javascript(folder)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
