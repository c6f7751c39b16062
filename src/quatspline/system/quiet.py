"""Silence for other people's code: its warnings are not its caller's business."""

from __future__ import annotations

import os
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

_one = threading.RLock()


def _renew() -> None:
    global _one  # a child has not the thread that held it
    _one = threading.RLock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_renew)


@contextmanager
def quiet() -> Iterator[None]:
    """No warning leaks from what runs inside.

    One thread at a time: the filters of warnings are the process's, so that of two threads the last
    one out would leave the other's behind; and libraries need not bear several threads.
    """
    with _one, warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        yield
