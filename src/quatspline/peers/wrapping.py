"""What all wrappers of third-party schemes share: silence, frames, the return of a closed curve.

A wrapper calls the library as its documentation says, on its fastest documented path, and changes
nothing but the form of numbers: times since the first keyframe, quaternions (m, 4) scalar first, rates
in the body frame.  Faults stay in: they are measured, by version.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
from quatspline.system.caching import cache_base
from quatspline.system.forking import undivided
from quatspline.system.quiet import quiet

_begun: set[str] = set()
"""Libraries that this process has imported, or is about to."""


@contextmanager
def _alone(library: str) -> Iterator[None]:
    """What runs inside imports a library; the first time no other process does beside it.

    Two processes that compile functions of numba's `guvectorize` into one cache at once leave a
    mixture there, which crashes whatever process loads it (numba's issue 10128).
    """
    if library in _begun:  # `quiet` keeps other threads out
        yield
        return
    lock = _lock()
    _begun.add(library)
    try:
        yield
    except BaseException:
        _begun.discard(library)
        raise
    finally:
        if lock is not None:
            lock.release()


def _lock() -> Any:
    """A lock of this user's processes, taken; None where there is no place for one."""
    from filelock import FileLock

    base = cache_base()
    try:
        base.mkdir(parents=True, exist_ok=True)
        lock = FileLock(base / "peers.lock")
        lock.acquire()
    except (OSError, NotImplementedError):
        return None
    return lock


class PeerCurve(Curve):
    """A curve that a third-party library evaluates; its warnings stay inside."""

    # What a library does not publish (order, support, constant rate) is what we measured.
    orders: tuple[int, ...] = (0,)

    def _published(self, t: FloatArray, order: int) -> FloatArray | None:
        """Body rates (m, 3) that the library publishes and its wrapper does not offer; None without any.

        They are others than the curve's.  Instruments report how far off they are.
        """
        return None

    def _build(self, keyframes: Keyframes, given: dict[str, Any], hold: bool = False) -> None:
        with undivided(), quiet(), _alone(self.peer or ""):
            super()._build(keyframes, given, hold)

    def _evaluate(self, *arguments: Any) -> int:
        with quiet():
            return super()._evaluate(*arguments)


def with_return(keyframes: Keyframes) -> FloatArray:
    """The keyframes (n, 4); closed (n + 1, 4), the first one repeated with the closing sign."""
    q = keyframes.quaternions
    return np.concatenate([q, keyframes.sign * q[:1]]) if keyframes.closed else q


def body_frame(q: FloatArray, rates: FloatArray) -> FloatArray:
    """World rates (m, 3) at orientations q (m, 4), seen from the body.

    The same turn serves acceleration: the frame's own turning drops out because omega x omega = 0.
    """
    return quaternion.rotate(quaternion.conj(q), rates)
