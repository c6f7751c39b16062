"""The trial of first calls at once: processes one after the other, in each threads that all call first.

Every thread waits at one barrier, builds a scheme of its own, evaluates it and lists all schemes.  Some
processes start with empty caches of compiled code (ours and numba's), and then build few schemes.
Passed when every thread lists every scheme and every curve is the same whoever built it.  By hand:

    python tests/robustness/threads.py

takes minutes; a small part of it is in ``test_threads.py``.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

COLD = ("slerp", "quartic", "quaternionic-squad")
"""What threads build without a cache: a family each of few kernels, and the peer that compiles."""
PATIENCE = 900.0
"""Seconds after which a process counts as stuck: compiling cold takes tens of them."""
KEYFRAMES = [[1, 0, 0, 0], [0.8, 0.6, 0, 0], [0.64, 0.48, 0.6, 0], [0.512, 0.384, 0.48, 0.6]]


def child(names: Sequence[str]) -> list[dict[str, Any]]:
    """What each thread of this process saw, all of them calling at once; nothing was called before."""
    barrier = threading.Barrier(len(names))
    seen: list[dict[str, Any]] = [{"scheme": name} for name in names]
    threads = [threading.Thread(target=_first_call, args=(entry, barrier)) for entry in seen]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return seen


def _first_call(entry: dict[str, Any], barrier: threading.Barrier) -> None:
    import quatspline as qs

    barrier.wait()
    try:
        curve = qs.build(entry["scheme"], None, KEYFRAMES)
        entry["samples"] = curve([0.5, 1.25, 2.75]).tolist()
        entry["listed"] = qs.schemes()
    except BaseException as error:
        entry["failure"] = f"{type(error).__name__}: {error}"


def trial(processes: int, threads: int, cold: int) -> Iterator[tuple[str, list[str]]]:
    """A line and the faults of each process, the cold ones first."""
    (alone,) = _in_process(["slerp"])
    if "failure" in alone:
        raise RuntimeError(f"one thread alone fails: {alone['failure']}")
    everything = alone["listed"]
    samples: dict[str, Any] = {}
    for number in range(processes):
        names = COLD if number < cold else everything
        chosen = [names[(number * threads + k) % len(names)] for k in range(threads)]
        began = time.perf_counter()
        with _caches(number < cold) as environment:
            seen = _in_process(chosen, environment)
        faults = [fault for entry in seen for fault in _faults(entry, everything, samples)]
        counts = " ".join(str(len(entry.get("listed", ()))) for entry in seen)
        kind = "cold" if number < cold else "warm"
        seconds = time.perf_counter() - began
        yield f"{number + 1:3} {kind}  schemes: {counts}  {seconds:6.1f} s", faults


def _in_process(names: Sequence[str], environment: dict[str, str] | None = None) -> Any:
    done = subprocess.run(
        [sys.executable, "-W", "error", __file__, "--child", *names],
        capture_output=True,
        text=True,
        env={**os.environ, **(environment or {})},
        timeout=PATIENCE,
        check=False,
    )
    if done.returncode:
        failure = f"exit status {done.returncode}: {done.stderr[-2000:]}"
        return [{"scheme": name, "failure": failure} for name in names]
    return json.loads(done.stdout)


def _faults(entry: dict[str, Any], everything: list[str], samples: dict[str, Any]) -> Iterator[str]:
    name = entry["scheme"]
    if "failure" in entry:
        yield f"{name}: {entry['failure']}"
        return
    if entry["listed"] != everything:
        yield f"{name}: not listed: {sorted({*everything} - {*entry['listed']})}"
    if samples.setdefault(name, entry["samples"]) != entry["samples"]:
        yield f"{name}: other samples than another thread's"


@contextmanager
def _caches(empty: bool) -> Iterator[dict[str, str]]:
    """Variables for a process: none, or folders of compiled code that start empty."""
    if not empty:
        yield {}
        return
    with tempfile.TemporaryDirectory() as place:
        yield {"QUATSPLINE_CACHE": f"{place}/ours", "NUMBA_CACHE_DIR": f"{place}/numba"}


def main() -> int:
    """Run the trial as asked for and tell what went wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--processes", type=int, default=20)
    parser.add_argument("--threads", type=int, default=8)
    parser.add_argument("--cold", type=int, default=5)
    parser.add_argument("--child", nargs="+", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.child:
        print(json.dumps(child(given.child)))
        return 0
    faulty = 0
    for line, faults in trial(given.processes, given.threads, given.cold):
        print("\n".join([line, *faults]), flush=True)
        faulty += bool(faults)
    print(f"{given.processes - faulty} of {given.processes} processes without a fault")
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main())
