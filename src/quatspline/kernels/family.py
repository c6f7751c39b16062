"""How a family of curves is made: the mathematics of one sample in, kernels that evaluate blocks out.

A family says what the constants of a segment mean.  Its functions take them as a row ``c`` with the local
parameter u in [0, 1], and return a `Quat` or a `Vec`; they also run as plain Python, on one row of
a curve's ``segments``:

    point(c, u)          the orientation Q(u)
    jet(c, u)            (Q, Q', Q''), derivatives in R^4 by u: rates follow from it; or both of
    velocity(c, u)       vec(~Q Q'), half the body velocity by u
    acceleration(c, u)   its derivative by u, half the body acceleration

The loop over the samples of a block is written here, once.  numba's cache cannot tell closures that hold
functions apart; so a loop is copied for each function, which it finds as a global, under
that function's file and a name of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from quatspline.kernels import loops
from quatspline.kernels.jit import CONSTANTS, ROWS, Kernel, bound, inlined
from quatspline.kernels.values import restored, vec

Kernels = tuple[Kernel, Kernel, Kernel]


@dataclass(frozen=True)
class Family:
    """The sample kernels that evaluate one layout of constants; made by `family`.

    Attributes
    ----------
    constants : numbers per segment
    near : kernels for orders 0, 1, 2 where every half angle stays within `scalars.NEAR`
    far : kernels for any angle
    """

    constants: int
    near: Kernels
    far: Kernels

    def __post_init__(self) -> None:
        if self.constants > ROWS - CONSTANTS:  # the driver would write beyond the sheet
            raise ValueError(
                f"{self.constants} constants per segment: a sheet has {ROWS - CONSTANTS} rows for them"
            )


def family(
    constants: int,
    point: Callable[..., Any],
    *,
    jet: Callable[..., Any] | None = None,
    velocity: Callable[..., Any] | None = None,
    acceleration: Callable[..., Any] | None = None,
    spare: Callable[..., Any] | None = None,
    far: Family | None = None,
) -> Family:
    """Make a family from functions of one sample; see the module.

    Parameters
    ----------
    constants
        Numbers per segment, at most as many as a sheet has rows for them.
    point, jet, velocity, acceleration
        The functions, each decorated with `inlined`.
    spare
        Where the point is nearly of unit length: what restores it.  A point off by more than rounding is
        normalised or, where it has no length left, replaced by ``spare(c, u)``.
    far
        The family of the same constants for any angle, where this one is only for near ones.
    """
    count = exactly
    if jet is not None:
        velocity, acceleration = (inlined(bound(f, FUNCTION=jet)) for f in (_first, _second))
        count = whole
    if velocity is None or acceleration is None:
        raise TypeError("a family needs a jet, or a velocity and an acceleration")
    near = (
        _orientations(point, spare),
        Kernel(
            partial(bound, loops.velocity, FUNCTION=velocity, COUNT=count),
            "sample",
            lambda c, u, rate: (2.0 * rate) * velocity(c, u),
        ),
        Kernel(
            partial(bound, loops.acceleration, FUNCTION=acceleration, COUNT=count),
            "sample",
            lambda c, u, rate: (2.0 * rate * rate) * acceleration(c, u),
        ),
    )
    return Family(constants, near=near, far=near if far is None else far.near)


def _orientations(point: Callable[..., Any], spare: Callable[..., Any] | None) -> Kernel:
    """The kernel of orientations, restored to unit length where there is something to spare."""
    if spare is None:
        make = partial(bound, loops.orientation, FUNCTION=point)
        return Kernel(make, "sample", lambda c, u, rate: point(c, u))
    make = partial(bound, loops.unit_orientation, FUNCTION=point, SPARE=spare)
    return Kernel(make, "sample", lambda c, u, rate: restored(point(c, u), spare(c, u)))


@inlined
def exactly(n):
    """n samples."""
    return n


@inlined
def whole(n):
    """n samples rounded up to whole vectors (of 8): a loop without a remainder.

    The remainder of a long loop body may be contracted otherwise than its vectors, and a sample's last
    digits would depend on its neighbours.  BLOCK is a multiple, so that the sheet has room.
    """
    return (n + 7) & -8


FUNCTION: Any = None
"""What a copy of `_first` and `_second` finds in its place."""


def _first(c, u):
    q, q1, _ = FUNCTION(c, u)
    return vec(~q * q1)


def _second(c, u):
    q, _, q2 = FUNCTION(c, u)
    return vec(~q * q2)
