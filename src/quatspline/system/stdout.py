"""What commands say on standard output; that it takes nothing is told by its name."""

from __future__ import annotations

from collections.abc import Iterable

from quatspline.system.atomic import naming

STDOUT = "standard output"


def say(lines: Iterable[str]) -> None:
    """Print lines at once: what fails later does not take them along."""
    with naming(STDOUT):
        for line in lines:
            print(line)
        print(end="", flush=True)
