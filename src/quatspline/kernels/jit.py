"""How functions are marked for compilation; nothing is compiled here, and numba is not imported.

Each kind is a function of plain Python that `compiler` can turn into machine code.

``inlined``   scalar functions, always inlined into compiled callers
``compiled``  functions that others call: `engine.run` picks how
``Kernel``    functions that the compiled driver reaches through their address: a scheme supplies only its
              mathematics.  Two kinds exist, `sample_kernel` (evaluates a block of samples) and
              `fit_kernel` (turns keyframes into segments).
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from types import FunctionType
from typing import Any, Literal

ROOMS = ("engines", "kernels", "families", "fitting", "proposed")
"""Where compiled code stands, besides the file of a scheme."""

BLOCK = 48
"""Samples in a block: its sheet stays within the first-level cache, and rows no power of two apart
do not compete for the same places there."""

RESULT = 2
"""The first row of the result: w, x, y, z of a quaternion or x, y, z of a rate.  Row 0 holds u, row 1 1/h."""

CONSTANTS = RESULT + 4
"""The first row of the segment's constants, which come last: a family has as many rows as it needs."""

ROWS = CONSTANTS + 94
"""Rows that a sheet has room for: moving frames of degree 9 fill them.  What a family leaves untouched costs
nothing, being memory on the stack that no cache ever sees."""

LANES = 4
"""Constants are spread over a row by vectors of so many, the widest that a core stores at once: BLOCK is a
multiple."""

ITERATIONS, CHANGE, RESIDUAL, REACH = range(4)
"""Entries of a fit kernel's report; the last is the largest half angle that a sample can meet."""

UNREPORTED = -1.0
"""A reach that was not written: kernels for near angles must not be taken by an oversight."""

OVERWRITTEN = -2.0
"""In the place of a reach: what follows the constants was written to."""

INLINED: list[Callable[..., Any]] = []
"""Functions that compiled code inlines, in the order of their definition."""


def inlined(function: Callable[..., Any]) -> Any:
    """A function that compiled callers always inline, so that loops vectorise; Python runs it as it is."""
    INLINED.append(function)
    return function


class Compiled:
    """A function of plain Python, which also runs as machine code (`compiler.machine`)."""

    def __init__(self, python: Callable[..., Any]) -> None:
        functools.update_wrapper(self, python)
        self.python = python
        self.machine: Any = None
        """What the compiler made of it."""
        self.work = 0.0
        """Rows that plain Python has gone through, see `engine`."""

    def __call__(self, *arguments: Any) -> Any:
        """Run it as it is written."""
        return self.python(*arguments)


def compiled(function: Callable[..., Any]) -> Compiled:
    """A function that compiled code calls, or Python through `engine.run`."""
    return Compiled(function)


class Kernel:
    """A function that compiled code calls through its address.

    Attributes
    ----------
    kind : "sample" or "fit", which tells the signature
    sample : of a sample kernel, the same for one sample in plain Python: sample(c, u, rate)
    """

    def __init__(
        self,
        make: Callable[[], Callable[..., Any]],
        kind: Literal["sample", "fit"],
        sample: Callable[..., Any] | None = None,
    ) -> None:
        self._make, self.kind, self.sample = make, kind, sample
        self.machine: Any = None
        """What the compiler made of it: kept alive, for the address belongs to it."""
        self.work = 0.0
        """Samples that plain Python has evaluated or fitted by it, on all curves."""
        self.address = 0
        """Of the machine code, once there is any."""

    @property
    def python(self) -> Callable[..., Any]:
        """The function as it is written."""
        return self._make()


def sample_kernel(function: Callable[..., Any]) -> Kernel:
    """A kernel ``f(sheet, n)`` that evaluates the first n samples of a block.

    ``sheet`` holds ROWS x BLOCK numbers, one row a quantity (``rows_of(sheet)``).
    """
    return Kernel(lambda: function, "sample")


def fit_kernel(function: Callable[..., Any]) -> Kernel:
    """A kernel ``f(q, h, closed, sign, parameters, segments, report)`` that fits one track.

    q (n, 4) keyframes, h (segments,) spacings, sign the closing sign, parameters (p,) the
    scheme's options as numbers; fills segments (segments, constants) and report (4,),
    whose entries are named above.  Writing report[REACH] is a duty, whatever the family.
    """
    return Kernel(lambda: function, "fit")


@inlined
def rows_of(sheet):
    """The sheet as an array (ROWS, BLOCK): in plain Python it is one."""
    return sheet


def bound(template: Callable[..., Any], **functions: Callable[..., Any]) -> Callable[..., Any]:
    """A copy of a template with functions as globals, in the file and at the line of the first.

    numba's cache cannot tell closures that hold functions apart; it can tell such copies.
    """
    first, *_ = (getattr(f, "python", f) for f in functions.values())
    name = "_".join([*(called(f) for f in functions.values()), template.__name__])
    code = template.__code__.replace(
        co_filename=first.__code__.co_filename,
        co_firstlineno=first.__code__.co_firstlineno,
        co_name=name,
        co_qualname=name,
    )
    return FunctionType(code, {**template.__globals__, **functions}, name)


def called(function: Callable[..., Any]) -> str:
    """A name that tells a function from others of the same code: its own, and what it closes over."""
    function = getattr(function, "python", function)
    held = (cell.cell_contents for cell in function.__closure__ or ())
    parts = (called(x) if isinstance(x, FunctionType) else repr(x) for x in held)
    return "_".join([function.__name__, *parts])
