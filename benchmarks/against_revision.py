"""Times the compiled schemes of this checkout against those of another one, interleaved.

    git worktree add ../before SOME_REVISION
    python benchmarks/against_revision.py ../before [--schemes quartic,squad] [--rounds 15]

Each checkout runs in a process of its own that lives through all rounds, kernels compiled and loaded
before the first.  In every round both time every task, one right after the other, in an order drawn
anew; a ratio is the median over rounds of new over old.  Prints a table of ratios, one row per scheme,
and, of both checkouts, the medians in nanoseconds per sample or keyframe.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import random
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

HERE = Path(__file__).parents[1]
SCHEMES = "quartic,local-quintic,squad,hermite,kim,nielson,slerp"
ORDERS = (0, 1, 2)
KEYFRAMES, SAMPLES, DEGREES = 1000, 10_000, 40.0
LEAST = 0.01
"""Processor seconds that one measurement lasts at least."""

PLACES = 64
"""Places in memory that arrays take in turn: by where they lie, the same code may take three times as long."""

Task = Callable[[], object]


def tasks(name: str) -> dict[str, tuple[Task, int]]:
    """What is timed of a scheme, each with the items of a call: samples, keyframes."""
    import quatspline as qs

    q = _walk(np.random.default_rng(0))
    curve = qs.build(name, None, q)
    timed: dict[str, tuple[Task, int]] = {
        f"order {order}": (_sampling(curve, order), SAMPLES) for order in ORDERS
    }
    timed["set-up"] = (lambda: qs.build(name, None, q)), KEYFRAMES
    timed["one sample"] = (lambda: curve(123.4)), 1
    return timed


def _sampling(curve: Any, order: int) -> Task:
    """Evaluate sorted samples, arrays in another place each time."""
    width = 3 if order else 4
    out, t = np.empty(width * SAMPLES + 8 * PLACES), np.empty(SAMPLES + 8 * PLACES)
    samples, places = np.linspace(*curve.domain, SAMPLES), itertools.cycle(range(PLACES))

    def call() -> None:
        start = 8 * next(places)
        given = t[start : start + SAMPLES]
        given[:] = samples
        curve(given, order, out=out[start : start + width * SAMPLES].reshape(SAMPLES, width))

    return call


def _walk(rng: np.random.Generator) -> Any:
    """Keyframes of steps about random axes; no function of the package, which may differ."""
    q = [np.array([1.0, 0.0, 0.0, 0.0])]
    angle = 0.5 * np.radians(DEGREES)
    for axis in rng.normal(size=(KEYFRAMES - 1, 3)):
        x, y, z = np.sin(angle) * axis / np.linalg.norm(axis)
        a, b, c, d = q[-1]
        w = np.cos(angle)
        step = np.array([[a, -b, -c, -d], [b, a, -d, c], [c, d, a, -b], [d, -c, b, a]])
        q.append(step @ (w, x, y, z))
    return np.array(q)


def worker(names: list[str]) -> None:
    """Answer each line "scheme<tab>task" by the nanoseconds of an item, calibrated at first."""
    timed = {(name, task): what for name in names for task, what in tasks(name).items()}
    loops = {key: _calibrated(call) for key, (call, _) in timed.items()}
    print(json.dumps(list(timed)), flush=True)
    for line in sys.stdin:
        name, task = line.rstrip("\n").split("\t")
        call, items = timed[name, task]
        count = loops[name, task]
        print(1e9 * _elapsed(call, count) / (count * items), flush=True)


def _elapsed(call: Task, count: int) -> float:
    start = time.process_time()  # others may share the machine
    for _ in range(count):
        call()
    return time.process_time() - start


def _calibrated(call: Task) -> int:
    call()
    count = 1
    while (seconds := _elapsed(call, count)) < LEAST / 4:
        count *= 4
    return max(1, int(np.ceil(count * LEAST / seconds)))


class Checkout:
    """A worker process on the sources of a checkout."""

    def __init__(self, root: Path, names: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, __file__, "--worker", names],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ
            | {"QUATSPLINE_ENGINE": "compiled", "PYTHONPATH": str(root.resolve() / "src")},
        )
        self.keys = [tuple(key) for key in json.loads(self._answer())]

    def _answer(self) -> str:
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit(f"the worker ended with status {self.process.wait()}")
        return line

    def time(self, key: tuple[str, str]) -> float:
        """Nanoseconds of an item."""
        assert self.process.stdin is not None
        self.process.stdin.write("\t".join(key) + "\n")
        self.process.stdin.flush()
        return float(self._answer())


def compare(old: Path, new: Path, names: str, rounds: int) -> pd.DataFrame:
    """Nanoseconds of every task in every round: columns scheme, task, round, old, new."""
    before, after = Checkout(old, names), Checkout(new, names)
    rows, rng = [], random.Random(0)
    for number in range(rounds):
        for key in rng.sample(after.keys, len(after.keys)):
            pair = [("old", before), ("new", after)]
            rng.shuffle(pair)
            rows.append({"scheme": key[0], "task": key[1], "round": number})
            rows[-1] |= {side: checkout.time(key) for side, checkout in pair}
    return pd.DataFrame(rows)


def summary(times: pd.DataFrame) -> str:
    """Tables of ratios and of nanoseconds."""
    times = times.assign(ratio=times["new"] / times["old"])
    columns = list(dict.fromkeys(times.sort_values("task")["task"]))
    medians = times.groupby(["scheme", "task"])[["ratio", "old", "new"]].median()
    ratios = medians["ratio"].unstack()[columns]
    ratios["all"] = ratios.median(axis=1)
    each = medians[["old", "new"]].unstack().swaplevel(axis=1).sort_index(axis=1)
    return "\n".join(
        [
            "new / old",
            ratios.to_string(float_format="{:.3f}".format),
            f"median over all: {medians['ratio'].median():.3f}",
            "\nns per sample, keyframe or call",
            each.to_string(float_format="{:,.2f}".format),
        ]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("old", type=Path, nargs="?", help="a checkout of another revision")
    parser.add_argument("--new", type=Path, default=HERE, help="default: this checkout")
    parser.add_argument("--schemes", default=SCHEMES)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--worker", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.worker:
        worker(given.worker.split(","))
    elif given.old is None:
        parser.error("which checkout?")
    else:
        print(summary(compare(given.old, given.new, given.schemes, given.rounds)))


if __name__ == "__main__":
    main()
