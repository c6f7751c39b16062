"""What the wrappers of third-party schemes share: silence, versions, frames.

A wrapper calls the library as its documentation says, on its fastest documented path, and changes
nothing but the form of numbers: times since the first keyframe, quaternions (m, 4) scalar first, rates
in the body frame.  Faults stay in: they are measured, by version.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from quatspline import quaternion
from quatspline.curve import Curve
from quatspline.keyframes import Keyframes
from quatspline.quaternion import FloatArray
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
    import platformdirs
    from filelock import FileLock

    base = Path(os.environ.get("QUATSPLINE_CACHE") or platformdirs.user_cache_dir("quatspline"))
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
        """Body rates (m, 3) that the library publishes and its wrapper does not offer, being others
        than the curve's; None without any.  Instruments report how far off they are."""
        return None

    def _build(self, keyframes: Keyframes, given: dict[str, Any]) -> None:
        with undivided(), quiet(), _alone(self.peer or ""):
            super()._build(keyframes, given)

    def _evaluate(self, *arguments: Any) -> int:
        with quiet():
            return super()._evaluate(*arguments)


def with_return(keyframes: Keyframes) -> FloatArray:
    """The keyframes (n, 4); closed (n + 1, 4), the first one repeated with the closing sign."""
    q = keyframes.quaternions
    return np.concatenate([q, keyframes.sign * q[:1]]) if keyframes.closed else q


def reflected(keyframes: Keyframes) -> tuple[FloatArray, FloatArray]:
    """Keyframes (n + 2, 4) and times (n + 3,) that put the wrap of an always closed library outside.

    Both ends get a reflected phantom, q_{-1} = q_0 q_1^{-1} q_0 at t_{-1} = 2 t_0 - t_1, so that no
    segment between given keyframes meets the wrap of a curve that four keyframes shape.
    """
    q, t = keyframes.quaternions, keyframes.knots
    before = _mirror(q[0], q[1])
    after = _mirror(q[-1], q[-2])
    last = 2.0 * t[-1] - t[-2]
    times = np.concatenate([[2.0 * t[0] - t[1]], t, [last, last + t[-1] - t[-2]]])
    return np.concatenate([before[None], q, after[None]]), times


def _mirror(a: FloatArray, b: FloatArray) -> FloatArray:
    """The point that follows b, a on their great arc at the same step: a b^-1 a."""
    return quaternion.mul(quaternion.mul(a, quaternion.conj(b)), a)


def body_frame(q: FloatArray, rates: FloatArray) -> FloatArray:
    """World rates (m, 3) at orientations q (m, 4), seen from the body.

    The same turn serves acceleration: the frame's own turning drops out because omega x omega = 0.
    """
    return quaternion.rotate(quaternion.conj(q), rates)


def unit_quaternions(q: FloatArray) -> list[Any]:
    """Rows (w, x, y, z) as quaternions of the package `splines`."""
    from splines.quaternion import UnitQuaternion

    return [UnitQuaternion.from_unit_xyzw((x, y, z, w)) for w, x, y, z in q.tolist()]


def rows(quaternions: Any, first: FloatArray) -> FloatArray:
    """Quaternions of `splines` as rows (m, 4), in the sign of our first keyframe.

    The package flips a first keyframe with negative scalar part ("canonicalized").
    """
    sign = -1.0 if first[0] < 0.0 else 1.0
    return sign * np.array([q.wxyz for q in quaternions], dtype=float).reshape(-1, 4)


def published_velocity(curve: Any, t: FloatArray, orientation: FloatArray) -> FloatArray:
    """``evaluate(t, 1)`` of a curve of `splines`, world frame, in the body frame (m, 3)."""
    with quiet():
        return body_frame(orientation, np.array([curve.evaluate(x, 1) for x in t], dtype=float))


class InterpolatePyCurve(PeerCurve):
    """What the curves of InterpolatePy share: one call a sample, rates in the world frame."""

    peer = "InterpolatePy"
    reference = "interpolatepy"
    closable = False
    orders = (0, 1, 2)

    def _construct(self, curve: type, *arguments: Any) -> None:
        """Call a class of the library; some flip all signs, so ours is read off the first key."""
        from interpolatepy import Quaternion

        keyframes = self._keyframes
        q = [Quaternion(*row) for row in keyframes.quaternions.tolist()]
        self.curve = curve(keyframes.knots.tolist(), q, *arguments)
        self.sign = 1.0
        first = self._orientation(keyframes.knots[:1])[0]
        self.sign = -1.0 if first @ keyframes.quaternions[0] < 0.0 else 1.0

    def _orientation(self, t: FloatArray) -> FloatArray:
        q = [(p.w, p.x, p.y, p.z) for p in map(self.curve.evaluate, t.tolist())]
        return self.sign * np.array(q, dtype=float).reshape(-1, 4)

    def _velocity(self, t: FloatArray) -> FloatArray:
        return self._rates(self.curve.evaluate_velocity, t)

    def _acceleration(self, t: FloatArray) -> FloatArray:
        return self._rates(self.curve.evaluate_acceleration, t)

    def _rates(self, evaluate: Any, t: FloatArray) -> FloatArray:
        world = np.array([evaluate(x) for x in t.tolist()], dtype=float).reshape(-1, 3)
        return body_frame(self._orientation(t), world)
