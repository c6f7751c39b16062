"""What one core can do, measured beside what is held against it: fused multiply-adds, and writing.

Both are compiled as kernels are, so that they use the same vectors.  A sample can take no less than the larger of
its arithmetic, in packed instructions of which each counts as a multiply-add, and of writing its result.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from quatspline.kernels.jit import compiled, inlined
from quatspline.quaternion import FloatArray
from quatspline.timing.interleaved import Contender, repeated

MULTIPLY_ADD, WRITING = "multiply-add", "writing"

CHAINS, STEPS, VALUES = 8, 64, 2048
"""Independent chains, as many as fill two units of four cycles' latency; steps of each; and values, in the
first-level cache, which all chains start from."""

MULTIPLY_ADDS = CHAINS * STEPS * VALUES
"""Of a pass: the chains' starts and their sum, two in a hundred more, are left out."""


@inlined
def _step(c, x, y):
    a0, a1, a2, a3, a4, a5, a6, a7 = c
    return (
        a0 * x + y,
        a1 * x + y,
        a2 * x + y,
        a3 * x + y,
        a4 * x + y,
        a5 * x + y,
        a6 * x + y,
        a7 * x + y,
    )


@inlined
def _four(c, x, y):
    return _step(_step(_step(_step(c, x, y), x, y), x, y), x, y)


@inlined
def _sixteen(c, x, y):
    return _four(_four(_four(_four(c, x, y), x, y), x, y), x, y)


@compiled
def multiply_add(values, x, y):
    """Every value becomes the mean of eight chains a <- a x + y that start beside it."""
    for j in range(values.size):
        v = values[j]
        c = (v, v + 1.0, v + 2.0, v + 3.0, v + 4.0, v + 5.0, v + 6.0, v + 7.0)
        c = _sixteen(_sixteen(_sixteen(_sixteen(c, x, y), x, y), x, y), x, y)
        values[j] = 0.125 * (((c[0] + c[1]) + (c[2] + c[3])) + ((c[4] + c[5]) + (c[6] + c[7])))


@compiled
def write(out, value):
    """Fill out (m,)."""
    for j in range(out.size):
        out[j] = value


def multiply_adding() -> Contender:
    """A pass of MULTIPLY_ADDS."""
    from quatspline.engines.compiler import machine  # numba

    return repeated(partial(machine(multiply_add), np.linspace(0.0, 1.0, VALUES), 0.75, 0.25))


def writing(items: int, width: int) -> Contender:
    """Items of width float64 each, into one array."""
    from quatspline.engines.compiler import machine  # numba

    out: FloatArray = np.empty(items * width)
    return repeated(partial(machine(write), out, 1.0))


def attainable(packed: float, multiply_add: float, written: float) -> float:
    """Seconds that an item takes at least: of arithmetic instructions, or of writing.

    Parameters
    ----------
    packed
        Arithmetic instructions of an item, see `counted.packed`.
    multiply_add, written
        Seconds of a multiply-add, and of writing an item.
    """
    return max(packed * multiply_add, written)
