"""Fuzz in-house schemes: ``python tests/fuzz/run.py --builds 1000000 --jobs 2``.

Cases are numbered, and case i of a seed is always the same.  What was found is kept in a file, a line
per chunk of cases, so that an interrupted run goes on where it stopped; failures are printed with the
call that repeats them: ``python tests/fuzz/run.py --only INDEX``.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

from cases import case, names
from checks import outcome

CHUNK = 1000
SHOWN = 40


def chunk(seed: int, first: int, count: int, schemes: list[str]) -> dict[str, Any]:
    """The outcomes of some cases, counted, and each failure by index."""
    counts: Counter[str] = Counter()
    failures: list[tuple[int, str, str]] = []
    for index in range(first, first + count):
        drawn = case(seed, index, schemes)
        kind, what = outcome(drawn)
        counts[kind if kind != "refused" else f"refused: {what}"] += 1
        if kind == "failed":
            failures.append((index, drawn.scheme, what))
    return {"first": first, "count": count, "counts": counts, "failures": failures}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--builds", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--schemes", nargs="+", help="only these; indices are then others")
    parser.add_argument("--only", type=int, help="one case, its failure raised")
    parser.add_argument("--keep", type=Path, help="a file of finished chunks to go on from")
    given = parser.parse_args()
    schemes = given.schemes or names()
    if given.only is not None:
        drawn = case(given.seed, given.only, schemes)
        print(drawn, outcome(drawn), sep="\n")
        return 0
    done = _kept(given.keep, given.seed, schemes)
    left = [i for i in range(0, given.builds, CHUNK) if i not in done]
    with ProcessPoolExecutor(given.jobs) as pool:
        runs = [
            pool.submit(chunk, given.seed, i, min(CHUNK, given.builds - i), schemes) for i in left
        ]
        for run in runs:
            found = run.result()
            done[found["first"]] = found
            if given.keep:
                with given.keep.open("a", encoding="utf-8") as stream:
                    stream.write(json.dumps(found) + "\n")
    return _told(done)


def _kept(path: Path | None, seed: int, schemes: list[str]) -> dict[int, dict[str, Any]]:
    """Finished chunks of a file; its first line says of which cases."""
    head = json.dumps({"seed": seed, "schemes": schemes})
    lines = path.read_text(encoding="utf-8").splitlines() if path and path.exists() else []
    if path and lines[:1] != [head]:
        path.write_text(head + "\n", encoding="utf-8")
        return {}
    return {found["first"]: found for found in map(json.loads, lines[1:])}


def _told(done: dict[int, dict[str, Any]]) -> int:
    counts: Counter[str] = Counter()
    failures = [tuple(failure) for found in done.values() for failure in found["failures"]]
    for found in done.values():
        counts.update(found["counts"])
    for kind, number in sorted(counts.items()):
        print(f"{number:9d}  {kind}")
    for scheme, number in Counter(scheme for _, scheme, _ in failures).most_common():
        print(f"{number:9d}  failed: {scheme}")
    for index, scheme, what in sorted(failures)[:SHOWN]:
        print(f"--only {index}: {scheme}: {what[:300]}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
