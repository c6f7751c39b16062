"""What is said of motion files: refused in one sentence, or read with a warning."""

from __future__ import annotations

import warnings
from pathlib import Path

from quatspline.system.sentence import one_line

MOST = 384
"""Characters of a sentence: it may quote a file, and tell of a file's faults each kind."""


class MotionFileError(ValueError):
    """A motion file that cannot be read or written: one sentence that names the file, the line and the reason.

    Examples
    --------
    >>> import quatspline as qs
    >>> qs.read_motion("walk.bhv")
    Traceback (most recent call last):
    quatspline.motion.errors.MotionFileError: walk.bhv: unknown suffix '.bhv': did you mean '.bvh'?
    """

    def __init__(self, sentence: str) -> None:
        super().__init__(one_line(sentence, MOST))


class MotionFileWarning(UserWarning):
    """Something in a motion file was left out, or had several readings of which one was chosen."""


def warn(path: str | Path, what: str) -> None:
    """Say what a reader or writer did that its user may not expect."""
    warnings.warn(one_line(f"{path}: {what}"), MotionFileWarning, stacklevel=2)
