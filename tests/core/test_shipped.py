"""Which baselines come with the package: all others are tried before they are imported."""

from __future__ import annotations

import subprocess

import pytest

from quatspline import catalogue, discovery


def test_the_list_of_what_is_shipped_is_that_of_the_repository() -> None:
    folder = discovery.shipped("baselines")
    line = ["git", "ls-files", "--error-unmatch", "*.py"]
    try:
        done = subprocess.run(line, cwd=folder, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("not a clone")
    tracked = {name.removesuffix(".py") for name in done.stdout.split() if name[0] != "_"}
    assert set((folder / discovery.SHIPPED).read_text().split()) == tracked


def test_what_is_shipped_is_no_plug_in() -> None:
    assert {"slerp", "quartic"} <= set(catalogue.schemes()) - catalogue.plug_ins()
