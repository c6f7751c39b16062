"""The compiler: how functions become machine code, where that is cached, how kernels get addresses.

numba is imported with this module, and this module with the first compilation.  numba's disk cache does
not notice an edit to a function that a cached one calls in another file, so each file's cache folder
is keyed by a hash of all the sources that take part in it.
"""

from __future__ import annotations

import hashlib
import operator
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numba
from numba import carray, extending
from numba.core import types
from numba.core.ccallback import CFunc
from numba.core.compiler_lock import global_compiler_lock

from quatspline.engines.disk import keep
from quatspline.kernels.jit import BLOCK, INLINED, ROOMS, ROWS, Compiled, Kernel, rows_of
from quatspline.kernels.values import Mat, Quat, Vec
from quatspline.system import forking
from quatspline.system.caching import cache_base
from quatspline.system.moved import today

SETTINGS: dict[str, Any] = {
    "error_model": "numpy",
    # Contraction to fused multiply-adds keeps or improves accuracy; nothing here may reassociate, and
    # divisions stay divisions, so that a sample's rounding does not depend on its neighbours.
    "fastmath": {"contract", "nsz"},
}

SHEET = types.CPointer(types.float64)
_vector = types.Array(types.float64, 1, "C")
_matrix = types.Array(types.float64, 2, "C")

SIGNATURES: dict[str, Any] = {
    "sample": types.void(SHEET, types.intp),
    "fit": types.void(_matrix, _vector, types.boolean, types.float64, _vector, _matrix, _vector),
}
"""Of kernels."""

forking.hold(global_compiler_lock)  # a child that inherits it taken could compile nothing


def machine(function: Compiled) -> Any:
    """The machine code of a function: cached on disk, free of the interpreter lock."""
    if function.machine is None:
        with forking.undivided(), global_compiler_lock:
            if function.machine is None:  # another thread may have been here first
                _teach_functions()
                made: Any = numba.njit(nogil=True, **SETTINGS)(function.python)
                _keep(made, function.python)
                function.machine = made
    return function.machine


def address(kernel: Kernel) -> int:
    """The address of a kernel's machine code; compiles it, or loads it from the cache."""
    if not kernel.address:
        with forking.undivided(), global_compiler_lock:
            if kernel.machine is None:
                _teach_functions()
                kind = SIGNATURES[kernel.kind]
                made: Any = CFunc(kernel.python, (kind.args, kind.return_type), {}, dict(SETTINGS))
                _keep(made, kernel.python)
                made.compile()
                kernel.machine = made
            kernel.address = int(kernel.machine.address)
    return kernel.address


def _keep(made: Any, function: Callable[..., Any]) -> None:
    keep(made, function, cache_folder(Path(function.__code__.co_filename)))


@cache
def cache_folder(source: Path) -> Path:
    """The folder for code compiled from a file, named after all sources that take part in it."""
    digest = hashlib.sha256(numba.__version__.encode())
    for path in sorted(compiled_from(source)):
        digest.update(path.read_bytes())
    return cache_base() / digest.hexdigest()[:16]


def compiled_from(source: Path) -> set[Path]:
    """A file and the files of this package that it imports compiled code from, and so on."""
    package, seen = Path(__file__).parents[1], {source, *SHARED}
    pending = [*seen]
    while pending:
        path = pending.pop()
        seen.add(path)
        for module in _imported(path.read_text(encoding="utf-8")):
            found = package.joinpath(*today(module).split(".")[1:]).with_suffix(".py")
            if found.parent.name in ROOMS and found not in seen and found.is_file():
                pending.append(found)
    return seen


SHARED = [
    Path(__file__),
    *(Path(__file__).parents[1] / f"kernels/{name}.py" for name in ("jit", "values", "loops")),
]
"""What takes part in all machine code, whatever a source says."""
IMPORT = re.compile(
    r"^(?:from|import)[ \t]+(quatspline[\w.]*)(?:[ \t]+import[ \t]+(\([^)]*\)|[^\n]+))?",
    re.MULTILINE,
)


def _imported(text: str) -> Iterator[str]:
    """Names of this package's modules that a source imports, and of what may be one."""
    for module, members in IMPORT.findall(text):
        yield module
        for member in re.sub(r"#[^\n]*", "", members).strip("()").split(","):
            if member.strip():
                yield f"{module}.{member.split()[0]}"


# -- what numba has to be told -------------------------------------------------------------------

OPERATORS = {
    operator.mul: "__mul__",
    operator.add: "__add__",
    operator.sub: "__sub__",
    operator.matmul: "__matmul__",
    operator.neg: "__neg__",
    operator.invert: "__invert__",
}
"""Of the values, whose methods hold the formulas."""

INLINE: dict[str, Any] = {"forceinline": True, **SETTINGS}
overload: Any = extending.overload  # its stub knows no option of SETTINGS

_taught = 0


def _teach_functions() -> None:
    """Have compiled callers inline what was marked since the last time."""
    global _taught
    while _taught < len(INLINED):
        function = INLINED[_taught]
        if function is not rows_of:
            extending.register_jitable(**INLINE)(function)
        _taught += 1


@extending.typeof_impl.register(Compiled)
def _(function: Compiled, context: Any) -> Any:
    return types.Dispatcher(machine(function))


@overload(rows_of, jit_options=INLINE, strict=False)
def _(sheet):
    return lambda sheet: carray(sheet, (ROWS, BLOCK))


_times = {cls: extending.register_jitable(**INLINE)(cls.__rmul__) for cls in (Quat, Vec, Mat)}


def _class(kind: Any) -> Any:
    """The class of a value, of the type that numba has for it; None for other types."""
    cls = getattr(kind, "instance_class", None)
    return cls if cls in _times else None


def _teach(symbol: Any, name: str) -> None:
    """Give an operator its formulas in compiled code."""

    def unary(a):
        return vars(_class(a)).get(name) if _class(a) else None

    def binary(a, b):
        if isinstance(a, types.Number) and symbol is operator.mul and _class(b):
            times = _times[_class(b)]
            return lambda a, b: times(b, a)
        return unary(a)

    chosen: Any = unary if symbol in (operator.neg, operator.invert) else binary
    overload(symbol, jit_options=INLINE, strict=False)(chosen)


_symbol: Any
for _symbol, _name in OPERATORS.items():
    _teach(_symbol, _name)
