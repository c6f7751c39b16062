"""The package spiceypy, bindings of NAIF's SPICE toolkit: a C-kernel segment of type 3."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from quatspline.keyframes import Keyframes
from quatspline.peers.wrapping import PeerCurve, with_return
from quatspline.quaternion import FloatArray

INSTRUMENT = -1000
FRAME = "J2000"


class SpiceypyCk3(PeerCurve):
    """A C-kernel of data type 3 written by ``ckw03``, read by ``ckgp``, one call per sample.  MIT.

    SPICE documents that pointing between two instances of an interval is found "by linear
    interpolation": a rotation at constant rate about a fixed axis, so C^0, interpolating, local (two
    keyframes shape a segment).  The file is made once; every call writes it, loads it, reads all samples and
    unloads it, because loaded kernels are the process's.  Times are clock ticks as they are; orientations
    only, as matrices without a sign.  The vectorised ``cyice.ckgp`` is not called: in 8.3.0 it writes past
    the end of its flags, which ends the process sooner or later [spiceypy].
    """

    title = "SPICE CK type 3"
    reference = "spiceypy"
    peer = "spiceypy"
    continuity = 0
    order = 2
    support = 2
    constant_rate = "everywhere"
    departs = {
        "test_equivariance_at_half_turns": "rounding decides the way round at half a turn",
        "test_keeps_given_signs": "rotations carry no sign",
    }

    def _fit(self, keyframes: Keyframes) -> None:
        import spiceypy

        self.library = spiceypy
        self.keys = with_return(keyframes)
        with tempfile.TemporaryDirectory() as folder:
            self.kernel = self._written(Path(folder) / "keyframes.bc")

    def _written(self, file: Path) -> bytes:
        """The C-kernel of the keyframes: one interval, no angular velocities."""
        ticks = self._keyframes.knots.copy()  # what is read-only it refuses
        library, none = self.library, np.zeros((ticks.size, 3))
        handle = library.ckopn(str(file), "keyframes", 0)
        library.ckw03(
            handle, ticks[0], ticks[-1], INSTRUMENT, FRAME, False, "keyframes",
            ticks.size, ticks, self.keys.copy(), none, 1, ticks[:1],
        )  # fmt: skip
        library.ckcls(handle)
        return file.read_bytes()

    def _orientation(self, t: FloatArray) -> FloatArray:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "keyframes.bc"
            file.write_bytes(self.kernel)
            handle = self.library.cklpf(str(file))
            try:
                q = np.array([self._read(x) for x in t.tolist()]).reshape(-1, 4)
            finally:
                self.library.ckupf(handle)
        segment, _ = self.keyframes.locate(t)
        same = np.sum(q * self.keys[segment], axis=1) >= 0.0
        return np.where(same, 1.0, -1.0)[:, None] * q

    def _read(self, tick: float) -> FloatArray:
        matrix, _ = self.library.ckgp(INSTRUMENT, tick, 0.0, FRAME)
        return self.library.m2q(matrix)
