"""Libraries of JavaScript: one process of Node.js, asked for all samples of a curve at once.

The packages are those of ``javascript/package.json``, installed by ``make peers-node`` or by ``npm ci``
in that folder.  A time taken of such a curve contains two pipes, about 0.2 ms a call.
"""

from __future__ import annotations

import atexit
import json
import os
import shutil
import subprocess
import threading
from contextlib import suppress

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.installed import JAVASCRIPT
from quatspline.peers.wrapping import PeerCurve, with_return
from quatspline.quaternion import FloatArray

TO_XYZW, TO_WXYZ = [1, 2, 3, 0], [3, 0, 1, 2]


class NodeCurve(PeerCurve):
    """A curve that JavaScript evaluates: its keyframes go along with every call."""

    call: str
    """What ``bridge.mjs`` is asked for."""

    def _fit(self, keyframes: Keyframes) -> None:
        q = with_return(keyframes)[:, TO_XYZW]
        more = [extra[:, TO_XYZW] for extra in self._more(keyframes)]
        self.table = np.column_stack([keyframes.knots, q, *more])

    def _more(self, keyframes: Keyframes) -> tuple[FloatArray, ...]:
        """What the call needs of every keyframe besides, as quaternions (n, 4), closed (n + 1, 4)."""
        return ()

    def _orientation(self, t: FloatArray) -> FloatArray:
        if not t.size:
            return np.empty((0, 4))
        samples = np.column_stack([t, *self.keyframes.locate(t)])
        return bridge().ask(self.call, self.table, samples)[:, TO_WXYZ]


class Bridge:
    """The process, its pipes, and the lock that lets one thread ask at a time."""

    def __init__(self) -> None:
        node = shutil.which("node") or "node"
        self.process = subprocess.Popen(
            [node, str(JAVASCRIPT / "bridge.mjs")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        self.lock = threading.Lock()

    def ask(self, call: str, keyframes: FloatArray, samples: FloatArray) -> FloatArray:
        """Quaternions (m, 4), scalar last, of the tables that ``bridge.mjs`` describes.

        Raises
        ------
        RuntimeError
            When the library, or the process, fails.
        """
        shapes = {"call": call, "keyframes": keyframes.shape, "samples": samples.shape}
        head = json.dumps(shapes).encode()
        size = len(head).to_bytes(4, "little")
        parts = (size, head, keyframes.tobytes(), samples.tobytes())
        with self.lock:
            answer, q = self._asked(b"".join(parts), 8 * 4 * len(samples))
        if "error" in answer:
            raise RuntimeError(f"{call}, by node: {answer['error']}")
        return np.frombuffer(q, dtype=float).reshape(-1, 4)

    def _asked(self, request: bytes, size: int) -> tuple[dict[str, str], bytes]:
        """What the process says, and the bytes that follow if all is well."""
        pipe, answers = self.process.stdin, self.process.stdout
        assert pipe is not None
        assert answers is not None
        try:
            pipe.write(request)
            pipe.flush()
            answer = json.loads(answers.readline())
            return answer, b"" if "error" in answer else answers.read(size)
        except (OSError, ValueError):  # a pipe that is broken, half a line
            return {"error": "its process ended"}, b""

    def close(self) -> None:
        """End the process: it leaves where its input ends."""
        for pipe in (self.process.stdin, self.process.stdout):
            with suppress(OSError):  # what a broken pipe still held
                if pipe is not None:
                    pipe.close()
        self.process.wait()


_bridges: dict[int, Bridge] = {}
"""By process: a fork's child must not read its parent's answers."""


def bridge() -> Bridge:
    """The bridge of this process, begun where there is none, or none that lives."""
    own = os.getpid()
    if own in _bridges and _bridges[own].process.poll() is not None:
        _close()
    if own not in _bridges:
        _bridges[own] = Bridge()
        atexit.register(_close)
    return _bridges[own]


def _close() -> None:
    bridge = _bridges.pop(os.getpid(), None)
    if bridge is not None:
        bridge.close()
