"""Memory that is taken where it is written: for arrays of which perhaps little is needed."""

from __future__ import annotations

import contextlib
import mmap
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray


class Pages:
    """Room for floats, whose pages are taken one by one as they are written.

    Numpy asks for pages of 2 MB where it can: to fill an array they take half the time, but a few numbers in each
    take it whole.  Here that is asked for when most is about to be written (`whole`).
    """

    def __init__(self, count: int) -> None:
        private: dict[str, Any] = {}
        if sys.platform != "win32":  # what a fork's child writes is its own
            private = {"flags": mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS}
        self._memory = mmap.mmap(-1, max(1, 8 * count), **private)
        self._advise("MADV_NOHUGEPAGE")
        self.array: NDArray[np.float64] = np.frombuffer(self._memory, count=count)

    def whole(self) -> None:
        """Most is about to be written: larger pages serve."""
        self._advise("MADV_HUGEPAGE")

    def _advise(self, name: str) -> None:
        if hasattr(mmap, name):
            with contextlib.suppress(OSError):  # of a kernel without such pages
                self._memory.madvise(getattr(mmap, name))
