"""Speed: what every scheme costs on fixed tasks, beside what one core can do (`floors`).

A task is a set of contenders that do the same work: all schemes that can, in-house and peers as
published, and the floors: a fused multiply-add, writing the result, and one sine and cosine a sample
(numpy).  They are timed interleaved (`timing`), so that each is held against the floors of the same run.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from quatspline.catalogue import scheme
from quatspline.counted import of_a_sample, packed
from quatspline.curve import Curve
from quatspline.engines import engine
from quatspline.instruments.trials import reason
from quatspline.options import among
from quatspline.quaternion import FloatArray
from quatspline.segments import SegmentCurve
from quatspline.timing.budget import Budget, OverBudget, calls, seconds
from quatspline.timing.floors import (
    MULTIPLY_ADD,
    MULTIPLY_ADDS,
    WRITING,
    multiply_adding,
    writing,
)
from quatspline.timing.interleaved import LEAST, Contender, Timing, interleaved, repeated
from quatspline.trajectories.walks import loop, walk

SINCOS = "sin, cos"
FLOORS = (MULTIPLY_ADD, WRITING, SINCOS)
DEGREES = 40.0
OPTIONS = {"tolerance": 1e-9}
"""Of schemes that have them: iterative ones."""

QUICK_PATIENCE, PATIENCE = 0.02, 0.1
"""Seconds that one call of a contender may take at either size: slower ones get the first samples only,
which lie as densely: some libraries take a step a segment."""
PROBE = 100

BUDGET = Budget(limit=1e6, meter=calls)
"""Of a library's set-up, about a quarter of a second: it is called a dozen times."""


@dataclass(frozen=True)
class Task:
    """What is timed: ``work(name)`` makes a scheme's contender for a number of items.

    Attributes
    ----------
    name, unit : of the task and of an item, e.g. "a sample"
    keyframes, items : sizes
    width : numbers written per item: what the floor writes
    work : scheme -> (function of a number of items -> contender); raises where it does not apply
    patience : seconds per call; slower contenders do fewer items, unless it is None
    arithmetic : scheme -> packed arithmetic instructions of an item, None where they are not counted
    """

    name: str
    unit: str
    keyframes: int
    items: int
    width: int
    work: Callable[[str], Callable[[int], Contender]]
    patience: float | None = None
    arithmetic: Callable[[str], float | None] = lambda _: None


@dataclass(frozen=True)
class Timed:
    """A timed contender, or why there is none."""

    name: str
    items: int = 0
    timing: Timing | None = None
    failure: str | None = field(default=None)


def measured(
    task: Task, names: Iterable[str], rounds: int, seed: int = 0, least: float = LEAST
) -> Iterator[Timed]:
    """Time the floors and schemes of a task interleaved; one row each."""
    made: dict[str, Contender] = {}
    items: dict[str, int] = {}
    for name in (*FLOORS, *names):
        try:
            made[name], items[name] = contender_of(task, name)
        except OverBudget as error:
            yield Timed(name, failure=str(error))
        except Exception as error:  # what does not apply is a row with its reason
            yield Timed(name, failure=reason(error))
    for name, timing in interleaved(made, rounds, seed, least).items():
        yield Timed(name, items[name], timing)


def contender_of(task: Task, name: str) -> tuple[Contender, int]:
    """The contender of a scheme or a floor, and the items that it does; raises where there is none."""
    if name in FLOORS:
        return _floor(task, name), MULTIPLY_ADDS if name == MULTIPLY_ADD else task.items
    make, items = task.work(name), task.items
    if task.patience is not None:
        patience = Budget(limit=task.patience, meter=seconds)
        items = patience.largest(lambda some: partial(make(some), 1), items, PROBE)
    return make(items), items


def _floor(task: Task, name: str) -> Contender:
    if name == MULTIPLY_ADD:
        return multiply_adding()
    if name == WRITING:
        return writing(task.items, task.width)
    angles = np.linspace(0.0, 1.5, task.items)
    sine, cosine = np.empty(task.items), np.empty(task.items)

    def waves() -> None:
        np.sin(angles, out=sine)
        np.cos(angles, out=cosine)

    return repeated(waves)


JOINTS = 31
FOUR_FRAMES, SET_UP_OF_JOINTS = "31 joints, four frames a segment", "set-up of 31 joints"
"""A skeleton, and the tasks of one that was reduced to 2500 keyframes."""

# -- tasks ---------------------------------------------------------------------------------------


def tasks(rng: np.random.Generator, quick: bool) -> list[Task]:
    """The tasks of the speed table; quick leaves out those that take longest."""
    keyframes = walk(rng, 1000, DEGREES)[:, 0]
    patience = QUICK_PATIENCE if quick else PATIENCE
    even = np.linspace(0.0, 999.0, 1_000_000)
    chosen = [
        evaluation("evaluate", keyframes, even, patience),
        set_up("set-up", keyframes),
        latency("one sample", keyframes),
    ]
    if quick:
        return chosen
    dense = walk(rng, 20_000, DEGREES)[:, 0]
    few = np.linspace(0.0, len(dense) - 1.0, 3 * len(dense))
    bones, frames = walk(rng, 300, DEGREES, JOINTS), np.linspace(0.0, 299.0, 10_000)
    reduced, sparse = walk(rng, 2500, DEGREES, JOINTS), np.linspace(0.0, 2499.0, 10_000)
    turns = np.tile(loop(rng, 1000, DEGREES)[:, 0], (1000, 1))
    return [
        *chosen,
        evaluation("velocity", keyframes, even, patience, order=1),
        evaluation("acceleration", keyframes, even, patience, order=2),
        evaluation("unsorted", keyframes, rng.permutation(even), patience),
        evaluation("three samples a segment", dense, few, patience),
        evaluation("31-joint skeleton", bones, frames, patience, width=4 * JOINTS),
        evaluation(FOUR_FRAMES, reduced, sparse, patience, width=4 * JOINTS),
        set_up(SET_UP_OF_JOINTS, reduced),
        evaluation("two threads", keyframes, even, patience, threads=2),
        long_set_up("a million keyframes", turns),
    ]


def _practical(name: str, count: int, samples: int = 0) -> type[Curve]:
    """The scheme, unless so many keyframes, and samples of every segment, are too many for it."""
    cls = scheme(name)
    if failure := BUDGET.refusal(cls, count, (samples, 0, 0)):
        raise OverBudget(failure)
    return cls


def _curve(name: str, keyframes: FloatArray) -> Curve:
    cls = _practical(name, len(keyframes))
    return cls(None, keyframes, **among(cls, OPTIONS))


def evaluation(
    name: str,
    keyframes: FloatArray,
    t: FloatArray,
    patience: float,
    *,
    order: int = 0,
    threads: int = 1,
    width: int | None = None,
) -> Task:
    """Samples into a given array; of one thread with the arithmetic that compiled schemes take for them."""

    def work(who: str) -> Callable[[int], Contender]:
        curve = _curve(who, keyframes)
        if threads > 1 and curve.peer is not None:
            raise ValueError("its library offers no threads")

        def make(items: int) -> Contender:
            samples = t[:items]
            out = curve(samples, order)
            return repeated(lambda: curve(samples, order, out=out, threads=threads))

        return make

    def arithmetic(who: str) -> float | None:
        if threads > 1 or not issubclass(scheme(who), SegmentCurve):
            return None
        curve = _curve(who, keyframes)
        curve(np.mean(curve.domain), order)  # of a long curve, the segments there are fitted
        return float(packed(of_a_sample(curve, order))) * int(np.prod(curve.keyframes.track_shape))

    sizes = len(keyframes), t.size, width or (3 if order else 4)
    return Task(name, "sample", *sizes, work, patience, arithmetic)


def set_up(name: str, keyframes: FloatArray) -> Task:
    """The public call that builds a curve, validation included."""
    times = np.arange(float(len(keyframes)))

    def work(who: str) -> Callable[[int], Contender]:
        curve = _curve(who, keyframes)  # what does not apply raises here
        make = partial(type(curve), times, keyframes, **curve.options)
        return lambda items: repeated(make)

    return Task(name, "keyframe", len(keyframes), len(keyframes), 4, work)


def latency(name: str, keyframes: FloatArray) -> Task:
    """One sample a call: a frame loop."""

    def work(who: str) -> Callable[[int], Contender]:
        curve = _curve(who, keyframes)
        return lambda items: repeated(lambda: curve(456.78))

    return Task(name, "call", len(keyframes), 1, 4, work)


def long_set_up(name: str, keyframes: FloatArray) -> Task:
    """Set-up and a sample a segment, so that nothing waits to be fitted."""
    t = np.arange(len(keyframes) - 1.0) + 0.5

    def work(who: str) -> Callable[[int], Contender]:
        cls = _practical(who, len(keyframes), samples=1)
        make = partial(cls, None, keyframes, **among(cls, OPTIONS))
        return lambda items: repeated(lambda: make()(t))

    return Task(name, "keyframe", len(keyframes), len(keyframes), 4, work)


# -- start ---------------------------------------------------------------------------------------

_IMPORT = """
import time
import numpy
start = time.perf_counter()
import quatspline
print(time.perf_counter() - start)
"""
_FIRST = """
import time
import numpy as np
import quatspline as qs
q = np.array([[1.0, 0, 0, 0], [0.8, 0.6, 0, 0], [0.6, 0.8, 0, 0]])
start = time.perf_counter()
qs.QuarticSpline(None, q)(0.5)
print(time.perf_counter() - start)
"""


def starts(rounds: int, quick: bool) -> Iterator[tuple[str, list[float]]]:
    """Seconds in new processes: the import; a first curve and sample in plain Python, and compiled.

    In full size also with its compilation.
    """
    machine = {engine.VARIABLE: "compiled"}
    yield "import quatspline", [_seconds(_IMPORT) for _ in range(rounds)]
    yield "first sample", [_seconds(_FIRST) for _ in range(rounds)]
    yield "first sample, code cached", [_seconds(_FIRST, **machine) for _ in range(rounds)]
    if quick:
        return
    with tempfile.TemporaryDirectory(prefix="quatspline-") as folder:
        yield "first sample, compiling", [_seconds(_FIRST, QUATSPLINE_CACHE=folder, **machine)]


def _seconds(script: str, **environment: str) -> float:
    known = os.environ | {engine.VARIABLE: ""} | environment
    command = [sys.executable, "-c", script]
    return float(subprocess.run(command, env=known, capture_output=True, check=True).stdout)
