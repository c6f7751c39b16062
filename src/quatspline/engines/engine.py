"""Two engines run the same functions: plain Python, at once, and machine code, once it repays compiling.

Compiling takes seconds in a fresh installation, and numba's import alone as long as thousands of samples
in plain Python.  So work begins in Python, is counted, and goes on in machine code from where that would
have repaid.  What makes tables, `always_compiled`, compiles first, so that no number depends on a cache.

``quatspline warmup`` compiles everything once, after which machine code only has to be loaded.

``QUATSPLINE_ENGINE`` decides otherwise: "compiled" or "python".
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from quatspline.kernels.jit import ROOMS, Compiled, Kernel
from quatspline.system.caching import cache_base
from quatspline.system.forking import undivided

VARIABLE = "QUATSPLINE_ENGINE"

REPAYS = 1e5
"""Samples that plain Python evaluates (30 to 40 us each, measured) while a scheme compiles."""

LOADS = 1.5e4
"""Samples that plain Python evaluates while numba and code that was compiled before load."""

ROW = 0.3
"""Samples that one row of array algebra counts as."""

DOMAIN = "math domain error"
"""What `math` says of a root of less than nothing."""

_always = 0


@contextmanager
def unfit_suppressed() -> Iterator[None]:
    """Suppress what Python raises where machine code goes on with infinities: that is then compiled."""
    with np.errstate(all="ignore"):
        try:
            yield
        except (ZeroDivisionError, OverflowError):
            pass
        except ValueError as error:
            if str(error) != DOMAIN:
                raise


@contextmanager
def always_compiled() -> Iterator[None]:
    """Within it, in any thread of this process, everything is compiled before it runs."""
    global _always
    _always += 1
    try:
        yield
    finally:
        _always -= 1


def compiles(work: float, kernel: Kernel | None = None) -> bool:
    """Whether so much work, in samples, is for machine code; where that of the kernel is there, any is.

    Raises
    ------
    ValueError
        Where the environment names an engine that there is not.
    """
    asked = os.environ.get(VARIABLE, "")
    if asked not in ("", "python", "compiled"):
        raise ValueError(f"{VARIABLE}={asked!r}: expected 'python' or 'compiled'")
    if _always > 0:
        return True
    if asked:
        return asked == "compiled"
    if kernel is not None:
        if kernel.address:
            return True
        work = max(work, kernel.work)
    return work >= REPAYS or (work >= LOADS and _is_warm())


def mark_warm() -> None:
    """Note in the cache that everything was compiled from these sources."""
    with suppress(OSError):  # then code was compiled for this process only
        _mark().touch()
    forget_warm()


def forget_warm() -> None:
    """Look at the cache again where it is asked for next."""
    _is_warm.cache_clear()


@cache
def _is_warm() -> bool:
    with suppress(OSError):
        return _mark().exists()
    return False


def _mark() -> Path:
    """A file named after the sources of compiled code and numba's version."""
    digest = hashlib.sha256(f"{version('numba')} {sys.implementation.cache_tag}".encode())
    for room in ROOMS:
        for path in sorted((Path(__file__).parents[1] / room).glob("*.py")):
            digest.update(path.read_bytes())
    return cache_base() / f"{digest.hexdigest()[:16]}.warm"


def run(function: Compiled, rows: int, *arguments: Any) -> Any:
    """Call a function, by the engine that it and so many more rows are for."""
    function.work += ROW * rows
    if not compiles(function.work):
        before = [array.copy() if _is_written(array) else None for array in arguments]
        with unfit_suppressed():
            return function.python(*arguments)
        for array, saved in zip(arguments, before, strict=True):
            if saved is not None:
                array[...] = saved
    return machine(function)(*arguments)


def _is_written(array: Any) -> bool:
    return isinstance(array, np.ndarray) and array.flags.writeable


def machine(function: Compiled) -> Any:
    """The machine code of a function."""
    return function.machine or native().machine(function)


def address(kernel: Kernel) -> int:
    """The address of a kernel's machine code."""
    return kernel.address or int(native().address(kernel))


_native: Any = None


def native() -> Any:
    """The module that compiles and drives machine code, with numba: imported when it is first needed."""
    global _native
    if _native is None:
        with undivided():  # a fork waits for the import
            from quatspline.engines import native as module

            _native = module
    return _native
