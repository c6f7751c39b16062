"""Runs experiments: measure, write the table, draw from the table alone, enter the manifest."""

from __future__ import annotations

import sys
import time
import traceback
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from quatspline import catalogue
from quatspline.cli.outcome import outcomes
from quatspline.engines.engine import always_compiled
from quatspline.runs import staff, sweeps
from quatspline.runs.experiment import (
    Experiment,
    Run,
    Size,
    experiments,
    files,
    fingerprint,
    traced,
)
from quatspline.runs.journal import Journal, Kept, forget
from quatspline.runs.results import JOURNAL, PAGE, Results, now
from quatspline.system.sentence import printable
from quatspline.system.stdout import say

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["Run", "experiments", "fingerprint", "run"]


def run(
    names: Sequence[str] = (),
    *,
    schemes: Sequence[str] | None = None,
    size: Size | None = None,
    seed: int = 0,
    out: str | Path = "results",
    command: Sequence[str] = (),
    jobs: int | None = None,
    dask: str | None = None,
    force: bool = False,
) -> list[str]:
    """Run experiments into a results directory and return the names of those that failed.

    One that fails is told on stderr and the rest still run.  What an interrupted run of the same
    options and sources had finished is kept.  ``size`` is by default full for the paper's, quick
    for the others.  Cells are measured by ``jobs`` processes, by default one a core, or by the Dask
    scheduler at an address.  A run of all experiments ends with derived tables and the page, and so
    does any into a folder that has them; the result of each table is then said in a line.  Files that
    are not the folder's own are replaced only with ``force``.  Raises ValueError for unknown or
    unusable names, for ``schemes`` without one, without a scheduler, and, before anything is
    measured, for a folder that another process writes to or that has foreign files of the names to
    be written.
    """
    if schemes is not None and not schemes:
        raise ValueError("schemes: no name given")
    chosen = experiments(names)
    picked = [catalogue.scheme(name).name for name in schemes] if schemes is not None else None
    runs = {e.name: Run.of(size or e.size, picked, seed) for e in chosen}
    with always_compiled(), staff.workers(jobs, dask):
        results = Results(out, force=force)
        with results.writing():
            for experiment, as_before in _outdated(chosen, results):
                chosen.append(experiment)
                runs[experiment.name] = as_before
            results.guard(_outputs(chosen, page=not names))
            journal = Journal(results, fingerprint(runs))
            results.begin(command, seed=seed, schemes=picked)
            for experiment in chosen:
                _run_or_keep(experiment, runs[experiment.name], results, journal)
            results.finish()
            journal.close()
            failed = [e.name for e in chosen if results.manifest["experiments"][e.name]["failure"]]
            failed += _write_page(results, asked=not names)
            say(outcomes(results.folder, [e.name for e in chosen if e.name not in failed]))
    return failed


def _outputs(chosen: Sequence[Experiment], *, page: bool) -> list[str]:
    """The files that a run may write, as far as that can be told before."""
    names = [f"{e.name}{end}" for e in chosen for end in e.outputs]
    return [*names, PAGE, JOURNAL] if page else [*names, JOURNAL]


def _outdated(chosen: Sequence[Experiment], results: Results) -> list[tuple[Experiment, Run]]:
    """Derived experiments of the folder that would not be run, with what they were asked for."""
    earlier = results.manifest.get("experiments") or {}
    others = sorted((set(earlier) & set(files())) - {e.name for e in chosen})
    derived = [e for e in (experiments(others) if others else []) if e.derived]
    entries = [(e, earlier[e.name]) for e in derived]
    return [(e, Run.of(entry["size"], entry["schemes"], entry["seed"])) for e, entry in entries]


def _write_page(results: Results, *, asked: bool) -> list[str]:
    """Write the page of all tables in the folder; its name if that fails, for they are worth more.

    As derived tables, a page that is there already must not show what others no longer say.
    """
    page = results.folder / PAGE
    if not asked and not results.owns(PAGE):
        if page.exists():
            _say(f"{page}: not written by a run in this folder, so it was left as it is")
        return []
    from quatspline.page import write_page

    try:
        _say(f"{write_page(results)}: written")
    except Exception as error:
        _say(f"{PAGE}: failed: {traced(error)}")
        return [PAGE]
    return []


# -- one experiment -----------------------------------------------------------------------------


def _run_or_keep(experiment: Experiment, run: Run, results: Results, journal: Journal) -> None:
    name = experiment.name
    kept = journal.finished(name)
    if kept is not None:
        _say(f"{name}: kept as finished by the interrupted run of {journal.content['start']}")
        results.record(name, kept)
        forget(results, name)
        return
    entry: dict[str, Any] = {"title": experiment.title, "size": run.size, "seed": run.seed}
    entry |= {"schemes": run.schemes, "start": now(), "failure": None}
    began = time.perf_counter()
    try:
        _perform(experiment, run, results)
    except Exception as error:
        entry["failure"] = traced(error)
        results.text(f"{name}.error.txt", "".join(traceback.format_exception(error)))
    results.tidy(name)
    entry |= {"end": now(), "seconds": round(time.perf_counter() - began, 3)}
    results.record(name, entry)
    if entry["failure"]:
        _say(f"{name}: failed: {entry['failure']}")
    else:
        journal.add(name, results.manifest["experiments"][name])
        forget(results, name)
        _say(f"{name}: done at {run.size} size in {entry['seconds']:.1f} s")


def _perform(experiment: Experiment, run: Run, results: Results) -> None:
    """Measure and write; then draw from what was written."""
    if experiment.problem is not None:
        raise experiment.problem
    name, module = experiment.name, experiment.module
    assert module is not None
    size = f"Size: {run.size}; seed {run.seed}."
    note = " ".join([*filter(None, [getattr(module, "NOTE", "")]), size])
    table = results.table(
        name,
        _checked(_measured(name, module, run, results)),
        title=experiment.title,
        note=note,
        formats=getattr(module, "FORMATS", None),
        keys=getattr(module, "KEYS", None),
        closing=getattr(module, "text", None),
    )
    if hasattr(module, "draw") and not _all_failed(table):
        if hasattr(module, "caption"):
            results.text(f"{name}.caption.txt", module.caption(table).strip() + "\n")
        _draw(module, table, name, results)
    if hasattr(module, "replays"):
        results.replays(name, module.replays(run))


def _measured(name: str, module: ModuleType, run: Run, results: Results) -> Any:
    if callable(getattr(module, "cells", None)):
        return sweeps.sweep(name, module, run, Kept(results, name, fingerprint({name: run})))
    if callable(getattr(module, "measure", None)):
        return module.measure(run)
    if callable(getattr(module, "derive", None)):
        from quatspline.findings.findings import reader  # pandas: workers import this module, too

        return module.derive(run, reader(results.folder))
    raise TypeError(
        "no function measure(run), nor cells(run) and measure_cell(run, ...), nor derive(run, read), "
        "in the file"
    )


def _all_failed(table: pd.DataFrame) -> bool:
    """Whether no row is a measurement: there is nothing to draw."""
    return "failure" in table and bool(table["failure"].notna().all())


def _checked(table: Any) -> pd.DataFrame:
    import pandas as pd

    if not isinstance(table, pd.DataFrame) or table.empty:
        found = "an empty table" if isinstance(table, pd.DataFrame) else type(table).__name__
        raise TypeError(f"measure returned {found}: a DataFrame with rows is expected")
    return table


def _draw(module: ModuleType, table: pd.DataFrame, name: str, results: Results) -> None:
    import matplotlib as mpl

    from quatspline.figures import style

    mpl.use("Agg")  # nothing here may open a window
    try:
        with style.applied():
            results.figure(name, module.draw(table))
    finally:
        if "matplotlib.pyplot" in sys.modules:
            sys.modules["matplotlib.pyplot"].close("all")


def _say(line: str) -> None:
    print(printable(line), file=sys.stderr, flush=True)
