"""Lines on stderr: what a user of the command line is told beside the result."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from quatspline.system.sentence import one_line


def note(line: str) -> None:
    """Say one line."""
    print(one_line(f"quatspline: {line}"), file=sys.stderr)


@contextmanager
def noted() -> Iterator[None]:
    """Warnings of what a motion file lost or left open are such lines, once each."""
    from quatspline.motion import MotionFileWarning

    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", MotionFileWarning)
        yield
    ours = [item for item in told if issubclass(item.category, MotionFileWarning)]
    for line in dict.fromkeys(str(item.message) for item in ours):
        note(line)
    for other in told:
        if other not in ours:
            warnings.warn_explicit(other.message, other.category, other.filename, other.lineno)


@contextmanager
def naming_file(path: str) -> Iterator[None]:
    """What is wrong with the keyframes of a file is told with the file's name."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error
