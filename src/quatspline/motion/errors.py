"""What is said of motion files: refused in one sentence, or read with a warning."""

from __future__ import annotations

import warnings
from pathlib import Path


class MotionFileError(ValueError):
    """A motion file that cannot be read or written: one sentence of the file, the line and the reason.

    Examples
    --------
    >>> import quatspline as qs
    >>> qs.read_motion("walk.bhv")
    Traceback (most recent call last):
    quatspline.motion.errors.MotionFileError: walk.bhv: unknown suffix '.bhv': did you mean '.bvh'?
    """


class MotionFileWarning(UserWarning):
    """A motion file of which something was left out or taken in one of several ways."""


def warn(path: str | Path, what: str) -> None:
    """Say what a reader or writer did that its user may not expect."""
    warnings.warn(f"{path}: {what}", MotionFileWarning, stacklevel=2)
