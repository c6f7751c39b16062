"""What commands say on standard output; that it takes nothing is told by its name."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TextIO

from quatspline.system.atomic import naming
from quatspline.system.sentence import printable

STDOUT = "standard output"

_own: TextIO | None = None


@contextmanager
def reserved() -> Iterator[None]:
    """Within it standard output is the command's own: what libraries and plug-ins print goes to stderr."""
    global _own
    before, _own, sys.stdout = (_own, sys.stdout), sys.stdout, sys.stderr
    try:
        yield
    finally:
        _own, sys.stdout = before


def output() -> TextIO:
    """Standard output as the command has it."""
    return _own or sys.stdout


def say(lines: Iterable[str]) -> None:
    """Print lines at once: what fails later does not take them along; no terminal obeys what they quote."""
    with naming(STDOUT):
        for line in lines:
            print(printable(line), file=output())
        print(end="", flush=True, file=output())
