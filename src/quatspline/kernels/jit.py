"""Compilation: how the kernels of this package are compiled, cached and called through addresses.

Three kinds of compiled code share the settings of this module.

``inlined``   scalar primitives, always inlined into their callers
``compiled``  ordinary functions called from Python
``Kernel``    functions reached through their address: one compiled driver serves every scheme, and
              a scheme supplies only its mathematics.  Two signatures exist, `sample_kernel`
              (evaluates a block of samples) and `fit_kernel` (turns keyframes into segments).

numba's disk cache does not notice an edit to a function that a cached kernel calls in another
file, so each file's cache folder is keyed by a hash of all the sources that take part in it.
"""

from __future__ import annotations

import hashlib
import os
import re
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numba
from llvmlite import ir
from numba import extending
from numba.core import types
from numba.core.compiler_lock import global_compiler_lock

from quatspline.system import forking
from quatspline.system.moved import today

intrinsic: Any = extending.intrinsic  # typed, mypy would ask callers for the typing context

BLOCK = 48
"""Samples in a block: its sheet stays within the first-level cache, and rows no power of two apart
do not compete for the same places there."""

ROWS = 64
"""Rows of a sheet: 0 holds u, 1 holds 1/h, 2... the segment's constants, the last four the result."""

CONSTANTS = 2
"""The first row of the segment's constants."""

LANES = 4
"""Constants are spread over a row by vectors of so many, the widest that a core stores at once: BLOCK is a
multiple."""

RESULT = ROWS - 4
"""The first row of the result: w, x, y, z of a quaternion or x, y, z of a rate."""

SETTINGS: dict[str, Any] = {
    "error_model": "numpy",
    # Contraction to fused multiply-adds keeps or improves accuracy; nothing here may reassociate, and
    # divisions stay divisions, so that a sample's rounding does not depend on its neighbours.
    "fastmath": {"contract", "nsz"},
}


@cache
def cache_folder(source: Path) -> str:
    """The folder for code compiled from a file, named after all sources that take part in it."""
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(_compiled_from(source)):
        digest.update(path.read_bytes())
    import platformdirs

    base = os.environ.get("QUATSPLINE_CACHE") or platformdirs.user_cache_dir("quatspline")
    folder = Path(base) / digest.hexdigest()[:16]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        folder = Path(tempfile.mkdtemp(prefix="quatspline-"))
    return str(folder)


def _compiled_from(source: Path) -> set[Path]:
    """A file and the files of this package that it imports compiled code from, and so on."""
    package, seen, pending = Path(__file__).parents[1], {Path(__file__)}, [source]
    while pending:
        path = pending.pop()
        seen.add(path)
        for module in _imported(path.read_text(encoding="utf-8")):
            found = package.joinpath(*today(module).split(".")[1:]).with_suffix(".py")
            if found not in seen and found.is_file() and COMPILES in found.read_text("utf-8"):
                pending.append(found)
    return seen


COMPILES = "kernels.jit import"
"""What every source of compiled code says."""
IMPORT = re.compile(r"^(?:from|import) (quatspline[\w.]*)(?: import \(?([\w\s,]+))?", re.MULTILINE)


def _imported(text: str) -> Iterator[str]:
    """Names of this package's modules that a source imports, and of what may be one."""
    for module, members in IMPORT.findall(text):
        yield module
        yield from (
            f"{module}.{member.split()[0]}" for member in members.split(",") if member.strip()
        )


forking.hold(global_compiler_lock)  # a child that inherits it taken could compile nothing


def _cached(function: Callable[..., Any], decorate: Callable[[], Any]) -> Any:
    """Run a numba decorator with the cache in our folder, leaving numba's own setting alone.

    That setting is the process's: of two threads at once, one would compile into the other's folder,
    or leave its own behind.  The lock is the one that numba compiles under, so that no two locks can
    be taken in two orders.
    """
    folder = cache_folder(Path(function.__code__.co_filename))
    config: Any = numba.config
    with forking.undivided(), global_compiler_lock:
        before = config.CACHE_DIR
        config.CACHE_DIR = folder
        try:
            return decorate()
        finally:
            config.CACHE_DIR = before


def inlined(function: Callable[..., Any]) -> Any:
    """A function that compiled callers always inline, so that loops vectorise; Python runs it as it is."""
    return extending.register_jitable(forceinline=True, **SETTINGS)(function)


def compiled(function: Callable[..., Any]) -> Any:
    """Compile a function called from Python: cached on disk, free of the interpreter lock."""
    return _cached(function, lambda: numba.njit(cache=True, nogil=True, **SETTINGS)(function))


class Kernel:
    """A function compiled on first use and called from compiled code through its address."""

    def __init__(self, function: Callable[..., Any], signature: Any) -> None:
        self.python = function
        self.signature = signature
        self._compiled: Any = None  # kept alive: the address belongs to it
        self._address = 0

    @property
    def address(self) -> int:
        """The address of the compiled function; compiles it, or loads it from the cache."""
        # Not a cached_property: Python 3.11 computes those under a lock that a fork leaves taken.
        return self._address or self._compile()

    def _compile(self) -> int:
        with forking.undivided(), global_compiler_lock:
            if self._compiled is None:  # another thread may have been here first
                self._compiled = _cached(
                    self.python,
                    lambda: numba.cfunc(self.signature, cache=True, **SETTINGS)(self.python),
                )
                self._address = int(self._compiled.address)
        return self._address


_sheet = types.CPointer(types.float64)
_vector = types.Array(types.float64, 1, "C")
_matrix = types.Array(types.float64, 2, "C")

SAMPLE_SIGNATURE = types.void(_sheet, types.intp)
FIT_SIGNATURE = types.void(
    _matrix, _vector, types.boolean, types.float64, _vector, _matrix, _vector
)

ITERATIONS, CHANGE, RESIDUAL, REACH = range(4)
"""Entries of a fit kernel's report; the last is the largest half angle that a sample can meet."""

UNREPORTED = -1.0
"""A reach that was not written: kernels for near angles must not be taken by an oversight."""


def sample_kernel(function: Callable[..., Any]) -> Kernel:
    """A kernel ``f(sheet, n)`` that evaluates the first n samples of a block.

    ``sheet`` points to ROWS x BLOCK numbers, one row a quantity (``carray(sheet, (ROWS, BLOCK))``).
    """
    return Kernel(function, SAMPLE_SIGNATURE)


def fit_kernel(function: Callable[..., Any]) -> Kernel:
    """A kernel ``f(q, h, closed, sign, parameters, segments, report)`` that fits one track.

    q (n, 4) keyframes, h (segments,) spacings, sign the closing sign, parameters (p,) the
    scheme's options as numbers; fills segments (segments, constants) and report (4,),
    whose entries are named above.  Writing report[REACH] is a duty, whatever the family.
    """
    return Kernel(function, FIT_SIGNATURE)


@intrinsic(prefer_literal=True)
def on_stack(typing: Any, count: Any) -> Any:
    """Room for a constant count of float64 on the stack, aligned to a cache line: no allocation."""

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        room = ir.ArrayType(ir.DoubleType(), count.literal_value)
        with builder.goto_entry_block():
            space = builder.alloca(room)
        space.align = 64
        return builder.bitcast(space, context.get_value_type(_sheet))

    return _sheet(count), generate


@intrinsic
def splat(typing: Any, sheet: Any, at: Any, value: Any) -> Any:
    """Store LANES copies of a value from a place of a sheet on; a loop would store one by one."""

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        pointer, place, number = values
        vector = ir.VectorType(ir.DoubleType(), LANES)
        nothing, lane = ir.Constant(vector, ir.Undefined), ir.IntType(32)
        one = builder.insert_element(nothing, number, lane(0))
        every = ir.Constant(ir.VectorType(lane, LANES), [0] * LANES)
        where = builder.bitcast(builder.gep(pointer, [place]), vector.as_pointer())
        builder.store(builder.shuffle_vector(one, nothing, every), where, align=8)
        return context.get_dummy_value()

    return types.void(_sheet, types.intp, types.float64), generate


@intrinsic
def at_address(typing: Any, address: Any) -> Any:
    """A pointer to the float64 at an address."""

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        return builder.inttoptr(values[0], context.get_value_type(_sheet))

    return _sheet(types.intp), generate


@intrinsic
def call_sample(typing: Any, address: Any, sheet: Any, count: Any) -> Any:
    """Call a sample kernel by its address from compiled code."""
    return types.void(types.intp, *SAMPLE_SIGNATURE.args), _through(SAMPLE_SIGNATURE)


@intrinsic
def call_fit(
    typing: Any,
    address: Any,
    q: Any,
    h: Any,
    closed: Any,
    sign: Any,
    parameters: Any,
    segments: Any,
    report: Any,
) -> Any:
    """Call a fit kernel by its address from compiled code."""
    return types.void(types.intp, *FIT_SIGNATURE.args), _through(FIT_SIGNATURE)


def _through(signature: Any) -> Callable[..., Any]:
    """Code generation of a call through an address with the given signature."""

    def generate(context: Any, builder: Any, typed: Any, values: Any) -> Any:
        kinds = [context.get_value_type(kind) for kind in signature.args]
        pointer = ir.FunctionType(ir.VoidType(), kinds).as_pointer()
        builder.call(builder.inttoptr(values[0], pointer), values[1:])
        return context.get_dummy_value()

    return generate
