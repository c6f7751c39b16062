"""Curve: the one interface of all schemes, with its claims.

Longer than other modules because the interface is documented here: more than half are docstrings.
"""

from __future__ import annotations

import abc
import operator
import sys
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from quatspline import keyframes as kf
from quatspline import options, quaternion, solving, stencil
from quatspline.inputs.arrays import (
    FloatArray,
    check_out,
    checked_threads,
    switch,
)
from quatspline.inputs.domain import Domain
from quatspline.log_curve import log_curve
from quatspline.operations import UNSTATED, Operations
from quatspline.solving import SolveReport

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation


class _BySupport:
    """The lookahead of a window that reaches as far ahead of a segment as behind it.

    No data descriptor: a class or an instance that has another one sets it like any claim.
    """

    def __get__(self, curve: Curve | None, cls: type[Curve]) -> int | None:
        support = cls.support if curve is None else curve.support
        return None if support is None else max(support // 2 - 1, 0)


class Curve(abc.ABC):
    """A unit-quaternion curve through (or near) keyframes.

    A scheme subclasses this in a file of its own: class attributes state its claims, `_fit`
    prepares the curve, and `_orientation` evaluates it.  Input arrives validated, normalised and
    aligned.  The base class handles several tracks, closed curves and numerical rates.

    Parameters
    ----------
    times : (n,) strictly increasing, or (n + 1,) for a closed curve, whose last time is that of the return;
        numbers, integer stamps (subtracted as integers), datetimes or timedeltas (which count in
        seconds); None means 0, 1, 2, ...
    quaternions : (n, 4) scalar first, (n, *K, 4) for several tracks; a scipy ``Rotation``, a list of
        them, numpy-quaternion's arrays, columns of pandas
    closed : whether the curve returns to its first keyframe
    align : put neighbours on one hemisphere (the short way round); False keeps the signs as given
    closing_sign : with closed and align=False, -1 closes an odd number of full turns
    hold : hold the first or last pose outside the domain of an open curve; False refuses such times
    normalise : accept quaternions of any length, such as rounded ones; False refuses those whose norm
        differs from 1 by more than 1e-3
    **options : options of the scheme

    Raises
    ------
    ValueError
        On bad input, naming the argument, the first offending index and the value.
    ConvergenceError
        When an iterative solver does not converge (unless ``on_failure="return"``).

    Examples
    --------
    >>> import quatspline as qs
    >>> curve = qs.build("quartic", [0, 2, 3], [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0, 0.6, 0.8, 0]])
    >>> curve
    <QuarticSpline 'quartic': 3 keyframes, open, [0, 3]>
    >>> curve(2.0)
    array([0.8, 0.6, 0. , 0. ])
    >>> curve.keyframes.spacings
    array([2., 1.])
    """

    name: ClassVar[str]
    """The key: the file's stem with hyphens."""
    title: ClassVar[str]
    reference: ClassVar[str]
    """A key of references.bib."""
    interpolates: bool = True
    continuity: int
    """k of C^k on S^3."""
    order: int
    """Interior approximation order on smooth motion, uniform knots."""
    support: int | None
    """Keyframes that shape one segment; None means all."""
    lookahead: int | None = cast("int | None", _BySupport())
    """Keyframes after a segment's own two that shape it; None means all.  Half of those beyond the two
    that `support` counts, unless a scheme says otherwise."""
    constant_rate: str
    """Where keyframes of a constant spin give that spin: "everywhere", "interior" or "no"."""
    non_uniform: ClassVar[bool] = True
    closable: ClassVar[bool] = True
    iterative: ClassVar[bool] = False
    peer: ClassVar[str | None] = None
    """The third-party distribution that it wraps."""
    min_keyframes: ClassVar[int] = 2
    practical_keyframes: ClassVar[int | None] = None
    """Keyframes beyond which experiments leave it out, on any machine: time or memory would not do."""
    orders: tuple[int, ...] = (0, 1, 2)
    """Orders that a call offers; a peer may lack some."""
    operations: Operations = UNSTATED
    """Counts that no machine changes, e.g. ``Operations(exps=Per(sample=3), logs=Per(keyframe=1))``; those of
    compiled schemes are counted."""
    departs: ClassVar[dict[str, str]] = {}
    """Conformance checks that a scheme does not pass, a peer run as published as a rule, each with its reason."""
    rescue: ClassVar[dict[str, Any]] = {}
    """Options that find the curve where the published iteration, the default, does not converge."""
    rough: ClassVar[dict[str, Any]] = {}
    """Options of nearly the same curve for less time, where very many are tried, as in a reduction."""
    batched: ClassVar[bool] = False
    """Whether `_fit` and the evaluation take all tracks at once."""

    solve_report: SolveReport | None = None

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if "name" not in cls.__dict__:
            file = getattr(sys.modules.get(cls.__module__), "__file__", None) or cls.__name__
            cls.name = Path(file).stem.replace("_", "-")
        stated = cls.__dict__.get("operations", UNSTATED)
        if not (isinstance(stated, Operations) or hasattr(stated, "__get__")):
            raise TypeError(f"operations of {cls.name}: expected an Operations, found {stated!r}")

    def __init__(
        self,
        times: ArrayLike | None,
        quaternions: Any,
        *,
        closed: bool = False,
        align: bool = True,
        closing_sign: int | None = None,
        hold: bool = False,
        normalise: bool = False,
        **given: Any,
    ) -> None:
        keyframes = kf.prepare(
            times,
            quaternions,
            closed=closed,
            align=align,
            closing_sign=closing_sign,
            normalise=normalise,
            min_keyframes=self.min_keyframes,
        )
        self._build(keyframes, given, hold)

    @classmethod
    def from_keyframes(cls, keyframes: kf.Keyframes, *, hold: bool = False, **given: Any) -> Self:
        """Build the curve from prepared keyframes: what the constructor does after validation."""
        curve = cls.__new__(cls)
        curve._build(keyframes, given, hold)
        return curve

    # -- what a scheme writes -------------------------------------------------------------------

    @abc.abstractmethod
    def _fit(self, keyframes: kf.Keyframes) -> None:
        """Prepare the curve; keyword-only parameters are the scheme's options."""

    @abc.abstractmethod
    def _orientation(self, t: FloatArray) -> FloatArray:
        """Unit quaternions (m, 4) at t (m,), times since the first keyframe, within the domain."""

    def _velocity(self, t: FloatArray) -> FloatArray:
        """Body angular velocity (m, 3) in rad per time; by default from `_orientation`."""
        return stencil.rates(self._orientation, t, self._keyframes.knots)[0]

    def _acceleration(self, t: FloatArray) -> FloatArray:
        """Body angular acceleration (m, 3); by default from `_orientation`."""
        return stencil.rates(self._orientation, t, self._keyframes.knots)[1]

    # -- what a user reads ----------------------------------------------------------------------

    @property
    def times(self) -> NDArray[Any]:
        """Keyframe times as given, (n,) or, closed, (n + 1,).

        float64, but int64 for integers that float64 does not hold, and longdoubles, datetimes and
        timedeltas as they are.
        """
        return self._keyframes.times

    @cached_property
    def quaternions(self) -> FloatArray:
        """Keyframes (n, *K, 4), normalised and aligned."""
        return self._keyframes.shaped()

    @property
    def closed(self) -> bool:
        """Whether the curve returns to its first keyframe."""
        return self._keyframes.closed

    @property
    def domain(self) -> tuple[Any, Any]:
        """First and last time: numbers, or datetimes where keyframes have them."""
        return self._domain.ends

    @property
    def keyframes(self) -> kf.Keyframes:
        """The prepared keyframes."""
        return self._keyframes

    @property
    def options(self) -> dict[str, Any]:
        """The scheme's own options as given, a copy."""
        return dict(self._options)

    @property
    def engine(self) -> Literal["python", "compiled"] | None:
        """What evaluates the orientations of a scheme written in kernels: "python" or "compiled".

        None for schemes with their own code, in numpy or in a library.
        """
        return None

    @property
    def numeric_orders(self) -> tuple[int, ...]:
        """Orders whose values come from the shared numerical fallback."""
        cls = type(self)
        own = (
            True,
            cls._velocity is not Curve._velocity,
            cls._acceleration is not Curve._acceleration,
        )
        return tuple(k for k in self.orders if not own[k])

    def __call__(
        self,
        t: ArrayLike,
        order: int = 0,
        *,
        out: FloatArray | None = None,
        frame: Literal["body", "world"] = "body",
        threads: int = 1,
    ) -> FloatArray:
        """Evaluate at times t of any shape S.

        Parameters
        ----------
        t : scalar or array of shape S; an open curve refuses times outside its domain unless ``hold``
            was set, a closed one wraps them
        order : 0 for unit quaternions S + (*K, 4); 1 for the angular velocity S + (*K, 3) in rad per
            time; 2 for the angular acceleration
        out : float64 array of exactly that shape, with any strides; it is filled and returned
        frame : frame of the rates, "body" (default) or "world"
        threads : number of threads, useful for large t

        Raises
        ------
        ValueError
            On NaN, times outside an open domain, an order that the scheme lacks, a wrong out.

        Examples
        --------
        >>> import quatspline as qs
        >>> spin = qs.build("slerp", [0, 1], [[1, 0, 0, 0], [0, 0, 0, 1]])  # half a turn about z
        >>> spin(0.5, 1).round(6)
        array([0.      , 0.      , 3.141593])
        >>> spin([[0.1, 0.2, 0.3]]).shape
        (1, 3, 4)
        """
        samples, slack = self._domain.take(t)
        outside = None
        if self._domain.hold:
            samples, outside = self._domain.held(samples, slack)
        if type(order) is not int or order not in self.orders:
            order = self._checked_order(order)
        if not (isinstance(frame, str) and frame in ("body", "world")):
            raise ValueError(f"frame={frame!r}: expected 'body' or 'world'")
        if threads != 1:
            threads = checked_threads(threads)
        shape = samples.shape + self._widths[order]
        if out is not None:
            check_out(out, shape)
        direct = out is not None and out.flags.carray and not np.may_share_memory(samples, out)
        result: FloatArray = out if direct and out is not None else np.empty(shape)
        flat, origin = samples.reshape(-1), self._domain.origin
        bad = self._evaluate(flat, origin, slack, order, result.reshape(-1), threads)
        if bad >= 0:
            self._domain.refuse(t, bad)
        if order and outside is not None:
            result[outside] = 0.0  # at rest
        if order and frame == "world":
            turn = np.empty(samples.shape + self._widths[0])
            self._evaluate(flat, origin, slack, 0, turn.reshape(-1), threads)
            result[...] = quaternion.rotate(turn, result)
        if out is None or direct:
            return result
        out[...] = result  # strided, or the samples' own memory
        return out

    def log(self, t: ArrayLike) -> FloatArray:
        """The log-curve ln q(t), S + (*K, 3): the principal logarithm, for the curve's own sign.

        Where the curve runs straight through -1 (a spin about one axis through the identity), the
        logarithm continues past pi, anchored at ``domain[0]``.

        Examples
        --------
        >>> import quatspline as qs
        >>> spin = qs.build("slerp", [0, 1], [[1, 0, 0, 0], [0, 0, 0, 1]])
        >>> spin.log(1).round(6)  # half the rotation vector
        array([0.      , 0.      , 1.570796])
        """
        samples, slack = self._domain.take(t)
        if self._domain.hold:
            samples, _ = self._domain.held(samples, slack)
        return log_curve(self.inner, self._keyframes, samples - self._domain.origin, self(t))

    def rotation(self, t: ArrayLike) -> Rotation:
        """The orientations at t as a scipy ``Rotation``.

        Examples
        --------
        >>> import quatspline as qs
        >>> spin = qs.build("slerp", [0, 1], [[1, 0, 0, 0], [0, 0, 0, 1]])
        >>> spin.rotation(0.5).as_euler("xyz", degrees=True).round(6)
        array([ 0.,  0., 90.])
        """
        from scipy.spatial.transform import Rotation

        return Rotation.from_quat(self(t), scalar_first=True)

    def __repr__(self) -> str:
        n, ends = self._keyframes.count, self.domain
        lo, hi = (f"{end:g}" if isinstance(end, float) else str(end) for end in ends)
        kind = "closed" if self.closed else "open"
        tracks = f", tracks {self._keyframes.track_shape}" if self._keyframes.track_shape else ""
        return f"<{type(self).__name__} {self.name!r}: {n} keyframes, {kind}, [{lo}, {hi}]{tracks}>"

    def __getstate__(self) -> Any:
        # What it was made of: fitted constants hold addresses, which are those of this process.
        return self._keyframes, self._options, self._domain.hold

    def __setstate__(self, state: Any) -> None:
        self._build(*state)

    # -- how it works ---------------------------------------------------------------------------

    def _build(self, keyframes: kf.Keyframes, given: dict[str, Any], hold: bool = False) -> None:
        if keyframes.count < self.min_keyframes:
            raise ValueError(
                f"quaternions has {keyframes.count} keyframes: {self.name} needs {self.min_keyframes}"
            )
        if keyframes.closed and not self.closable:
            raise ValueError(f"closed=True: {self.name} has no closed curve")
        i = None if self.non_uniform else keyframes.uneven
        if i is not None:
            raise ValueError(
                f"times[{i}] to times[{i + 1}] is {float(keyframes.spacings[i])!r}, not "
                f"{float(keyframes.spacings[0])!r}: {self.name} takes uniform times only"
            )
        self._options = options.checked(type(self), given)
        self._keyframes = keyframes
        period = float(keyframes.knots[-1])
        self._domain = Domain(keyframes.times, period, keyframes.closed, switch("hold", hold))
        self._widths = tuple((*keyframes.track_shape, width) for width in (4, 3, 3))
        if self.batched or keyframes.tracks.shape[0] == 1:
            # No part is the curve itself: a cycle would keep its memory until garbage collection.
            self._parts: tuple[Curve, ...] = ()
            self._fit(keyframes, **self._options)
        else:
            known = options.declared_by(type(self))
            excused = {"on_failure": "return"} if "on_failure" in known else {}
            self._parts = tuple(
                type(self).from_keyframes(keyframes.track(k), **self._options | excused)
                for k in range(keyframes.tracks.shape[0])
            )
            report = solving.joined([p.solve_report for p in self._parts], keyframes.track_shape)
            if report is not None:
                self._conclude(report, self._options.get("on_failure", "raise"))

    def _evaluate(
        self,
        t: FloatArray,
        origin: float,
        slack: float,
        order: int,
        out: FloatArray,
        threads: int,
    ) -> int:
        """Fill out (m * K * (4 or 3),), sample by sample, at t (m,), where the curve begins at origin.

        Returns the index of the first time that is not finite or outside an open domain by more than
        the slack, -1 if there is none.
        """
        inner, flips, bad = self._domain.wrap(t - origin, slack)
        if bad.any():
            return int(np.argmax(bad))
        out = out.reshape(t.size, self._keyframes.tracks.shape[0], 3 if order else 4)
        for k, part in enumerate(self._parts or (self,)):
            evaluate = (part._orientation, part._velocity, part._acceleration)[order]
            out[:, k] = evaluate(inner)
            if order == 0 and self._keyframes.signs[k] < 0.0:
                out[flips, k] *= -1.0
        return -1

    def since(self, t: Any) -> FloatArray:
        """Times since the first keyframe (m,), within the domain, of samples of any kind and shape."""
        samples, slack = self._domain.take(t)
        if self._domain.hold:
            samples, _ = self._domain.held(samples, slack)
        inner, _, bad = self._domain.wrap(samples.reshape(-1) - self._domain.origin, slack)
        if bad.any():
            self._domain.refuse(t, int(np.argmax(bad)))
        return inner

    def inner(self, t: FloatArray, order: int = 0) -> FloatArray:
        """Values (m, K, 4 or 3) at times since the first keyframe (m,), unchecked.

        Nothing is rounded by adding a clock's time and taking it off again.
        """
        out = np.empty((t.size, self._keyframes.tracks.shape[0], 3 if order else 4))
        self._evaluate(np.array(t, dtype=float), 0.0, np.inf, order, out.reshape(-1), 1)
        return out

    def orientations(self, t: FloatArray) -> FloatArray:
        """Orientations (m, 4) of a single track at times since the first keyframe (m,).

        Within the domain, neither checked nor wrapped: for instruments, which ask often and near one another.
        """
        return self._orientation(t)

    def _checked_order(self, order: Any) -> int:
        try:
            order = operator.index(order)
        except TypeError:
            raise ValueError(f"order={order!r}: expected 0, 1 or 2") from None
        if order not in (0, 1, 2):
            raise ValueError(f"order={order}: expected 0, 1 or 2")
        if order not in self.orders:
            raise ValueError(f"order={order}: {self.name} offers orders {self.orders} only")
        return order

    def _conclude(self, report: SolveReport, on_failure: str = "raise") -> None:
        """Keep the report of a solve; raise ConvergenceError where it failed and was not excused."""
        self.solve_report = report
        if on_failure == "raise":
            solving.require_converged(self.name, report, tracks=bool(self._keyframes.track_shape))
